#include "solver/bem/tensor_space.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

namespace isorim::solver {

using geometry::BezierElement;
using geometry::BSpline;
using geometry::ExtractionOperator;
using geometry::KnotVector;
using geometry::NurbsCurve;
using geometry::NurbsSurface;

std::vector<double> bisected(std::span<const double> breakpoints, int levels) {
  std::vector<double> result(breakpoints.begin(), breakpoints.end());
  for (int level = 0; level < levels; ++level) {
    std::vector<double> finer;
    finer.reserve(2 * result.size());
    for (std::size_t i = 0; i + 1 < result.size(); ++i) {
      finer.push_back(result[i]);
      finer.push_back(0.5 * (result[i] + result[i + 1]));
    }
    finer.push_back(result.back());
    result = std::move(finer);
  }
  return result;
}

KnotVector field_knots(const KnotVector& geometry, int degree, std::span<const double> breakpoints,
                       std::span<const double> jumps) {
  std::vector<double> inner;
  inner.push_back(breakpoints.front());
  for (const double u : breakpoints.subspan(1, breakpoints.size() - 2)) {
    const int given = geometry.multiplicity(u);
    int multiplicity = given > 0 ? std::clamp(given + degree - geometry.degree(), 1, degree + 1) : 1;
    if (std::ranges::binary_search(jumps, u)) multiplicity = degree + 1;
    inner.insert(inner.end(), static_cast<std::size_t>(multiplicity), u);
  }
  inner.push_back(breakpoints.back());
  return KnotVector::clamped(degree, inner);
}

namespace {

/// The same splines on finer knots of a higher degree.
Eigen::MatrixXd express(const KnotVector& knots, Eigen::MatrixXd coefficients, const KnotVector& finer) {
  const BSpline raised = elevate_degree(BSpline{knots, std::move(coefficients)}, finer.degree() - knots.degree());
  const std::span<const double> have = raised.knots.knots();
  std::vector<double> missing;
  std::ranges::set_difference(finer.knots(), have, std::back_inserter(missing));
  return refine_knots(raised, missing).coefficients;
}

/// The weight function in the field's splines; empty if functions are to be polynomials.
Eigen::VectorXd field_weights(const NurbsCurve<2>& shape, const std::array<LineSpace, 1>& lines) {
  if (shape.is_polynomial() || lines[0].knots.degree() < shape.degree()) return {};
  return express(shape.knots(), shape.homogeneous().row(2), lines[0].knots).transpose();
}

Eigen::VectorXd field_weights(const NurbsSurface<3>& shape, const std::array<LineSpace, 2>& lines) {
  if (shape.is_polynomial() || lines[0].knots.degree() < shape.knots_u().degree() ||
      lines[1].knots.degree() < shape.knots_v().degree())
    return {};
  const Eigen::MatrixXd weights = shape.homogeneous().row(3).reshaped(shape.count_u(), shape.count_v());
  const Eigen::MatrixXd in_u = express(shape.knots_u(), weights.transpose(), lines[0].knots);
  return express(shape.knots_v(), in_u.transpose(), lines[1].knots).reshaped();
}

/// Numbers functions in the order of their first B-splines. same[i] is a B-spline that i is added to, itself or one of
/// those that are not added to another.
template <int Dim>
void number_functions(TensorSpace<Dim>& space, std::span<const std::int32_t> same) {
  space.number.assign(same.size(), -1);
  for (std::size_t i = 0; i < same.size(); ++i) {
    std::int32_t& number = space.number[static_cast<std::size_t>(same[i])];
    if (number < 0) {
      number = static_cast<std::int32_t>(space.representative.size());
      space.representative.push_back(same[i]);
    }
    space.number[i] = number;
  }
}

/// For each function of a line the middle one of its piece.
std::vector<int> piece_middles(const LineSpace& line) {
  const int n = line.function_count();
  std::vector<std::vector<int>> pieces(static_cast<std::size_t>(*std::ranges::max_element(line.piece)) + 1);
  for (int i = 0; i < n; ++i) pieces[static_cast<std::size_t>(line.piece[static_cast<std::size_t>(i)])].push_back(i);
  std::vector<int> result;
  for (const int piece : line.piece) {
    const std::vector<int>& members = pieces[static_cast<std::size_t>(piece)];
    result.push_back(members[members.size() / 2]);
  }
  return result;
}

}  // namespace

TensorSpace<2> tensor_space(const NurbsCurve<2>& shape, std::array<LineSpace, 1> lines) {
  TensorSpace<2> space{std::move(lines), {}, {}, {}};
  space.weights = field_weights(shape, space.lines);
  const LineSpace& line = space.lines[0];
  std::vector<std::int32_t> same(static_cast<std::size_t>(line.knots.basis_count()));
  for (std::size_t i = 0; i < same.size(); ++i) same[i] = line.number(static_cast<int>(i));
  number_functions(space, same);
  return space;
}

TensorSpace<3> tensor_space(const NurbsSurface<3>& shape, std::array<LineSpace, 2> lines,
                            const PatchSmoothness<3>& smooth) {
  TensorSpace<3> space{std::move(lines), {}, {}, {}};
  space.weights = field_weights(shape, space.lines);
  const std::array<int, 2> count{space.lines[0].knots.basis_count(), space.lines[1].knots.basis_count()};
  const std::array<std::vector<int>, 2> middle{piece_middles(space.lines[0]), piece_middles(space.lines[1])};
  std::vector<std::int32_t> same;
  same.reserve(static_cast<std::size_t>(count[0]) * static_cast<std::size_t>(count[1]));
  const auto is_on_pole = [&](std::size_t d, int i) {
    return (i == 0 && smooth.pole[2 * d]) || (i == count[d] - 1 && smooth.pole[2 * d + 1]);
  };
  for (int j = 0; j < count[1]; ++j)
    for (int i = 0; i < count[0]; ++i) {
      int a = space.lines[0].number(i);
      int b = space.lines[1].number(j);
      if (is_on_pole(1, j))
        a = middle[0][static_cast<std::size_t>(a)];
      else if (is_on_pole(0, i))
        b = middle[1][static_cast<std::size_t>(b)];
      same.push_back(a + count[0] * b);
    }
  number_functions(space, same);
  return space;
}

namespace {

/// The B-splines of an element and their rows.
struct LocalRows {
  std::vector<std::int32_t> splines;
  /// One column a B-spline.
  Eigen::MatrixXd rows;
};

std::vector<std::int32_t> splines_on(const TensorSpace<2>& space, std::size_t cell) {
  const ExtractionOperator& u = space.lines[0].elements[cell];
  std::vector<std::int32_t> splines(static_cast<std::size_t>(u.matrix.rows()));
  std::iota(splines.begin(), splines.end(), u.first_function);
  return splines;
}

std::vector<std::int32_t> splines_on(const TensorSpace<3>& space, std::size_t cell) {
  const std::size_t columns = space.lines[0].elements.size();
  const ExtractionOperator& u = space.lines[0].elements[cell % columns];
  const ExtractionOperator& v = space.lines[1].elements[cell / columns];
  const std::int32_t stride = space.lines[0].knots.basis_count();
  std::vector<std::int32_t> splines;
  for (int j = 0; j < v.matrix.rows(); ++j)
    for (int i = 0; i < u.matrix.rows(); ++i) splines.push_back(u.first_function + i + (v.first_function + j) * stride);
  return splines;
}

Eigen::MatrixXd local_rows(const TensorSpace<2>& space, std::size_t cell) {
  return space.lines[0].elements[cell].matrix.transpose();
}

Eigen::MatrixXd local_rows(const TensorSpace<3>& space, std::size_t cell) {
  const std::size_t columns = space.lines[0].elements.size();
  const Eigen::MatrixXd& u = space.lines[0].elements[cell % columns].matrix;
  const Eigen::MatrixXd& v = space.lines[1].elements[cell / columns].matrix;
  const Eigen::Index p = u.rows();
  const Eigen::Index q = v.rows();
  Eigen::MatrixXd rows(p * q, p * q);
  for (Eigen::Index j = 0; j < q; ++j)
    for (Eigen::Index i = 0; i < p; ++i)
      rows.col(i + p * j).reshaped(p, q).noalias() = u.row(i).transpose().lazyProduct(v.row(j));
  return rows;
}

template <int Dim>
void apply_weights(const TensorSpace<Dim>& space, bool polynomial, LocalRows& local) {
  if (space.weights.size() == 0) return;
  for (Eigen::Index k = 0; k < local.rows.cols(); ++k)
    local.rows.col(k) *= space.weights(local.splines[static_cast<std::size_t>(k)]);
  // The table has divided out the weight there.
  if (polynomial) local.rows /= local.rows.row(0).sum();
}

/// B-splines of one function added up.
template <int Dim>
CellFunctions merged(const TensorSpace<Dim>& space, LocalRows& local) {
  CellFunctions cell;
  for (Eigen::Index k = 0; k < local.rows.cols(); ++k) {
    const std::int32_t function = space.number[static_cast<std::size_t>(local.splines[static_cast<std::size_t>(k)])];
    const auto known = std::ranges::find(cell.functions, function);
    const Eigen::Index column = known - cell.functions.begin();
    if (known == cell.functions.end()) {
      cell.functions.push_back(function);
      local.rows.col(column) = local.rows.col(k).eval();
    } else {
      local.rows.col(column) += local.rows.col(k);
    }
  }
  cell.rows = local.rows.leftCols(static_cast<Eigen::Index>(cell.functions.size()));
  return cell;
}

template <int Dim>
typename PatchSpace<Dim>::Place place_of(const TensorSpace<Dim>& space, std::int32_t spline) {
  typename PatchSpace<Dim>::Place result;
  std::size_t rest = static_cast<std::size_t>(spline);
  int stride = 1;
  for (std::size_t d = 0; d + 1 < Dim; ++d) {
    const LineSpace& line = space.lines[d];
    const std::size_t count = static_cast<std::size_t>(line.knots.basis_count());
    const LinePoint& point = line.points[rest % count];
    result.place(static_cast<Eigen::Index>(d)) = point.place;
    result.element += stride * point.element;
    stride *= static_cast<int>(line.elements.size());
    rest /= count;
  }
  return result;
}

}  // namespace

template <int Dim>
std::vector<std::int32_t> functions_on(const TensorSpace<Dim>& space, std::size_t cell) {
  std::vector<std::int32_t> functions = splines_on(space, cell);
  for (std::int32_t& function : functions) function = space.number[static_cast<std::size_t>(function)];
  return functions;
}

template <int Dim>
CellFunctions cell_functions(const TensorSpace<Dim>& space, std::size_t cell, bool polynomial) {
  LocalRows local{splines_on(space, cell), local_rows(space, cell)};
  apply_weights(space, polynomial, local);
  return merged(space, local);
}

template <int Dim>
typename PatchSpace<Dim>::Place collocation_place(const TensorSpace<Dim>& space, std::int32_t function) {
  return place_of<Dim>(space, space.representative[static_cast<std::size_t>(function)]);
}

template <int Dim>
PatchSpace<Dim> patch_space(const TensorSpace<Dim>& space, std::span<const BezierElement<Dim>> elements) {
  PatchSpace<Dim> result;
  result.elements.reserve(elements.size());
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const CellFunctions cell = cell_functions<Dim>(space, e, elements[e].polynomial);
    if (e == 0) {
      result.functions.reserve(elements.size() * cell.functions.size());
      result.rows.reserve(elements.size() * static_cast<std::size_t>(cell.rows.size()));
    }
    FieldElement<Dim>& field = result.elements.emplace_back();
    for (std::size_t d = 0; d + 1 < Dim; ++d) field.degree[d] = static_cast<std::int8_t>(space.lines[d].knots.degree());
    field.rational = space.weights.size() > 0 && !elements[e].polynomial;
    field.first = result.functions.size();
    field.count = static_cast<int>(cell.functions.size());
    field.row = result.rows.size();
    result.functions.insert(result.functions.end(), cell.functions.begin(), cell.functions.end());
    result.rows.insert(result.rows.end(), cell.rows.data(), cell.rows.data() + cell.rows.size());
  }
  for (const std::int32_t spline : space.representative) result.points.push_back(place_of<Dim>(space, spline));
  return result;
}

template std::vector<std::int32_t> functions_on(const TensorSpace<2>&, std::size_t);
template std::vector<std::int32_t> functions_on(const TensorSpace<3>&, std::size_t);
template CellFunctions cell_functions(const TensorSpace<2>&, std::size_t, bool);
template CellFunctions cell_functions(const TensorSpace<3>&, std::size_t, bool);
template PatchSpace<2>::Place collocation_place<2>(const TensorSpace<2>&, std::int32_t);
template PatchSpace<3>::Place collocation_place<3>(const TensorSpace<3>&, std::int32_t);
template PatchSpace<2> patch_space(const TensorSpace<2>&, std::span<const BezierElement<2>>);
template PatchSpace<3> patch_space(const TensorSpace<3>&, std::span<const BezierElement<3>>);

}  // namespace isorim::solver
