#pragma once

#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>

#include <Eigen/Core>

#include "geometry/vocabulary.h"
#include "quadrature/target_rules.h"
#include "solver/bem/field_densities.h"
#include "solver/bem/simple_solution.h"

namespace isorim::solver {

/// One thread's room for Representation.
template <int Dim>
struct RepresentationRoom {
  RepresentationRoom(const Problem<Dim>& problem, const FieldSpace<Dim>& space, const Solution<Dim>& solution)
      : densities(problem, space, solution) {}

  FieldDensities<Dim> densities;
  quadrature::NodeBuffer<Dim> buffer;
  Densities own;
  /// Densities less the simple solution, times weights: nodes x components.
  Densities weighted;
  std::vector<double> single_values;
  std::vector<double> double_values;
};

/// int U (t - t_v) dS - int T (u - v) dS and its derivatives at points off the boundary, v a simple solution. Densities
/// at kept nodes are computed once. Safe to use from several threads with different rooms.
template <int Dim>
class Representation {
 public:
  /// The arguments must outlive the object.
  Representation(const Problem<Dim>& problem, const FieldSpace<Dim>& space, const quadrature::TargetRules<Dim>& rules,
                 int components);

  struct Sums {
    Eigen::VectorXd value;
    /// components x Dim.
    Eigen::MatrixXd gradient;
  };
  Sums at(const quadrature::Target<Dim>& target, const SimpleSolution<Dim>& simple,
          RepresentationRoom<Dim>& room) const;
  /// The value alone.
  Eigen::VectorXd value_at(const quadrature::Target<Dim>& target, const SimpleSolution<Dim>& simple,
                           RepresentationRoom<Dim>& room) const;

 private:
  const Densities& densities_at(int element, const quadrature::NodeView<Dim>& nodes,
                                RepresentationRoom<Dim>& room) const;
  void weigh(const quadrature::Target<Dim>& target, const quadrature::NodeView<Dim>& nodes, const Densities& densities,
             const SimpleSolution<Dim>& simple, RepresentationRoom<Dim>& room) const;
  void add_value(const quadrature::Target<Dim>& target, const quadrature::NodeView<Dim>& nodes,
                 RepresentationRoom<Dim>& room, Sums& sums) const;
  void add_gradient(const quadrature::Target<Dim>& target, const quadrature::NodeView<Dim>& nodes,
                    RepresentationRoom<Dim>& room, Sums& sums) const;

  const Problem<Dim>* problem_;
  const FieldSpace<Dim>* space_;
  const quadrature::TargetRules<Dim>* rules_;
  int components_;
  mutable std::mutex mutex_;
  /// Element by element, by the number of the kept rule.
  mutable std::vector<std::unordered_map<int, std::unique_ptr<const Densities>>> kept_;
};

}  // namespace isorim::solver
