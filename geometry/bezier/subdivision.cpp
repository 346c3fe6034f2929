#include "geometry/bezier/subdivision.h"

#include <cstddef>

namespace isorim::geometry {

std::pair<std::vector<double>, std::vector<double>> subdivide(std::span<const double> net, int rows,
                                                              std::span<const int> degrees, int direction,
                                                              double fraction) {
  // Seen along the direction the net is `outer` polygons, each of degree + 1 points that lie `stride` doubles apart.
  const auto degree = static_cast<std::size_t>(degrees[static_cast<std::size_t>(direction)]);
  std::size_t stride = static_cast<std::size_t>(rows);
  for (int d = 0; d < direction; ++d) stride *= static_cast<std::size_t>(degrees[static_cast<std::size_t>(d)]) + 1;
  const std::size_t polygon = stride * (degree + 1);
  const std::size_t outer = net.size() / polygon;

  std::vector<double> first(net.begin(), net.end());
  std::vector<double> second(net.begin(), net.end());
  for (std::size_t o = 0; o < outer; ++o) {
    double* left = first.data() + o * polygon;
    double* right = second.data() + o * polygon;
    // `right` runs de Casteljau's triangle in place; the first point of each of its columns belongs to `left`.
    for (std::size_t step = 1; step <= degree; ++step) {
      for (std::size_t i = 0; i + step <= degree; ++i) {
        for (std::size_t k = 0; k < stride; ++k) {
          double& here = right[i * stride + k];
          here += fraction * (right[(i + 1) * stride + k] - here);
        }
      }
      for (std::size_t k = 0; k < stride; ++k) left[step * stride + k] = right[k];
    }
  }
  return {std::move(first), std::move(second)};
}

}  // namespace isorim::geometry
