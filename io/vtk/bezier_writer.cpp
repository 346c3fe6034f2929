#include "io/vtk/bezier_writer.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <vtkCallbackCommand.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkErrorCode.h>
#include <vtkExecutive.h>
#include <vtkFieldData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSignedCharArray.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkTypeInt32Array.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include "geometry/errors.h"
#include "geometry/spline/bspline.h"
#include "io/atomic_file.h"

namespace isorim::io {

namespace {

/// One cell to be: a homogeneous net, (Dim + 1) x count with the first parameter fastest, and what is said about it.
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

/// A VTK grid of Bézier cells with all arrays allocated for the final size, filled cell by cell.
class GridBuilder {
 public:
  GridBuilder(std::size_t cell_count, std::size_t point_count);

  void add(const CellSource& cell);
  /// Point fields come in the order of the nets and are put into that of the cells' points.
  void add_point_field(const VtuField& field);
  void add_cell_field(const VtuField& field);
  void add_patch_names(std::span<const std::string> names);
  vtkUnstructuredGrid* finish();

 private:
  const std::vector<int>& point_order(const CellSource& cell);
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
  /// Where each cell's points start; one more than cells.
  std::vector<std::int64_t> first_point_{0};
  /// The order of each cell's points; points into orders_.
  std::vector<const std::vector<int>*> cell_order_;
  std::map<std::pair<std::array<int, 2>, bool>, std::vector<int>> orders_;
  std::set<std::string> point_names_{"RationalWeights"};
  std::set<std::string> cell_names_{"HigherOrderDegrees", "patch", "element", "orientation"};
};

void allocate(vtkDataArray* array, const char* name, int components, std::size_t tuples) {
  if (name != nullptr) array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(static_cast<vtkIdType>(tuples));
}

GridBuilder::GridBuilder(std::size_t cell_count, std::size_t point_count) {
  points_->SetDataTypeToDouble();
  points_->SetNumberOfPoints(static_cast<vtkIdType>(point_count));
  allocate(weights_, "RationalWeights", 1, point_count);
  allocate(degrees_, "HigherOrderDegrees", 3, cell_count);
  allocate(types_, nullptr, 1, cell_count);
  allocate(patch_, "patch", 1, cell_count);
  allocate(element_, "element", 1, cell_count);
  allocate(orientation_, "orientation", 1, cell_count);
  first_point_.reserve(cell_count + 1);
  cell_order_.reserve(cell_count);
}

const std::vector<int>& GridBuilder::point_order(const CellSource& cell) {
  const bool reversed = cell.orientation < 0;
  std::vector<int>& order = orders_[{cell.degree, reversed}];
  if (order.empty()) order = vtk_point_order(cell.degree, reversed);
  return order;
}

void GridBuilder::add(const CellSource& cell) {
  const auto index = static_cast<vtkIdType>(cell_order_.size());
  const std::vector<int>& order = point_order(cell);
  double* point = static_cast<vtkDoubleArray*>(points_->GetData())->GetPointer(3 * first_point_.back());
  double* weight = weights_->GetPointer(first_point_.back());
  for (const int k : order) {
    const double* source = cell.net + k * cell.rows;
    const int dimension = cell.rows - 1;
    const double w = source[dimension];
    for (int d = 0; d < 3; ++d) *point++ = d < dimension ? source[d] / w : 0.0;
    *weight++ = w;
  }
  for (int d = 0; d < 3; ++d) {
    degrees_->SetTypedComponent(index, d, static_cast<unsigned char>(d < 2 ? cell.degree[static_cast<size_t>(d)] : 0));
  }
  types_->SetValue(index, cell.is_curve() ? VTK_BEZIER_CURVE : VTK_BEZIER_QUADRILATERAL);
  patch_->SetValue(index, cell.patch);
  element_->SetValue(index, cell.element);
  orientation_->SetValue(index, static_cast<signed char>(cell.orientation));
  first_point_.push_back(first_point_.back() + cell.point_count());
  cell_order_.push_back(&order);
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

void GridBuilder::add_point_field(const VtuField& field) {
  claim_name(field.name, point_names_);
  require_size(field, first_point_.back(), "control points");
  vtkNew<vtkDoubleArray> array;
  allocate(array, field.name.c_str(), field.components, static_cast<std::size_t>(first_point_.back()));
  double* target = array->GetPointer(0);
  for (std::size_t cell = 0; cell < cell_order_.size(); ++cell) {
    const double* source = field.values.data() + first_point_[cell] * field.components;
    for (const int k : *cell_order_[cell]) {
      target = std::copy_n(source + k * field.components, field.components, target);
    }
  }
  grid_->GetPointData()->AddArray(array);
}

void GridBuilder::add_cell_field(const VtuField& field) {
  claim_name(field.name, cell_names_);
  require_size(field, static_cast<std::int64_t>(cell_order_.size()), "elements");
  vtkNew<vtkDoubleArray> array;
  allocate(array, field.name.c_str(), field.components, cell_order_.size());
  std::copy(field.values.begin(), field.values.end(), array->GetPointer(0));
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
  vtkNew<IndexArray> offsets;
  vtkNew<IndexArray> connectivity;
  allocate(offsets, nullptr, 1, first_point_.size());
  allocate(connectivity, nullptr, 1, static_cast<std::size_t>(first_point_.back()));
  std::transform(first_point_.begin(), first_point_.end(), offsets->GetPointer(0),
                 [](std::int64_t i) { return static_cast<Index>(i); });
  Index* target = connectivity->GetPointer(0);
  for (std::int64_t i = 0; i < first_point_.back(); ++i) target[i] = static_cast<Index>(i);
  vtkNew<vtkCellArray> cells;
  cells->SetData(offsets, connectivity);
  grid_->SetCells(types_, cells);
}

vtkUnstructuredGrid* GridBuilder::finish() {
  grid_->SetPoints(points_);
  if (first_point_.back() <= std::numeric_limits<std::int32_t>::max()) {
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

/// VTK would print its errors; this keeps them for the message of ours.
vtkSmartPointer<vtkCallbackCommand> error_collector(std::string& messages) {
  auto collector = vtkSmartPointer<vtkCallbackCommand>::New();
  collector->SetClientData(&messages);
  collector->SetCallback([](vtkObject*, unsigned long, void* client, void* text) {
    if (text != nullptr) *static_cast<std::string*>(client) += static_cast<const char*>(text);
  });
  return collector;
}

void write_grid(const std::filesystem::path& path, vtkUnstructuredGrid* grid) {
  AtomicFile file(path);
  std::string messages;
  const auto collector = error_collector(messages);
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  for (vtkObject* source : {static_cast<vtkObject*>(writer), static_cast<vtkObject*>(writer->GetExecutive())}) {
    source->AddObserver(vtkCommand::ErrorEvent, collector);
  }
  writer->SetFileName(file.temporary().c_str());
  writer->SetInputData(grid);
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  writer->SetCompressorTypeToNone();
  writer->SetHeaderTypeToUInt64();
  const bool written = writer->Write() == 1 && writer->GetErrorCode() == vtkErrorCode::NoError && messages.empty();
  if (!written) {
    throw InputError(fmt::format("cannot write '{}': {}", path.string(),
                                 vtkErrorCode::GetStringFromErrorCode(writer->GetErrorCode())));
  }
  file.commit();
}

void write_cells(const std::filesystem::path& path, std::size_t count,
                 const std::function<CellSource(std::size_t)>& cell, const VtuContent& content) {
  std::size_t point_count = 0;
  for (std::size_t i = 0; i < count; ++i) point_count += static_cast<std::size_t>(cell(i).point_count());
  GridBuilder builder(count, point_count);
  for (std::size_t i = 0; i < count; ++i) builder.add(cell(i));
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
  const auto cell = [&](std::size_t i) {
    const geometry::BezierElement<Dim>& element = table.elements[i];
    CellSource source;
    std::copy(element.degree.begin(), element.degree.end(), source.degree.begin());
    source.net = table.net(element).data();
    source.rows = Dim + 1;
    source.patch = element.patch;
    source.element = static_cast<int>(i);
    source.orientation = element.orientation;
    return source;
  };
  write_cells(path, table.elements.size(), cell, content);
}

template <int Dim>
void write_curves_vtu(const std::filesystem::path& path, std::span<const geometry::NurbsCurve<Dim>> curves,
                      std::span<const std::string> names) {
  std::vector<geometry::BezierSegment> segments;
  std::vector<CellSource> cells;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const auto pieces = geometry::bezier_segments({curves[i].knots(), curves[i].homogeneous()});
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      segments.push_back(pieces[k]);
      cells.push_back({.degree = {curves[i].degree(), 0},
                       .rows = Dim + 1,
                       .patch = static_cast<int>(i),
                       .element = static_cast<int>(k)});
    }
  }
  for (std::size_t i = 0; i < cells.size(); ++i) cells[i].net = segments[i].coefficients.data();
  VtuContent content;
  content.patch_names = names;
  write_cells(
      path, cells.size(), [&](std::size_t i) { return cells[i]; }, content);
}

template void write_vtu(const std::filesystem::path&, const geometry::ElementTable<2>&, const VtuContent&);
template void write_vtu(const std::filesystem::path&, const geometry::ElementTable<3>&, const VtuContent&);
template void write_curves_vtu(const std::filesystem::path&, std::span<const geometry::NurbsCurve<2>>,
                               std::span<const std::string>);
template void write_curves_vtu(const std::filesystem::path&, std::span<const geometry::NurbsCurve<3>>,
                               std::span<const std::string>);

}  // namespace isorim::io
