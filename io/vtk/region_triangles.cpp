#include "io/vtk/region_triangles.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <vtkCellArray.h>
#include <vtkContourTriangulator.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include "io/vtk/bernstein.h"

namespace isorim::io {
namespace {

using geometry::HomogeneousPoints;
using geometry::Point2;
using geometry::Point3;
using Triangle = std::array<int, 3>;
using Edge = std::pair<int, int>;

/// The surface over the unit cell of an element.
class ElementSurface {
 public:
  ElementSurface(const geometry::ElementTable<3>& table, const geometry::BezierElement<3>& element)
      : net_(table.net_matrix(element)), degree_{element.degree[0], element.degree[1]} {}

  Point3 at(const Point2& st) const {
    const Eigen::VectorXd in_s = bernstein(degree_[0], st.x());
    const Eigen::VectorXd in_t = bernstein(degree_[1], st.y());
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    for (int j = 0; j <= degree_[1]; ++j) {
      for (int i = 0; i <= degree_[0]; ++i) sum += in_s[i] * in_t[j] * net_.col(i + j * (degree_[0] + 1));
    }
    return sum.head<3>() / sum[3];
  }

  /// Lengths in space of the unit cell's middle lines, which make its parameters comparable.
  Point2 stretch() const {
    const double s = (at({1.0, 0.5}) - at({0.5, 0.5})).norm() + (at({0.5, 0.5}) - at({0.0, 0.5})).norm();
    const double t = (at({0.5, 1.0}) - at({0.5, 0.5})).norm() + (at({0.5, 0.5}) - at({0.5, 0.0})).norm();
    const double least = 1e-6 * std::max(s, t);
    return {std::max(s, least), std::max(t, least)};
  }

 private:
  Eigen::Map<const HomogeneousPoints<3>> net_;
  std::array<int, 2> degree_;
};

double distance_from_segment(const Point3& point, const Point3& from, const Point3& to) {
  const geometry::Vector3 direction = to - from;
  const double squared_length = direction.squaredNorm();
  const double fraction =
      squared_length > 0.0 ? std::clamp((point - from).dot(direction) / squared_length, 0.0, 1.0) : 0.0;
  return (point - from - fraction * direction).norm();
}

double doubled_area(const Point2& a, const Point2& b, const Point2& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

// --- From curves to polygons ----------------------------------------------------------------------------------

using Polygon = std::vector<Point2>;

Point2 curve_point(const HomogeneousPoints<2>& net, double u) {
  const Eigen::Vector3d value = net * bernstein(static_cast<int>(net.cols()) - 1, u);
  return value.head<2>() / value[2];
}

/// Turns curves into chords that lie within the tolerance of them on the surface.
class CurveSampler {
 public:
  CurveSampler(const ElementSurface& surface, double tolerance) : surface_(surface), tolerance_(tolerance) {}

  /// Appends the points of the curve without its last one.
  void append(const HomogeneousPoints<2>& net, Polygon& polygon) const {
    // Symmetric curves may meet their chord where they are probed.
    const int parts = net.cols() == 2 ? 1 : 3;
    for (int i = 0; i < parts; ++i) bisect(net, i / double(parts), (i + 1) / double(parts), 0, polygon);
  }

 private:
  static constexpr int max_depth = 12;

  void bisect(const HomogeneousPoints<2>& net, double from, double to, int depth, Polygon& polygon) const {
    if (depth < max_depth && !is_flat(net, from, to)) {
      const double middle = 0.5 * (from + to);
      bisect(net, from, middle, depth + 1, polygon);
      bisect(net, middle, to, depth + 1, polygon);
      return;
    }
    polygon.push_back(curve_point(net, from));
  }

  bool is_flat(const HomogeneousPoints<2>& net, double from, double to) const {
    const Point3 start = surface_.at(curve_point(net, from));
    const Point3 end = surface_.at(curve_point(net, to));
    for (const double f : {0.25, 0.5, 0.75}) {
      const Point3 between = surface_.at(curve_point(net, from + f * (to - from)));
      if (distance_from_segment(between, start, end) > 0.5 * tolerance_) return false;
    }
    return true;
  }

  const ElementSurface& surface_;
  double tolerance_;
};

/// The curves of a region in the order in which they follow one another, chain by chain.
std::vector<std::vector<const HomogeneousPoints<2>*>> chains_of(const geometry::TrimmedRegion& region) {
  const auto start_of = [](const HomogeneousPoints<2>& net) -> Point2 { return net.col(0).head<2>() / net(2, 0); };
  const auto end_of = [](const HomogeneousPoints<2>& net) -> Point2 {
    return net.rightCols<1>().topRows<2>() / net(2, net.cols() - 1);
  };
  const std::size_t count = region.curves.size();
  std::vector<bool> used(count, false);
  std::vector<std::vector<const HomogeneousPoints<2>*>> chains;
  for (std::size_t first = 0; first < count; ++first) {
    if (used[first]) continue;
    const Point2 begin = start_of(region.curves[first]);
    auto& chain = chains.emplace_back();
    for (std::size_t current = first;;) {
      used[current] = true;
      chain.push_back(&region.curves[current]);
      const Point2 end = end_of(region.curves[current]);
      double nearest = (end - begin).squaredNorm();
      std::optional<std::size_t> next;
      for (std::size_t i = first + 1; i < count && nearest > 0.0; ++i) {
        if (used[i]) continue;
        const double distance = (start_of(region.curves[i]) - end).squaredNorm();
        if (distance >= nearest) continue;
        nearest = distance;
        next = i;
      }
      if (!next) break;
      current = *next;
    }
  }
  return chains;
}

std::vector<Polygon> polygons_of(const geometry::TrimmedRegion& region, const ElementSurface& surface,
                                 double tolerance) {
  // Nearer points are one.
  constexpr double same_point = 1e-12;
  const CurveSampler sampler(surface, tolerance);
  std::vector<Polygon> polygons;
  for (const auto& chain : chains_of(region)) {
    Polygon sampled;
    for (const HomogeneousPoints<2>* net : chain) sampler.append(*net, sampled);
    Polygon polygon;
    for (const Point2& point : sampled)
      if (polygon.empty() || (point - polygon.back()).norm() > same_point) polygon.push_back(point);
    while (polygon.size() > 1 && (polygon.front() - polygon.back()).norm() <= same_point) polygon.pop_back();
    if (polygon.size() >= 3) polygons.push_back(std::move(polygon));
  }
  return polygons;
}

double doubled_area(const std::vector<Polygon>& polygons) {
  double sum = 0.0;
  for (const Polygon& polygon : polygons) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      sum += doubled_area(polygon.front(), polygon[i], polygon[(i + 1) % polygon.size()]);
    }
  }
  return sum;
}

// --- From polygons to triangles -------------------------------------------------------------------------------

struct Mesh {
  std::vector<Point2> vertices;
  std::vector<Triangle> triangles;

  double doubled_area_of(const Triangle& t) const {
    return doubled_area(vertices[std::size_t(t[0])], vertices[std::size_t(t[1])], vertices[std::size_t(t[2])]);
  }
  /// Counter-clockwise ones only: VTK's filler may leave triangles without area.
  void add(Triangle triangle) {
    const double area = doubled_area_of(triangle);
    if (area == 0.0) return;
    if (area < 0.0) std::swap(triangle[1], triangle[2]);
    triangles.push_back(triangle);
  }
};

/// The polygons filled by VTK; empty where it fails.
std::optional<Mesh> fill_with_ears(const std::vector<Polygon>& polygons) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> lines;
  Mesh mesh;
  for (const Polygon& polygon : polygons) {
    const auto first = static_cast<vtkIdType>(mesh.vertices.size());
    const auto count = static_cast<vtkIdType>(polygon.size());
    for (vtkIdType i = 0; i < count; ++i) {
      const Point2& point = polygon[std::size_t(i)];
      mesh.vertices.push_back(point);
      points->InsertNextPoint(point.x(), point.y(), 0.0);
      const vtkIdType line[2] = {first + i, first + (i + 1) % count};
      lines->InsertNextCell(2, line);
    }
  }
  vtkNew<vtkPolyData> contours;
  contours->SetPoints(points);
  contours->SetLines(lines);
  vtkNew<vtkCellArray> filled;
  const double normal[3] = {0.0, 0.0, 1.0};
  if (vtkContourTriangulator::TriangulateContours(contours, 0, lines->GetNumberOfCells(), filled, normal) == 0)
    return std::nullopt;
  vtkNew<vtkIdList> corners;
  double sum = 0.0;
  for (vtkIdType i = 0; i < filled->GetNumberOfCells(); ++i) {
    filled->GetCellAtId(i, corners);
    if (corners->GetNumberOfIds() != 3) return std::nullopt;
    const Triangle triangle{int(corners->GetId(0)), int(corners->GetId(1)), int(corners->GetId(2))};
    sum += std::abs(mesh.doubled_area_of(triangle));
    mesh.add(triangle);
  }
  const double expected = doubled_area(polygons);
  if (std::abs(sum - expected) > 1e-9 * std::abs(expected)) return std::nullopt;
  return mesh;
}

/// The polygons filled by trapezoids: between two neighbouring heights of vertices the region is a row of trapezoids,
/// whose corners are all the points at which the polygons meet these heights. Even-odd, so touching loops do no harm.
class TrapezoidFiller {
 public:
  explicit TrapezoidFiller(const std::vector<Polygon>& polygons) : polygons_(polygons) {
    for (const Polygon& polygon : polygons)
      for (const Point2& point : polygon) heights_.push_back(point.y());
    std::ranges::sort(heights_);
    // Heights that differ by rounding would make trapezoids without area.
    constexpr double least_height = 1e-10;
    const auto repeated = [](double low, double high) { return high - low <= least_height; };
    heights_.erase(std::unique(heights_.begin(), heights_.end(), repeated), heights_.end());
  }

  Mesh fill() {
    for (std::size_t slab = 0; slab + 1 < heights_.size(); ++slab) collect(slab);
    for (const Trapezoid& trapezoid : trapezoids_) fill(trapezoid);
    return std::move(mesh_);
  }

 private:
  /// Between heights slab and slab + 1; vertex numbers of its corners.
  struct Trapezoid {
    std::size_t slab = 0;
    std::array<int, 2> bottom{};
    std::array<int, 2> top{};
  };

  std::size_t level_of(double height) const {
    const auto above = std::ranges::upper_bound(heights_, height);
    return static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, above - heights_.begin() - 1));
  }

  int vertex(std::size_t level, double x) {
    auto& row = rows_[level];
    const auto [place, is_new] = row.try_emplace(x, static_cast<int>(mesh_.vertices.size()));
    if (is_new) mesh_.vertices.emplace_back(x, heights_[level]);
    return place->second;
  }

  void collect(std::size_t slab) {
    struct Side {
      double bottom, top;
    };
    std::vector<Side> sides;
    for (const Polygon& polygon : polygons_) {
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        Point2 low = polygon[i];
        Point2 high = polygon[(i + 1) % polygon.size()];
        if (low.y() > high.y()) std::swap(low, high);
        const std::size_t from = level_of(low.y());
        const std::size_t to = level_of(high.y());
        if (from > slab || to <= slab) continue;
        const auto x_at = [&](std::size_t level) {
          if (level == from) return low.x();
          if (level == to) return high.x();
          return low.x() + (high.x() - low.x()) * (heights_[level] - low.y()) / (high.y() - low.y());
        };
        sides.push_back({x_at(slab), x_at(slab + 1)});
      }
    }
    std::ranges::sort(sides, {}, [](const Side& side) { return side.bottom + side.top; });
    for (std::size_t i = 0; i + 1 < sides.size(); i += 2) {
      trapezoids_.push_back({slab,
                             {vertex(slab, sides[i].bottom), vertex(slab, sides[i + 1].bottom)},
                             {vertex(slab + 1, sides[i].top), vertex(slab + 1, sides[i + 1].top)}});
    }
  }

  /// The vertices of a row from one to another, left to right.
  std::vector<int> row_between(std::size_t level, const std::array<int, 2>& ends) const {
    const double from = mesh_.vertices[std::size_t(ends[0])].x();
    const double to = mesh_.vertices[std::size_t(ends[1])].x();
    std::vector<int> row;
    const auto& all = rows_.at(level);
    for (auto place = all.lower_bound(from); place != all.end() && place->first <= to; ++place)
      row.push_back(place->second);
    return row;
  }

  void fill(const Trapezoid& trapezoid) {
    const std::vector<int> bottom = row_between(trapezoid.slab, trapezoid.bottom);
    const std::vector<int> top = row_between(trapezoid.slab + 1, trapezoid.top);
    if (bottom.empty() || top.empty()) return;
    std::size_t b = 0;
    std::size_t t = 0;
    while (b + 1 < bottom.size() || t + 1 < top.size()) {
      const bool along_bottom =
          t + 1 == top.size() || (b + 1 < bottom.size() && static_cast<double>(b) * double(top.size() - 1) <=
                                                               static_cast<double>(t) * double(bottom.size() - 1));
      if (along_bottom) {
        mesh_.add({bottom[b], bottom[b + 1], top[t]});
        ++b;
      } else {
        mesh_.add({bottom[b], top[t + 1], top[t]});
        ++t;
      }
    }
  }

  const std::vector<Polygon>& polygons_;
  std::vector<double> heights_;
  std::map<std::size_t, std::map<double, int>> rows_;
  std::vector<Trapezoid> trapezoids_;
  Mesh mesh_;
};

// --- Flipping and refining ------------------------------------------------------------------------------------

Edge edge_of(int a, int b) {
  return std::minmax(a, b);
}

/// Improves and refines a mesh over an element.
class MeshRefiner {
 public:
  MeshRefiner(Mesh& mesh, const ElementSurface& surface, double tolerance)
      : mesh_(mesh), surface_(surface), stretch_(surface.stretch()), tolerance_(tolerance) {
    points_.reserve(mesh.vertices.size());
    for (const Point2& vertex : mesh.vertices) points_.push_back(surface.at(vertex));
  }

  void run() {
    constexpr int most_rounds = 12;
    flip_edges();
    for (int round = 0; round < most_rounds; ++round) {
      const std::set<Edge> marked = edges_to_split();
      if (marked.empty()) return;
      split(marked);
      flip_edges();
    }
  }

  const std::vector<Point3>& points() const { return points_; }

 private:
  /// The triangles on either side; for the second `border` at the region's edge, `crowded` where there are more than
  /// two, as loops that overlap may leave them.
  using EdgeMap = std::map<Edge, std::array<int, 2>>;
  static constexpr int border = -1;
  static constexpr int crowded = -2;

  EdgeMap edges() const {
    EdgeMap map;
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Triangle& t = mesh_.triangles[i];
        const auto [place, is_new] =
            map.try_emplace(edge_of(t[k], t[(k + 1) % 3]), std::array<int, 2>{static_cast<int>(i), border});
        if (!is_new) place->second[1] = place->second[1] == border ? static_cast<int>(i) : crowded;
      }
    }
    return map;
  }

  /// In lengths of space, roughly.
  Point2 scaled(int vertex) const { return mesh_.vertices[std::size_t(vertex)].cwiseProduct(stretch_); }

  int opposite(const Triangle& t, const Edge& edge) const {
    for (const int vertex : t)
      if (vertex != edge.first && vertex != edge.second) return vertex;
    return t[0];
  }

  /// The cosine of the angle at `apex` in the triangle with the edge.
  double cosine(int apex, const Edge& edge) const {
    const Point2 a = scaled(edge.first) - scaled(apex);
    const Point2 b = scaled(edge.second) - scaled(apex);
    return a.dot(b) / std::max(a.norm() * b.norm(), 1e-300);
  }

  /// Flips until the angles against each edge add up to at most half a turn: none grows thinner than it has to be.
  void flip_edges() {
    EdgeMap sides_of = edges();
    std::vector<Edge> waiting;
    for (const auto& [edge, sides] : sides_of)
      if (sides[1] >= 0) waiting.push_back(edge);
    // Rounding could make edges of four points on one circle flip for ever.
    std::size_t flips_left = 10 * mesh_.triangles.size() + 100;
    while (!waiting.empty() && flips_left > 0) {
      const Edge edge = waiting.back();
      waiting.pop_back();
      const auto place = sides_of.find(edge);
      if (place == sides_of.end() || !flip(place, sides_of, waiting)) continue;
      --flips_left;
    }
  }

  /// Flips an edge with two sides if that is better and possible, and lets the edges around it wait for their turn.
  bool flip(EdgeMap::iterator place, EdgeMap& sides_of, std::vector<Edge>& waiting) {
    const Edge edge = place->first;
    const auto [one, other] = place->second;
    Triangle& first = mesh_.triangles[std::size_t(one)];
    Triangle& second = mesh_.triangles[std::size_t(other)];
    const int a = opposite(first, edge);
    const int b = opposite(second, edge);
    // cos(alpha) + cos(beta) < 0 exactly if alpha + beta is more than half a turn.
    if (cosine(a, edge) + cosine(b, edge) > -1e-9) return false;
    auto [p, q] = edge;
    // So that p, q run counter-clockwise in the first.
    for (std::size_t k = 0; k < 3; ++k)
      if (first[k] == q && first[(k + 1) % 3] == p) std::swap(p, q);
    const Triangle new_first{a, p, b};
    const Triangle new_second{a, b, q};
    const double least = 1e-3 * std::min(mesh_.doubled_area_of(first), mesh_.doubled_area_of(second));
    if (mesh_.doubled_area_of(new_first) <= least || mesh_.doubled_area_of(new_second) <= least) return false;
    if (!sides_of.try_emplace(edge_of(a, b), place->second).second) return false;
    sides_of.erase(place);
    first = new_first;
    second = new_second;
    std::ranges::replace(sides_of.at(edge_of(p, b)), other, one);
    std::ranges::replace(sides_of.at(edge_of(q, a)), one, other);
    for (const Edge& around : {edge_of(a, p), edge_of(p, b), edge_of(b, q), edge_of(q, a)})
      if (sides_of.at(around)[1] >= 0) waiting.push_back(around);
    return true;
  }

  Point2 middle(const Edge& edge) const {
    return 0.5 * (mesh_.vertices[std::size_t(edge.first)] + mesh_.vertices[std::size_t(edge.second)]);
  }

  bool is_far(const Edge& edge) const {
    const Point3& from = points_[std::size_t(edge.first)];
    const Point3& to = points_[std::size_t(edge.second)];
    return distance_from_segment(surface_.at(middle(edge)), from, to) > tolerance_;
  }

  bool is_middle_far(const Triangle& t) const {
    Point2 parameters = Point2::Zero();
    std::array<Point3, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      parameters += mesh_.vertices[std::size_t(t[k])] / 3.0;
      corners[k] = points_[std::size_t(t[k])];
    }
    const Point3 on_surface = surface_.at(parameters);
    const geometry::Vector3 u = corners[1] - corners[0];
    const geometry::Vector3 v = corners[2] - corners[0];
    const geometry::Vector3 normal(u.y() * v.z() - u.z() * v.y(), u.z() * v.x() - u.x() * v.z(),
                                   u.x() * v.y() - u.y() * v.x());
    const double length = normal.norm();
    return length > 0.0 && std::abs(normal.dot(on_surface - corners[0])) > tolerance_ * length;
  }

  /// Inner edges alone: those of the region already lie along their curves.
  std::set<Edge> edges_to_split() const {
    const EdgeMap map = edges();
    std::set<Edge> marked;
    for (const auto& [edge, sides] : map)
      if (sides[1] != border && is_far(edge)) marked.insert(edge);
    for (const Triangle& t : mesh_.triangles) {
      if (!is_middle_far(t)) continue;
      std::optional<Edge> longest;
      double length = 0.0;
      for (std::size_t k = 0; k < 3; ++k) {
        const Edge edge = edge_of(t[k], t[(k + 1) % 3]);
        const double own = (points_[std::size_t(edge.first)] - points_[std::size_t(edge.second)]).norm();
        if (map.at(edge)[1] == border || own <= length) continue;
        longest = edge;
        length = own;
      }
      if (longest) marked.insert(*longest);
    }
    return marked;
  }

  void split(const std::set<Edge>& marked) {
    std::map<Edge, int> middles;
    for (const Edge& edge : marked) {
      middles[edge] = static_cast<int>(mesh_.vertices.size());
      mesh_.vertices.push_back(middle(edge));
      points_.push_back(surface_.at(mesh_.vertices.back()));
    }
    std::vector<Triangle> old;
    std::swap(old, mesh_.triangles);
    for (const Triangle& t : old) split(t, middles);
  }

  void split(const Triangle& t, const std::map<Edge, int>& middles) {
    // The corners with the middles of marked sides between them: a convex polygon with up to six vertices.
    std::vector<int> ring;
    std::vector<std::size_t> at_middles;
    for (std::size_t k = 0; k < 3; ++k) {
      ring.push_back(t[k]);
      const auto found = middles.find(edge_of(t[k], t[(k + 1) % 3]));
      if (found == middles.end()) continue;
      at_middles.push_back(ring.size());
      ring.push_back(found->second);
    }
    if (at_middles.size() == 3) {
      const std::array<int, 3> m{ring[1], ring[3], ring[5]};
      mesh_.triangles.push_back({m[0], m[1], m[2]});
      for (std::size_t k = 0; k < 3; ++k) mesh_.triangles.push_back({t[k], m[k], m[(k + 2) % 3]});
      return;
    }
    if (at_middles.empty()) {
      mesh_.triangles.push_back(t);
      return;
    }
    // A fan about a middle meets no straight run of three vertices but through its own apex.
    const std::size_t apex = at_middles.front();
    for (std::size_t k = 1; k + 1 < ring.size(); ++k) {
      mesh_.triangles.push_back({ring[apex], ring[(apex + k) % ring.size()], ring[(apex + k + 1) % ring.size()]});
    }
  }

  Mesh& mesh_;
  const ElementSurface& surface_;
  Point2 stretch_;
  double tolerance_;
  std::vector<Point3> points_;
};

}  // namespace

RegionTriangles triangulate_region(const geometry::ElementTable<3>& table, const geometry::BezierElement<3>& element,
                                   double chord_tolerance) {
  const ElementSurface surface(table, element);
  const geometry::TrimmedRegion& region = table.regions[static_cast<std::size_t>(element.region)];
  const std::vector<Polygon> polygons = polygons_of(region, surface, chord_tolerance);
  if (polygons.empty()) return {};
  std::optional<Mesh> filled = fill_with_ears(polygons);
  Mesh mesh = filled ? std::move(*filled) : TrapezoidFiller(polygons).fill();
  MeshRefiner refiner(mesh, surface, chord_tolerance);
  refiner.run();
  RegionTriangles result;
  const auto count = static_cast<Eigen::Index>(mesh.vertices.size());
  result.parameters.resize(2, count);
  result.points.resize(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    result.parameters.col(i) = mesh.vertices[std::size_t(i)];
    result.points.col(i) = refiner.points()[std::size_t(i)];
  }
  result.triangles = std::move(mesh.triangles);
  return result;
}

}  // namespace isorim::io
