#include "io/picture/data_file.h"

#include <array>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <vtkCallbackCommand.h>
#include <vtkCell.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkCommand.h>
#include <vtkExecutive.h>
#include <vtkImageData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include "geometry/errors.h"

namespace isorim::io::picture {
namespace {

void note_error(vtkObject* /*caller*/, unsigned long /*event*/, void* client, void* /*data*/) {
  *static_cast<bool*>(client) = true;
}

/// Runs a reader; VTK's complaints become an exception instead of words on the screen.
template <class Reader>
vtkSmartPointer<vtkDataSet> read_with(const std::filesystem::path& path) {
  bool has_failed = false;
  const vtkNew<vtkCallbackCommand> listener;
  listener->SetCallback(note_error);
  listener->SetClientData(&has_failed);
  const vtkNew<Reader> reader;
  reader->SetReaderErrorObserver(listener);
  reader->SetParserErrorObserver(listener);
  reader->AddObserver(vtkCommand::ErrorEvent, listener);
  reader->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, listener);
  reader->SetFileName(path.c_str());
  reader->Update();
  vtkSmartPointer<vtkDataSet> data = reader->GetOutput();
  if (has_failed || reader->GetErrorCode() != 0 || data == nullptr) {
    throw InputError(fmt::format("is no {} file that VTK can read", path.extension().string()));
  }
  return data;
}

/// The planes of an image that are drawn: the axis across and its index.
std::vector<std::array<int, 2>> drawn_planes(const std::array<int, 3>& counts) {
  std::vector<std::array<int, 2>> planes;
  for (int axis = 0; axis < 3; ++axis) {
    if (counts[static_cast<std::size_t>(axis)] == 1) return {{axis, 0}};
  }
  for (int axis = 0; axis < 3; ++axis) planes.push_back({axis, counts[static_cast<std::size_t>(axis)] / 2});
  return planes;
}

vtkSmartPointer<vtkDataSet> quadrilaterals_of(vtkImageData* image) {
  std::array<int, 3> counts{};
  image->GetDimensions(counts.data());
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  const vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i) points->InsertNextPoint(image->GetPoint(i));
  grid->SetPoints(points);
  grid->GetPointData()->ShallowCopy(image->GetPointData());
  vtkUnsignedCharArray* ghosts = image->GetPointGhostArray();
  const auto is_hidden = [&](vtkIdType point) {
    return ghosts != nullptr && (ghosts->GetValue(point) & vtkDataSetAttributes::HIDDENPOINT) != 0;
  };
  const vtkNew<vtkIntArray> element;
  element->SetName("element");
  for (const auto& [axis, index] : drawn_planes(counts)) {
    const std::size_t u = (static_cast<std::size_t>(axis) + 1) % 3;
    const std::size_t v = (u + 1) % 3;
    const auto id_at = [&, axis = axis, index = index](int i, int j) {
      std::array<int, 3> ijk{};
      ijk[static_cast<std::size_t>(axis)] = index;
      ijk[u] = i;
      ijk[v] = j;
      return image->ComputePointId(ijk.data());
    };
    for (int j = 0; j + 1 < counts[v]; ++j) {
      for (int i = 0; i + 1 < counts[u]; ++i) {
        const std::array<vtkIdType, 4> quad{id_at(i, j), id_at(i + 1, j), id_at(i + 1, j + 1), id_at(i, j + 1)};
        if (is_hidden(quad[0]) || is_hidden(quad[1]) || is_hidden(quad[2]) || is_hidden(quad[3])) continue;
        grid->InsertNextCell(VTK_QUAD, 4, quad.data());
        element->InsertNextValue(axis);
      }
    }
  }
  grid->GetCellData()->AddArray(element);
  return grid;
}

vtkSmartPointer<vtkDataSet> read_any(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  if (extension == ".vtu") return read_with<vtkXMLUnstructuredGridReader>(path);
  if (extension == ".vtp") return read_with<vtkXMLPolyDataReader>(path);
  if (extension == ".vti") return quadrilaterals_of(vtkImageData::SafeDownCast(read_with<vtkXMLImageDataReader>(path)));
  throw InputError(fmt::format("found the extension \"{}\"; expected .vtu, .vtp or .vti", extension));
}

}  // namespace

vtkSmartPointer<vtkDataSet> read_data_file(const std::filesystem::path& path) {
  if (!std::filesystem::is_regular_file(path)) throw InputError("there is no such file");
  vtkSmartPointer<vtkDataSet> data = read_any(path);
  if (data->GetNumberOfCells() == 0) throw InputError("holds no cells");
  return data;
}

}  // namespace isorim::io::picture
