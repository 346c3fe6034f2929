#include "io/vtk/bezier_writer.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSignedCharArray.h>
#include <vtkStringArray.h>
#include <vtkTypeInt32Array.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include "geometry/errors.h"
#include "geometry/spline/bspline.h"
#include "io/vtk/bernstein.h"
#include "io/vtk/region_triangles.h"
#include "io/vtk/xml_output.h"

namespace isorim::io {

namespace {

/// One Bézier cell to be: a homogeneous net, (Dim + 1) x count with the first parameter fastest, and what is said about
/// it.
struct CellSource {
  /// The degrees; 0 in the second place for a curve.
  std::array<int, 2> degree{};
  const double* net = nullptr;
  /// Dim + 1.
  int rows = 0;
  int patch = 0;
  int element = 0;
  int orientation = 1;

  int point_count() const { return (degree[0] + 1) * (degree[1] + 1); }
  bool is_curve() const { return degree[1] == 0; }
};

/// For each point of a VTK cell the index of its control point in the net. Quadrilaterals: corners counter-clockwise
/// from (0, 0); inner points of the edges bottom, right, top, left, each along its increasing parameter; inner points
/// with the first parameter fastest. Curves: both ends, then the inner points. `reversed`: s -> 1 - s.
std::vector<int> vtk_point_order(const std::array<int, 2>& degree, bool reversed) {
  const auto [p, q] = degree;
  std::vector<int> order;
  const auto add = [&, p = p](int i, int j) { order.push_back((reversed ? p - i : i) + j * (p + 1)); };
  add(0, 0);
  add(p, 0);
  if (q > 0) {
    add(p, q);
    add(0, q);
  }
  for (int i = 1; i < p; ++i) add(i, 0);
  for (int j = 1; j < q; ++j) add(p, j);
  if (q > 0) {
    for (int i = 1; i < p; ++i) add(i, q);
  }
  for (int j = 1; j < q; ++j) add(0, j);
  for (int j = 1; j < q; ++j) {
    for (int i = 1; i < p; ++i) add(i, j);
  }
  return order;
}

/// A VTK grid, filled element by element: a Bézier cell for a whole element or a curve, triangles for a cut element.
class GridBuilder {
 public:
  GridBuilder();

  void add(const CellSource& cell);
  /// The triangles of a cut element, whose own net is `cell`.
  void add(const CellSource& cell, const RegionTriangles& region);
  /// Control values come in the order of the nets. They become control values of the cells' points, and values at the
  /// vertices of triangles.
  void add_point_field(const VtuField& field);
  void add_cell_field(const VtuField& field);
  /// One value a curve.
  void add_curve_field(const VtuField& field, std::size_t curves);
  void add_patch_names(std::span<const std::string> names);
  vtkUnstructuredGrid* finish();

 private:
  /// What became of an element.
  struct Run {
    CellSource cell;
    /// Empty for a Bézier cell: the parameters of the vertices.
    geometry::Points<2> parameters;
    std::int64_t first_point = 0;
  };

  const std::vector<int>& point_order(const CellSource& cell);
  void add_point(const double* point, double weight);
  void add_cell(int type, const std::array<int, 2>& degree, const CellSource& source);
  /// `owner` tells for each cell whose value it has.
  void add_field_of(const VtuField& field, vtkIntArray* owner);
  template <class IndexArray>
  void set_cells();
  void claim_name(const std::string& name, std::set<std::string>& taken);

  vtkNew<vtkUnstructuredGrid> grid_;
  vtkNew<vtkPoints> points_;
  vtkNew<vtkDoubleArray> weights_;
  vtkNew<vtkUnsignedCharArray> degrees_;
  vtkNew<vtkUnsignedCharArray> types_;
  vtkNew<vtkIntArray> patch_;
  vtkNew<vtkIntArray> element_;
  vtkNew<vtkSignedCharArray> orientation_;
  std::vector<Run> runs_;
  /// The points of each cell, and where each cell's begin; one more than cells.
  std::vector<std::int64_t> connectivity_;
  std::vector<std::int64_t> offsets_{0};
  std::int64_t control_points_ = 0;
  std::map<std::pair<std::array<int, 2>, bool>, std::vector<int>> orders_;
  std::set<std::string> point_names_{"RationalWeights"};
  std::set<std::string> cell_names_{"HigherOrderDegrees", "patch", "element", "orientation"};
};

void name_array(vtkDataArray* array, const char* name, int components) {
  array->SetName(name);
  array->SetNumberOfComponents(components);
}

GridBuilder::GridBuilder() {
  points_->SetDataTypeToDouble();
  name_array(weights_, "RationalWeights", 1);
  name_array(degrees_, "HigherOrderDegrees", 3);
  name_array(patch_, "patch", 1);
  name_array(element_, "element", 1);
  name_array(orientation_, "orientation", 1);
}

const std::vector<int>& GridBuilder::point_order(const CellSource& cell) {
  const bool reversed = cell.orientation < 0;
  std::vector<int>& order = orders_[{cell.degree, reversed}];
  if (order.empty()) order = vtk_point_order(cell.degree, reversed);
  return order;
}

void GridBuilder::add_point(const double* point, double weight) {
  points_->InsertNextPoint(point);
  weights_->InsertNextValue(weight);
}

/// The points of the cell are in connectivity_ already.
void GridBuilder::add_cell(int type, const std::array<int, 2>& degree, const CellSource& source) {
  const std::array<unsigned char, 3> degrees{static_cast<unsigned char>(degree[0]),
                                             static_cast<unsigned char>(degree[1]), 0};
  degrees_->InsertNextTypedTuple(degrees.data());
  types_->InsertNextValue(static_cast<unsigned char>(type));
  patch_->InsertNextValue(source.patch);
  element_->InsertNextValue(source.element);
  orientation_->InsertNextValue(static_cast<signed char>(source.orientation));
  offsets_.push_back(static_cast<std::int64_t>(connectivity_.size()));
}

void GridBuilder::add(const CellSource& cell) {
  const std::int64_t first = points_->GetNumberOfPoints();
  const int dimension = cell.rows - 1;
  for (const int k : point_order(cell)) {
    const double* source = cell.net + k * cell.rows;
    std::array<double, 3> point{};
    for (int d = 0; d < dimension; ++d) point[static_cast<std::size_t>(d)] = source[d] / source[dimension];
    connectivity_.push_back(points_->GetNumberOfPoints());
    add_point(point.data(), source[dimension]);
  }
  add_cell(cell.is_curve() ? VTK_BEZIER_CURVE : VTK_BEZIER_QUADRILATERAL, cell.degree, cell);
  runs_.push_back({cell, {}, first});
  control_points_ += cell.point_count();
}

void GridBuilder::add(const CellSource& cell, const RegionTriangles& region) {
  const std::int64_t first = points_->GetNumberOfPoints();
  for (Eigen::Index i = 0; i < region.points.cols(); ++i) add_point(region.points.col(i).data(), 1.0);
  for (std::array<int, 3> triangle : region.triangles) {
    if (cell.orientation < 0) std::swap(triangle[1], triangle[2]);
    for (const int vertex : triangle) connectivity_.push_back(first + vertex);
    add_cell(VTK_TRIANGLE, {1, 1}, cell);
  }
  runs_.push_back({cell, region.parameters, first});
  control_points_ += cell.point_count();
}

void GridBuilder::claim_name(const std::string& name, std::set<std::string>& taken) {
  if (name.empty()) throw InputError("a field has no name");
  if (!taken.insert(name).second) throw InputError(fmt::format("the field name '{}' is taken", name));
}

void require_size(const VtuField& field, std::int64_t tuples, const char* what) {
  if (field.components < 1) {
    throw InputError(fmt::format("field '{}' has {} components, expected at least 1", field.name, field.components));
  }
  if (static_cast<std::int64_t>(field.values.size()) != tuples * field.components) {
    throw InputError(fmt::format("field '{}' has {} values, expected {} ({} components of {} {})", field.name,
                                 field.values.size(), tuples * field.components, field.components, tuples, what));
  }
}

/// The field with control values `values` (components a control point) at a place of the unit cell.
void interpolate(const CellSource& cell, const double* values, int components, const geometry::Point2& place,
                 double* result) {
  const Eigen::VectorXd in_s = bernstein(cell.degree[0], place.x());
  const Eigen::VectorXd in_t = bernstein(cell.degree[1], place.y());
  std::fill_n(result, components, 0.0);
  double sum = 0.0;
  for (int k = 0; k < cell.point_count(); ++k) {
    const int columns = cell.degree[0] + 1;
    const double weight = cell.net[k * cell.rows + cell.rows - 1] * in_s[k % columns] * in_t[k / columns];
    for (int c = 0; c < components; ++c) result[c] += weight * values[k * components + c];
    sum += weight;
  }
  for (int c = 0; c < components; ++c) result[c] /= sum;
}

void GridBuilder::add_point_field(const VtuField& field) {
  claim_name(field.name, point_names_);
  require_size(field, control_points_, "control points");
  vtkNew<vtkDoubleArray> array;
  name_array(array, field.name.c_str(), field.components);
  array->SetNumberOfTuples(points_->GetNumberOfPoints());
  const double* source = field.values.data();
  for (const Run& run : runs_) {
    double* target = array->GetPointer(run.first_point * field.components);
    if (run.parameters.cols() == 0) {
      for (const int k : point_order(run.cell)) {
        target = std::copy_n(source + k * field.components, field.components, target);
      }
    }
    for (Eigen::Index i = 0; i < run.parameters.cols(); ++i) {
      interpolate(run.cell, source, field.components, run.parameters.col(i), target + i * field.components);
    }
    source += run.cell.point_count() * field.components;
  }
  grid_->GetPointData()->AddArray(array);
}

void GridBuilder::add_cell_field(const VtuField& field) {
  require_size(field, static_cast<std::int64_t>(runs_.size()), "elements");
  add_field_of(field, element_);
}

void GridBuilder::add_curve_field(const VtuField& field, std::size_t curves) {
  require_size(field, static_cast<std::int64_t>(curves), "curves");
  add_field_of(field, patch_);
}

void GridBuilder::add_field_of(const VtuField& field, vtkIntArray* owner) {
  claim_name(field.name, cell_names_);
  vtkNew<vtkDoubleArray> array;
  name_array(array, field.name.c_str(), field.components);
  for (vtkIdType cell = 0; cell < owner->GetNumberOfTuples(); ++cell) {
    array->InsertNextTypedTuple(field.values.data() + std::int64_t{owner->GetValue(cell)} * field.components);
  }
  grid_->GetCellData()->AddArray(array);
}

void GridBuilder::add_patch_names(std::span<const std::string> names) {
  vtkNew<vtkStringArray> array;
  array->SetName("patch_names");
  for (const std::string& name : names) array->InsertNextValue(name);
  if (!names.empty()) grid_->GetFieldData()->AddArray(array);
}

template <class IndexArray>
void GridBuilder::set_cells() {
  using Index = typename IndexArray::ValueType;
  const auto fill = [](IndexArray* array, const std::vector<std::int64_t>& values) {
    array->SetNumberOfValues(static_cast<vtkIdType>(values.size()));
    std::transform(values.begin(), values.end(), array->GetPointer(0),
                   [](std::int64_t i) { return static_cast<Index>(i); });
  };
  vtkNew<IndexArray> offsets;
  vtkNew<IndexArray> connectivity;
  fill(offsets, offsets_);
  fill(connectivity, connectivity_);
  vtkNew<vtkCellArray> cells;
  cells->SetData(offsets, connectivity);
  grid_->SetCells(types_, cells);
}

vtkUnstructuredGrid* GridBuilder::finish() {
  grid_->SetPoints(points_);
  if (std::max<std::int64_t>(offsets_.back(), points_->GetNumberOfPoints()) <=
      std::numeric_limits<std::int32_t>::max()) {
    set_cells<vtkTypeInt32Array>();
  } else {
    set_cells<vtkTypeInt64Array>();
  }
  grid_->GetPointData()->SetRationalWeights(weights_);
  vtkCellData* cell_data = grid_->GetCellData();
  cell_data->SetHigherOrderDegrees(degrees_);
  cell_data->AddArray(patch_);
  cell_data->AddArray(element_);
  cell_data->AddArray(orientation_);
  return grid_;
}

void write_grid(const std::filesystem::path& path, vtkUnstructuredGrid* grid) {
  const vtkNew<vtkXMLUnstructuredGridWriter> writer;
  write_xml(path, writer, grid);
}

void add_content_and_write(const std::filesystem::path& path, GridBuilder& builder, const VtuContent& content) {
  try {
    for (const VtuField& field : content.point_fields) builder.add_point_field(field);
    for (const VtuField& field : content.cell_fields) builder.add_cell_field(field);
  } catch (Error& error) {
    error.add_context(path.string());
    throw;
  }
  builder.add_patch_names(content.patch_names);
  write_grid(path, builder.finish());
}

}  // namespace

template <int Dim>
void write_vtu(const std::filesystem::path& path, const geometry::ElementTable<Dim>& table, const VtuContent& content) {
  GridBuilder builder;
  double chord_tolerance = 0.0;
  if (!table.regions.empty()) chord_tolerance = content.chord_tolerance * geometry::bounding_box(table).diagonal();
  for (std::size_t i = 0; i < table.elements.size(); ++i) {
    const geometry::BezierElement<Dim>& element = table.elements[i];
    CellSource source;
    std::copy(element.degree.begin(), element.degree.end(), source.degree.begin());
    source.net = table.net(element).data();
    source.rows = Dim + 1;
    source.patch = element.patch;
    source.element = static_cast<int>(i);
    source.orientation = element.orientation;
    if constexpr (Dim == 3) {
      if (element.is_cut()) {
        builder.add(source, triangulate_region(table, element, chord_tolerance));
        continue;
      }
    }
    builder.add(source);
  }
  add_content_and_write(path, builder, content);
}

template <int Dim>
void write_curves_vtu(const std::filesystem::path& path, std::span<const geometry::NurbsCurve<Dim>> curves,
                      std::span<const std::string> names, std::span<const VtuField> fields) {
  GridBuilder builder;
  // The builder keeps pointers to the nets.
  std::vector<std::vector<geometry::BezierSegment>> segments;
  segments.reserve(curves.size());
  for (std::size_t i = 0; i < curves.size(); ++i) {
    segments.push_back(geometry::bezier_segments({curves[i].knots(), curves[i].homogeneous()}));
    for (std::size_t k = 0; k < segments.back().size(); ++k) {
      builder.add({.degree = {curves[i].degree(), 0},
                   .net = segments.back()[k].coefficients.data(),
                   .rows = Dim + 1,
                   .patch = static_cast<int>(i),
                   .element = static_cast<int>(k)});
    }
  }
  try {
    for (const VtuField& field : fields) builder.add_curve_field(field, curves.size());
  } catch (Error& error) {
    error.add_context(path.string());
    throw;
  }
  builder.add_patch_names(names);
  write_grid(path, builder.finish());
}

template void write_vtu(const std::filesystem::path&, const geometry::ElementTable<2>&, const VtuContent&);
template void write_vtu(const std::filesystem::path&, const geometry::ElementTable<3>&, const VtuContent&);
template void write_curves_vtu(const std::filesystem::path&, std::span<const geometry::NurbsCurve<2>>,
                               std::span<const std::string>, std::span<const VtuField>);
template void write_curves_vtu(const std::filesystem::path&, std::span<const geometry::NurbsCurve<3>>,
                               std::span<const std::string>, std::span<const VtuField>);

}  // namespace isorim::io
