#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "geometry/vocabulary.h"
#include "quadrature/rim.h"
#include "quadrature/target_rules.h"
#include "solver/bem/evaluation.h"
#include "solver/bem/field_densities.h"

/// Integrals of a solution over the boundary, and its errors there.
namespace isorim::solver {

/// Over a part of the boundary.
template <int Dim>
struct FieldIntegrals {
  /// Length or area.
  double measure = 0.0;
  /// int t dS: the total flux, or the resultant force on the body.
  Eigen::VectorXd flux;
  /// int (y - point) x t dS for tractions: 1 number in the plane, 3 in space; none for potentials.
  Eigen::VectorXd moment;
  /// int u dS.
  Eigen::VectorXd potential;
  /// int u_i n_k dS, components x Dim. For the potential of a body that moves with unit speed along x_i in a fluid at
  /// rest (flux n_i, exterior), minus the fluid's density times row 0 is the added mass in row i (Lamb, art. 121).
  Eigen::MatrixXd potential_normal;
  /// int u . t dS; half of it is the energy (stored in the domain, or in the fluid with the opposite sign) if there are
  /// no loads in the domain.
  double work = 0.0;
  /// int |u|^2 dS and int |t| dS.
  double potential_squared = 0.0;
  double flux_magnitude = 0.0;
};

/// Over all of the boundary and its parts.
template <int Dim>
struct BoundaryIntegrals {
  FieldIntegrals<Dim> total;
  /// By the number of the patch, and of the condition of the problem.
  std::vector<FieldIntegrals<Dim>> patches;
  std::vector<FieldIntegrals<Dim>> conditions;
};

/// Moments about `point`. Unknown fields enter through their coefficients, prescribed ones through their functions.
template <int Dim>
BoundaryIntegrals<Dim> field_integrals(const Problem<Dim>& problem, const FieldSpace<Dim>& space,
                                       const Solution<Dim>& solution, const EvaluationOptions& options = {},
                                       const geometry::Point<Dim>& point = geometry::Point<Dim>::Zero());

template <int Dim>
struct ResultIntegrals : BoundaryIntegrals<Dim> {
  /// Of the loads in the domain, about the same point.
  LoadResultant load;
  /// Interior problems: total.flux + load.force, which is zero but for the errors of discretisation, and likewise for
  /// the moments; empty for exterior ones.
  Eigen::VectorXd force_imbalance;
  Eigen::VectorXd moment_imbalance;
};

/// field_integrals() and how far they and the loads are from balance.
template <int Dim>
ResultIntegrals<Dim> result_integrals(const Problem<Dim>& problem, const FieldSpace<Dim>& space,
                                      const Solution<Dim>& solution,
                                      const geometry::Point<Dim>& point = geometry::Point<Dim>::Zero(),
                                      const EvaluationOptions& options = {});

/// A function of place, normal and both fields at the nodes of an element (nodes x components), for use by one thread.
template <int Dim>
using FieldFunction =
    std::function<void(const quadrature::NodeView<Dim>& nodes, const Densities& fields, std::span<double> values)>;
/// The integrals over the boundary of `count` functions at once, function i at node q in values[i n + q]; `make` is
/// called once for each thread. What a function throws comes through.
template <int Dim>
Eigen::VectorXd integrate_fields(const Problem<Dim>& problem, const FieldSpace<Dim>& space,
                                 const Solution<Dim>& solution, int count,
                                 const std::function<FieldFunction<Dim>()>& make,
                                 const EvaluationOptions& options = {});
/// Of one function.
template <int Dim>
double integrate_fields(const Problem<Dim>& problem, const FieldSpace<Dim>& space, const Solution<Dim>& solution,
                        const std::function<FieldFunction<Dim>()>& make, const EvaluationOptions& options = {});

/// Errors of a field, all components together.
struct ErrorNorms {
  /// (int |f - f_exact|^2 dS)^(1/2), and of the exact field.
  double l2 = 0.0;
  double exact_l2 = 0.0;
  /// Largest |f - f_exact| and |f_exact| at the nodes of the quadrature.
  double max = 0.0;
  double exact_max = 0.0;
};

/// Functions of place and normal, one for each component; those that are absent are not looked at.
template <int Dim>
struct ExactData {
  std::vector<quadrature::IntegrandFactory<Dim>> potential;
  std::vector<quadrature::IntegrandFactory<Dim>> flux;
};
template <int Dim>
struct BoundaryErrors {
  std::optional<ErrorNorms> potential;
  std::optional<ErrorNorms> flux;
};
/// Throws InputError for a number of functions that is neither zero nor that of the components.
template <int Dim>
BoundaryErrors<Dim> boundary_errors(const Problem<Dim>& problem, const FieldSpace<Dim>& space,
                                    const Solution<Dim>& solution, const ExactData<Dim>& exact,
                                    const EvaluationOptions& options = {});

}  // namespace isorim::solver
