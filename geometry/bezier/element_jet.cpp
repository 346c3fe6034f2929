#include "geometry/bezier/element_jet.h"

#include <cstddef>

#include <Eigen/Geometry>

namespace isorim::geometry {

BernsteinJet bernstein_jet(int degree, double s) {
  BernsteinJet jet;
  const double rest = 1.0 - s;
  const auto raise = [&](int to) {
    // From degree to - 1 to degree `to`, in place.
    jet.values[static_cast<std::size_t>(to)] = s * jet.values[static_cast<std::size_t>(to - 1)];
    for (std::size_t i = static_cast<std::size_t>(to) - 1; i > 0; --i)
      jet.values[i] = rest * jet.values[i] + s * jet.values[i - 1];
    jet.values[0] *= rest;
  };
  jet.values[0] = 1.0;
  for (int p = 1; p < degree; ++p) raise(p);
  const std::size_t last = static_cast<std::size_t>(degree);
  if (degree == 0) {
    jet.derivatives[0] = 0.0;
    return jet;
  }
  jet.derivatives[0] = -degree * jet.values[0];
  for (std::size_t i = 1; i < last; ++i) jet.derivatives[i] = degree * (jet.values[i - 1] - jet.values[i]);
  jet.derivatives[last] = degree * jet.values[last - 1];
  raise(degree);
  return jet;
}

namespace {

/// Homogeneous point and derivatives by each coordinate of the cell: columns 0, 1[, 2].
template <int Dim>
using HomogeneousJet = Eigen::Matrix<double, Dim + 1, Dim>;

HomogeneousJet<2> homogeneous_jet(const ElementTable<2>& table, const BezierElement<2>& element,
                                  const Point<1>& place) {
  const int p = element.degree[0];
  const BernsteinJet basis = bernstein_jet(p, place(0));
  const auto net = table.net_matrix(element);
  HomogeneousJet<2> jet = HomogeneousJet<2>::Zero();
  for (int i = 0; i <= p; ++i) {
    jet.col(0) += basis.values[static_cast<std::size_t>(i)] * net.col(i);
    jet.col(1) += basis.derivatives[static_cast<std::size_t>(i)] * net.col(i);
  }
  return jet;
}

HomogeneousJet<3> homogeneous_jet(const ElementTable<3>& table, const BezierElement<3>& element,
                                  const Point<2>& place) {
  const int p = element.degree[0];
  const int q = element.degree[1];
  const BernsteinJet u = bernstein_jet(p, place(0));
  const BernsteinJet v = bernstein_jet(q, place(1));
  const auto net = table.net_matrix(element);
  HomogeneousJet<3> jet = HomogeneousJet<3>::Zero();
  for (int j = 0; j <= q; ++j) {
    Eigen::Vector4d value = Eigen::Vector4d::Zero();
    Eigen::Vector4d slope = Eigen::Vector4d::Zero();
    for (int i = 0; i <= p; ++i) {
      value += u.values[static_cast<std::size_t>(i)] * net.col(i + j * (p + 1));
      slope += u.derivatives[static_cast<std::size_t>(i)] * net.col(i + j * (p + 1));
    }
    jet.col(0) += v.values[static_cast<std::size_t>(j)] * value;
    jet.col(1) += v.values[static_cast<std::size_t>(j)] * slope;
    jet.col(2) += v.derivatives[static_cast<std::size_t>(j)] * value;
  }
  return jet;
}

Vector2 natural_area_vector(const Eigen::Matrix<double, 2, 1>& tangent) {
  return {tangent.y(), -tangent.x()};
}
Vector3 natural_area_vector(const Eigen::Matrix<double, 3, 2>& tangents) {
  return tangents.col(0).cross(tangents.col(1));
}

}  // namespace

template <int Dim>
ElementJet<Dim> evaluate_jet(const ElementTable<Dim>& table, const BezierElement<Dim>& element,
                             const Point<Dim - 1>& place) {
  const HomogeneousJet<Dim> jet = homogeneous_jet(table, element, place);
  ElementJet<Dim> result;
  const double weight = jet(Dim, 0);
  result.position = jet.col(0).template head<Dim>() / weight;
  for (int d = 0; d + 1 < Dim; ++d)
    result.tangents.col(d) = (jet.col(d + 1).template head<Dim>() - jet(Dim, d + 1) * result.position) / weight;
  result.area_vector = element.orientation * natural_area_vector(result.tangents);
  return result;
}

template ElementJet<2> evaluate_jet(const ElementTable<2>&, const BezierElement<2>&, const Point<1>&);
template ElementJet<3> evaluate_jet(const ElementTable<3>&, const BezierElement<3>&, const Point<2>&);

}  // namespace isorim::geometry
