#include "quadrature/piece_samples.h"

#include <array>
#include <cstddef>

#include "quadrature/bernstein.h"
#include "quadrature/gauss_legendre.h"

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

HomogeneousJet<2> evaluate_net(Eigen::Map<const geometry::HomogeneousPoints<2>> net,
                               const std::array<const BernsteinTable*, 1>& basis, const std::array<int, 1>& node) {
  HomogeneousJet<2> jet;
  for (int i = 0; i <= basis[0]->degree; ++i) {
    jet.value += basis[0]->values_at(node[0])[i] * net.col(i);
    jet.derivative[0] += basis[0]->derivatives_at(node[0])[i] * net.col(i);
  }
  return jet;
}

HomogeneousJet<3> evaluate_net(Eigen::Map<const geometry::HomogeneousPoints<3>> net,
                               const std::array<const BernsteinTable*, 2>& basis, const std::array<int, 2>& node) {
  HomogeneousJet<3> jet;
  const int columns = basis[0]->degree + 1;
  for (int j = 0; j <= basis[1]->degree; ++j) {
    Eigen::Vector4d value = Eigen::Vector4d::Zero();
    Eigen::Vector4d derivative = Eigen::Vector4d::Zero();
    for (int i = 0; i < columns; ++i) {
      value += basis[0]->values_at(node[0])[i] * net.col(j * columns + i);
      derivative += basis[0]->derivatives_at(node[0])[i] * net.col(j * columns + i);
    }
    jet.value += basis[1]->values_at(node[1])[j] * value;
    jet.derivative[0] += basis[1]->values_at(node[1])[j] * derivative;
    jet.derivative[1] += basis[1]->derivatives_at(node[1])[j] * value;
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

}  // namespace

template <int Dim>
void sample_piece(const ElementPiece<Dim>& piece, const Orders<Dim - 1>& orders, PieceSamples<Dim>& samples) {
  std::array<const BernsteinTable*, Dim - 1> basis;
  Eigen::Index count = 1;
  for (std::size_t d = 0; d < Dim - 1; ++d) {
    basis[d] = &bernstein_table(piece.element->degree[d], orders[d]);
    count *= orders[d];
  }
  samples.points.resize(Dim, count);
  samples.normals.resize(Dim, count);
  const Eigen::Map<const geometry::HomogeneousPoints<Dim>> net(piece.net(), Dim + 1,
                                                               piece.element->control_point_count());
  for (Eigen::Index k = 0; k < count; ++k) {
    Orders<Dim - 1> node;
    double weight = piece.element->orientation;
    auto rest = static_cast<int>(k);
    for (std::size_t d = 0; d < Dim - 1; ++d) {
      node[d] = rest % orders[d];
      rest /= orders[d];
      weight *= gauss_legendre(orders[d]).weights[static_cast<std::size_t>(node[d])];
    }
    const HomogeneousJet<Dim> jet = evaluate_net(net, basis, node);
    samples.points.col(k) = jet.point();
    samples.normals.col(k) = weight * natural_normal(jet);
  }
}

template void sample_piece(const ElementPiece<2>&, const Orders<1>&, PieceSamples<2>&);
template void sample_piece(const ElementPiece<3>&, const Orders<2>&, PieceSamples<3>&);

}  // namespace isorim::quadrature
