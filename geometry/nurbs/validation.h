#pragma once

#include <cmath>
#include <span>
#include <string_view>

#include <Eigen/Core>
#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/vocabulary.h"

/// Checks that curves and surfaces share; for the .cpp files of this folder.
namespace isorim::geometry {

/// Weights that differ by more leave a basis function without digits, and draw all but a sliver of the parameters to
/// one point.
inline constexpr double largest_weight_ratio = 1e10;

/// Throws GeometryError unless every weight is positive and finite, their ratios at most largest_weight_ratio, and
/// every coordinate finite. index_name turns the number of a column into what the user calls that control point.
template <int Dim, class IndexName>
void require_valid_net(const HomogeneousPoints<Dim>& net, std::string_view entity, const IndexName& index_name) {
  for (Eigen::Index i = 0; i < net.cols(); ++i) {
    const double weight = net(Dim, i);
    if (!(weight > 0.0) || !std::isfinite(weight))
      throw GeometryError(
          fmt::format("{}: weight {} is {}; weights must be positive and finite", entity, index_name(i), weight));
    for (int d = 0; d < Dim; ++d)
      if (!std::isfinite(net(d, i)))
        throw GeometryError(
            fmt::format("{}: coordinate {} of control point {} (times its weight) is {}; expected a finite number",
                        entity, "xyz"[d], index_name(i), net(d, i)));
  }
  if (net.cols() == 0) return;
  const double least = net.row(Dim).minCoeff();
  const double most = net.row(Dim).maxCoeff();
  if (most > largest_weight_ratio * least)
    throw GeometryError(fmt::format("{}: the weights range from {:g} to {:g}; expected a ratio of at most {:g}", entity,
                                    least, most, largest_weight_ratio));
}

/// Cartesian points and weights (none: all 1) as homogeneous points. Throws GeometryError if the counts differ.
template <int Dim>
HomogeneousPoints<Dim> homogeneous_net(const Points<Dim>& points, std::span<const double> weights,
                                       std::string_view entity) {
  if (!weights.empty() && weights.size() != static_cast<std::size_t>(points.cols()))
    throw GeometryError(
        fmt::format("{}: {} weights given for {} control points", entity, weights.size(), points.cols()));
  HomogeneousPoints<Dim> net(Dim + 1, points.cols());
  net.template topRows<Dim>() = points;
  net.row(Dim).setOnes();
  if (weights.empty()) return net;
  for (Eigen::Index i = 0; i < net.cols(); ++i) net.col(i) *= weights[static_cast<std::size_t>(i)];
  return net;
}

}  // namespace isorim::geometry
