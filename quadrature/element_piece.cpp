#include "quadrature/element_piece.h"

#include <algorithm>
#include <limits>

#include "geometry/bezier/subdivision.h"
#include "quadrature/adaptive.h"

namespace isorim::quadrature {

namespace {

template <int Dim>
std::array<int, Dim - 1> degrees_of(const geometry::BezierElement<Dim>& element) {
  std::array<int, Dim - 1> degrees;
  std::copy(element.degree.begin(), element.degree.end(), degrees.begin());
  return degrees;
}

/// The largest ratio of two weights on one line of the net that runs in the direction.
template <int Dim>
double weight_ratio(const ElementPiece<Dim>& piece, int direction) {
  const std::array<int, Dim - 1> degrees = degrees_of(*piece.element);
  const int points = degrees[static_cast<std::size_t>(direction)] + 1;
  const int stride = direction == 0 ? 1 : degrees[0] + 1;
  const int lines = piece.element->control_point_count() / points;
  double ratio = 1.0;
  for (int line = 0; line < lines; ++line) {
    const int start = direction == 0 ? line * points : line;
    double smallest = piece.net()[start * (Dim + 1) + Dim];
    double largest = smallest;
    for (int i = 1; i < points; ++i) {
      const double weight = piece.net()[(start + i * stride) * (Dim + 1) + Dim];
      smallest = std::min(smallest, weight);
      largest = std::max(largest, weight);
    }
    ratio = std::max(ratio, largest / smallest);
  }
  return ratio;
}

/// Gauss-Legendre with n points errs like rho^(-2 n), rho the sum of the semi-axes of the largest ellipse with foci
/// at the ends in which the integrand is analytic (Trefethen, SIAM Rev. 50, 2008, theorem 4.5). A quadratic weight
/// function 1, w, 1 on [-1, 1] vanishes at +-i sqrt((1 + w) / (1 - w)).
int rational_order(double ratio, int degree, double tolerance) {
  const double pole = std::sqrt((ratio + 1.0) / (ratio - 1.0));
  const double rho = pole + std::sqrt(pole * pole + 1.0);
  const double points = std::log(1.0 / std::max(tolerance, 1e-16)) / (2.0 * std::log(rho));
  // The numerators' degree and the repeated pole cost a few points on top.
  return std::min(static_cast<int>(std::ceil(points)) + 2 * degree + 1, largest_adaptive_order);
}

template <int Dim>
void keep_part(ElementPiece<Dim>& piece, CutRegion region) {
  if (region.extent() != CutRegion::Extent::everything)
    piece.region = std::make_shared<const CutRegion>(std::move(region));
}

}  // namespace

template <int Dim>
std::vector<ElementPiece<Dim>> pieces_of_element(const geometry::ElementTable<Dim>& table,
                                                 const geometry::BezierElement<Dim>& element, CutForm form) {
  std::vector<ElementPiece<Dim>> pieces;
  if (form == CutForm::sectors && element.is_cut()) {
    for (Sector& sector : sectors_of(table.regions[static_cast<std::size_t>(element.region)])) {
      pieces.push_back({&element, table.nets.data() + element.offset, {}, 0});
      pieces.back().sector = std::make_shared<const Sector>(std::move(sector));
    }
  } else if (ElementPiece<Dim> piece = whole_element(table, element); !piece.empty()) {
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

template <int Dim>
std::pair<ElementPiece<Dim>, ElementPiece<Dim>> bisect(const ElementPiece<Dim>& piece, int direction) {
  if (piece.sector) {
    std::pair<ElementPiece<Dim>, ElementPiece<Dim>> halves{piece, piece};
    auto [first, second] = bisect(*piece.sector, direction);
    halves.first.sector = std::make_shared<const Sector>(std::move(first));
    halves.second.sector = std::make_shared<const Sector>(std::move(second));
    halves.first.depth = halves.second.depth = piece.depth + 1;
    return halves;
  }
  const std::array<int, Dim - 1> degrees = degrees_of(*piece.element);
  const auto size = static_cast<std::size_t>(piece.element->control_point_count() * (Dim + 1));
  auto [first, second] = geometry::subdivide({piece.net(), size}, Dim + 1, degrees, direction);
  const int depth = piece.depth + 1;
  std::pair<ElementPiece<Dim>, ElementPiece<Dim>> halves{{piece.element, piece.element_net, std::move(first), depth},
                                                         {piece.element, piece.element_net, std::move(second), depth}};
  if (piece.is_cut()) {
    auto [kept_of_first, kept_of_second] = piece.region->halves(direction);
    keep_part(halves.first, std::move(kept_of_first));
    keep_part(halves.second, std::move(kept_of_second));
  }
  return halves;
}

template <int Dim>
bool is_affine(const geometry::ElementTable<Dim>& table, const geometry::BezierElement<Dim>& element) {
  if (!element.polynomial) return false;
  constexpr double roundings = 16.0 * std::numeric_limits<double>::epsilon();
  const auto net = table.net_matrix(element);
  const int columns = element.degree[0] + 1;
  const auto corner = net.col(0).template head<Dim>();
  std::array<geometry::Vector<Dim>, Dim - 1> edges;
  for (std::size_t d = 0; d < Dim - 1; ++d) {
    const int end = d == 0 ? element.degree[0] : element.degree[d] * columns;
    edges[d] = (net.col(end).template head<Dim>() - corner) / element.degree[d];
  }
  const double size = net.template topRows<Dim>().cwiseAbs().maxCoeff();
  for (int k = 0; k < net.cols(); ++k) {
    geometry::Vector<Dim> rest = net.col(k).template head<Dim>() - corner - (k % columns) * edges[0];
    if constexpr (Dim == 3) {
      const int row = k / columns;
      rest -= row * edges[1];
    }
    if (rest.cwiseAbs().maxCoeff() > roundings * size) return false;
  }
  return true;
}

template <int Dim>
Orders<Dim - 1> expected_orders(const ElementPiece<Dim>& piece, double tolerance) {
  constexpr double constant_weights = 1.0 + 1e-14;
  Orders<Dim - 1> orders;
  for (std::size_t d = 0; d < Dim - 1; ++d) {
    const int degree = piece.element->degree[d];
    orders[d] = exact_order<Dim>(degree);
    if (piece.element->polynomial) continue;
    const double ratio = weight_ratio(piece, static_cast<int>(d));
    orders[d] = ratio <= constant_weights ? orders[d] + 2 : rational_order(ratio, degree, tolerance);
  }
  return orders;
}

template std::pair<ElementPiece<2>, ElementPiece<2>> bisect(const ElementPiece<2>&, int);
template std::pair<ElementPiece<3>, ElementPiece<3>> bisect(const ElementPiece<3>&, int);
template std::vector<ElementPiece<2>> pieces_of_element(const geometry::ElementTable<2>&,
                                                        const geometry::BezierElement<2>&, CutForm);
template std::vector<ElementPiece<3>> pieces_of_element(const geometry::ElementTable<3>&,
                                                        const geometry::BezierElement<3>&, CutForm);
template bool is_affine(const geometry::ElementTable<2>&, const geometry::BezierElement<2>&);
template bool is_affine(const geometry::ElementTable<3>&, const geometry::BezierElement<3>&);
template Orders<1> expected_orders(const ElementPiece<2>&, double);
template Orders<2> expected_orders(const ElementPiece<3>&, double);

}  // namespace isorim::quadrature
