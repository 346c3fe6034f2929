#include "quadrature/piece_samples.h"

#include <array>
#include <cstddef>
#include <utility>

#include "quadrature/bernstein.h"
#include "quadrature/gauss_legendre.h"
#include "quadrature/region_moments.h"

namespace isorim::quadrature {

namespace {

/// A homogeneous point and its derivatives with respect to the element's directions.
template <int Dim>
struct HomogeneousJet {
  Eigen::Matrix<double, Dim + 1, 1> value = Eigen::Matrix<double, Dim + 1, 1>::Zero();
  std::array<Eigen::Matrix<double, Dim + 1, 1>, Dim - 1> derivative;

  HomogeneousJet() { derivative.fill(Eigen::Matrix<double, Dim + 1, 1>::Zero()); }

  geometry::Point<Dim> point() const { return value.template head<Dim>() / value[Dim]; }
  geometry::Vector<Dim> tangent(std::size_t d) const {
    return (derivative[d].template head<Dim>() - derivative[d][Dim] * point()) / value[Dim];
  }
};

/// Bernstein polynomials of one degree at one place.
struct Basis {
  int degree;
  const double* values;
  const double* derivatives;
};

Basis at_node(const BernsteinTable& table, int node) {
  return {table.degree, table.values_at(node), table.derivatives_at(node)};
}

HomogeneousJet<2> evaluate_net(Eigen::Map<const geometry::HomogeneousPoints<2>> net,
                               const std::array<Basis, 1>& basis) {
  HomogeneousJet<2> jet;
  for (int i = 0; i <= basis[0].degree; ++i) {
    jet.value += basis[0].values[i] * net.col(i);
    jet.derivative[0] += basis[0].derivatives[i] * net.col(i);
  }
  return jet;
}

HomogeneousJet<3> evaluate_net(Eigen::Map<const geometry::HomogeneousPoints<3>> net,
                               const std::array<Basis, 2>& basis) {
  HomogeneousJet<3> jet;
  const int columns = basis[0].degree + 1;
  for (int j = 0; j <= basis[1].degree; ++j) {
    Eigen::Vector4d value = Eigen::Vector4d::Zero();
    Eigen::Vector4d derivative = Eigen::Vector4d::Zero();
    for (int i = 0; i < columns; ++i) {
      value += basis[0].values[i] * net.col(j * columns + i);
      derivative += basis[0].derivatives[i] * net.col(j * columns + i);
    }
    jet.value += basis[1].values[j] * value;
    jet.derivative[0] += basis[1].values[j] * derivative;
    jet.derivative[1] += basis[1].derivatives[j] * value;
  }
  return jet;
}

geometry::Vector2 natural_normal(const HomogeneousJet<2>& jet) {
  const geometry::Vector2 tangent = jet.tangent(0);
  return {tangent[1], -tangent[0]};
}

geometry::Vector3 natural_normal(const HomogeneousJet<3>& jet) {
  const geometry::Vector3 u = jet.tangent(0);
  const geometry::Vector3 v = jet.tangent(1);
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

/// Which node of each direction's rule point k is, the first direction fastest.
template <int Dim>
Orders<Dim - 1> node_indices(int k, const Orders<Dim - 1>& nodes) {
  Orders<Dim - 1> indices;
  for (std::size_t d = 0; d < Dim - 1; ++d) {
    indices[d] = k % nodes[d];
    k /= nodes[d];
  }
  return indices;
}

template <int Dim>
void set_weights(const ElementPiece<Dim>& piece, const Orders<Dim - 1>& nodes, std::vector<double>& weights) {
  if constexpr (Dim == 3) {
    if (piece.is_cut()) return region_weights(piece.region->moments(nodes), nodes, weights);
  }
  weights.clear();
  const int count = static_cast<int>(points_of_rule(piece, nodes));
  for (int k = 0; k < count; ++k) {
    const Orders<Dim - 1> indices = node_indices<Dim>(k, nodes);
    double weight = 1.0;
    for (std::size_t d = 0; d < Dim - 1; ++d)
      weight *= gauss_legendre(nodes[d]).weights[static_cast<std::size_t>(indices[d])];
    weights.push_back(weight);
  }
}

}  // namespace

template <int Dim>
void sample_piece(const ElementPiece<Dim>& piece, const Orders<Dim - 1>& orders, PieceSamples<Dim>& samples) {
  if constexpr (Dim == 3) {
    if (piece.sector) {
      SectorRule rule = sector_rule(*piece.sector, orders);
      samples = sample_at(piece, rule.places);
      samples.weights = std::move(rule.weights);
      return;
    }
  }
  const Orders<Dim - 1> nodes = nodes_of_rule(piece, orders);
  set_weights(piece, nodes, samples.weights);
  std::array<const BernsteinTable*, Dim - 1> basis;
  for (std::size_t d = 0; d < Dim - 1; ++d) basis[d] = &bernstein_table(piece.element->degree[d], nodes[d]);
  const auto count = static_cast<Eigen::Index>(samples.weights.size());
  samples.points.resize(Dim, count);
  samples.normals.resize(Dim, count);
  const Eigen::Map<const geometry::HomogeneousPoints<Dim>> net(piece.net(), Dim + 1,
                                                               piece.element->control_point_count());
  for (Eigen::Index k = 0; k < count; ++k) {
    const Orders<Dim - 1> indices = node_indices<Dim>(static_cast<int>(k), nodes);
    std::array<Basis, Dim - 1> here;
    for (std::size_t d = 0; d < Dim - 1; ++d) here[d] = at_node(*basis[d], indices[d]);
    const HomogeneousJet<Dim> jet = evaluate_net(net, here);
    samples.points.col(k) = jet.point();
    samples.normals.col(k) = piece.element->orientation * natural_normal(jet);
  }
}

PieceSamples<3> sample_at(const ElementPiece<3>& piece, std::span<const geometry::Point2> places) {
  const auto count = static_cast<Eigen::Index>(places.size());
  PieceSamples<3> samples{geometry::Points<3>(3, count), geometry::Points<3>(3, count), {}};
  samples.weights.resize(places.size());
  const std::array<int, 2> degree{piece.element->degree[0], piece.element->degree[1]};
  const Eigen::Map<const geometry::HomogeneousPoints<3>> net(piece.net(), 4, piece.element->control_point_count());
  for (Eigen::Index k = 0; k < count; ++k) {
    const geometry::Point2& place = places[static_cast<std::size_t>(k)];
    const BernsteinValues u = bernstein_polynomials(degree[0], place[0]);
    const BernsteinValues v = bernstein_polynomials(degree[1], place[1]);
    const HomogeneousJet<3> jet = evaluate_net(net, {Basis{degree[0], u.values.data(), u.derivatives.data()},
                                                     Basis{degree[1], v.values.data(), v.derivatives.data()}});
    samples.points.col(k) = jet.point();
    samples.normals.col(k) = piece.element->orientation * natural_normal(jet);
  }
  return samples;
}

template void sample_piece(const ElementPiece<2>&, const Orders<1>&, PieceSamples<2>&);
template void sample_piece(const ElementPiece<3>&, const Orders<2>&, PieceSamples<3>&);

}  // namespace isorim::quadrature
