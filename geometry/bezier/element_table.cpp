#include "geometry/bezier/element_table.h"

#include <algorithm>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "geometry/bezier/subdivision.h"
#include "geometry/errors.h"
#include "geometry/spline/bspline.h"
#include "geometry/trimming/face_cells.h"

namespace isorim::geometry {

namespace {

/// target = source * extraction for `points` homogeneous points: (Dim + 1) x (p + 1) each way, at most 31 columns.
template <int Dim>
void extract(const double* source, const Eigen::MatrixXd& extraction, double* target) {
  using Net = Eigen::Matrix<double, Dim + 1, Eigen::Dynamic>;
  const Eigen::Index count = extraction.rows();
  Eigen::Map<Net>(target, Dim + 1, count).noalias() =
      Eigen::Map<const Net>(source, Dim + 1, count).lazyProduct(extraction);
}

/// Divides a net by its common weight.
template <int Dim>
void divide_out_weight(Eigen::Map<HomogeneousPoints<Dim>> net, double weight) {
  if (weight != 1.0) net.template topRows<Dim>() /= weight;
  net.row(Dim).setOnes();
}

/// A new element at the end of the table, its net not yet filled.
template <int Dim>
BezierElement<Dim>& append_element(ElementTable<Dim>& table, std::size_t patch, int orientation) {
  BezierElement<Dim>& element = table.elements.emplace_back();
  element.patch = static_cast<std::int32_t>(patch);
  element.orientation = static_cast<std::int8_t>(orientation);
  element.offset = table.nets.size();
  return element;
}

/// Space for count elements of `points` control points each. Grows geometrically over many small patches.
template <int Dim>
void reserve_more(ElementTable<Dim>& table, std::size_t count, std::size_t points) {
  const auto reserve = [](auto& container, std::size_t more) {
    const std::size_t needed = container.size() + more;
    if (needed > container.capacity()) container.reserve(std::max(needed, container.size() + container.size() / 2));
  };
  reserve(table.elements, count);
  reserve(table.nets, count * points * (Dim + 1));
}

void append_patch(ElementTable<2>& table, const Patch<2>& patch, std::size_t index) {
  const KnotVector& knots = patch.shape.knots();
  const HomogeneousPoints<2>& net = patch.shape.homogeneous();
  const int p = knots.degree();
  const std::vector<ExtractionOperator> operators = extraction_operators(knots);
  reserve_more(table, operators.size(), static_cast<std::size_t>(p) + 1);
  for (const ExtractionOperator& extraction : operators) {
    BezierElement<2>& element = append_element(table, index, patch.orientation);
    element.degree = {static_cast<std::int8_t>(p)};
    element.domain = {extraction.domain};
    table.nets.resize(table.nets.size() + 3 * (static_cast<std::size_t>(p) + 1));
    double* target = table.nets.data() + element.offset;
    const auto local = net.middleCols(extraction.first_function, p + 1);
    extract<2>(local.data(), extraction.matrix, target);
    element.polynomial = (local.row(2).array() == local(2, 0)).all();
    if (element.polynomial) divide_out_weight<2>({target, 3, p + 1}, local(2, 0));
  }
}

/// The strip of a surface over one span of v, Bézier in v: (p_v + 1) rows of count_u homogeneous points.
struct Strip {
  /// 4 count_u x (p_v + 1).
  Eigen::MatrixXd net;
  /// For each column i of the net: its p_v + 1 weights are equal.
  std::vector<char> equal_weights;
};

void fill_strip(const NurbsSurface<3>& surface, const ExtractionOperator& v, Strip& strip) {
  const Eigen::Index nu = surface.count_u();
  const Eigen::Index rows = v.matrix.rows();
  const auto source = surface.homogeneous().middleCols(v.first_function * nu, rows * nu);
  strip.net.noalias() = source.reshaped(4 * nu, rows).lazyProduct(v.matrix);
  strip.equal_weights.resize(static_cast<std::size_t>(nu));
  for (Eigen::Index i = 0; i < nu; ++i) {
    bool equal = true;
    for (Eigen::Index j = 1; j < rows; ++j) equal = equal && source(3, i + j * nu) == source(3, i);
    strip.equal_weights[static_cast<std::size_t>(i)] = equal;
  }
}

/// The weight that all control points of the surface over the element share, or NaN. It is read off the surface's
/// own weights: rounding in the extraction must not make a polynomial element rational.
double common_weight(const NurbsSurface<3>& surface, const Strip& strip, const ExtractionOperator& u,
                     const ExtractionOperator& v) {
  const Eigen::Index first = u.first_function + v.first_function * static_cast<Eigen::Index>(surface.count_u());
  const double weight = surface.homogeneous()(3, first);
  for (Eigen::Index i = 0; i < u.matrix.rows(); ++i)
    if (!strip.equal_weights[static_cast<std::size_t>(u.first_function + i)] ||
        surface.homogeneous()(3, first + i) != weight)
      return std::numeric_limits<double>::quiet_NaN();
  return weight;
}

/// Narrows the last element of the table, whose net is that of a whole cell, to the rectangle of its region.
void narrow(ElementTable<3>& table, CellRegion&& kept) {
  BezierElement<3>& element = table.elements.back();
  element.region = static_cast<std::int32_t>(table.regions.size());
  table.regions.push_back(std::move(kept.region));
  const std::array<int, 2> degrees{element.degree[0], element.degree[1]};
  const std::array<Interval, 2> rectangle{kept.u, kept.v};
  const std::span<double> net(table.nets.data() + element.offset, table.nets.size() - element.offset);
  for (std::size_t d = 0; d < 2; ++d) {
    const Interval cell = element.domain[d];
    const auto within = [&](double u) { return (u - cell.first) / cell.length(); };
    restrict_net(net, 4, degrees, static_cast<int>(d), {within(rectangle[d].first), within(rectangle[d].last)});
    element.domain[d] = rectangle[d];
  }
}

/// A surface on its way into the table.
struct SurfaceElements {
  const NurbsSurface<3>& surface;
  std::size_t patch = 0;
  int orientation = 1;
  std::vector<ExtractionOperator> in_u = extraction_operators(surface.knots_u());
  std::vector<ExtractionOperator> in_v = extraction_operators(surface.knots_v());
  Strip strip = {};

  std::size_t control_points() const {
    return static_cast<std::size_t>((surface.knots_u().degree() + 1) * (surface.knots_v().degree() + 1));
  }
};

/// The element of the whole cell, from the strip of its row.
void append_cell(ElementTable<3>& table, const SurfaceElements& from, const ExtractionOperator& u,
                 const ExtractionOperator& v) {
  const Eigen::Index nu = from.surface.count_u();
  const int p = from.surface.knots_u().degree();
  const int q = from.surface.knots_v().degree();
  BezierElement<3>& element = append_element(table, from.patch, from.orientation);
  element.degree = {static_cast<std::int8_t>(p), static_cast<std::int8_t>(q)};
  element.domain = {u.domain, v.domain};
  table.nets.resize(table.nets.size() + 4 * from.control_points());
  double* target = table.nets.data() + element.offset;
  for (Eigen::Index j = 0; j <= q; ++j)
    extract<3>(from.strip.net.data() + 4 * (u.first_function + j * nu), u.matrix, target + 4 * j * (p + 1));
  const double weight = common_weight(from.surface, from.strip, u, v);
  element.polynomial = weight > 0.0;
  if (element.polynomial) divide_out_weight<3>({target, 4, (p + 1) * (q + 1)}, weight);
}

void append_whole(ElementTable<3>& table, SurfaceElements&& from) {
  reserve_more(table, from.in_u.size() * from.in_v.size(), from.control_points());
  for (const ExtractionOperator& v : from.in_v) {
    fill_strip(from.surface, v, from.strip);
    for (const ExtractionOperator& u : from.in_u) append_cell(table, from, u, v);
  }
}

/// Only the cells of which something is kept.
void append_kept(ElementTable<3>& table, SurfaceElements&& from, FaceCells&& cells) {
  const auto is_kept = [](std::int32_t state) { return state != FaceCells::outside; };
  reserve_more(table, static_cast<std::size_t>(std::ranges::count_if(cells.state, is_kept)), from.control_points());
  const std::size_t columns = from.in_u.size();
  for (std::size_t row = 0; row < from.in_v.size(); ++row) {
    const std::span<const std::int32_t> states = std::span(cells.state).subspan(row * columns, columns);
    if (std::ranges::none_of(states, is_kept)) continue;
    fill_strip(from.surface, from.in_v[row], from.strip);
    for (std::size_t column = 0; column < columns; ++column) {
      if (!is_kept(states[column])) continue;
      append_cell(table, from, from.in_u[column], from.in_v[row]);
      if (states[column] == FaceCells::whole) continue;
      narrow(table, std::move(cells.regions[static_cast<std::size_t>(states[column])]));
    }
  }
}

void append_extracted(ElementTable<3>& table, const ExtractedSurface& surface, std::size_t patch, int orientation) {
  const std::vector<ExtractionElement>& elements = surface.elements();
  reserve_more(table, elements.size(), static_cast<std::size_t>(elements.front().rows.cols()));
  for (std::size_t e = 0; e < elements.size(); ++e) {
    BezierElement<3>& element = append_element(table, patch, orientation);
    element.degree = elements[e].degree;
    element.domain = elements[e].domain;
    HomogeneousPoints<3> net = bezier_net(surface, static_cast<int>(e));
    element.polynomial = (net.row(3).array() == net(3, 0)).all();
    if (element.polynomial) divide_out_weight<3>({net.data(), 4, net.cols()}, net(3, 0));
    table.nets.insert(table.nets.end(), net.data(), net.data() + net.size());
  }
}

/// Appends the elements of a patch.
struct PatchAppender {
  ElementTable<3>& table;
  const Patch<3>& patch;
  std::size_t index = 0;

  void operator()(const NurbsSurface<3>& surface) const {
    append_whole(table, SurfaceElements{surface, index, patch.orientation});
  }
  void operator()(const TrimmedSurface& face) const {
    append_kept(table, SurfaceElements{face.surface(), index, patch.orientation}, cut_into_cells(face));
  }
  void operator()(const ExtractedSurface& surface) const { append_extracted(table, surface, index, patch.orientation); }
};

void append_patch(ElementTable<3>& table, const Patch<3>& patch, std::size_t index) {
  try {
    std::visit(PatchAppender{table, patch, index}, patch.shape);
  } catch (Error& error) {
    error.add_context(fmt::format("patch \"{}\"", patch.name));
    throw;
  }
}

}  // namespace

template <int Dim>
ElementTable<Dim> bezier_elements(const Boundary<Dim>& boundary) {
  ElementTable<Dim> table;
  for (std::size_t i = 0; i < boundary.patches.size(); ++i) {
    const Patch<Dim>& patch = boundary.patches[i];
    if (patch.orientation != 1 && patch.orientation != -1)
      throw GeometryError(
          fmt::format("patch \"{}\": orientation is {}; expected 1 or -1", patch.name, patch.orientation));
    append_patch(table, patch, i);
  }
  return table;
}

template <int Dim>
BoundingBox<Dim> bounding_box(const ElementTable<Dim>& table) {
  if (table.elements.empty()) throw GeometryError("bounding box: the boundary has no elements");
  const Eigen::Index count = static_cast<Eigen::Index>(table.nets.size()) / (Dim + 1);
  const Eigen::Map<const HomogeneousPoints<Dim>> net(table.nets.data(), Dim + 1, count);
  BoundingBox<Dim> box{Point<Dim>::Constant(std::numeric_limits<double>::infinity()),
                       Point<Dim>::Constant(-std::numeric_limits<double>::infinity())};
  for (Eigen::Index i = 0; i < count; ++i) {
    const Point<Dim> point = net.col(i).template head<Dim>() / net(Dim, i);
    box.lower = box.lower.cwiseMin(point);
    box.upper = box.upper.cwiseMax(point);
  }
  return box;
}

template ElementTable<2> bezier_elements(const Boundary<2>&);
template ElementTable<3> bezier_elements(const Boundary<3>&);
template BoundingBox<2> bounding_box(const ElementTable<2>&);
template BoundingBox<3> bounding_box(const ElementTable<3>&);

}  // namespace isorim::geometry
