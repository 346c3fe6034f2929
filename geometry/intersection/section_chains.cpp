#include "geometry/intersection/section_chains.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "geometry/topology/point_clusters.h"

namespace isorim::geometry {
namespace {

class Joiner {
 public:
  explicit Joiner(const std::vector<ChainLink>& links)
      : links_(links), next_(links.size(), -1), previous_(links.size(), -1) {}

  void join_within(double tolerance) {
    PointClusters<2> places(tolerance);
    std::vector<Meeting> meetings;
    const auto at = [&](const Point2& point) -> Meeting& {
      const auto i = static_cast<std::size_t>(places.add(point));
      if (i == meetings.size()) meetings.emplace_back();
      return meetings[i];
    };
    for (int i = 0; i < static_cast<int>(links_.size()); ++i) {
      if (next(i) < 0) at(link(i).end).ending.push_back(i);
      if (previous(i) < 0) at(link(i).start).starting.push_back(i);
    }
    for (Meeting& meeting : meetings)
      for (const int i : meeting.ending) pair(i, meeting.starting, tolerance);
  }

  std::vector<LinkChain> chains() const {
    std::vector<LinkChain> result;
    std::vector<bool> used(links_.size(), false);
    const auto run = [&](int first) {
      LinkChain chain;
      for (int i = first; i >= 0 && !used[static_cast<std::size_t>(i)]; i = next(i)) {
        used[static_cast<std::size_t>(i)] = true;
        chain.links.push_back(i);
      }
      chain.is_closed = next(chain.links.back()) == first;
      result.push_back(std::move(chain));
    };
    for (int i = 0; i < static_cast<int>(links_.size()); ++i)
      if (previous(i) < 0) run(i);
    for (int i = 0; i < static_cast<int>(links_.size()); ++i)
      if (!used[static_cast<std::size_t>(i)]) run(i);
    return result;
  }

 private:
  struct Meeting {
    std::vector<int> ending;
    std::vector<int> starting;
  };

  const ChainLink& link(int i) const { return links_[static_cast<std::size_t>(i)]; }
  int next(int i) const { return next_[static_cast<std::size_t>(i)]; }
  int previous(int i) const { return previous_[static_cast<std::size_t>(i)]; }

  /// Joins i with the first of the starts, clockwise from i itself, that is free.
  void pair(int i, const std::vector<int>& starting, double tolerance) {
    int best = -1;
    double least = 10.0;
    for (const int candidate : starting) {
      if (previous(candidate) >= 0 || closes_too_little(candidate, i, tolerance)) continue;
      const Vector2& back = link(i).arriving;
      const Vector2& ahead = link(candidate).leaving;
      double turn = std::atan2(ahead.x() * back.y() - ahead.y() * back.x(), ahead.dot(back));
      if (turn <= 0.0) turn += 2.0 * std::numbers::pi;
      if (turn >= least) continue;
      least = turn;
      best = candidate;
    }
    if (best < 0) return;
    next_[static_cast<std::size_t>(i)] = best;
    previous_[static_cast<std::size_t>(best)] = i;
  }

  /// The chain from `first` to `last` is hardly longer than the gap that would close it.
  bool closes_too_little(int first, int last, double tolerance) const {
    double length = 0.0;
    int i = first;
    for (; i >= 0 && i != last; i = next(i)) {
      length += link(i).length;
      if (length > 10.0 * tolerance) return false;
    }
    return i == last && length + link(last).length <= 10.0 * tolerance &&
           (link(last).end - link(first).start).norm() > 0.0;
  }

  const std::vector<ChainLink>& links_;
  std::vector<int> next_;
  std::vector<int> previous_;
};

}  // namespace

std::vector<LinkChain> join_links(const std::vector<ChainLink>& links, double finest, double coarsest) {
  Joiner joiner(links);
  for (double tolerance = finest; tolerance < coarsest; tolerance *= 10.0) joiner.join_within(tolerance);
  joiner.join_within(coarsest);
  return joiner.chains();
}

}  // namespace isorim::geometry
