#include "geometry/fitting/contour_ordering.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/fitting/band_thinning.h"
#include "geometry/fitting/contour_measures.h"
#include "geometry/fitting/neighbour_tree.h"
#include "geometry/fitting/point_tour.h"
#include "geometry/fitting/two_heaps.h"

namespace isorim::geometry {
namespace {

/// Steps longer than this times the points' own spacing are gaps.
constexpr double gap_factor = 4.0;
/// Turns greater than this to one side and at once to the other are a zigzag; noise shows in this part of the points.
constexpr double zigzag_angle = 40.0 / 180.0 * std::numbers::pi;
constexpr double zigzag_part = 0.18;
/// Pieces that are no loops and shorter than this part of all are left out.
constexpr double fragment_part = 0.05;

/// Distinct points and their weights.
struct Sample {
  Points<2> points;
  std::vector<double> weights;
  /// Indices of the given points that each stands for.
  std::vector<std::vector<int>> origins;

  std::size_t count() const { return weights.size(); }
};

Sample distinct(const Points<2>& points, const std::vector<int>& counts, std::vector<DroppedPoint>& dropped) {
  std::vector<int> order(static_cast<std::size_t>(points.cols()));
  std::iota(order.begin(), order.end(), 0);
  const auto coordinates = [&](int i) { return std::pair(points(0, i), points(1, i)); };
  std::ranges::sort(order, [&](int a, int b) { return std::pair(coordinates(a), a) < std::pair(coordinates(b), b); });
  Sample sample;
  std::vector<int> kept;
  for (const int i : order) {
    const double weight = counts.empty() ? 1.0 : counts[static_cast<std::size_t>(i)];
    if (!kept.empty() && coordinates(kept.back()) == coordinates(i)) {
      sample.weights.back() += weight;
      dropped.push_back({i, DropReason::duplicate});
      continue;
    }
    kept.push_back(i);
    sample.weights.push_back(weight);
    sample.origins.push_back({i});
  }
  sample.points = points(Eigen::all, kept);
  return sample;
}

// --- Groups ---------------------------------------------------------------------------------------------------

/// Points that are joined by steps shorter than gaps.
struct Group {
  std::vector<int> members;
  /// Length of their spanning tree.
  double length = 0.0;
};

/// The distance to the second nearest point: on a curve, the larger of the steps to either side.
std::vector<double> spacings(const NeighbourTree& tree) {
  std::vector<double> result;
  for (int i = 0; i < static_cast<int>(tree.points().cols()); ++i) {
    const std::vector<int> nearest = tree.nearest(tree.points().col(i), 2, i);
    result.push_back(nearest.empty() ? 0.0 : (tree.points().col(nearest.back()) - tree.points().col(i)).norm());
  }
  return result;
}

/// Steps between the two that are longer are gaps. The geometric mean of the spacings lets sparse follow dense parts
/// and keeps out what is alone.
double longest_step(const std::vector<double>& spacing, int a, int b) {
  return gap_factor * std::sqrt(spacing[static_cast<std::size_t>(a)] * spacing[static_cast<std::size_t>(b)]);
}

std::vector<Group> groups(const NeighbourTree& tree, const std::vector<double>& spacing) {
  struct Step {
    double length;
    int from;
    int to;
  };
  const int count = static_cast<int>(spacing.size());
  std::vector<Step> steps;
  for (int i = 0; i < count; ++i) {
    for (const int j : tree.nearest(tree.points().col(i), 10, i)) {
      const double length = (tree.points().col(i) - tree.points().col(j)).norm();
      if (length <= longest_step(spacing, i, j)) steps.push_back({length, i, j});
    }
  }
  std::ranges::sort(steps, [](const Step& a, const Step& b) {
    return std::pair(a.length, std::pair(a.from, a.to)) < std::pair(b.length, std::pair(b.from, b.to));
  });
  std::vector<int> parents(spacing.size());
  std::iota(parents.begin(), parents.end(), 0);
  const auto root = [&](int i) {
    while (parents[static_cast<std::size_t>(i)] != i) {
      int& parent = parents[static_cast<std::size_t>(i)];
      parent = parents[static_cast<std::size_t>(parent)];
      i = parent;
    }
    return i;
  };
  std::vector<double> lengths(spacing.size(), 0.0);
  for (const Step& step : steps) {
    const int a = root(step.from);
    const int b = root(step.to);
    if (a == b) continue;
    parents[static_cast<std::size_t>(b)] = a;
    lengths[static_cast<std::size_t>(a)] += lengths[static_cast<std::size_t>(b)] + step.length;
  }
  std::vector<Group> all(spacing.size());
  for (int i = 0; i < count; ++i) {
    Group& group = all[static_cast<std::size_t>(root(i))];
    group.members.push_back(i);
    group.length = lengths[static_cast<std::size_t>(root(i))];
  }
  std::erase_if(all, [](const Group& group) { return group.members.empty(); });
  return all;
}

// --- Chains ---------------------------------------------------------------------------------------------------

struct Chain {
  std::vector<int> members;
  bool closed = false;
};

/// Pieces of contours between gaps, and how they are joined.
class ChainJoiner {
 public:
  ChainJoiner(const Points<2>& points, const OrderingOptions& options) : points_(points), options_(options) {}

  /// A tour cut where its steps are gaps.
  void add_tour(const std::vector<int>& tour, const std::vector<double>& spacing) {
    const std::size_t size = tour.size();
    std::vector<std::size_t> cuts;
    std::size_t longest = 0;
    double length = 0.0;
    for (std::size_t i = 0; i < size; ++i) {
      const int a = tour[i];
      const int b = tour[(i + 1) % size];
      length += distance(a, b);
      if (distance(a, b) > longest_step(spacing, a, b)) cuts.push_back(i);
      if (distance(a, b) > distance(tour[longest], tour[(longest + 1) % size])) longest = i;
    }
    const bool runs_back = distance(tour[longest], tour[(longest + 1) % size]) > 0.25 * length;
    if (cuts.empty() && (runs_back || options_.ends == ContourEnds::open)) cuts.push_back(longest);
    if (cuts.empty()) {
      chains_.push_back({tour, true});
      return;
    }
    for (std::size_t c = 0; c < cuts.size(); ++c) {
      Chain chain;
      const std::size_t end = (cuts[(c + 1) % cuts.size()] + 1) % size;
      std::size_t i = (cuts[c] + 1) % size;
      do {
        chain.members.push_back(tour[i]);
        i = (i + 1) % size;
      } while (i != end);
      chains_.push_back(std::move(chain));
    }
  }

  std::vector<Chain> joined() {
    while (join_nearest()) {
    }
    for (Chain& chain : chains_) {
      if (options_.ends == ContourEnds::closed && chain.members.size() > 2) chain.closed = true;
    }
    return chains_;
  }

 private:
  double distance(int a, int b) const { return (points_.col(a) - points_.col(b)).norm(); }

  double length(const Chain& chain) const {
    double sum = 0.0;
    for (std::size_t i = 1; i < chain.members.size(); ++i) sum += distance(chain.members[i - 1], chain.members[i]);
    return sum;
  }

  struct Join {
    double distance = std::numeric_limits<double>::infinity();
    std::size_t first = 0;
    std::size_t second = 0;
    /// The first chain is joined at its start, the second at its end.
    bool at_start = false;
    bool at_end = false;
  };

  void consider(std::size_t a, std::size_t b, const std::vector<double>& lengths, Join& best) const {
    const std::vector<int>& first = chains_[a].members;
    const std::vector<int>& second = chains_[b].members;
    if (a == b) {
      if (options_.ends == ContourEnds::open || first.size() < 3) return;
      const double gap = distance(first.back(), first.front());
      if (gap <= options_.largest_gap * lengths[a] && gap < best.distance) best = {gap, a, b, false, false};
      return;
    }
    for (const bool at_start : {false, true}) {
      for (const bool at_end : {false, true}) {
        const double gap = distance(at_start ? first.front() : first.back(), at_end ? second.back() : second.front());
        if (gap <= options_.largest_gap * (lengths[a] + lengths[b]) && gap < best.distance) {
          best = {gap, a, b, at_start, at_end};
        }
      }
    }
  }

  bool join_nearest() {
    std::vector<double> lengths;
    for (const Chain& chain : chains_) lengths.push_back(length(chain));
    Join best;
    for (std::size_t a = 0; a < chains_.size(); ++a) {
      for (std::size_t b = a; b < chains_.size(); ++b) {
        if (!chains_[a].closed && !chains_[b].closed) consider(a, b, lengths, best);
      }
    }
    if (!std::isfinite(best.distance)) return false;
    Chain& first = chains_[best.first];
    if (best.first == best.second) {
      first.closed = true;
      return true;
    }
    Chain& second = chains_[best.second];
    if (best.at_start) std::ranges::reverse(first.members);
    if (best.at_end) std::ranges::reverse(second.members);
    first.members.insert(first.members.end(), second.members.begin(), second.members.end());
    chains_.erase(chains_.begin() + static_cast<std::ptrdiff_t>(best.second));
    return true;
  }

  const Points<2>& points_;
  const OrderingOptions& options_;
  std::vector<Chain> chains_;
};

// --- Judging --------------------------------------------------------------------------------------------------

/// The angle by which the polygon turns at b, in (-pi, pi].
double turn(const Point2& a, const Point2& b, const Point2& c) {
  const Vector2 in = b - a;
  const Vector2 out = c - b;
  return std::atan2(in.x() * out.y() - in.y() * out.x(), in.dot(out));
}

bool is_zigzag(const Points<2>& points, const std::vector<Chain>& chains) {
  std::size_t zigzags = 0;
  std::size_t count = 0;
  for (const Chain& chain : chains) {
    const std::size_t size = chain.members.size();
    if (size < 24) continue;
    double before = 0.0;
    for (std::size_t i = 1; i + 1 < size; ++i) {
      const double here =
          turn(points.col(chain.members[i - 1]), points.col(chain.members[i]), points.col(chain.members[i + 1]));
      zigzags += std::min(std::abs(here), std::abs(before)) > zigzag_angle && (here > 0.0) != (before > 0.0);
      before = here;
      ++count;
    }
  }
  return static_cast<double>(zigzags) > zigzag_part * static_cast<double>(count);
}

/// Points that the chain goes out to and comes back from, over steps much longer than its others.
std::vector<int> remove_spikes(const Points<2>& points, Chain& chain) {
  std::vector<double> steps;
  const auto distance = [&](int a, int b) { return (points.col(a) - points.col(b)).norm(); };
  for (std::size_t i = 1; i < chain.members.size(); ++i) {
    steps.push_back(distance(chain.members[i - 1], chain.members[i]));
  }
  if (steps.size() < 8) return {};
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::ranges::nth_element(steps, middle);
  const double usual = *middle;
  std::vector<int> spikes;
  for (std::size_t i = 0; i < chain.members.size() && chain.members.size() > 8;) {
    const std::size_t size = chain.members.size();
    const bool is_end = !chain.closed && (i == 0 || i + 1 == size);
    const int a = chain.members[(i + size - 1) % size];
    const int b = chain.members[i];
    const int c = chain.members[(i + 1) % size];
    const bool stands_off = std::min(distance(a, b), distance(b, c)) > 2.5 * usual && distance(a, c) < 2.5 * usual;
    if (!is_end && stands_off) {
      spikes.push_back(b);
      chain.members.erase(chain.members.begin() + static_cast<std::ptrdiff_t>(i));
    } else {
      ++i;
    }
  }
  return spikes;
}

struct Extent {
  double length = 0.0;
  double area = 0.0;
};

Extent extent(const Points<2>& points, const Chain& chain) {
  Extent result;
  const std::size_t size = chain.members.size();
  for (std::size_t i = chain.closed ? 0 : 1; i < size; ++i) {
    result.length += (points.col(chain.members[i]) - points.col(chain.members[(i + size - 1) % size])).norm();
  }
  if (chain.closed) result.area = std::abs(polygon_area(points(Eigen::all, chain.members)));
  return result;
}

/// What gaps and noise leave over: few points, or a short piece that is no loop.
bool is_fragment(const Extent& extent, const Chain& chain, double whole, const OrderingOptions& options) {
  if (static_cast<int>(chain.members.size()) < options.least_points) return true;
  const double step = extent.length / static_cast<double>(chain.members.size());
  const bool is_loop = chain.closed && extent.area > 0.75 * step * extent.length;
  return !is_loop && extent.length < fragment_part * whole;
}

// --- The whole ------------------------------------------------------------------------------------------------

struct Ordering {
  std::vector<Chain> chains;
  /// Members of the sample: in groups too small, and in pieces that are no contours.
  std::vector<int> outliers;
  std::vector<int> fragments;
};

Ordering order_sample(const Sample& sample, const OrderingOptions& options) {
  const NeighbourTree tree(sample.points);
  const std::vector<double> spacing = spacings(tree);
  ChainJoiner joiner(sample.points, options);
  Ordering ordering;
  for (const Group& group : groups(tree, spacing)) {
    if (static_cast<int>(group.members.size()) < options.least_points) {
      ordering.outliers.insert(ordering.outliers.end(), group.members.begin(), group.members.end());
      continue;
    }
    const Points<2> members = sample.points(Eigen::all, group.members);
    const double way_out =
        options.ends == ContourEnds::closed ? std::numeric_limits<double>::infinity() : 0.25 * group.length;
    for (std::vector<int>& tour : short_tours(members, {.largest_cost = way_out})) {
      for (int& i : tour) i = group.members[static_cast<std::size_t>(i)];
      joiner.add_tour(tour, spacing);
    }
  }
  ordering.chains = joiner.joined();
  double whole = 0.0;
  for (const Chain& chain : ordering.chains) whole += extent(sample.points, chain).length;
  std::erase_if(ordering.chains, [&](const Chain& chain) {
    if (!is_fragment(extent(sample.points, chain), chain, whole, options)) return false;
    ordering.fragments.insert(ordering.fragments.end(), chain.members.begin(), chain.members.end());
    return true;
  });
  return ordering;
}

/// The sample without some of its members, on the middle lines of its bands.
Sample thinned(const Sample& sample, const std::vector<int>& without) {
  std::vector<int> kept;
  std::vector<double> weights;
  for (std::size_t i = 0; i < sample.count(); ++i) {
    if (std::ranges::binary_search(without, static_cast<int>(i))) continue;
    kept.push_back(static_cast<int>(i));
    weights.push_back(sample.weights[i]);
  }
  ThinnedPoints thin = thin_band(sample.points(Eigen::all, kept), weights);
  Sample result{std::move(thin.points), std::move(thin.weights), {}};
  for (const std::vector<int>& members : thin.members) {
    std::vector<int>& origins = result.origins.emplace_back();
    for (const int m : members) {
      const std::vector<int>& of = sample.origins[static_cast<std::size_t>(kept[static_cast<std::size_t>(m)])];
      origins.insert(origins.end(), of.begin(), of.end());
    }
  }
  return result;
}

void check(const Points<2>& points, const std::vector<int>& counts, const OrderingOptions& options) {
  if (!points.allFinite()) throw GeometryError("ordering: a coordinate is not a number");
  if (!counts.empty() && static_cast<Eigen::Index>(counts.size()) != points.cols()) {
    throw GeometryError(fmt::format("ordering: {} counts for {} points", counts.size(), points.cols()));
  }
  if (!counts.empty() && *std::ranges::min_element(counts) < 1) {
    throw GeometryError(fmt::format("ordering: a count is {}, it must be positive", *std::ranges::min_element(counts)));
  }
  if (!(options.largest_gap >= 0.0 && options.largest_gap <= 1.0)) {
    throw GeometryError(fmt::format("ordering: the largest gap is {}, it must lie in [0, 1]", options.largest_gap));
  }
  if (options.least_points < 3) {
    throw GeometryError(fmt::format("ordering: least points is {}, it must be at least 3", options.least_points));
  }
}

/// How far the given points lie off the contours that were made of them, and where that tells that two contours were
/// taken for one, or mixed up.
class DoubtfulParts {
 public:
  DoubtfulParts(const Points<2>& given, const Sample& sample, const std::vector<Chain>& chains)
      : given_(given), sample_(sample), chains_(chains), tree_(sample.points), positions_(sample.count()) {
    for (std::size_t c = 0; c < chains.size(); ++c) {
      const std::vector<int>& members = chains[c].members;
      double length = 0.0;
      for (std::size_t i = 0; i < members.size(); ++i) {
        if (i > 0) length += (sample.points.col(members[i]) - sample.points.col(members[i - 1])).norm();
        positions_[static_cast<std::size_t>(members[i])] = {static_cast<int>(c), length};
      }
    }
  }

  void find(OrderedContours& result) {
    for (const Chain& chain : chains_) search(chain);
    if (!place_) return;
    result.doubtful_share = part_ / whole_;
    result.doubtful_place = *place_;
  }

 private:
  struct Position {
    int chain = -1;
    double length = 0.0;
  };

  /// Enough points for the share of variance to be told to 0.02, which then lies between that of one even heap and of
  /// two normal ones.
  static constexpr std::size_t points_a_window = 48;
  static constexpr double two_heaps = 0.82;
  /// Contours nearer to each other, in standard deviations of the points across them, have been mixed up in tests.
  static constexpr double nearest = 7.5;

  Point2 point(const Chain& chain, std::size_t i) const {
    return sample_.points.col(chain.members[i % chain.members.size()]);
  }

  void search(const Chain& chain) {
    const std::size_t size = chain.members.size();
    std::vector<double> offsets;
    std::size_t first = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const bool has_neighbours = chain.closed || (i > 0 && i + 1 < size);
      if (has_neighbours) add_offsets(chain, i, offsets);
      if (offsets.size() < points_a_window && i + 1 < size) continue;
      judge(chain, first, i + 1, offsets);
      first = i + 1;
      offsets.clear();
    }
  }

  void add_offsets(const Chain& chain, std::size_t i, std::vector<double>& offsets) const {
    const Vector2 along = (point(chain, i + 1) - point(chain, i + chain.members.size() - 1)).normalized();
    for (const int k : sample_.origins[static_cast<std::size_t>(chain.members[i])]) {
      const Vector2 arm = given_.col(k) - point(chain, i);
      offsets.push_back(along.x() * arm.y() - along.y() * arm.x());
    }
  }

  void judge(const Chain& chain, std::size_t first, std::size_t last, const std::vector<double>& offsets) {
    const bool is_two = split_of_heaps(offsets, two_heaps).has_value();
    double squares = 0.0;
    for (const double offset : offsets) squares += offset * offset;
    const double reach = offsets.empty() ? 0.0 : nearest * std::sqrt(squares / static_cast<double>(offsets.size()));
    for (std::size_t i = first; i < last; ++i) {
      const double step = (point(chain, i + 1) - point(chain, i)).norm();
      whole_ += step;
      if (!is_two && !has_other_part(chain.members[i], reach)) continue;
      part_ += step;
      place_ = point(chain, i);
    }
  }

  /// Another contour, or a part of the same one that is far along it, within reach.
  bool has_other_part(int member, double reach) const {
    constexpr double far_along = 4.0;
    const Position& own = positions_[static_cast<std::size_t>(member)];
    bool found = false;
    tree_.for_each_within(sample_.points.col(member), reach, [&](int other, double) {
      const Position& position = positions_[static_cast<std::size_t>(other)];
      if (position.chain < 0) return;
      const double apart = std::abs(position.length - own.length);
      const double round = position.chain == own.chain ? std::min(apart, length_of(own.chain) - apart) : apart;
      found = found || position.chain != own.chain || round > far_along * reach;
    });
    return found;
  }

  double length_of(int chain) const {
    const std::vector<int>& members = chains_[static_cast<std::size_t>(chain)].members;
    return positions_[static_cast<std::size_t>(members.back())].length;
  }

  const Points<2>& given_;
  const Sample& sample_;
  const std::vector<Chain>& chains_;
  NeighbourTree tree_;
  /// Of the members of the sample.
  std::vector<Position> positions_;
  double part_ = 0.0;
  double whole_ = 0.0;
  std::optional<Point2> place_;
};

Contour contour_of(const Sample& sample, const Chain& chain) {
  Contour contour;
  contour.points = sample.points(Eigen::all, chain.members);
  contour.closed = chain.closed;
  for (const int i : chain.members) contour.weights.push_back(sample.weights[static_cast<std::size_t>(i)]);
  finish(contour);
  return contour;
}

}  // namespace

const char* drop_reason_name(DropReason reason) {
  switch (reason) {
    case DropReason::duplicate:
      return "duplicate";
    case DropReason::passed_over:
      return "passed over";
    case DropReason::not_reached:
      return "not reached";
    case DropReason::outlier:
      return "outlier";
    case DropReason::spike:
      return "spike";
  }
  return "unknown";
}

OrderedContours order_contours(const Points<2>& points, const std::vector<int>& counts,
                               const OrderingOptions& options) {
  check(points, counts, options);
  OrderedContours result;
  Sample sample = distinct(points, counts, result.dropped);
  Ordering ordering = order_sample(sample, options);
  const auto drop = [&](int member, DropReason reason) {
    for (const int i : sample.origins[static_cast<std::size_t>(member)]) result.dropped.push_back({i, reason});
  };
  constexpr int most_rounds = 3;
  for (int round = 0; round < most_rounds && is_zigzag(sample.points, ordering.chains); ++round) {
    for (const int i : ordering.outliers) drop(i, DropReason::outlier);
    std::ranges::sort(ordering.outliers);
    sample = thinned(sample, ordering.outliers);
    ordering = order_sample(sample, options);
    result.thinned = true;
  }
  if (result.thinned) DoubtfulParts(points, sample, ordering.chains).find(result);
  for (const int i : ordering.outliers) drop(i, DropReason::outlier);
  for (const int i : ordering.fragments) drop(i, DropReason::outlier);
  for (Chain& chain : ordering.chains) {
    for (const int i : remove_spikes(sample.points, chain)) drop(i, DropReason::spike);
    result.contours.push_back(contour_of(sample, chain));
  }
  if (result.contours.empty()) {
    throw GeometryError(fmt::format("ordering: no group of at least {} points among the {} given", options.least_points,
                                    points.cols()));
  }
  std::ranges::stable_sort(result.contours, {}, [](const Contour& contour) { return -contour.points.cols(); });
  std::ranges::sort(result.dropped, {}, &DroppedPoint::index);
  return result;
}

}  // namespace isorim::geometry
