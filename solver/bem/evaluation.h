#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "geometry/vocabulary.h"
#include "solver/bem/field_space.h"
#include "solver/bem/problem.h"
#include "solver/bem/solve.h"

/// The solution after the solve. Unknown fields enter through their coefficients, prescribed ones through the
/// conditions' own functions.
namespace isorim::solver {

/// The solution at one point.
template <int Dim>
struct FieldValue {
  /// Potential (1) or displacement (Dim).
  Eigen::VectorXd value;
  /// components x Dim: row i is the gradient of component i.
  Eigen::MatrixXd gradient;
  /// Elasticity: the stress tensor (in the plane the components in it; the one across is in stress_across). Else 0 x 0.
  /// See stress.h for von Mises' and the principal stresses.
  Eigen::MatrixXd stress;
  double stress_across = 0.0;
};

/// Of a point relative to the domain (not the body: they differ in exterior problems).
enum class Location { inside, outside, on_boundary };

template <int Dim>
struct PointEvaluation {
  Location location = Location::inside;
  /// Empty if the point lies outside the domain.
  FieldValue<Dim> field;
};

struct EvaluationOptions {
  /// What the quadrature aims at, relative.
  double tolerance = 1e-11;
  /// 0: all that OpenMP offers.
  int threads = 0;
};

/// The solution anywhere in the domain and on its boundary. points: Dim x n.
///
/// Inside, from the representation formula (kernels.h) and its derivatives,
///
///   u(x) = v(x) + int U (t - t_v) dS - int T (u - v) dS + int_Omega U b dOmega,
///
/// v a linear field and t_v its flux or traction. Near the boundary v is the one that agrees with the solution and its
/// gradient at the nearest boundary point, so that the densities vanish where the kernels peak and accuracy is not lost
/// ("simple solutions": Y. Liu & T. J. Rudolphi, Comput. Mech. 24 (1999) 286-292); the same accuracy is had at any
/// distance. Points nearer to the boundary than 1e-10 of its size count as on it.
template <int Dim>
std::vector<PointEvaluation<Dim>> evaluate_at(const Problem<Dim>& problem, const FieldSpace<Dim>& space,
                                              const Solution<Dim>& solution,
                                              const Eigen::Ref<const geometry::Points<Dim>>& points,
                                              const EvaluationOptions& options = {});

/// On the boundary itself: values as above from the boundary data alone (the gradient from the flux and the tangential
/// derivatives), and the flux or traction.
template <int Dim>
struct BoundaryValue {
  geometry::Point<Dim> position;
  /// Unit, outward.
  geometry::Vector<Dim> normal;
  FieldValue<Dim> field;
  Eigen::VectorXd flux;
};

/// An object serves one thread; the arguments of the constructor must outlive it.
template <int Dim>
class BoundaryFields {
 public:
  BoundaryFields(const Problem<Dim>& problem, const FieldSpace<Dim>& space, const Solution<Dim>& solution);
  ~BoundaryFields();

  /// At a place of an element's unit cell. Where the cell collapses (a pole), the limit, to about nine digits.
  BoundaryValue<Dim> operator()(int element, const geometry::Point<Dim - 1>& place);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

template <int Dim>
BoundaryValue<Dim> evaluate_on_boundary(const Problem<Dim>& problem, const FieldSpace<Dim>& space,
                                        const Solution<Dim>& solution, int element,
                                        const geometry::Point<Dim - 1>& place);

}  // namespace isorim::solver
