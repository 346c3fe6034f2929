#include "solver/bem/point_selection.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <Eigen/LU>
#include <Eigen/QR>
#include <fmt/format.h>

#include "geometry/bezier/element_jet.h"
#include "geometry/errors.h"
#include "solver/bem/matching.h"

namespace isorim::solver {

using geometry::BernsteinJet;
using geometry::Point;

template <int Dim>
void numerators(const PatchSpace<Dim>& patch, int element, const Point<Dim - 1>& place, std::span<double> values) {
  const FieldElement<Dim>& field = patch.elements[static_cast<std::size_t>(element)];
  std::array<BernsteinJet, Dim - 1> basis;
  for (int d = 0; d + 1 < Dim; ++d)
    basis[static_cast<std::size_t>(d)] = geometry::bernstein_jet(field.degree[static_cast<std::size_t>(d)], place(d));
  const std::size_t p = static_cast<std::size_t>(field.degree[0]) + 1;
  const std::size_t length = static_cast<std::size_t>(field.bernstein_count());
  for (std::size_t k = 0; k < static_cast<std::size_t>(field.count); ++k) {
    const double* row = patch.rows.data() + field.row + k * length;
    double sum = 0.0;
    for (std::size_t j = 0; j < length; ++j) {
      double product = basis[0].values[j % p];
      if constexpr (Dim == 3) product *= basis[1].values[j / p];
      sum += row[j] * product;
    }
    values[k] = sum;
  }
}

namespace {

/// The elements that each function lives on.
struct Supports {
  std::vector<std::size_t> begin;
  std::vector<std::int32_t> elements;

  std::span<const std::int32_t> of(int function) const {
    const std::size_t f = static_cast<std::size_t>(function);
    return std::span(elements).subspan(begin[f], begin[f + 1] - begin[f]);
  }
};

template <int Dim>
std::span<const std::int32_t> functions_of(const PatchSpace<Dim>& patch, int element) {
  const FieldElement<Dim>& field = patch.elements[static_cast<std::size_t>(element)];
  return std::span(patch.functions).subspan(field.first, static_cast<std::size_t>(field.count));
}

template <int Dim>
Supports supports(const PatchSpace<Dim>& patch) {
  Supports result;
  result.begin.assign(patch.points.size() + 1, 0);
  for (const std::int32_t f : patch.functions) ++result.begin[static_cast<std::size_t>(f) + 1];
  for (std::size_t f = 0; f < patch.points.size(); ++f) result.begin[f + 1] += result.begin[f];
  std::vector<std::size_t> next(result.begin.begin(), result.begin.end() - 1);
  result.elements.resize(patch.functions.size());
  for (std::size_t e = 0; e < patch.elements.size(); ++e)
    for (const std::int32_t f : functions_of(patch, static_cast<int>(e)))
      result.elements[next[static_cast<std::size_t>(f)]++] = static_cast<std::int32_t>(e);
  return result;
}

/// Functions without a point, some dozens that live near one another.
constexpr std::size_t cluster_size = 40;

template <int Dim>
std::vector<int> next_cluster(const PatchSpace<Dim>& patch, const Supports& support, int seed,
                              const std::vector<char>& has_point) {
  std::vector<int> cluster{seed};
  std::vector<char> seen(patch.points.size(), 0);
  seen[static_cast<std::size_t>(seed)] = 1;
  for (std::size_t i = 0; i < cluster.size(); ++i)
    for (const std::int32_t e : support.of(cluster[i]))
      for (const std::int32_t f : functions_of(patch, e)) {
        if (cluster.size() == cluster_size) return cluster;
        const std::size_t index = static_cast<std::size_t>(f);
        if (seen[index] || has_point[index]) continue;
        seen[index] = 1;
        cluster.push_back(f);
      }
  return cluster;
}

/// One cluster's choice.
template <int Dim>
class Selection {
 public:
  using Place = typename PatchSpace<Dim>::Place;
  Selection(PatchSpace<Dim>& patch, const Supports& support, std::vector<int> cluster, std::vector<char>& has_point)
      : patch_(patch), cluster_(std::move(cluster)), has_point_(has_point), column_(patch.points.size(), -1) {
    for (const int f : cluster_) add_column(f);
    for (const int f : cluster_) elements_.insert(elements_.end(), support.of(f).begin(), support.of(f).end());
    std::ranges::sort(elements_);
    elements_.erase(std::unique(elements_.begin(), elements_.end()), elements_.end());
    for (const std::int32_t e : elements_)
      for (const std::int32_t f : functions_of(patch_, e))
        if (has_point_[static_cast<std::size_t>(f)] && column_[static_cast<std::size_t>(f)] < 0) {
          fixed_.push_back(patch_.points[static_cast<std::size_t>(f)]);
          add_column(f);
        }
  }

  /// Returns functions that depend on the others.
  std::vector<int> choose(const std::function<std::vector<Point<Dim - 1>>(int)>& candidates, double indistinct) {
    std::vector<Place> places;
    for (const std::int32_t e : elements_)
      for (const Point<Dim - 1>& place : candidates(e)) places.push_back({e, place});
    if (places.empty()) return cluster_;
    const Eigen::Index wanted = static_cast<Eigen::Index>(cluster_.size());
    const Eigen::MatrixXd values = free_part(values_at(places));
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors(values.transpose());
    const Eigen::Index rank = rank_of(factors, indistinct);
    if (rank < wanted) return dependent_functions(values, rank);
    std::vector<Place> chosen;
    for (Eigen::Index k = 0; k < wanted; ++k)
      chosen.push_back(places[static_cast<std::size_t>(factors.colsPermutation().indices()(k))]);
    assign(chosen);
    return {};
  }

 private:
  static Eigen::Index rank_of(const Eigen::ColPivHouseholderQR<Eigen::MatrixXd>& factors, double indistinct) {
    const auto pivots = factors.matrixQR().diagonal().cwiseAbs();
    return (pivots.array() > indistinct * pivots(0)).count();
  }

  /// Those of the cluster that the others leave least of.
  std::vector<int> dependent_functions(const Eigen::MatrixXd& values, Eigen::Index rank) const {
    std::vector<int> found;
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors(values);
    for (Eigen::Index k = rank; k < values.cols(); ++k)
      found.push_back(cluster_[static_cast<std::size_t>(factors.colsPermutation().indices()(k))]);
    return found;
  }

  void add_column(int function) { column_[static_cast<std::size_t>(function)] = columns_++; }

  /// Scaled to the sum one, as the functions are; columns of functions that have no point yet and are not of the
  /// cluster are left out.
  Eigen::MatrixXd values_at(const std::vector<Place>& places) const {
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(places.size()), columns_);
    std::vector<double> values;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const auto functions = functions_of(patch_, places[i].element);
      values.resize(functions.size());
      numerators<Dim>(patch_, places[i].element, places[i].place, values);
      double sum = 0.0;
      for (const double value : values) sum += value;
      for (std::size_t k = 0; k < functions.size(); ++k) {
        const Eigen::Index column = column_[static_cast<std::size_t>(functions[k])];
        if (column >= 0) result(static_cast<Eigen::Index>(i), column) = values[k] / sum;
      }
    }
    return result;
  }

  /// What is left of the values of the cluster's functions when those of the others have been fitted at their points.
  Eigen::MatrixXd free_part(const Eigen::MatrixXd& values) const {
    if (fixed_.empty()) return values;
    const Eigen::MatrixXd known = values_at(fixed_);
    const Eigen::Index n = static_cast<Eigen::Index>(cluster_.size());
    const Eigen::Index m = columns_ - n;
    return values.leftCols(n) - values.rightCols(m) * known.rightCols(m).partialPivLu().solve(known.leftCols(n));
  }

  /// To functions that are large there. (Otherwise parts of the matrix, of which later clusters make use, might be
  /// singular.)
  void assign(const std::vector<Place>& places) {
    constexpr double nothing = 1e-12;
    const Eigen::MatrixXd values = values_at(places).leftCols(static_cast<Eigen::Index>(cluster_.size()));
    const std::vector<int> function_at = cheapest_matching(-values.cwiseAbs().cwiseMax(nothing).array().log().matrix());
    for (std::size_t i = 0; i < places.size(); ++i) {
      const std::size_t function = static_cast<std::size_t>(cluster_[static_cast<std::size_t>(function_at[i])]);
      patch_.points[function] = places[i];
      has_point_[function] = 1;
    }
  }

  PatchSpace<Dim>& patch_;
  std::vector<int> cluster_;
  std::vector<char>& has_point_;
  /// Of each function, or -1: the cluster's first, then those with points.
  std::vector<Eigen::Index> column_;
  Eigen::Index columns_ = 0;
  std::vector<std::int32_t> elements_;
  std::vector<Place> fixed_;
};

}  // namespace

template <int Dim>
std::vector<int> choose_points(PatchSpace<Dim>& patch, std::vector<char> has_point,
                               const std::function<std::vector<Point<Dim - 1>>(int element)>& candidates,
                               double indistinct) {
  if (std::ranges::find(has_point, 0) == has_point.end()) return {};
  const Supports support = supports(patch);
  for (int f = 0; f < static_cast<int>(has_point.size()); ++f) {
    if (has_point[static_cast<std::size_t>(f)]) continue;
    const std::vector<int> dependent =
        Selection<Dim>(patch, support, next_cluster(patch, support, f, has_point), has_point)
            .choose(candidates, indistinct);
    if (!dependent.empty()) return dependent;
  }
  return {};
}

template <int Dim>
void require_points(PatchSpace<Dim>& patch, std::vector<char> has_point,
                    const std::function<std::vector<Point<Dim - 1>>(int element)>& candidates) {
  const std::vector<int> dependent = choose_points(patch, std::move(has_point), candidates, 1e-10);
  if (!dependent.empty())
    throw NumericalError(
        fmt::format("field space: {} functions depend on the others at all candidates for their "
                    "collocation points",
                    dependent.size()));
}

template std::vector<int> choose_points(PatchSpace<2>&, std::vector<char>,
                                        const std::function<std::vector<Point<1>>(int)>&, double);
template std::vector<int> choose_points(PatchSpace<3>&, std::vector<char>,
                                        const std::function<std::vector<Point<2>>(int)>&, double);
template void require_points(PatchSpace<2>&, std::vector<char>, const std::function<std::vector<Point<1>>(int)>&);
template void require_points(PatchSpace<3>&, std::vector<char>, const std::function<std::vector<Point<2>>(int)>&);
template void numerators(const PatchSpace<2>&, int, const Point<1>&, std::span<double>);
template void numerators(const PatchSpace<3>&, int, const Point<2>&, std::span<double>);

}  // namespace isorim::solver
