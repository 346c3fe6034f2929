#include "geometry/tessellation/face_filling.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <Eigen/Geometry>

#include "geometry/errors.h"

namespace isorim::geometry {
namespace {

/// More triangles of one face are a sign of a tolerance below what makes sense.
constexpr std::size_t most_triangles = 4'000'000;
/// Of vertices that are no vertex of the mesh: the corners beyond the face.
constexpr int no_number = std::numeric_limits<int>::max();

std::array<Point2, 2> box_of(const std::vector<LoopPolygon>& loops) {
  std::array<Point2, 2> box{loops.front().front().uv, loops.front().front().uv};
  for (const LoopPolygon& loop : loops) {
    for (const LoopPoint& point : loop) {
      box[0] = box[0].cwiseMin(point.uv);
      box[1] = box[1].cwiseMax(point.uv);
    }
  }
  return box;
}

Point2 inside(const NurbsSurface<3>& surface, const Point2& uv) {
  const Interval u = surface.knots_u().domain();
  const Interval v = surface.knots_v().domain();
  return {std::clamp(uv.x(), u.first, u.last), std::clamp(uv.y(), v.first, v.last)};
}

/// Mean lengths in space of the sides of a rectangle of the parameters.
Vector2 stretch_of(const NurbsSurface<3>& surface, const Point2& lower, const Point2& upper) {
  Vector2 sum = Vector2::Zero();
  constexpr int steps = 4;
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < steps; ++j) {
      const Point2 part((i + 0.5) / steps, (j + 0.5) / steps);
      const SurfaceJet<3> jet = evaluate_jet(surface, inside(surface, lower + part.cwiseProduct(upper - lower)));
      sum += Vector2(jet.du.norm(), jet.dv.norm());
    }
  }
  const Vector2 lengths = (sum / (steps * steps)).cwiseProduct(upper - lower);
  return lengths.cwiseMax(1e-6 * lengths.maxCoeff());
}

/// Whether the control points lie in one plane: that of the first of them, the one farthest from it, and the one
/// farthest from the line through both.
bool lies_in_plane(const NurbsSurface<3>& surface) {
  const Points<3> points = surface.control_points();
  const Point3 first = points.col(0);
  Eigen::Index farthest = 0;
  const double size = (points.colwise() - first).colwise().norm().maxCoeff(&farthest);
  const Vector3 along = points.col(farthest) - first;
  Eigen::Index beside = 0;
  const double area = (points.colwise() - first).colwise().cross(along).colwise().norm().maxCoeff(&beside);
  const Vector3 normal = (points.col(beside) - first).cross(along);
  const double rounding = 1e-13 * (size + points.cwiseAbs().maxCoeff());
  return area > 0.0 && (normal.transpose() / area * (points.colwise() - first)).cwiseAbs().maxCoeff() <= rounding;
}

double distance_from_segment(const Point3& point, const Point3& from, const Point3& to) {
  const Vector3 direction = to - from;
  const double squared_length = direction.squaredNorm();
  const double part = squared_length > 0.0 ? std::clamp((point - from).dot(direction) / squared_length, 0.0, 1.0) : 0.0;
  return (point - from - part * direction).norm();
}

/// Knots inside an interval, and between them as many lines as the degree has to bend, without the ends.
std::vector<double> seed_lines(const KnotVector& knots, Interval range) {
  std::vector<double> ends = knots.breakpoints();
  std::vector<double> lines;
  const int parts = knots.degree();
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    for (int k = 0; k < parts; ++k) {
      const double line = std::lerp(ends[i], ends[i + 1], static_cast<double>(k) / parts);
      if (line > range.first && line < range.last) lines.push_back(line);
    }
  }
  return lines;
}

}  // namespace

FilledFace::FilledFace(const NurbsSurface<3>& surface, ConstrainedDelaunay mesh)
    : surface_(&surface), is_flat_(lies_in_plane(surface)), mesh_(std::move(mesh)) {}

std::optional<FilledFace> FilledFace::fill(const NurbsSurface<3>& surface, const std::vector<LoopPolygon>& loops,
                                           const std::vector<Point3>& points) {
  const auto [lower, upper] = box_of(loops);
  if (!((upper - lower).minCoeff() > 0.0)) return std::nullopt;
  FilledFace face(surface, ConstrainedDelaunay(lower, upper, stretch_of(surface, lower, upper)));
  face.vertices_.assign(4, {Point2::Zero(), Point3::Zero(), no_number});
  if (!face.add_loops(loops, points)) return std::nullopt;
  face.mesh_.find_windings();
  for (const ConstrainedDelaunay::Triangle& triangle : face.mesh_.triangles())
    if (triangle.winding != 0 && triangle.winding != 1) return std::nullopt;
  face.add_seeds();
  return face;
}

bool FilledFace::add_loops(const std::vector<LoopPolygon>& loops, const std::vector<Point3>& points) {
  std::vector<std::vector<int>> rings;
  for (const LoopPolygon& loop : loops) {
    std::vector<int>& ring = rings.emplace_back();
    for (const LoopPoint& point : loop) {
      const std::optional<int> local = mesh_.insert(point.uv);
      if (!local || *local < 4) return false;
      if (static_cast<std::size_t>(*local) == vertices_.size())
        vertices_.push_back({point.uv, points[static_cast<std::size_t>(point.vertex)], point.vertex});
      // Two different vertices of the mesh in one place of the parameters.
      if (vertex(*local).number != point.vertex) return false;
      ring.push_back(*local);
    }
  }
  for (const std::vector<int>& ring : rings)
    for (std::size_t i = 0; i < ring.size(); ++i)
      if (!mesh_.add_segment(ring[i], ring[(i + 1) % ring.size()])) return false;
  return true;
}

bool FilledFace::insert(const Point2& uv) {
  const std::optional<int> local = mesh_.insert(uv);
  if (!local || static_cast<std::size_t>(*local) != vertices_.size()) return false;
  const Point2 place = inside(*surface_, mesh_.point(*local));
  own_points_.push_back(evaluate(*surface_, place));
  vertices_.push_back({place, own_points_.back(), -static_cast<int>(own_points_.size())});
  return true;
}

/// Points where curved surfaces are likely to need them, so that symmetric shapes do not deceive the probes.
void FilledFace::add_seeds() {
  const KnotVector& in_u = surface_->knots_u();
  const KnotVector& in_v = surface_->knots_v();
  if (is_flat_ || (in_u.degree() == 1 && in_v.degree() == 1)) return;
  Point2 lower = vertices_[4].uv;
  Point2 upper = lower;
  for (std::size_t i = 4; i < vertices_.size(); ++i) {
    lower = lower.cwiseMin(vertices_[i].uv);
    upper = upper.cwiseMax(vertices_[i].uv);
  }
  const std::vector<double> lines_u = seed_lines(in_u, {lower.x(), upper.x()});
  const std::vector<double> lines_v = seed_lines(in_v, {lower.y(), upper.y()});
  const auto count = [](const std::vector<double>& lines) { return static_cast<double>(lines.size() + 1); };
  const Vector2 spacing((upper.x() - lower.x()) / count(lines_u), (upper.y() - lower.y()) / count(lines_v));
  for (const double v : lines_v) {
    for (const double u : lines_u) {
      const Point2 uv(u, v);
      const int triangle = mesh_.triangle_at(uv);
      if (triangle < 0 || !is_kept(triangle)) continue;
      const auto& corners = mesh_.triangles()[static_cast<std::size_t>(triangle)].vertices;
      const bool is_free = std::ranges::none_of(
          corners, [&](int corner) { return (vertex(corner).uv - uv).cwiseQuotient(spacing).norm() < 0.3; });
      if (is_free) insert(uv);
    }
  }
}

/// The triangle's normal is far from that of the surface.
bool FilledFace::looks_away(const ConstrainedDelaunay::Triangle& triangle, const Point2& middle) const {
  const Point3& a = vertex(triangle.vertices[0]).point;
  const Vector3 normal = (vertex(triangle.vertices[1]).point - a).cross(vertex(triangle.vertices[2]).point - a);
  const SurfaceJet<3> jet = evaluate_jet(*surface_, inside(*surface_, middle));
  return normal.dot(jet.du.cross(jet.dv)) < 0.3 * normal.norm() * jet.du.cross(jet.dv).norm();
}

/// Where the triangle is farthest from the surface, if that is too far: the middle of an edge, or its own.
std::optional<Point2> FilledFace::where_to_divide(int number, double tolerance) const {
  const ConstrainedDelaunay::Triangle& triangle = mesh_.triangles()[static_cast<std::size_t>(number)];
  std::optional<Point2> place;
  double worst = is_flat_ ? std::numeric_limits<double>::infinity() : tolerance;
  double longest = 0.0;
  std::optional<Point2> middle_of_longest;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vertex& a = vertex(triangle.vertices[(i + 1) % 3]);
    const Vertex& b = vertex(triangle.vertices[(i + 2) % 3]);
    if (triangle.is_segment[i]) continue;
    const Point2 middle = 0.5 * (a.uv + b.uv);
    const Point3 on_surface = evaluate(*surface_, inside(*surface_, middle));
    const double distance = distance_from_segment(on_surface, a.point, b.point);
    const double length = (on_surface - a.point).norm() + (on_surface - b.point).norm();
    if (distance > worst) {
      worst = distance;
      place = middle;
    }
    if (length > longest) {
      longest = length;
      middle_of_longest = middle;
    }
  }
  const Vertex& a = vertex(triangle.vertices[0]);
  const Vertex& b = vertex(triangle.vertices[1]);
  const Vertex& c = vertex(triangle.vertices[2]);
  const Point2 middle = (a.uv + b.uv + c.uv) / 3.0;
  const Vector3 normal = (b.point - a.point).cross(c.point - a.point);
  if (normal.norm() > 0.0) {
    const Point3 on_surface = evaluate(*surface_, inside(*surface_, middle));
    const double distance = std::abs(normal.normalized().dot(on_surface - a.point));
    if (distance > worst) place = middle;
  }
  // Triangles that are small against the tolerance may look anywhere.
  if (!place && longest > 4.0 * tolerance && looks_away(triangle, middle)) place = middle_of_longest;
  return place;
}

void FilledFace::refine(double tolerance) {
  mesh_.take_changed();
  std::vector<int> open;
  for (std::size_t i = 0; i < mesh_.triangles().size(); ++i) open.push_back(static_cast<int>(i));
  while (!open.empty()) {
    std::vector<int> changed;
    for (const int triangle : open) {
      if (!is_kept(triangle)) continue;
      const std::optional<Point2> place = where_to_divide(triangle, tolerance);
      if (!place || !insert(*place)) continue;
      const std::vector<int> more = mesh_.take_changed();
      changed.insert(changed.end(), more.begin(), more.end());
      if (mesh_.triangles().size() > most_triangles)
        throw NumericalError("more than four million triangles; expected a larger tolerance");
    }
    std::ranges::sort(changed);
    changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
    open = std::move(changed);
  }
}

bool FilledFace::split_between(int a, int b) {
  std::vector<Point2> places;
  for (const ConstrainedDelaunay::Triangle& triangle : mesh_.triangles()) {
    if (triangle.winding != 1) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vertex& first = vertex(triangle.vertices[(i + 1) % 3]);
      const Vertex& second = vertex(triangle.vertices[(i + 2) % 3]);
      if (!triangle.is_segment[i] && first.number == a && second.number == b)
        places.push_back(0.5 * (first.uv + second.uv));
    }
  }
  bool found = false;
  for (const Point2& place : places) found = insert(place) || found;
  return found;
}

std::vector<std::array<int, 3>> FilledFace::triangles() const {
  std::vector<std::array<int, 3>> result;
  for (const ConstrainedDelaunay::Triangle& triangle : mesh_.triangles()) {
    if (triangle.winding != 1) continue;
    std::array<int, 3> numbers{};
    for (std::size_t i = 0; i < 3; ++i) numbers[i] = vertex(triangle.vertices[i]).number;
    // At a pole several places of the parameters are one vertex.
    if (numbers[0] == numbers[1] || numbers[1] == numbers[2] || numbers[2] == numbers[0]) continue;
    result.push_back(numbers);
  }
  return result;
}

}  // namespace isorim::geometry
