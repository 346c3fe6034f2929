#include "geometry/bezier/subdivision.h"

#include <cstddef>

namespace isorim::geometry {
namespace {

/// Seen along one direction a net is `count` polygons, each of degree + 1 points that lie `stride` doubles apart.
struct Polygons {
  std::size_t degree = 0;
  std::size_t stride = 0;
  std::size_t count = 0;

  std::size_t size() const { return stride * (degree + 1); }
};

Polygons polygons_along(std::size_t size, int rows, std::span<const int> degrees, int direction) {
  Polygons polygons;
  polygons.degree = static_cast<std::size_t>(degrees[static_cast<std::size_t>(direction)]);
  polygons.stride = static_cast<std::size_t>(rows);
  for (int d = 0; d < direction; ++d)
    polygons.stride *= static_cast<std::size_t>(degrees[static_cast<std::size_t>(d)]) + 1;
  polygons.count = size / polygons.size();
  return polygons;
}

/// One polygon by its part over [0, fraction].
void keep_first_part(double* points, const Polygons& shape, double fraction) {
  for (std::size_t step = 1; step <= shape.degree; ++step)
    for (std::size_t i = shape.degree; i >= step; --i)
      for (std::size_t k = 0; k < shape.stride; ++k) {
        const double before = points[(i - 1) * shape.stride + k];
        double& here = points[i * shape.stride + k];
        here = before + fraction * (here - before);
      }
}

/// One polygon by its part over [fraction, 1].
void keep_last_part(double* points, const Polygons& shape, double fraction) {
  for (std::size_t step = 1; step <= shape.degree; ++step)
    for (std::size_t i = 0; i + step <= shape.degree; ++i)
      for (std::size_t k = 0; k < shape.stride; ++k) {
        double& here = points[i * shape.stride + k];
        here += fraction * (points[(i + 1) * shape.stride + k] - here);
      }
}

}  // namespace

std::pair<std::vector<double>, std::vector<double>> subdivide(std::span<const double> net, int rows,
                                                              std::span<const int> degrees, int direction,
                                                              double fraction) {
  const Polygons shape = polygons_along(net.size(), rows, degrees, direction);
  std::vector<double> first(net.begin(), net.end());
  std::vector<double> second(net.begin(), net.end());
  for (std::size_t polygon = 0; polygon < shape.count; ++polygon) {
    double* left = first.data() + polygon * shape.size();
    double* right = second.data() + polygon * shape.size();
    // `right` runs de Casteljau's triangle in place; the first point of each of its columns belongs to `left`.
    for (std::size_t step = 1; step <= shape.degree; ++step) {
      for (std::size_t i = 0; i + step <= shape.degree; ++i) {
        for (std::size_t k = 0; k < shape.stride; ++k) {
          double& here = right[i * shape.stride + k];
          here += fraction * (right[(i + 1) * shape.stride + k] - here);
        }
      }
      for (std::size_t k = 0; k < shape.stride; ++k) left[step * shape.stride + k] = right[k];
    }
  }
  return {std::move(first), std::move(second)};
}

void restrict_net(std::span<double> net, int rows, std::span<const int> degrees, int direction, Interval piece) {
  const Polygons shape = polygons_along(net.size(), rows, degrees, direction);
  for (std::size_t polygon = 0; polygon < shape.count; ++polygon) {
    double* points = net.data() + polygon * shape.size();
    if (piece.last < 1.0) keep_first_part(points, shape, piece.last);
    if (piece.first > 0.0) keep_last_part(points, shape, piece.first / piece.last);
  }
}

}  // namespace isorim::geometry
