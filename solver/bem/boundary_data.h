#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "geometry/vocabulary.h"
#include "quadrature/rim.h"
#include "quadrature/target_rules.h"
#include "solver/bem/problem.h"

namespace isorim::solver {

/// What a condition prescribes at some points, component by component (of the condition's frame).
template <int Dim>
struct ConditionValues {
  /// Value, flux or Robin's reference; empty: zero everywhere.
  std::array<std::vector<double>, Dim> value;
  /// Robin's coefficient; empty for the other kinds.
  std::array<std::vector<double>, Dim> coefficient;
};

/// Evaluates the data of all conditions of a problem; an object serves one thread.
template <int Dim>
class BoundaryData {
 public:
  explicit BoundaryData(const Problem<Dim>& problem);

  /// At the columns of `points`, with the outward unit normals there. Throws InputError, naming the condition and the
  /// place, for a value that is not finite and for a Robin coefficient that is not positive.
  void evaluate(int condition, const Eigen::Ref<const geometry::Points<Dim>>& points,
                const Eigen::Ref<const geometry::Points<Dim>>& normals, ConditionValues<Dim>& result);
  /// At the nodes of an element.
  void evaluate(int condition, const quadrature::NodeView<Dim>& nodes, ConditionValues<Dim>& result);

 private:
  struct Component {
    quadrature::Integrand<Dim> value;
    quadrature::Integrand<Dim> coefficient;
  };
  const Problem<Dim>* problem_;
  std::vector<std::vector<Component>> components_;
  geometry::Points<Dim> points_;
  geometry::Points<Dim> normals_;
};

}  // namespace isorim::solver
