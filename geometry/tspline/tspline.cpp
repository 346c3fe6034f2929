#include "geometry/tspline/tspline.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/nurbs/validation.h"
#include "geometry/tspline/local_bspline.h"

namespace isorim::geometry {
namespace {

std::string place(const TMesh& mesh, const IndexBox& anchor) {
  const auto coordinate = [&](Direction d) {
    const double first = mesh.knots(d)[anchor.first[index(d)]];
    const double last = mesh.knots(d)[anchor.last[index(d)]];
    return first == last ? fmt::format("{} = {}", "uv"[index(d)], first)
                         : fmt::format("{} from {} to {}", "uv"[index(d)], first, last);
  };
  return coordinate(Direction::u) + ", " + coordinate(Direction::v);
}

/// Where a parameter is evaluated: which limit, and the place that chooses the polynomial pieces.
struct Location {
  double clamped = 0.0;
  Limit limit = Limit::from_right;
};

Location locate(const KnotVector& knots, double u) {
  const Interval domain = knots.domain();
  // The negation also takes NaN, which stays visible in the value.
  if (!(u < domain.last)) return {domain.last, Limit::from_left};
  return {std::max(u, domain.first), Limit::from_right};
}

/// Derivatives of order 0 to Orders of one local B-spline; all zero outside its support.
template <int Orders>
Eigen::Matrix<double, Orders + 1, 1> local_derivatives(std::span<const double> knots, const Location& location,
                                                       double u) {
  Eigen::Matrix<double, Orders + 1, 1> derivatives = Eigen::Matrix<double, Orders + 1, 1>::Zero();
  const int piece = piece_at(knots, location.clamped, location.limit);
  if (piece < 0) return derivatives;
  for (int order = 0; order <= Orders; ++order) derivatives[order] = piece_derivative(knots, piece, u, order);
  return derivatives;
}

/// Calls use(k, derivatives in u, derivatives in v) for each function on the face of uv.
template <int Orders, class Use>
void for_functions_at(const TMesh& mesh, const Point2& uv, Use&& use) {
  const Location u = locate(mesh.knots(Direction::u), uv[0]);
  const Location v = locate(mesh.knots(Direction::v), uv[1]);
  const int face =
      mesh.index_mesh().face_at(mesh.knots(Direction::u).find_span(uv[0]), mesh.knots(Direction::v).find_span(uv[1]));
  for (const int k : mesh.functions_on_faces()[static_cast<std::size_t>(face)])
    use(k, local_derivatives<Orders>(mesh.local_knots(k, Direction::u), u, uv[0]),
        local_derivatives<Orders>(mesh.local_knots(k, Direction::v), v, uv[1]));
}

/// The derivatives of x / w from those of the homogeneous (x, w); columns: value, du, dv, duu, duv, dvv (Piegl &
/// Tiller, eq. 4.20).
SurfaceJet<3> rational_jet(const Eigen::Matrix<double, 4, 6>& sums) {
  const auto a = [&](Eigen::Index column) -> Vector3 { return sums.col(column).head<3>(); };
  const auto w = [&](Eigen::Index column) { return sums(3, column); };
  const double weight = w(0);
  SurfaceJet<3> jet;
  jet.point = a(0) / weight;
  jet.du = (a(1) - w(1) * jet.point) / weight;
  jet.dv = (a(2) - w(2) * jet.point) / weight;
  jet.duu = (a(3) - 2.0 * w(1) * jet.du - w(3) * jet.point) / weight;
  jet.duv = (a(4) - w(1) * jet.dv - w(2) * jet.du - w(4) * jet.point) / weight;
  jet.dvv = (a(5) - 2.0 * w(2) * jet.dv - w(5) * jet.point) / weight;
  return jet;
}

/// The knots of the face's functions strictly inside `range`, with its ends, increasing.
std::vector<double> cut_lines(const TMesh& mesh, std::span<const int> functions, Direction d, Interval range) {
  std::vector<double> lines{range.first, range.last};
  for (const int k : functions)
    for (const double knot : mesh.local_knots(k, d))
      if (range.first < knot && knot < range.last) lines.push_back(knot);
  std::sort(lines.begin(), lines.end());
  lines.erase(std::unique(lines.begin(), lines.end()), lines.end());
  return lines;
}

bool supports(std::span<const double> knots, Interval range) {
  return knots.front() <= range.first && range.last <= knots.back();
}

/// The functions of the cell's face that live on the cell.
std::vector<std::int32_t> functions_on_cell(const TMesh& mesh, const BezierCell& cell) {
  std::vector<std::int32_t> functions;
  for (const int k : mesh.functions_on_faces()[static_cast<std::size_t>(cell.face)])
    if (supports(mesh.local_knots(k, Direction::u), cell.domain[0]) &&
        supports(mesh.local_knots(k, Direction::v), cell.domain[1]))
      functions.push_back(k);
  return functions;
}

ExtractionElement extraction_element(const TMesh& mesh, const BezierCell& cell) {
  ExtractionElement element;
  element.degree = {static_cast<std::int8_t>(mesh.degree(Direction::u)),
                    static_cast<std::int8_t>(mesh.degree(Direction::v))};
  element.domain = cell.domain;
  element.functions = functions_on_cell(mesh, cell);
  std::vector<double> row_u(static_cast<std::size_t>(element.degree[0]) + 1);
  std::vector<double> row_v(static_cast<std::size_t>(element.degree[1]) + 1);
  element.rows.resize(static_cast<Eigen::Index>(element.functions.size()),
                      static_cast<Eigen::Index>(row_u.size() * row_v.size()));
  for (std::size_t row = 0; row < element.functions.size(); ++row) {
    bernstein_coefficients(mesh.local_knots(element.functions[row], Direction::u), cell.domain[0], row_u);
    bernstein_coefficients(mesh.local_knots(element.functions[row], Direction::v), cell.domain[1], row_v);
    Eigen::Index column = 0;
    for (const double v : row_v)
      for (const double u : row_u) element.rows(static_cast<Eigen::Index>(row), column++) = u * v;
  }
  return element;
}

}  // namespace

TSpline::TSpline(TMesh mesh, HomogeneousPoints<3> homogeneous)
    : mesh_(std::move(mesh)), homogeneous_(std::move(homogeneous)) {
  if (homogeneous_.cols() != mesh_.function_count())
    throw GeometryError(fmt::format("T-spline: {} control points given; the T-mesh has {} anchors", homogeneous_.cols(),
                                    mesh_.function_count()));
  require_valid_net<3>(homogeneous_, "T-spline", [this](Eigen::Index k) {
    return fmt::format("{} (anchor at {})", k, place(mesh_, mesh_.anchors()[static_cast<std::size_t>(k)]));
  });
}

TSpline TSpline::from_points(TMesh mesh, const Points<3>& points, std::span<const double> weights) {
  return {std::move(mesh), homogeneous_net<3>(points, weights, "T-spline")};
}

TSpline::TSpline(const NurbsSurface<3>& surface)
    : TSpline(TMesh(surface.knots_u(), surface.knots_v()), surface.homogeneous()) {}

Points<3> TSpline::control_points() const {
  return homogeneous_.topRows<3>().array().rowwise() / homogeneous_.row(3).array();
}

Point3 evaluate(const TSpline& surface, const Point2& uv) {
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  for_functions_at<0>(surface.mesh(), uv,
                      [&](int k, const auto& u, const auto& v) { sum += u[0] * v[0] * surface.homogeneous().col(k); });
  return sum.head<3>() / sum[3];
}

SurfaceJet<3> evaluate_jet(const TSpline& surface, const Point2& uv) {
  Eigen::Matrix<double, 4, 6> sums = Eigen::Matrix<double, 4, 6>::Zero();
  for_functions_at<2>(surface.mesh(), uv, [&](int k, const auto& u, const auto& v) {
    const Eigen::Matrix<double, 1, 6> products{u[0] * v[0], u[1] * v[0], u[0] * v[1],
                                               u[2] * v[0], u[1] * v[1], u[0] * v[2]};
    sums += surface.homogeneous().col(k) * products;
  });
  return rational_jet(sums);
}

Eigen::VectorXd function_values(const TMesh& mesh, const Point2& uv) {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(mesh.function_count());
  for_functions_at<0>(mesh, uv, [&](int k, const auto& u, const auto& v) { values[k] = u[0] * v[0]; });
  return values;
}

TSpline transform(const TSpline& surface, const AffineMap<3>& map) {
  HomogeneousPoints<3> net = surface.homogeneous();
  net.topRows<3>() = map.linear * surface.homogeneous().topRows<3>() + map.translation * net.row(3);
  return {surface.mesh(), std::move(net)};
}

std::vector<BezierCell> bezier_mesh(const TMesh& mesh) {
  const std::vector<IndexBox>& faces = mesh.index_mesh().faces();
  std::vector<int> order(faces.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    const auto& first = faces[static_cast<std::size_t>(a)].first;
    const auto& second = faces[static_cast<std::size_t>(b)].first;
    return std::pair(first[1], first[0]) < std::pair(second[1], second[0]);
  });
  std::vector<BezierCell> cells;
  for (const int face : order) {
    const std::vector<int>& functions = mesh.functions_on_faces()[static_cast<std::size_t>(face)];
    const std::array<Interval, 2> whole = mesh.face_domain(face);
    if (whole[0].length() == 0.0 || whole[1].length() == 0.0) continue;
    const std::vector<double> lines_u = cut_lines(mesh, functions, Direction::u, whole[0]);
    const std::vector<double> lines_v = cut_lines(mesh, functions, Direction::v, whole[1]);
    for (std::size_t j = 0; j + 1 < lines_v.size(); ++j)
      for (std::size_t i = 0; i + 1 < lines_u.size(); ++i)
        cells.push_back({face, {Interval{lines_u[i], lines_u[i + 1]}, Interval{lines_v[j], lines_v[j + 1]}}});
  }
  return cells;
}

std::vector<ExtractionElement> extraction_elements(const TMesh& mesh) {
  std::vector<ExtractionElement> elements;
  for (const BezierCell& cell : bezier_mesh(mesh)) elements.push_back(extraction_element(mesh, cell));
  return elements;
}

ExtractedSurface extract(const TSpline& surface) {
  return {surface.homogeneous(), extraction_elements(surface.mesh())};
}

}  // namespace isorim::geometry
