#include "solver/bem/cell_regions.h"

#include <algorithm>
#include <cmath>

#include "geometry/bezier/subdivision.h"

namespace isorim::solver {

namespace {

/// Of a cube that belongs to no region yet.
constexpr std::int32_t unknown = -2;
constexpr int most_bisections = 60;

template <int Dim>
using NetMap = Eigen::Map<const geometry::HomogeneousPoints<Dim>>;

template <int Dim>
NetMap<Dim> net_map(const std::vector<double>& net) {
  return {net.data(), Dim + 1, static_cast<Eigen::Index>(net.size() / (Dim + 1))};
}

/// The direction in which a net's control polygons are longest.
template <int Dim>
int longest_direction(const geometry::Points<Dim>& points, const std::array<int, Dim - 1>& degrees) {
  if constexpr (Dim == 2) {
    return 0;
  } else {
    const Eigen::Index p = degrees[0] + 1;
    double u = 0.0;
    double v = 0.0;
    for (Eigen::Index k = 0; k < points.cols(); ++k) {
      if (k % p != 0) u = std::max(u, degrees[0] * (points.col(k) - points.col(k - 1)).norm());
      if (k >= p) v = std::max(v, degrees[1] * (points.col(k) - points.col(k - p)).norm());
    }
    return v > u ? 1 : 0;
  }
}

}  // namespace

template <int Dim>
CellRegions<Dim>::CellRegions(const geometry::ElementTable<Dim>& table, int count, double margin) {
  set_box(table, count, margin);
  std::size_t size = 1;
  for (const std::int64_t along : counts_) size *= static_cast<std::size_t>(along);
  regions_.assign(size, unknown);
  for (const geometry::BezierElement<Dim>& element : table.elements) {
    if (table.net_matrix(element).row(Dim).minCoeff() > 0.0) continue;
    regions_.clear();
    return;
  }
  for (const geometry::BezierElement<Dim>& element : table.elements) {
    const std::span<const double> net = table.net(element);
    std::array<int, Dim - 1> degrees;
    std::copy(element.degree.begin(), element.degree.end(), degrees.begin());
    touch({net.begin(), net.end()}, degrees, 0);
  }
  // The outermost cubes are free: the first one belongs to what lies around the box.
  for (std::size_t i = 0; i < size; ++i)
    if (regions_[i] == unknown) fill(i);
}

template <int Dim>
void CellRegions<Dim>::set_box(const geometry::ElementTable<Dim>& table, int count, double margin) {
  const geometry::BoundingBox<Dim> box = geometry::bounding_box(table);
  margin_ = margin;
  width_ = std::max((box.upper - box.lower).maxCoeff() / std::max(count, 1), 4.0 * margin);
  // A cube and a half on all sides.
  lower_ = box.lower - geometry::Point<Dim>::Constant(1.5 * width_);
  for (std::size_t d = 0; d < Dim; ++d) {
    const auto k = static_cast<Eigen::Index>(d);
    counts_[d] = static_cast<std::int64_t>(std::ceil((box.upper[k] - box.lower[k]) / width_)) + 3;
  }
}

template <int Dim>
std::int64_t CellRegions<Dim>::coordinate(double x, std::size_t d) const {
  const double at = std::floor((x - lower_[static_cast<Eigen::Index>(d)]) / width_);
  return static_cast<std::int64_t>(std::fmin(std::fmax(at, 0.0), static_cast<double>(counts_[d] - 1)));
}

template <int Dim>
std::size_t CellRegions<Dim>::number(const Index& cell) const {
  std::int64_t result = 0;
  for (std::size_t d = Dim; d-- > 0;) result = result * counts_[d] + cell[d];
  return static_cast<std::size_t>(result);
}

template <int Dim>
auto CellRegions<Dim>::cell(std::size_t number) const -> Index {
  Index result;
  auto rest = static_cast<std::int64_t>(number);
  for (std::size_t d = 0; d < Dim; ++d) {
    result[d] = rest % counts_[d];
    rest /= counts_[d];
  }
  return result;
}

template <int Dim>
void CellRegions<Dim>::touch(const std::vector<double>& net, const std::array<int, Dim - 1>& degrees, int depth) {
  const NetMap<Dim> homogeneous = net_map<Dim>(net);
  const geometry::Points<Dim> points =
      homogeneous.template topRows<Dim>().array().rowwise() / homogeneous.row(Dim).array();
  Index lower;
  Index upper;
  std::int64_t widest = 0;
  for (std::size_t d = 0; d < Dim; ++d) {
    const auto row = points.row(static_cast<Eigen::Index>(d));
    lower[d] = coordinate(row.minCoeff() - margin_, d);
    upper[d] = coordinate(row.maxCoeff() + margin_, d);
    widest = std::max(widest, upper[d] - lower[d]);
  }
  if (widest > 1 && depth < most_bisections) {
    const auto halves = geometry::subdivide(net, Dim + 1, degrees, longest_direction<Dim>(points, degrees));
    touch(halves.first, degrees, depth + 1);
    touch(halves.second, degrees, depth + 1);
    return;
  }
  Index at = lower;
  while (at[Dim - 1] <= upper[Dim - 1]) {
    regions_[number(at)] = touched;
    std::size_t d = 0;
    while (++at[d] > upper[d] && d + 1 < Dim) {
      at[d] = lower[d];
      ++d;
    }
  }
}

template <int Dim>
void CellRegions<Dim>::fill(std::size_t first) {
  constexpr std::size_t sample_count = 5;
  const auto region = static_cast<std::int32_t>(samples_.size());
  std::vector<std::size_t> cells{first};
  regions_[first] = region;
  for (std::size_t next = 0; next < cells.size(); ++next) {
    const Index here = cell(cells[next]);
    for (std::size_t d = 0; d < Dim; ++d) {
      for (const std::int64_t step : {-1, 1}) {
        Index beside = here;
        beside[d] += step;
        if (beside[d] < 0 || beside[d] >= counts_[d]) continue;
        std::int32_t& other = regions_[number(beside)];
        if (other != unknown) continue;
        other = region;
        cells.push_back(number(beside));
      }
    }
  }
  std::vector<geometry::Point<Dim>>& samples = samples_.emplace_back();
  const std::size_t count = std::min(sample_count, cells.size());
  for (std::size_t k = 0; k < count; ++k) {
    const Index at = cell(cells[k * (cells.size() - 1) / std::max<std::size_t>(count - 1, 1)]);
    geometry::Point<Dim>& middle = samples.emplace_back();
    for (std::size_t d = 0; d < Dim; ++d) {
      const auto i = static_cast<Eigen::Index>(d);
      middle[i] = lower_[i] + (static_cast<double>(at[d]) + 0.5) * width_;
    }
  }
}

template <int Dim>
int CellRegions<Dim>::region(const geometry::Point<Dim>& point) const {
  if (regions_.empty()) return touched;
  Index at;
  for (std::size_t d = 0; d < Dim; ++d) at[d] = coordinate(point[static_cast<Eigen::Index>(d)], d);
  return regions_[number(at)];
}

template class CellRegions<2>;
template class CellRegions<3>;

}  // namespace isorim::solver
