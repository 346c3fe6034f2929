#include "io/picture/drawable.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkIdList.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkStaticPointLocator.h>

#include "geometry/errors.h"
#include "io/picture/bezier_cells.h"

namespace isorim::io::picture {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr double crease_cosine = 0.8660254037844387;

/// Polydata in the making: points with the field, perhaps normals, and cells of one kind.
class Builder {
 public:
  Builder() {
    points_->SetDataTypeToDouble();
    shown_->SetName("shown");
    patch_->SetName("patch");
    for (vtkDoubleArray* three : {normals_.Get(), colour_.Get()}) three->SetNumberOfComponents(3);
    normals_->SetName("Normals");
    colour_->SetName("colour");
  }

  vtkIdType add_point(const Eigen::Vector3d& point, double value) {
    shown_->InsertNextValue(value);
    return points_->InsertNextPoint(point.data());
  }
  void add_normal(const Eigen::Vector3d& normal) { normals_->InsertNextTypedTuple(normal.data()); }
  void add_cell(const std::vector<vtkIdType>& ids, int patch = 0) {
    cells_->InsertNextCell(static_cast<vtkIdType>(ids.size()), ids.data());
    patch_->InsertNextValue(patch);
  }
  void add_colour(const double* colour) { colour_->InsertNextTypedTuple(colour); }

  enum class Kind { faces, lines, vertices };
  vtkSmartPointer<vtkPolyData> finish(Kind kind) {
    auto data = vtkSmartPointer<vtkPolyData>::New();
    data->SetPoints(points_);
    if (kind == Kind::faces) data->SetPolys(cells_);
    if (kind == Kind::lines) data->SetLines(cells_);
    if (kind == Kind::vertices) data->SetVerts(cells_);
    data->GetPointData()->AddArray(shown_);
    if (normals_->GetNumberOfTuples() > 0) data->GetPointData()->SetNormals(normals_);
    data->GetCellData()->AddArray(patch_);
    if (colour_->GetNumberOfTuples() > 0) data->GetCellData()->AddArray(colour_);
    return data;
  }

 private:
  vtkNew<vtkPoints> points_;
  vtkNew<vtkDoubleArray> shown_;
  vtkNew<vtkDoubleArray> normals_;
  vtkNew<vtkDoubleArray> colour_;
  vtkNew<vtkIntArray> patch_;
  vtkNew<vtkCellArray> cells_;
};

bool is_facet(int type) {
  return type == VTK_TRIANGLE || type == VTK_QUAD || type == VTK_POLYGON;
}

class Maker {
 public:
  Maker(vtkDataSet* data, const std::optional<ShownField>& field, double chord_tolerance)
      : data_(data),
        field_(field),
        chord_tolerance_(chord_tolerance),
        patch_(data->GetCellData()->GetArray("patch")),
        element_(data->GetCellData()->GetArray("element")),
        colour_(data->GetCellData()->GetArray("colour")) {
    if (colour_ != nullptr && colour_->GetNumberOfComponents() != 3) colour_ = nullptr;
  }

  Drawable make() {
    for (vtkIdType cell = 0; cell < data_->GetNumberOfCells(); ++cell) add(cell);
    add_facets();
    using Kind = Builder::Kind;
    return {faces_.finish(Kind::faces), borders_.finish(Kind::lines), curves_.finish(Kind::lines),
            dots_.finish(Kind::vertices), field_.has_value()};
  }

 private:
  void add(vtkIdType cell) {
    const int type = data_->GetCellType(cell);
    switch (type) {
      case VTK_EMPTY_CELL:
        return;
      case VTK_BEZIER_QUADRILATERAL:
        return add_quadrilateral(cell);
      case VTK_BEZIER_CURVE:
        return add_curve(cell);
      case VTK_LINE:
      case VTK_POLY_LINE:
        return add_polyline(cell);
      case VTK_VERTEX:
      case VTK_POLY_VERTEX:
        return add_dots(cell);
      default:
        break;
    }
    if (!is_facet(type)) {
      throw InputError(fmt::format(
          "cell {}: found the cell type {} of VTK; expected Bézier curves or quadrilaterals, facets, lines or points",
          cell, type));
    }
    facets_.push_back(cell);
  }

  int patch_of(vtkIdType cell) const { return patch_ != nullptr ? static_cast<int>(patch_->GetComponent(cell, 0)) : 0; }

  void add_face(const std::vector<vtkIdType>& ids, vtkIdType cell) {
    faces_.add_cell(ids, patch_of(cell));
    if (colour_ == nullptr) return;
    std::array<double, 3> colour{};
    colour_->GetTuple(cell, colour.data());
    faces_.add_colour(colour.data());
  }

  /// The tuples at the points of a cell, a column each; without rows if the field is none of points.
  Eigen::MatrixXd control_values(const BezierCell& bezier) const {
    if (!field_ || field_->is_of_cells) return Eigen::MatrixXd(0, bezier.net.cols());
    Eigen::MatrixXd values(field_->components(), bezier.net.cols());
    for (std::size_t k = 0; k < bezier.ids.size(); ++k) {
      field_->array->GetTuple(bezier.ids[k], values.col(static_cast<Eigen::Index>(k)).data());
    }
    return values;
  }

  double reduced_tuple(vtkIdType index) const {
    std::vector<double> tuple(static_cast<std::size_t>(field_->components()));
    field_->array->GetTuple(index, tuple.data());
    return field_->reduced(tuple.data());
  }

  /// The field in a cell at one of its sampled points.
  double shown(vtkIdType cell, const BezierSamples& samples, Eigen::Index k) const {
    if (!field_) return none;
    return field_->is_of_cells ? reduced_tuple(cell) : field_->reduced(samples.values.col(k).data());
  }

  double shown_at(vtkIdType cell, vtkIdType point) const {
    return field_ ? reduced_tuple(field_->is_of_cells ? cell : point) : none;
  }

  BezierSamples sampled(vtkIdType cell) const {
    const BezierCell bezier = read_bezier_cell(data_, cell);
    const int degree = std::max(bezier.degree[0], bezier.degree[1]);
    // Fields bend where shapes do not.
    const int least = field_ && !field_->is_of_cells ? 4 * degree : 1;
    return evaluate(bezier, control_values(bezier), pieces_for(bezier, chord_tolerance_, least));
  }

  void add_quadrilateral(vtkIdType cell) {
    const BezierSamples samples = sampled(cell);
    const auto [n, m] = samples.pieces;
    vtkIdType first = -1;
    for (Eigen::Index k = 0; k < samples.points.cols(); ++k) {
      const vtkIdType id = faces_.add_point(samples.points.col(k), shown(cell, samples, k));
      faces_.add_normal(samples.normals.col(k));
      if (k == 0) first = id;
    }
    const vtkIdType columns = n + 1;
    for (int j = 0; j < m; ++j) {
      for (int i = 0; i < n; ++i) {
        const vtkIdType a = first + i + j * columns;
        add_face({a, a + 1, a + columns + 1}, cell);
        add_face({a, a + columns + 1, a + columns}, cell);
      }
    }
    const auto side = [&](Eigen::Index from, Eigen::Index step, int pieces) {
      std::vector<vtkIdType> ids;
      for (int i = 0; i <= pieces; ++i) ids.push_back(borders_.add_point(samples.points.col(from + i * step), none));
      borders_.add_cell(ids);
    };
    side(0, 1, n);
    side(m * columns, 1, n);
    side(0, columns, m);
    side(n, columns, m);
  }

  void add_curve(vtkIdType cell) {
    const BezierSamples samples = sampled(cell);
    std::vector<vtkIdType> ids;
    for (Eigen::Index k = 0; k < samples.points.cols(); ++k) {
      ids.push_back(curves_.add_point(samples.points.col(k), shown(cell, samples, k)));
    }
    curves_.add_cell(ids, patch_of(cell));
  }

  std::vector<vtkIdType> points_of(vtkIdType cell) const {
    const vtkNew<vtkIdList> list;
    data_->GetCellPoints(cell, list);
    return {list->begin(), list->end()};
  }

  Eigen::Vector3d place(vtkIdType point) const {
    Eigen::Vector3d result;
    data_->GetPoint(point, result.data());
    return result;
  }

  void add_polyline(vtkIdType cell) {
    std::vector<vtkIdType> ids;
    for (const vtkIdType point : points_of(cell)) {
      ids.push_back(curves_.add_point(place(point), shown_at(cell, point)));
    }
    curves_.add_cell(ids, patch_of(cell));
  }

  void add_dots(vtkIdType cell) {
    for (const vtkIdType point : points_of(cell))
      dots_.add_cell({dots_.add_point(place(point), shown_at(cell, point))});
  }

  // --- Facets ---------------------------------------------------------------------------------------------------

  /// Twice the area along the normal (Newell).
  Eigen::Vector3d area_vector(const std::vector<vtkIdType>& ids) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    const Eigen::Vector3d origin = place(ids.front());
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const Eigen::Vector3d a = place(ids[i]) - origin;
      const Eigen::Vector3d b = place(ids[(i + 1) % ids.size()]) - origin;
      sum += a.cross(b);
    }
    return sum;
  }

  /// For each point the first one at its place.
  std::vector<vtkIdType> merged_points() const {
    const vtkNew<vtkPolyData> cloud;
    const vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    for (vtkIdType i = 0; i < data_->GetNumberOfPoints(); ++i) points->InsertNextPoint(place(i).data());
    cloud->SetPoints(points);
    const vtkNew<vtkStaticPointLocator> locator;
    locator->SetDataSet(cloud);
    locator->BuildLocator();
    std::vector<vtkIdType> map(static_cast<std::size_t>(data_->GetNumberOfPoints()));
    locator->MergePoints(1e-9 * data_->GetLength(), map.data());
    return map;
  }

  void add_facets() {
    if (facets_.empty()) return;
    const std::vector<vtkIdType> merged = merged_points();
    const auto place_of = [&](vtkIdType point) { return static_cast<std::size_t>(merged[std::size_t(point)]); };
    std::vector<Eigen::Vector3d> areas;
    std::vector<std::vector<std::size_t>> around(merged.size());
    for (std::size_t f = 0; f < facets_.size(); ++f) {
      const std::vector<vtkIdType> ids = points_of(facets_[f]);
      areas.push_back(area_vector(ids));
      for (const vtkIdType id : ids) around[place_of(id)].push_back(f);
    }
    for (std::size_t f = 0; f < facets_.size(); ++f) {
      std::vector<vtkIdType> corners;
      const std::vector<vtkIdType> ids = points_of(facets_[f]);
      for (const vtkIdType id : ids) {
        corners.push_back(faces_.add_point(place(id), shown_at(facets_[f], id)));
        faces_.add_normal(smooth_normal(areas, f, around[place_of(id)]));
      }
      add_face(corners, facets_[f]);
    }
    add_facet_borders(merged);
  }

  static Eigen::Vector3d smooth_normal(const std::vector<Eigen::Vector3d>& areas, std::size_t facet,
                                       const std::vector<std::size_t>& neighbours) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    const Eigen::Vector3d own = areas[facet];
    for (const std::size_t other : neighbours) {
      if (own.dot(areas[other]) >= crease_cosine * own.norm() * areas[other].norm()) sum += areas[other];
    }
    return sum.squaredNorm() > 0.0 ? sum.normalized() : Eigen::Vector3d::Zero();
  }

  /// The edges that only one facet of an element has.
  void add_facet_borders(const std::vector<vtkIdType>& merged) {
    using Edge = std::tuple<vtkIdType, vtkIdType, vtkIdType>;
    std::vector<Edge> edges;
    for (const vtkIdType facet : facets_) {
      const vtkIdType element = element_ != nullptr ? static_cast<vtkIdType>(element_->GetComponent(facet, 0)) : facet;
      const std::vector<vtkIdType> ids = points_of(facet);
      for (std::size_t i = 0; i < ids.size(); ++i) {
        const vtkIdType a = merged[std::size_t(ids[i])];
        const vtkIdType b = merged[std::size_t(ids[(i + 1) % ids.size()])];
        edges.emplace_back(element, std::min(a, b), std::max(a, b));
      }
    }
    std::sort(edges.begin(), edges.end());
    for (auto edge = edges.begin(); edge != edges.end();) {
      const auto next = std::upper_bound(edge, edges.end(), *edge);
      if (next - edge == 1) {
        borders_.add_cell(
            {borders_.add_point(place(std::get<1>(*edge)), none), borders_.add_point(place(std::get<2>(*edge)), none)});
      }
      edge = next;
    }
  }

  vtkDataSet* data_;
  std::optional<ShownField> field_;
  double chord_tolerance_;
  vtkDataArray* patch_;
  vtkDataArray* element_;
  vtkDataArray* colour_;
  Builder faces_;
  Builder borders_;
  Builder curves_;
  Builder dots_;
  std::vector<vtkIdType> facets_;
};

}  // namespace

Drawable make_drawable(vtkDataSet* data, const std::optional<ShownField>& field, double chord_tolerance) {
  return Maker(data, field, chord_tolerance).make();
}

namespace {

/// A piece of a curve in the plane, the lower end first.
struct Segment {
  Eigen::Vector2d lower;
  Eigen::Vector2d upper;

  double x_at(double y) const {
    const double share = (y - lower.y()) / (upper.y() - lower.y());
    return lower.x() + share * (upper.x() - lower.x());
  }
};

/// All that are not level, in the order of their lower ends.
std::vector<Segment> segments_of(vtkPolyData* curves) {
  std::vector<Segment> segments;
  const vtkNew<vtkIdList> ids;
  const auto place = [&](vtkIdType i) {
    Eigen::Vector3d point;
    curves->GetPoint(ids->GetId(i), point.data());
    return Eigen::Vector2d(point.head<2>());
  };
  for (vtkIdType cell = 0; cell < curves->GetNumberOfCells(); ++cell) {
    curves->GetCellPoints(cell, ids);
    for (vtkIdType i = 0; i + 1 < ids->GetNumberOfIds(); ++i) {
      const Eigen::Vector2d a = place(i);
      const Eigen::Vector2d b = place(i + 1);
      if (a.y() != b.y()) segments.push_back(a.y() < b.y() ? Segment{a, b} : Segment{b, a});
    }
  }
  std::sort(segments.begin(), segments.end(),
            [](const Segment& a, const Segment& b) { return a.lower.y() < b.lower.y(); });
  return segments;
}

}  // namespace

vtkSmartPointer<vtkPolyData> filled_region(vtkPolyData* curves) {
  Builder faces;
  std::array<double, 6> box{};
  curves->GetBounds(box.data());
  const bool is_flat = box[4] == box[5];
  const std::vector<Segment> segments = is_flat ? segments_of(curves) : std::vector<Segment>();
  std::vector<double> heights;
  for (const Segment& segment : segments) heights.insert(heights.end(), {segment.lower.y(), segment.upper.y()});
  std::sort(heights.begin(), heights.end());
  // Ends of curves that meet do so to rounding.
  const double step = 1e-12 * curves->GetLength();
  const auto add_trapezoid = [&](const Segment& left, const Segment& right, double low, double high) {
    std::vector<vtkIdType> corners;
    for (const auto& [side, y] : {std::pair{&left, low}, {&right, low}, {&right, high}, {&left, high}}) {
      corners.push_back(faces.add_point({side->x_at(y), y, box[4]}, none));
      faces.add_normal(Eigen::Vector3d::UnitZ());
    }
    faces.add_cell(corners);
  };
  std::vector<Segment> crossed;
  auto next = segments.begin();
  for (std::size_t k = 0; k + 1 < heights.size(); ++k) {
    const double low = heights[k];
    const double high = heights[k + 1];
    if (high - low <= step) continue;
    const double middle = 0.5 * (low + high);
    std::erase_if(crossed, [&](const Segment& segment) { return segment.upper.y() <= middle; });
    for (; next != segments.end() && next->lower.y() < middle; ++next) {
      if (next->upper.y() > middle) crossed.push_back(*next);
    }
    if (crossed.size() % 2 != 0) continue;
    std::sort(crossed.begin(), crossed.end(),
              [&](const Segment& a, const Segment& b) { return a.x_at(middle) < b.x_at(middle); });
    for (std::size_t i = 0; i < crossed.size(); i += 2) add_trapezoid(crossed[i], crossed[i + 1], low, high);
  }
  return faces.finish(Builder::Kind::faces);
}

}  // namespace isorim::io::picture
