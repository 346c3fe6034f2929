#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "quadrature/element_piece.h"
#include "quadrature/piece_samples.h"
#include "quadrature/rim.h"

namespace isorim::quadrature {

namespace {

/// Some points of a piece, of a cut one only such as are kept.
template <int Dim>
void sample_kept_part(const ElementPiece<Dim>& piece, PieceSamples<Dim>& samples) {
  constexpr int nodes = 5;
  constexpr int rows = 6;
  Orders<Dim - 1> orders;
  for (std::size_t d = 0; d < Dim - 1; ++d) orders[d] = piece.element->degree[d] == 1 ? 2 : nodes;
  if constexpr (Dim == 3) {
    if (piece.is_cut()) {
      samples = sample_at(piece, piece.region->inner_points(rows));
      return;
    }
  }
  sample_piece(piece, orders, samples);
}

/// Points of the boundary with their outward unit normals: the tangent half-spaces whose intersection is the kernel,
/// the set of poles from which the whole boundary is seen.
template <int Dim>
PieceSamples<Dim> tangent_planes(const geometry::ElementTable<Dim>& table, std::size_t most_elements) {
  // A regular choice of elements where there are very many.
  const std::size_t stride = std::max<std::size_t>(1, table.elements.size() / most_elements);
  PieceSamples<Dim> planes;
  PieceSamples<Dim> samples;
  std::vector<double> points;
  std::vector<double> normals;
  for (std::size_t e = 0; e < table.elements.size(); e += stride) {
    sample_kept_part(whole_element(table, table.elements[e]), samples);
    for (Eigen::Index i = 0; i < samples.points.cols(); ++i) {
      const double length = samples.normals.col(i).norm();
      if (length <= 0.0) continue;
      for (int k = 0; k < Dim; ++k) {
        points.push_back(samples.points(k, i));
        normals.push_back(samples.normals(k, i) / length);
      }
    }
  }
  const auto count = static_cast<Eigen::Index>(points.size()) / Dim;
  planes.points = Eigen::Map<const geometry::Points<Dim>>(points.data(), Dim, count);
  planes.normals = Eigen::Map<const geometry::Points<Dim>>(normals.data(), Dim, count);
  return planes;
}

/// Signed distances of the tangent planes from x: positive where x lies on the inner side.
template <int Dim>
Eigen::VectorXd clearances(const PieceSamples<Dim>& planes, const geometry::Point<Dim>& x) {
  return planes.normals.cwiseProduct(planes.points.colwise() - x).colwise().sum().transpose();
}

/// A point that every plane leaves at least `margin` on its inner side, by moving to the margin of the worst plane
/// again and again (Agmon and Motzkin-Schoenberg's relaxation, Canad. J. Math. 6, 1954); none after some hundred steps.
template <int Dim>
std::optional<geometry::Point<Dim>> kernel_point(const PieceSamples<Dim>& planes, geometry::Point<Dim> x,
                                                 double margin) {
  constexpr int steps = 300;
  for (int step = 0; step < steps; ++step) {
    Eigen::Index worst = 0;
    const double clearance = clearances(planes, x).minCoeff(&worst);
    if (clearance >= 0.5 * margin) return x;
    x -= (margin - clearance) * planes.normals.col(worst);
  }
  return std::nullopt;
}

constexpr std::size_t all_elements = static_cast<std::size_t>(-1);

}  // namespace

template <int Dim>
bool is_star_shaped_about(const geometry::ElementTable<Dim>& table, const geometry::Point<Dim>& pole) {
  const double slack = 1e-12 * geometry::bounding_box(table).diagonal();
  const PieceSamples<Dim> planes = tangent_planes(table, all_elements);
  return planes.points.cols() > 0 && clearances(planes, pole).minCoeff() >= -slack;
}

template <int Dim>
geometry::Point<Dim> default_pole(const geometry::ElementTable<Dim>& table) {
  constexpr std::size_t most_elements = 2000;
  const geometry::BoundingBox<Dim> box = geometry::bounding_box(table);
  const PieceSamples<Dim> planes = tangent_planes(table, most_elements);
  if (planes.points.cols() == 0) return box.middle();
  for (const double margin : {0.02, 0.002, 0.0002}) {
    if (const auto pole = kernel_point(planes, box.middle(), margin * box.diagonal())) return *pole;
  }
  return box.middle();
}

template bool is_star_shaped_about(const geometry::ElementTable<2>&, const geometry::Point<2>&);
template bool is_star_shaped_about(const geometry::ElementTable<3>&, const geometry::Point<3>&);
template geometry::Point<2> default_pole(const geometry::ElementTable<2>&);
template geometry::Point<3> default_pole(const geometry::ElementTable<3>&);

}  // namespace isorim::quadrature
