#include "geometry/tessellation/constrained_delaunay.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

namespace isorim::geometry {
namespace {

__extension__ using Wide = __int128;

constexpr std::int64_t grid = std::int64_t{1} << 40;
/// Of the corners beyond the rectangle.
constexpr std::int64_t margin = grid / 4;

constexpr std::array<int, 3> next{1, 2, 0};
constexpr std::array<int, 3> previous{2, 0, 1};

std::size_t index(int i) {
  return static_cast<std::size_t>(i);
}

int number_of(const ConstrainedDelaunay::Triangle& triangle, int vertex) {
  for (int i = 0; i < 3; ++i)
    if (triangle.vertices[index(i)] == vertex) return i;
  return -1;
}

}  // namespace

ConstrainedDelaunay::ConstrainedDelaunay(const Point2& lower, const Point2& upper, const Vector2& stretch)
    : lower_(lower), cell_((upper - lower) / static_cast<double>(grid)), metric_(stretch / static_cast<double>(grid)) {
  places_ = {{-margin, -margin}, {grid + margin, -margin}, {grid + margin, grid + margin}, {-margin, grid + margin}};
  of_vertex_.resize(4);
  triangles_.resize(2);
  set(0, {0, 1, 2}, {Side{}, Side{1, 0, false}, Side{}});
  set(1, {0, 2, 3}, {Side{}, Side{}, Side{0, 0, false}});
}

// --- Positions ------------------------------------------------------------------------------------------------

std::optional<ConstrainedDelaunay::Place> ConstrainedDelaunay::place_of(const Point2& point) const {
  const Point2 scaled = (point - lower_).cwiseQuotient(cell_);
  // Points on the border may leave it by rounding.
  constexpr double reach = static_cast<double>(margin) / 2.0;
  if (!(scaled.minCoeff() > -reach && scaled.maxCoeff() < static_cast<double>(grid) + reach)) return std::nullopt;
  return Place{std::llround(scaled.x()), std::llround(scaled.y())};
}

Point2 ConstrainedDelaunay::point(int vertex) const {
  const Place& place = places_[index(vertex)];
  return lower_ + Point2(static_cast<double>(place.x), static_cast<double>(place.y)).cwiseProduct(cell_);
}

/// 1 if c lies on the left of the line from a to b, -1 on its right, 0 on it.
int ConstrainedDelaunay::orientation(int a, int b, const Place& c) const {
  const Place& p = places_[index(a)];
  const Place& q = places_[index(b)];
  const Wide area = static_cast<Wide>(q.x - p.x) * (c.y - p.y) - static_cast<Wide>(q.y - p.y) * (c.x - p.x);
  return area > 0 ? 1 : area < 0 ? -1 : 0;
}

ConstrainedDelaunay::Location ConstrainedDelaunay::locate(const Place& place) const {
  int triangle = last_;
  const std::size_t most = 4 * triangles_.size() + 16;
  for (std::size_t step = 0; step < most; ++step) {
    const Triangle& t = at(triangle);
    Location found{triangle, -1, -1};
    int zeros = 0;
    int leave = -1;
    for (int k = 0; k < 3 && leave < 0; ++k) {
      // Another edge first each time, so that the walk does not go round in a circle.
      const int i = static_cast<int>((index(k) + step) % 3);
      const int where = orientation(t.vertices[index(next[index(i)])], t.vertices[index(previous[index(i)])], place);
      if (where < 0) leave = i;
      if (where != 0) continue;
      ++zeros;
      // The vertex shared by two edges on whose lines the place lies.
      found.vertex = zeros == 2 ? t.vertices[index(3 - i - found.edge)] : -1;
      found.edge = i;
    }
    if (leave < 0) {
      last_ = triangle;
      return found;
    }
    triangle = t.neighbours[index(leave)];
    if (triangle < 0) break;
  }
  return {};
}

int ConstrainedDelaunay::triangle_at(const Point2& point) const {
  const std::optional<Place> place = place_of(point);
  return place ? locate(*place).triangle : -1;
}

// --- Making triangles -----------------------------------------------------------------------------------------

ConstrainedDelaunay::Side ConstrainedDelaunay::side(int triangle, int edge) const {
  const Triangle& t = at(triangle);
  return {t.neighbours[index(edge)], t.sides[index(edge)], t.is_segment[index(edge)]};
}

int ConstrainedDelaunay::new_triangle(int winding) {
  triangles_.emplace_back().winding = winding;
  return static_cast<int>(triangles_.size()) - 1;
}

void ConstrainedDelaunay::set(int triangle, const std::array<int, 3>& vertices, const std::array<Side, 3>& sides) {
  Triangle& t = at(triangle);
  t.vertices = vertices;
  for (std::size_t i = 0; i < 3; ++i) {
    t.neighbours[i] = sides[i].neighbour;
    t.sides[i] = sides[i].side;
    t.is_segment[i] = sides[i].is_segment;
    of_vertex_[index(vertices[i])] = triangle;
    if (sides[i].neighbour < 0) continue;
    Triangle& other = at(sides[i].neighbour);
    const int a = vertices[index(next[i])];
    const int b = vertices[index(previous[i])];
    for (std::size_t j = 0; j < 3; ++j)
      if (other.vertices[index(next[j])] == b && other.vertices[index(previous[j])] == a)
        other.neighbours[j] = triangle;
  }
  changed_.push_back(triangle);
}

void ConstrainedDelaunay::split_triangle(int triangle, int vertex) {
  const auto [a, b, c] = at(triangle).vertices;
  const Side opposite_a = side(triangle, 0);
  const Side opposite_b = side(triangle, 1);
  const Side opposite_c = side(triangle, 2);
  const int second = new_triangle(at(triangle).winding);
  const int third = new_triangle(at(triangle).winding);
  set(triangle, {a, b, vertex}, {Side{second, 0, false}, Side{third, 0, false}, opposite_c});
  set(second, {b, c, vertex}, {Side{third, 0, false}, Side{triangle, 0, false}, opposite_a});
  set(third, {c, a, vertex}, {Side{triangle, 0, false}, Side{second, 0, false}, opposite_b});
  legalise_round(vertex, {triangle, second, third});
}

void ConstrainedDelaunay::split_edge(int triangle, int edge, int vertex) {
  const Triangle& t = at(triangle);
  const int p = t.vertices[index(edge)];
  const int a = t.vertices[index(next[index(edge)])];
  const int b = t.vertices[index(previous[index(edge)])];
  const int beyond = t.neighbours[index(edge)];
  const int q = at(beyond).vertices[0] + at(beyond).vertices[1] + at(beyond).vertices[2] - a - b;
  const Side on_pa = side(triangle, previous[index(edge)]);
  const Side on_bp = side(triangle, next[index(edge)]);
  const Side on_qb = side(beyond, number_of(at(beyond), a));
  const Side on_aq = side(beyond, number_of(at(beyond), b));
  const int third = new_triangle(at(triangle).winding);
  const int fourth = new_triangle(at(beyond).winding);
  set(triangle, {p, a, vertex}, {Side{fourth, 0, false}, Side{third, 0, false}, on_pa});
  set(third, {p, vertex, b}, {Side{beyond, 0, false}, on_bp, Side{triangle, 0, false}});
  set(beyond, {q, b, vertex}, {Side{third, 0, false}, Side{fourth, 0, false}, on_qb});
  set(fourth, {q, vertex, a}, {Side{triangle, 0, false}, on_aq, Side{beyond, 0, false}});
  legalise_round(vertex, {triangle, third, beyond, fourth});
}

// --- Flips ----------------------------------------------------------------------------------------------------

/// The two triangles at the edge make a quadrilateral whose other diagonal lies inside it.
bool ConstrainedDelaunay::is_convex(int triangle, int edge) const {
  const Triangle& t = at(triangle);
  const int p = t.vertices[index(edge)];
  const int a = t.vertices[index(next[index(edge)])];
  const int b = t.vertices[index(previous[index(edge)])];
  const Triangle& u = at(t.neighbours[index(edge)]);
  const int q = u.vertices[0] + u.vertices[1] + u.vertices[2] - a - b;
  return orientation(p, a, q) > 0 && orientation(q, b, p) > 0;
}

/// The angles opposite to the edge make more than a half turn.
bool ConstrainedDelaunay::wants_flip(int triangle, int edge) const {
  const Triangle& t = at(triangle);
  const int beyond = t.neighbours[index(edge)];
  if (beyond < 0 || t.is_segment[index(edge)] || !is_convex(triangle, edge)) return false;
  const int p = t.vertices[index(edge)];
  const int a = t.vertices[index(next[index(edge)])];
  const int b = t.vertices[index(previous[index(edge)])];
  const Triangle& u = at(beyond);
  const int q = u.vertices[0] + u.vertices[1] + u.vertices[2] - a - b;
  const auto leg = [&](int from, int to) {
    const Place& f = places_[index(from)];
    const Place& g = places_[index(to)];
    return Vector2(static_cast<double>(g.x - f.x) * metric_.x(), static_cast<double>(g.y - f.y) * metric_.y());
  };
  const auto angle = [](const Vector2& x, const Vector2& y) {
    return Vector2(x.dot(y), x.x() * y.y() - x.y() * y.x());
  };
  const Vector2 at_p = angle(leg(p, a), leg(p, b));
  const Vector2 at_q = angle(leg(q, b), leg(q, a));
  const double sine = at_p.y() * at_q.x() + at_p.x() * at_q.y();
  // A margin above rounding, so that no two diagonals replace each other for ever.
  return sine < -1e-10 * at_p.norm() * at_q.norm();
}

void ConstrainedDelaunay::flip(int triangle, int edge) {
  const Triangle& t = at(triangle);
  const int p = t.vertices[index(edge)];
  const int a = t.vertices[index(next[index(edge)])];
  const int b = t.vertices[index(previous[index(edge)])];
  const int beyond = t.neighbours[index(edge)];
  const int q = at(beyond).vertices[0] + at(beyond).vertices[1] + at(beyond).vertices[2] - a - b;
  const Side on_pa = side(triangle, previous[index(edge)]);
  const Side on_bp = side(triangle, next[index(edge)]);
  const Side on_qb = side(beyond, number_of(at(beyond), a));
  const Side on_aq = side(beyond, number_of(at(beyond), b));
  set(triangle, {p, a, q}, {on_aq, Side{beyond, 0, false}, on_pa});
  set(beyond, {p, q, b}, {on_qb, on_bp, Side{triangle, 0, false}});
}

void ConstrainedDelaunay::legalise_round(int vertex, std::vector<int> triangles) {
  while (!triangles.empty()) {
    const int triangle = triangles.back();
    triangles.pop_back();
    const int edge = number_of(at(triangle), vertex);
    if (edge < 0 || !wants_flip(triangle, edge)) continue;
    const int beyond = at(triangle).neighbours[index(edge)];
    flip(triangle, edge);
    triangles.push_back(triangle);
    triangles.push_back(beyond);
  }
}

void ConstrainedDelaunay::legalise(std::vector<EdgeVertices> edges) {
  while (!edges.empty()) {
    const EdgeVertices edge = edges.back();
    edges.pop_back();
    const std::optional<Location> place = find_edge(edge);
    if (!place || !wants_flip(place->triangle, place->edge)) continue;
    const int beyond = at(place->triangle).neighbours[index(place->edge)];
    const int p = at(place->triangle).vertices[index(place->edge)];
    const int q = at(beyond).vertices[0] + at(beyond).vertices[1] + at(beyond).vertices[2] - edge[0] - edge[1];
    flip(place->triangle, place->edge);
    for (const EdgeVertices& side : {EdgeVertices{p, edge[0]}, {edge[0], q}, {q, edge[1]}, {edge[1], p}})
      edges.push_back(side);
  }
}

// --- Points and segments --------------------------------------------------------------------------------------

std::optional<int> ConstrainedDelaunay::insert(const Point2& point) {
  const std::optional<Place> place = place_of(point);
  if (!place) return std::nullopt;
  const Location where = locate(*place);
  if (where.triangle < 0) return std::nullopt;
  if (where.vertex >= 0) return where.vertex;
  if (where.edge >= 0 && at(where.triangle).is_segment[index(where.edge)]) return std::nullopt;
  const int vertex = vertex_count();
  places_.push_back(*place);
  of_vertex_.push_back(-1);
  if (where.edge >= 0)
    split_edge(where.triangle, where.edge, vertex);
  else
    split_triangle(where.triangle, vertex);
  return vertex;
}

std::vector<int> ConstrainedDelaunay::triangles_round(int vertex) const {
  const int first = of_vertex_[index(vertex)];
  std::vector<int> fan{first};
  const auto walk = [&](const std::array<int, 3>& turn) {
    for (int t = first;;) {
      t = at(t).neighbours[index(turn[index(number_of(at(t), vertex))])];
      if (t < 0 || t == first) return t == first;
      fan.push_back(t);
    }
  };
  if (!walk(next)) walk(previous);
  return fan;
}

std::optional<ConstrainedDelaunay::Location> ConstrainedDelaunay::find_edge(const EdgeVertices& edge) const {
  for (const int triangle : triangles_round(edge[0])) {
    const Triangle& t = at(triangle);
    const int i = number_of(t, edge[0]);
    if (t.vertices[index(next[index(i)])] == edge[1]) return Location{triangle, previous[index(i)], -1};
  }
  return std::nullopt;
}

/// Inside both of them.
bool ConstrainedDelaunay::cross(const EdgeVertices& a, const EdgeVertices& b) const {
  return orientation(a[0], a[1], b[0]) * orientation(a[0], a[1], b[1]) < 0 &&
         orientation(b[0], b[1], a[0]) * orientation(b[0], b[1], a[1]) < 0;
}

/// The triangle at `from` through whose far side a segment leaves.
std::optional<ConstrainedDelaunay::Location> ConstrainedDelaunay::first_across(int from, int to) const {
  for (const int triangle : triangles_round(from)) {
    const Triangle& t = at(triangle);
    const int i = number_of(t, from);
    const int right = t.vertices[index(next[index(i)])];
    const int left = t.vertices[index(previous[index(i)])];
    if (cross({from, to}, {right, left})) return Location{triangle, i, -1};
  }
  return std::nullopt;
}

/// Those that a segment crosses; nothing if a vertex or a segment is in its way.
std::optional<std::vector<ConstrainedDelaunay::EdgeVertices>> ConstrainedDelaunay::edges_across(int from,
                                                                                                int to) const {
  std::vector<EdgeVertices> crossing;
  std::optional<Location> here = first_across(from, to);
  while (here) {
    const Triangle& t = at(here->triangle);
    const int a = t.vertices[index(next[index(here->edge)])];
    const int b = t.vertices[index(previous[index(here->edge)])];
    if (t.is_segment[index(here->edge)]) return std::nullopt;
    crossing.push_back({a, b});
    const int beyond = t.neighbours[index(here->edge)];
    if (beyond < 0) return std::nullopt;
    const Triangle& u = at(beyond);
    const int apex = u.vertices[0] + u.vertices[1] + u.vertices[2] - a - b;
    if (apex == to) return crossing;
    const int where = orientation(from, to, apex);
    if (where == 0) return std::nullopt;
    // On through the side whose ends lie on different sides of the segment: that opposite to b or to a.
    const bool apex_is_beside_a = where == orientation(from, to, a);
    here = Location{beyond, number_of(u, apex_is_beside_a ? a : b), -1};
  }
  return std::nullopt;
}

/// Flips the edges until none crosses the segment; those that took their place.
std::optional<std::vector<ConstrainedDelaunay::EdgeVertices>> ConstrainedDelaunay::flip_away(
    std::vector<EdgeVertices> crossing, const EdgeVertices& segment) {
  std::vector<EdgeVertices> made;
  std::deque<EdgeVertices> queue(crossing.begin(), crossing.end());
  const std::size_t most = 64 + 4 * crossing.size() * crossing.size();
  for (std::size_t step = 0; !queue.empty(); ++step) {
    if (step > most) return std::nullopt;
    const EdgeVertices edge = queue.front();
    queue.pop_front();
    const std::optional<Location> place = find_edge(edge);
    if (!place) continue;
    if (!is_convex(place->triangle, place->edge)) {
      queue.push_back(edge);
      continue;
    }
    const Triangle& beyond = at(at(place->triangle).neighbours[index(place->edge)]);
    const EdgeVertices diagonal{at(place->triangle).vertices[index(place->edge)],
                                beyond.vertices[0] + beyond.vertices[1] + beyond.vertices[2] - edge[0] - edge[1]};
    flip(place->triangle, place->edge);
    if (cross(segment, diagonal))
      queue.push_back(diagonal);
    else
      made.push_back(diagonal);
  }
  return made;
}

bool ConstrainedDelaunay::add_segment(int from, int to) {
  if (from == to) return true;
  std::vector<EdgeVertices> made;
  if (!find_edge({from, to})) {
    const auto crossing = edges_across(from, to);
    if (!crossing) return false;
    std::optional<std::vector<EdgeVertices>> replaced = flip_away(*crossing, {from, to});
    if (!replaced || !find_edge({from, to})) return false;
    made = std::move(*replaced);
  }
  const auto mark = [&](const Location& place, int step) {
    Triangle& t = at(place.triangle);
    t.sides[index(place.edge)] += step;
    t.is_segment[index(place.edge)] = true;
  };
  mark(*find_edge({from, to}), 1);
  mark(*find_edge({to, from}), -1);
  legalise(std::move(made));
  return true;
}

void ConstrainedDelaunay::find_windings() {
  std::vector<bool> known(triangles_.size(), false);
  std::vector<int> open{of_vertex_[0]};
  known[index(open.front())] = true;
  at(open.front()).winding = 0;
  while (!open.empty()) {
    const int triangle = open.back();
    open.pop_back();
    for (std::size_t i = 0; i < 3; ++i) {
      const int neighbour = at(triangle).neighbours[i];
      if (neighbour < 0 || known[index(neighbour)]) continue;
      known[index(neighbour)] = true;
      at(neighbour).winding = at(triangle).winding - at(triangle).sides[i];
      open.push_back(neighbour);
    }
  }
}

std::vector<int> ConstrainedDelaunay::take_changed() {
  return std::exchange(changed_, {});
}

}  // namespace isorim::geometry
