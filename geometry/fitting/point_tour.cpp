#include "geometry/fitting/point_tour.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

#include "geometry/fitting/contour_measures.h"
#include "geometry/fitting/neighbour_tree.h"

namespace isorim::geometry {
namespace {

constexpr int neighbour_count = 10;

/// The points with their nearest neighbours.
struct Neighbourhood {
  Points<2> points;
  std::vector<std::vector<int>> nearest;

  explicit Neighbourhood(const Points<2>& given) : points(given) {
    const NeighbourTree tree(given);
    for (int i = 0; i < static_cast<int>(given.cols()); ++i) {
      nearest.push_back(tree.nearest(given.col(i), neighbour_count, i));
    }
  }
  int count() const { return static_cast<int>(points.cols()); }
  double distance(int a, int b) const { return (points.col(a) - points.col(b)).norm(); }
};

// --- Start: greedy matching -----------------------------------------------------------------------------------

class DisjointSets {
 public:
  explicit DisjointSets(int count) : parents_(static_cast<std::size_t>(count)) {
    std::iota(parents_.begin(), parents_.end(), 0);
  }
  int root(int i) {
    while (parents_[static_cast<std::size_t>(i)] != i) {
      int& parent = parents_[static_cast<std::size_t>(i)];
      parent = parents_[static_cast<std::size_t>(parent)];
      i = parent;
    }
    return i;
  }
  /// False if they were one already.
  bool unite(int a, int b) {
    const int first = root(a);
    const int second = root(b);
    if (first == second) return false;
    parents_[static_cast<std::size_t>(second)] = first;
    return true;
  }

 private:
  std::vector<int> parents_;
};

/// Paths through the points by the shortest steps first; those that remain are joined, each at its end to the nearest
/// start or end of another.
class GreedyTour {
 public:
  explicit GreedyTour(const Neighbourhood& graph)
      : graph_(graph), sets_(graph.count()), links_(static_cast<std::size_t>(graph.count())) {
    match();
  }

  std::vector<int> tour() {
    std::vector<int> ends;
    for (int i = 0; i < graph_.count(); ++i) {
      if (links_[static_cast<std::size_t>(i)].size() < 2) ends.push_back(i);
    }
    std::vector<int> result;
    std::vector<char> visited(links_.size(), 0);
    int start = ends.empty() ? 0 : ends.front();
    while (start >= 0) {
      walk_path(start, visited, result);
      std::erase_if(ends, [&](int i) { return visited[static_cast<std::size_t>(i)] != 0; });
      start = nearest_of(ends, result.back());
    }
    return result;
  }

 private:
  void match() {
    std::vector<std::pair<double, std::pair<int, int>>> steps;
    for (int i = 0; i < graph_.count(); ++i) {
      for (const int j : graph_.nearest[static_cast<std::size_t>(i)]) {
        steps.push_back({graph_.distance(i, j), {std::min(i, j), std::max(i, j)}});
      }
    }
    std::ranges::sort(steps);
    for (const auto& [length, ends] : steps) {
      const int a = ends.first;
      const int b = ends.second;
      auto& of_a = links_[static_cast<std::size_t>(a)];
      auto& of_b = links_[static_cast<std::size_t>(b)];
      if (of_a.size() == 2 || of_b.size() == 2 || !sets_.unite(a, b)) continue;
      of_a.push_back(b);
      of_b.push_back(a);
    }
  }

  void walk_path(int start, std::vector<char>& visited, std::vector<int>& result) const {
    for (int here = start; here >= 0;) {
      visited[static_cast<std::size_t>(here)] = 1;
      result.push_back(here);
      int next = -1;
      for (const int i : links_[static_cast<std::size_t>(here)]) {
        if (!visited[static_cast<std::size_t>(i)]) next = i;
      }
      here = next;
    }
  }

  int nearest_of(const std::vector<int>& ends, int place) const {
    int nearest = -1;
    double least = std::numeric_limits<double>::infinity();
    for (const int i : ends) {
      const double distance = graph_.distance(i, place);
      if (distance >= least) continue;
      least = distance;
      nearest = i;
    }
    return nearest;
  }

  const Neighbourhood& graph_;
  DisjointSets sets_;
  std::vector<std::vector<int>> links_;
};

// --- Improvement ----------------------------------------------------------------------------------------------

/// A tour as an array with places, improved by 2-opt and or-opt moves.
class Improver {
 public:
  Improver(const Neighbourhood& graph, std::vector<int> tour, double largest_cost)
      : graph_(graph), tour_(std::move(tour)), places_(tour_.size()), largest_cost_(largest_cost) {
    for (int i = 0; i < size(); ++i) places_[static_cast<std::size_t>(at(i))] = i;
  }

  std::vector<int> improved() {
    std::vector<int> queue(tour_);
    std::vector<char> queued(tour_.size(), 1);
    // Every move shortens the tour, so there is an end; rounding cannot turn in circles for the threshold.
    while (!queue.empty()) {
      const int node = queue.back();
      queue.pop_back();
      queued[static_cast<std::size_t>(node)] = 0;
      touched_.clear();
      while (two_opt(node) || move_segment(node)) {
      }
      for (const int i : touched_) {
        if (queued[static_cast<std::size_t>(i)]) continue;
        queued[static_cast<std::size_t>(i)] = 1;
        queue.push_back(i);
      }
    }
    return tour_;
  }

 private:
  int size() const { return static_cast<int>(tour_.size()); }
  int at(int place) const { return tour_[static_cast<std::size_t>(place)]; }
  int place(int node) const { return places_[static_cast<std::size_t>(node)]; }
  int wrapped(int place) const { return place < 0 ? place + size() : place >= size() ? place - size() : place; }
  int next(int node) const { return at(wrapped(place(node) + 1)); }
  int previous(int node) const { return at(wrapped(place(node) - 1)); }
  double cost(int a, int b) const { return std::min(graph_.distance(a, b), largest_cost_); }
  static bool is_gain(double gain, double total) { return gain > 1e-12 * total; }

  /// Turns round what stands from place `first` to place `last`, cyclically, or the rest if that is shorter.
  void reverse_range(int first, int last) {
    int inner = wrapped(last - first) + 1;
    if (2 * inner > size()) {
      const int begin = first;
      first = wrapped(last + 1);
      last = wrapped(begin - 1);
      inner = size() - inner;
    }
    for (int k = 0; k < inner / 2; ++k) {
      const int a = wrapped(first + k);
      const int b = wrapped(last - k);
      std::swap(tour_[static_cast<std::size_t>(a)], tour_[static_cast<std::size_t>(b)]);
      places_[static_cast<std::size_t>(at(a))] = a;
      places_[static_cast<std::size_t>(at(b))] = b;
    }
  }

  void touch(std::initializer_list<int> nodes) { touched_.insert(touched_.end(), nodes); }

  bool two_opt(int a) {
    const int b = next(a);
    const int z = previous(a);
    const double ahead = cost(a, b);
    const double behind = cost(z, a);
    for (const int c : graph_.nearest[static_cast<std::size_t>(a)]) {
      const double step = cost(a, c);
      if (step >= ahead && step >= behind) break;
      const int d = next(c);
      if (c != b && d != a && is_gain(ahead + cost(c, d) - step - cost(b, d), ahead + step)) {
        reverse_range(place(b), place(c));
        touch({a, b, c, d});
        return true;
      }
      const int y = previous(c);
      if (c != z && y != a && is_gain(behind + cost(y, c) - step - cost(z, y), behind + step)) {
        reverse_range(place(c), place(z));
        touch({a, c, y, z});
        return true;
      }
    }
    return false;
  }

  /// Moves the one to three points from `first` on, in either direction, between two others.
  bool move_segment(int first) {
    if (size() < 8) return false;
    for (int length = 1; length <= 3; ++length) {
      for (const bool forward : {true, false}) {
        int last = first;
        for (int k = 1; k < length; ++k) last = forward ? next(last) : previous(last);
        if (insert_segment(forward ? first : last, forward ? last : first, first)) return true;
      }
    }
    return false;
  }

  /// The points from `from` to `to` (in the tour's direction) put between a neighbour c of the end `joined` and one of
  /// c's own neighbours in the tour.
  bool insert_segment(int from, int to, int joined) {
    const int before = previous(from);
    const int after = next(to);
    const int other = joined == from ? to : from;
    const double saved = cost(before, from) + cost(to, after) - cost(before, after);
    for (const int c : graph_.nearest[static_cast<std::size_t>(joined)]) {
      const double step = cost(joined, c);
      if (step >= saved) break;
      if (wrapped(place(c) - place(from)) <= wrapped(place(to) - place(from))) continue;
      for (const int d : {next(c), previous(c)}) {
        if ((c == before && d == from) || (c == after && d == to)) continue;
        if (is_gain(saved + cost(c, d) - step - cost(other, d), saved + step)) {
          splice(from, to, joined, c, d);
          touch({from, to, before, after, c, d});
          return true;
        }
      }
    }
    return false;
  }

  /// Puts the segment from..to between c and d, `joined` beside c.
  void splice(int from, int to, int joined, int c, int d) {
    const int length = wrapped(place(to) - place(from)) + 1;
    const bool ahead = wrapped(place(c) - place(to)) < wrapped(place(from) - place(c));
    std::vector<int> segment;
    for (int k = 0, node = from; k < length; ++k, node = next(node)) segment.push_back(node);
    const int left = next(c) == d ? c : d;
    if (left == c ? joined != from : joined == from) std::ranges::reverse(segment);
    // Shift what lies between the segment and its new place, the shorter way round.
    if (ahead) {
      int to_place = place(from);
      for (int p = wrapped(place(to) + 1), end = wrapped(place(left) + 1); p != end; p = wrapped(p + 1)) {
        put(at(p), to_place);
        to_place = wrapped(to_place + 1);
      }
      for (const int node : segment) {
        put(node, to_place);
        to_place = wrapped(to_place + 1);
      }
    } else {
      int to_place = place(to);
      for (int p = wrapped(place(from) - 1), end = place(left); p != end; p = wrapped(p - 1)) {
        put(at(p), to_place);
        to_place = wrapped(to_place - 1);
      }
      std::ranges::reverse(segment);
      for (const int node : segment) {
        put(node, to_place);
        to_place = wrapped(to_place - 1);
      }
    }
  }

  void put(int node, int place) {
    tour_[static_cast<std::size_t>(place)] = node;
    places_[static_cast<std::size_t>(node)] = place;
  }

  const Neighbourhood& graph_;
  std::vector<int> tour_;
  std::vector<int> places_;
  double largest_cost_;
  std::vector<int> touched_;
};

// --- Parting --------------------------------------------------------------------------------------------------

bool is_fat(const Neighbourhood& graph, const std::vector<int>& loop) {
  const Points<2> polygon = graph.points(Eigen::all, loop);
  double length = 0.0;
  for (std::size_t i = 0; i < loop.size(); ++i) length += graph.distance(loop[i], loop[(i + 1) % loop.size()]);
  return std::abs(polygon_area(polygon)) > 0.75 * length * length / static_cast<double>(loop.size());
}

struct Parting {
  double gain = 0.0;
  /// Places: the loops are first + 1 .. second, and the rest.
  int first = 0;
  int second = 0;
};

/// What parting at two steps of the tour would gain, the largest first.
std::vector<Parting> partings(const Neighbourhood& graph, const std::vector<int>& tour, int least_points) {
  const int size = static_cast<int>(tour.size());
  std::vector<int> places(static_cast<std::size_t>(graph.count()), -1);
  for (int i = 0; i < size; ++i) places[static_cast<std::size_t>(tour[static_cast<std::size_t>(i)])] = i;
  const auto at = [&](int place) { return tour[static_cast<std::size_t>(place % size)]; };
  std::vector<Parting> found;
  for (int i = 0; i < size; ++i) {
    // The steps (a, b) and (c, d) are replaced by (a, d) and (c, b).
    const int a = at(i);
    const int b = at(i + 1);
    for (const int d : graph.nearest[static_cast<std::size_t>(a)]) {
      const int place = places[static_cast<std::size_t>(d)];
      if (place < 0) continue;
      const int inner = (place - 1 - i + size) % size;
      if (inner < least_points || size - inner < least_points) continue;
      const int c = at(place - 1 + size);
      const double removed = graph.distance(a, b) + graph.distance(c, d);
      const double gain = removed - graph.distance(a, d) - graph.distance(c, b);
      if (gain > 1e-9 * removed) found.push_back({gain, i, (place - 1 + size) % size});
    }
  }
  std::ranges::sort(found, [](const Parting& x, const Parting& y) {
    return std::pair(-x.gain, x.first) < std::pair(-y.gain, y.first);
  });
  return found;
}

/// The tour in two, if that is shorter and both are loops; else empty.
std::vector<std::vector<int>> parted(const Neighbourhood& graph, const std::vector<int>& tour, int least_points) {
  const std::size_t size = tour.size();
  for (const Parting& parting : partings(graph, tour, least_points)) {
    std::vector<std::vector<int>> loops(2);
    std::size_t place = (static_cast<std::size_t>(parting.first) + 1) % size;
    const std::size_t end = (static_cast<std::size_t>(parting.second) + 1) % size;
    for (; place != end; place = (place + 1) % size) loops[0].push_back(tour[place]);
    const std::size_t rest = (static_cast<std::size_t>(parting.first) + 1) % size;
    for (; place != rest; place = (place + 1) % size) loops[1].push_back(tour[place]);
    if (is_fat(graph, loops[0]) && is_fat(graph, loops[1])) return loops;
  }
  return {};
}

}  // namespace

std::vector<std::vector<int>> short_tours(const Points<2>& points, const TourOptions& options) {
  const Neighbourhood graph(points);
  std::vector<std::vector<int>> open{Improver(graph, GreedyTour(graph).tour(), options.largest_cost).improved()};
  std::vector<std::vector<int>> tours;
  while (!open.empty()) {
    std::vector<int> tour = std::move(open.back());
    open.pop_back();
    std::vector<std::vector<int>> loops = parted(graph, tour, options.least_points);
    if (loops.empty()) {
      tours.push_back(std::move(tour));
    } else {
      open.insert(open.end(), std::make_move_iterator(loops.begin()), std::make_move_iterator(loops.end()));
    }
  }
  return tours;
}

}  // namespace isorim::geometry
