#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <span>
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

  /// Targets that an element serves by the same kept rule, by their numbers in the batch.
  struct Group {
    quadrature::NodeView<Dim> nodes;
    std::vector<std::size_t> targets;
  };

  FieldDensities<Dim> densities;
  quadrature::NodeBuffer<Dim> buffer;
  std::vector<Group> groups;
  /// At nodes made for one target; then less the simple solution, times weights.
  Densities own;
  std::vector<double> single_values;
  std::vector<double> double_values;
  /// Sums over an element's nodes for one target.
  struct Moments {
    /// Of U t, of T u, of T times 1 and the coordinates from the centre of Factors, and of U n.
    static constexpr int flux = 0, potential = 1, linear = 2, normal = 3 + Dim, count = 3 + 2 * Dim;
    std::array<double, count> values{};

    double without(const SimpleSolution<Dim>& v, const geometry::Point<Dim>& centre, int component) const;
  };
  std::vector<Moments> moments;
};

/// int U (t - t_v) dS - int T (u - v) dS and its derivatives at points off the boundary, v a simple solution. Safe to
/// use from several threads with different rooms.
///
/// Targets come in batches: an element's kept rules serve many of them, and u, t and linear functions at their nodes,
/// times weights, are computed once. v is taken off their sums then; at nodes that are made for one target, where the
/// kernels peak, it is taken off node by node.
template <int Dim>
class Representation {
 public:
  /// The arguments must outlive the object.
  Representation(const Problem<Dim>& problem, const FieldSpace<Dim>& space, const quadrature::TargetRules<Dim>& rules,
                 int components);

  struct Place {
    quadrature::Target<Dim> target;
    SimpleSolution<Dim> simple;
  };
  /// A good number of places, close to one another.
  static constexpr std::size_t batch = 64;

  struct Sums {
    Eigen::VectorXd value;
    /// components x Dim; of values() empty.
    Eigen::MatrixXd gradient;
  };
  /// Of each place: the same bits in whatever company it comes.
  std::vector<Sums> at(std::span<const Place> places, RepresentationRoom<Dim>& room) const;
  /// The values alone.
  std::vector<Sums> values(std::span<const Place> places, RepresentationRoom<Dim>& room) const;

 private:
  using View = quadrature::NodeView<Dim>;

  /// What stands beside the kernels at the nodes of a kept rule, times weights: rows of n numbers.
  struct Factors {
    int number = -1;
    /// Component by component.
    std::vector<double> potential;
    std::vector<double> flux;
    /// 1 and the coordinates of node - centre.
    std::vector<double> linear;
    std::vector<double> normal;
    geometry::Point<Dim> centre;
  };
  std::vector<Sums> sum(std::span<const Place> places, bool with_gradient, RepresentationRoom<Dim>& room) const;
  void add_element(int element, std::span<const Place> places, bool with_gradient, RepresentationRoom<Dim>& room,
                   std::span<Sums> sums) const;
  const Factors& factors_at(int element, const View& nodes, RepresentationRoom<Dim>& room) const;
  void evaluate_kernels(const View& nodes, const geometry::Point<Dim>& target, bool is_gradient,
                        std::span<double> of_single, std::span<double> of_double) const;
  void add_kept(const typename RepresentationRoom<Dim>::Group& group, const Factors& factors,
                std::span<const Place> places, bool is_gradient, RepresentationRoom<Dim>& room,
                std::span<Sums> sums) const;
  void set_moments(const View& nodes, const Factors& factors, std::size_t target_count, std::size_t size, int entry,
                   int j, RepresentationRoom<Dim>& room) const;
  void weigh(const Place& place, const View& nodes, Densities& densities) const;
  void add_own(const Place& place, const View& nodes, bool is_gradient, RepresentationRoom<Dim>& room,
               Sums& sums) const;

  const Problem<Dim>* problem_;
  const FieldSpace<Dim>* space_;
  const quadrature::TargetRules<Dim>* rules_;
  int components_;
  mutable std::array<std::mutex, 64> mutexes_;
  /// Of each element; guarded by one of the mutexes.
  mutable std::vector<std::vector<std::unique_ptr<const Factors>>> kept_;
};

}  // namespace isorim::solver
