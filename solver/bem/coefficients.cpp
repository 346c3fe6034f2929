#include "solver/bem/coefficients.h"

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/SparseCore>
#include <Eigen/SparseLU>

#include "geometry/errors.h"
#include "solver/bem/boundary_data.h"

namespace isorim::solver {

namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;

/// Row i: the functions' values at point i.
template <int Dim>
SparseMatrix collocation_matrix(const FieldSpace<Dim>& space) {
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<double> values;
  for (std::size_t i = 0; i < space.points.size(); ++i) {
    const CollocationPoint<Dim>& point = space.points[i];
    const std::span<const std::int32_t> functions = space.functions_of(point.element);
    values.resize(functions.size());
    basis_values(space, point.element, point.place, std::span<double>(values));
    for (std::size_t k = 0; k < functions.size(); ++k)
      entries.emplace_back(static_cast<int>(i), functions[k], values[k]);
  }
  SparseMatrix matrix(space.function_count(), space.function_count());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// Coefficients of what has the given values at the points.
Eigen::MatrixXd interpolate(const SparseMatrix& matrix, const Eigen::MatrixXd& values) {
  Eigen::SparseLU<SparseMatrix> factors;
  factors.compute(matrix);
  if (factors.info() != Eigen::Success)
    throw NumericalError("the matrix of the functions' values at the collocation points is singular");
  return factors.solve(values);
}

/// Fields by the components of the conditions' frames, and which of them are known at the points alone.
struct FrameFields {
  Eigen::MatrixXd potential;
  Eigen::MatrixXd flux;
};

/// The unknowns in their places, zero elsewhere.
template <int Dim>
FrameFields distribute(const Assembler<Dim>& assembler, const Eigen::Ref<const Eigen::VectorXd>& unknowns) {
  const int count = assembler.space().function_count();
  const int components = assembler.components();
  FrameFields fields{Eigen::MatrixXd::Zero(count, components), Eigen::MatrixXd::Zero(count, components)};
  for (int a = 0; a < count; ++a) {
    const int element = assembler.space().points[static_cast<std::size_t>(a)].element;
    for (int c = 0; c < components; ++c) {
      const double unknown = unknowns[a * components + c];
      if (assembler.is_flux_unknown(element, c)) {
        fields.flux(a, c) = assembler.flux_scale() * unknown;
      } else {
        fields.potential(a, c) = unknown;
      }
    }
  }
  return fields;
}

/// What the conditions say at the points, zero for what is unknown.
template <int Dim>
FrameFields values_at_points(const Assembler<Dim>& assembler, const Problem<Dim>& problem,
                             const Eigen::MatrixXd& unknown_potential) {
  const FieldSpace<Dim>& space = assembler.space();
  const int components = assembler.components();
  FrameFields known{Eigen::MatrixXd::Zero(space.function_count(), components),
                    Eigen::MatrixXd::Zero(space.function_count(), components)};
  BoundaryData<Dim> data(problem);
  ConditionValues<Dim> values;
  for (int i = 0; i < space.function_count(); ++i) {
    const CollocationPoint<Dim>& point = space.points[static_cast<std::size_t>(i)];
    const Condition<Dim>& condition = assembler.condition_on(point.element);
    data.evaluate(problem.condition_of[static_cast<std::size_t>(point.element)], point.position, point.normal, values);
    for (int c = 0; c < components; ++c) {
      const auto index = static_cast<std::size_t>(c);
      const double given = values.value[index].empty() ? 0.0 : values.value[index][0];
      const ConditionKind kind = condition.components[index].kind;
      if (kind == ConditionKind::value) known.potential(i, c) = given;
      if (kind == ConditionKind::flux) known.flux(i, c) = given;
      if (kind == ConditionKind::robin)
        known.flux(i, c) = assembler.sign() * values.coefficient[index][0] * (given - unknown_potential(i, c));
    }
  }
  return known;
}

template <int Dim>
Eigen::MatrixXd turn_back(const Assembler<Dim>& assembler, const Eigen::MatrixXd& field) {
  const int components = assembler.components();
  Eigen::MatrixXd turned = field;
  for (Eigen::Index a = 0; a < field.rows(); ++a) {
    const Condition<Dim>& condition =
        assembler.condition_on(assembler.space().points[static_cast<std::size_t>(a)].element);
    if (!condition.frame) continue;
    geometry::Vector<Dim> sum = geometry::Vector<Dim>::Zero();
    for (int c = 0; c < components; ++c) sum += field(a, c) * component_axis(condition, c);
    turned.row(a) = sum.transpose();
  }
  return turned;
}

}  // namespace

template <int Dim>
FieldCoefficients field_coefficients(const Assembler<Dim>& assembler, const Eigen::Ref<const Eigen::VectorXd>& unknowns,
                                     int problem) {
  const SparseMatrix matrix = collocation_matrix(assembler.space());
  const FrameFields found = distribute(assembler, unknowns);
  const FrameFields known = values_at_points<Dim>(assembler, assembler.problems()[static_cast<std::size_t>(problem)],
                                                  matrix * found.potential);
  Eigen::MatrixXd values(known.potential.rows(), 2 * known.potential.cols());
  values << known.potential, known.flux;
  if (values.cwiseAbs().maxCoeff() > 0.0) values = interpolate(matrix, values);
  const Eigen::Index components = known.potential.cols();
  return {turn_back<Dim>(assembler, found.potential + values.leftCols(components)),
          turn_back<Dim>(assembler, found.flux + values.rightCols(components))};
}

template FieldCoefficients field_coefficients<2>(const Assembler<2>&, const Eigen::Ref<const Eigen::VectorXd>&, int);
template FieldCoefficients field_coefficients<3>(const Assembler<3>&, const Eigen::Ref<const Eigen::VectorXd>&, int);

}  // namespace isorim::solver
