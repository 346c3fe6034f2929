#include "solver/bem/divided_table.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "geometry/bezier/subdivision.h"

namespace isorim::solver {

namespace {

template <int Dim>
std::array<int, Dim - 1> degrees_of(const geometry::BezierElement<Dim>& element) {
  std::array<int, Dim - 1> degrees;
  std::copy(element.degree.begin(), element.degree.end(), degrees.begin());
  return degrees;
}

}  // namespace

template <int Dim>
double extent(const Eigen::Ref<const geometry::HomogeneousPoints<Dim>>& net,
              const geometry::BezierElement<Dim>& element, int direction) {
  const geometry::Points<Dim> points = net.template topRows<Dim>().array().rowwise() / net.row(Dim).array();
  const Eigen::Index along = element.degree[static_cast<std::size_t>(direction)] + 1;
  const Eigen::Index step = direction == 0 ? 1 : element.degree[0] + 1;
  const Eigen::Index line_step = direction == 0 ? along : 1;
  double longest = 0.0;
  for (Eigen::Index line = 0; line < points.cols() / along; ++line) {
    double length = 0.0;
    for (Eigen::Index i = 0; i + 1 < along; ++i) {
      const Eigen::Index first = line * line_step + i * step;
      length += (points.col(first + step) - points.col(first)).norm();
    }
    longest = std::max(longest, length);
  }
  return longest;
}

template <int Dim>
DividedTable<Dim>::DividedTable(const geometry::ElementTable<Dim>& table, double length) {
  table_.regions = table.regions;
  struct Work {
    Part part;
    std::vector<double> net;
  };
  for (std::size_t e = 0; e < table.elements.size(); ++e) {
    const geometry::BezierElement<Dim>& element = table.elements[e];
    const std::array<int, Dim - 1> degrees = degrees_of(element);
    first_.push_back(parts_.size());
    const std::span<const double> whole = table.net(element);
    std::vector<Work> work;
    Part all;
    all.element = static_cast<int>(e);
    work.push_back({all, {whole.begin(), whole.end()}});
    while (!work.empty()) {
      Work piece = std::move(work.back());
      work.pop_back();
      const Eigen::Map<const geometry::HomogeneousPoints<Dim>> net(piece.net.data(), Dim + 1,
                                                                   element.control_point_count());
      int direction = 0;
      while (direction < Dim - 1 && (element.is_cut() || extent<Dim>(net, element, direction) <= length)) ++direction;
      if (direction == Dim - 1) {
        geometry::BezierElement<Dim> part = element;
        part.offset = table_.nets.size();
        table_.nets.insert(table_.nets.end(), piece.net.begin(), piece.net.end());
        table_.elements.push_back(part);
        parts_.push_back(piece.part);
        continue;
      }
      auto [low, high] = geometry::subdivide(piece.net, Dim + 1, degrees, direction);
      Work second{piece.part, std::move(high)};
      Work first{piece.part, std::move(low)};
      first.part.upper[direction] = second.part.lower[direction] =
          0.5 * (piece.part.lower[direction] + piece.part.upper[direction]);
      work.push_back(std::move(second));
      work.push_back(std::move(first));
    }
  }
  first_.push_back(parts_.size());
}

template <int Dim>
quadrature::Target<Dim> DividedTable<Dim>::target(quadrature::Target<Dim> target) const {
  if (target.element < 0) return target;
  const auto element = static_cast<std::size_t>(target.element);
  for (std::size_t p = first_[element]; p < first_[element + 1]; ++p) {
    const Part& part = parts_[p];
    if (((target.place - part.lower).array() < 0.0).any() || ((part.upper - target.place).array() < 0.0).any())
      continue;
    target.element = static_cast<int>(p);
    target.place = (target.place - part.lower).cwiseQuotient(part.upper - part.lower);
    break;
  }
  return target;
}

template class DividedTable<2>;
template class DividedTable<3>;
template double extent<2>(const Eigen::Ref<const geometry::HomogeneousPoints<2>>&, const geometry::BezierElement<2>&,
                          int);
template double extent<3>(const Eigen::Ref<const geometry::HomogeneousPoints<3>>&, const geometry::BezierElement<3>&,
                          int);

}  // namespace isorim::solver
