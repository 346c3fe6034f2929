#include "quadrature/element_jet.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstring>

#include "geometry/spline/knot_vector.h"
#include "quadrature/lanes.h"

namespace isorim::quadrature {

namespace {

constexpr int max_count = geometry::KnotVector::max_degree + 1;

/// Of nodes that are evaluated together.
struct PacketJob {
  int degree[2];
  int orientation;
  /// (degree + 1)(degree + 1) points, (w d[, w]) with d relative to the origin.
  const double* net;
  /// Packets; all arrays have room for whole ones.
  std::size_t packets;
  const double* place[2];
  const double* cell_weight;
  double* offset[3];
  double* normal[3];
  double* weight;
};

using PacketLoop = void (*)(const PacketJob&);
struct PacketLoops {
  PacketLoop rational_surface;
  PacketLoop polynomial_surface;
  PacketLoop rational_curve;
  PacketLoop polynomial_curve;
};

namespace baseline {
#include "quadrature/element_jet_loops.inc"
}  // namespace baseline

#ifdef ISORIM_DISPATCH
#pragma GCC push_options
#pragma GCC target("arch=haswell")
namespace haswell {
#include "quadrature/element_jet_loops.inc"
}  // namespace haswell
#pragma GCC pop_options
namespace widest = haswell;
#else
namespace widest = baseline;
#endif

template <int Dim>
PacketLoop loop_for(bool polynomial) {
  const PacketLoops& loops = has_wide_registers() ? widest::packet_loops : baseline::packet_loops;
  if constexpr (Dim == 2) return polynomial ? loops.polynomial_curve : loops.rational_curve;
  return polynomial ? loops.polynomial_surface : loops.rational_surface;
}

/// Bernstein polynomials of one degree with two derivatives.
struct BernsteinJet {
  double value[max_count];
  double first[max_count];
  double second[max_count];

  BernsteinJet(int degree, double u) {
    double lower[max_count] = {1.0};
    double lowest[max_count] = {};
    for (int k = 1; k < degree; ++k) {
      if (k == degree - 1) std::copy_n(lower, k, lowest);
      raise(lower, k, u);
    }
    std::copy_n(lower, degree, value);
    raise(value, degree, u);
    const auto at = [](const double* row, int i, int count) { return i < 0 || i >= count ? 0.0 : row[i]; };
    for (int i = 0; i <= degree; ++i) {
      first[i] = degree * (at(lower, i - 1, degree) - at(lower, i, degree));
      second[i] = degree * (degree - 1) *
                  (at(lowest, i - 2, degree - 1) - 2.0 * at(lowest, i - 1, degree - 1) + at(lowest, i, degree - 1));
    }
  }

 private:
  /// From degree k - 1 to k.
  static void raise(double* row, int k, double u) {
    row[k] = u * row[k - 1];
    for (int i = k - 1; i > 0; --i) row[i] = (1.0 - u) * row[i] + u * row[i - 1];
    row[0] *= 1.0 - u;
  }
};

/// Divides out the weight: derivatives of A / w from those of A and w (Piegl & Tiller, A3.2 and A4.4).
template <int Dim>
struct Homogeneous {
  Eigen::Matrix<double, Dim + 1, 1> value = Eigen::Matrix<double, Dim + 1, 1>::Zero();
  std::array<Eigen::Matrix<double, Dim + 1, 1>, Dim - 1> first;
  std::array<Eigen::Matrix<double, Dim + 1, 1>, Dim == 2 ? 1 : 3> second;

  Homogeneous() {
    first.fill(value);
    second.fill(value);
  }

  ElementJet<Dim> cartesian() const {
    const double w = value[Dim];
    ElementJet<Dim> jet;
    jet.offset = value.template head<Dim>() / w;
    for (std::size_t d = 0; d < Dim - 1; ++d)
      jet.first[d] = (first[d].template head<Dim>() - first[d][Dim] * jet.offset) / w;
    for (std::size_t k = 0; k < second.size(); ++k) {
      const std::size_t a = k == 2 ? 0 : k;
      const std::size_t b = k == 2 ? 1 : k;
      jet.second[k] = (second[k].template head<Dim>() - first[a][Dim] * jet.first[b] - first[b][Dim] * jet.first[a] -
                       second[k][Dim] * jet.offset) /
                      w;
    }
    return jet;
  }
};

template <int Dim>
Eigen::Matrix<double, Dim + 1, 1> relative_point(const double* point, const geometry::Point<Dim>& origin) {
  Eigen::Matrix<double, Dim + 1, 1> result;
  for (int c = 0; c < Dim; ++c) result[c] = point[c] - point[Dim] * origin[c];
  result[Dim] = point[Dim];
  return result;
}

Homogeneous<2> homogeneous_jet(const ElementNet<2>& net, const geometry::Point<1>& place,
                               const geometry::Point2& origin) {
  const BernsteinJet u(net.degree[0], place[0]);
  Homogeneous<2> jet;
  for (int i = 0; i <= net.degree[0]; ++i) {
    const Eigen::Vector3d point = relative_point<2>(net.points + std::ptrdiff_t{3} * i, origin);
    jet.value += u.value[i] * point;
    jet.first[0] += u.first[i] * point;
    jet.second[0] += u.second[i] * point;
  }
  return jet;
}

Homogeneous<3> homogeneous_jet(const ElementNet<3>& net, const geometry::Point2& place,
                               const geometry::Point3& origin) {
  const BernsteinJet u(net.degree[0], place[0]);
  const BernsteinJet v(net.degree[1], place[1]);
  Homogeneous<3> jet;
  const double* next = net.points;
  for (int j = 0; j <= net.degree[1]; ++j) {
    Eigen::Vector4d value = Eigen::Vector4d::Zero();
    Eigen::Vector4d first = Eigen::Vector4d::Zero();
    Eigen::Vector4d second = Eigen::Vector4d::Zero();
    for (int i = 0; i <= net.degree[0]; ++i, next += 4) {
      const Eigen::Vector4d point = relative_point<3>(next, origin);
      value += u.value[i] * point;
      first += u.first[i] * point;
      second += u.second[i] * point;
    }
    jet.value += v.value[j] * value;
    jet.first[0] += v.value[j] * first;
    jet.first[1] += v.first[j] * value;
    jet.second[0] += v.value[j] * second;
    jet.second[1] += v.second[j] * value;
    jet.second[2] += v.first[j] * first;
  }
  return jet;
}

/// The net as the loops want it.
template <int Dim>
void relative_net(const ElementNet<Dim>& net, const geometry::Point<Dim>& origin, std::vector<double>& result) {
  const int components = net.polynomial ? Dim : Dim + 1;
  std::size_t count = 1;
  for (const int degree : net.degree) count *= static_cast<std::size_t>(degree) + 1;
  result.resize(count * static_cast<std::size_t>(components));
  double* next = result.data();
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Matrix<double, Dim + 1, 1> point = relative_point<Dim>(net.points + (Dim + 1) * i, origin);
    for (int c = 0; c < components; ++c) *next++ = point[c];
  }
}

}  // namespace

template <int Dim>
ElementNet<Dim> element_net(const geometry::ElementTable<Dim>& table, const geometry::BezierElement<Dim>& element) {
  ElementNet<Dim> net{{}, element.polynomial, element.orientation, table.nets.data() + element.offset};
  for (std::size_t d = 0; d < Dim - 1; ++d) net.degree[d] = element.degree[d];
  return net;
}

template <int Dim>
ElementJet<Dim> element_jet(const ElementNet<Dim>& net, const geometry::Point<Dim - 1>& place,
                            const geometry::Point<Dim>& origin) {
  return homogeneous_jet(net, place, origin).cartesian();
}

template <int Dim>
void evaluate_nodes(const ElementNet<Dim>& net, const geometry::Point<Dim>& origin, NodeBuffer<Dim>& nodes) {
  static thread_local std::vector<double> relative;
  relative_net(net, origin, relative);
  const std::size_t packets = (nodes.size + kernel_lanes - 1) / kernel_lanes;
  const std::size_t room = packets * kernel_lanes;
  nodes.cell_weight.resize(room, 0.0);
  nodes.weight.resize(room);
  PacketJob job{{}, net.orientation,    relative.data(), packets, {}, nodes.cell_weight.data(), {},
                {}, nodes.weight.data()};
  for (std::size_t d = 0; d < Dim - 1; ++d) {
    // What fills the last packet repeats the last node.
    nodes.place[d].resize(room);
    std::fill(nodes.place[d].begin() + static_cast<std::ptrdiff_t>(nodes.size), nodes.place[d].end(),
              nodes.size > 0 ? nodes.place[d][nodes.size - 1] : 0.0);
    job.degree[d] = net.degree[d];
    job.place[d] = nodes.place[d].data();
  }
  for (std::size_t c = 0; c < Dim; ++c) {
    for (std::vector<double>* values : {&nodes.position[c], &nodes.normal[c], &nodes.offset[c]}) values->resize(room);
    job.offset[c] = nodes.offset[c].data();
    job.normal[c] = nodes.normal[c].data();
  }
  loop_for<Dim>(net.polynomial)(job);
  for (std::size_t c = 0; c < Dim; ++c) {
    const double base = origin[static_cast<Eigen::Index>(c)];
    for (std::size_t q = 0; q < room; ++q) nodes.position[c][q] = nodes.offset[c][q] + base;
  }
}

template ElementNet<2> element_net(const geometry::ElementTable<2>&, const geometry::BezierElement<2>&);
template ElementNet<3> element_net(const geometry::ElementTable<3>&, const geometry::BezierElement<3>&);
template ElementJet<2> element_jet(const ElementNet<2>&, const geometry::Point<1>&, const geometry::Point2&);
template ElementJet<3> element_jet(const ElementNet<3>&, const geometry::Point2&, const geometry::Point3&);
template void evaluate_nodes(const ElementNet<2>&, const geometry::Point2&, NodeBuffer<2>&);
template void evaluate_nodes(const ElementNet<3>&, const geometry::Point3&, NodeBuffer<3>&);

}  // namespace isorim::quadrature
