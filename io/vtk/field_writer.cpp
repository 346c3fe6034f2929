#include "io/vtk/field_writer.h"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataSetAttributes.h>
#include <vtkDoubleArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLImageDataWriter.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include "geometry/errors.h"
#include "io/vtk/xml_output.h"

namespace isorim::io {
namespace {

void add_arrays(vtkDataSetAttributes* data, const std::vector<PointArray>& arrays, Eigen::Index count,
                const std::filesystem::path& path) {
  for (const PointArray& source : arrays) {
    if (source.values.cols() != count) {
      throw InputError(fmt::format("{}: the field '{}' has {} columns; expected {}", path.string(), source.name,
                                   source.values.cols(), count));
    }
    vtkNew<vtkDoubleArray> array;
    array->SetName(source.name.c_str());
    array->SetNumberOfComponents(static_cast<int>(source.values.rows()));
    for (std::size_t c = 0; c < source.components.size(); ++c) {
      array->SetComponentName(static_cast<vtkIdType>(c), source.components[c].c_str());
    }
    array->SetNumberOfTuples(count);
    std::copy(source.values.data(), source.values.data() + source.values.size(), array->GetPointer(0));
    data->AddArray(array);
  }
}

vtkNew<vtkPoints> vtk_points(const Eigen::Matrix3Xd& points) {
  vtkNew<vtkPoints> result;
  result->SetDataTypeToDouble();
  for (Eigen::Index i = 0; i < points.cols(); ++i) result->InsertNextPoint(points.col(i).data());
  return result;
}

int facet_type(int vertices) {
  return vertices == 2 ? VTK_LINE : vertices == 3 ? VTK_TRIANGLE : VTK_QUAD;
}

}  // namespace

void write_facets_vtu(const std::filesystem::path& path, const FacetMesh& mesh) {
  const vtkNew<vtkUnstructuredGrid> grid;
  const vtkNew<vtkPoints> points = vtk_points(mesh.points);
  grid->SetPoints(points);
  vtkNew<vtkUnsignedCharArray> types;
  vtkNew<vtkCellArray> cells;
  for (const std::array<std::int64_t, 4>& facet : mesh.facets) {
    const auto vertices = static_cast<int>(std::count_if(facet.begin(), facet.end(), [](auto v) { return v >= 0; }));
    cells->InsertNextCell(vertices);
    for (int i = 0; i < vertices; ++i) cells->InsertCellPoint(facet[static_cast<std::size_t>(i)]);
    types->InsertNextValue(static_cast<unsigned char>(facet_type(vertices)));
  }
  grid->SetCells(types, cells);
  add_arrays(grid->GetPointData(), mesh.point_arrays, mesh.points.cols(), path);
  add_arrays(grid->GetCellData(), mesh.cell_arrays, static_cast<Eigen::Index>(mesh.facets.size()), path);
  const vtkNew<vtkXMLUnstructuredGridWriter> writer;
  write_xml(path, writer, grid);
}

void write_image_vti(const std::filesystem::path& path, const ImageShape& shape, const std::vector<PointArray>& arrays,
                     const std::vector<char>& hidden) {
  const vtkNew<vtkImageData> image;
  image->SetDimensions(shape.counts.data());
  image->SetOrigin(shape.origin.data());
  image->SetSpacing(shape.spacing.data());
  // Row by row.
  const Eigen::Matrix3d rows = shape.directions.transpose();
  image->SetDirectionMatrix(rows.data());
  add_arrays(image->GetPointData(), arrays, shape.point_count(), path);
  if (std::any_of(hidden.begin(), hidden.end(), [](char h) { return h != 0; })) {
    vtkNew<vtkUnsignedCharArray> ghosts;
    ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
    for (const char h : hidden) ghosts->InsertNextValue(h != 0 ? vtkDataSetAttributes::HIDDENPOINT : 0);
    image->GetPointData()->AddArray(ghosts);
  }
  const vtkNew<vtkXMLImageDataWriter> writer;
  write_xml(path, writer, image);
}

void write_points_vtp(const std::filesystem::path& path, const Eigen::Matrix3Xd& points, PointForm form,
                      const std::vector<PointArray>& arrays) {
  const vtkNew<vtkPolyData> data;
  const vtkNew<vtkPoints> places = vtk_points(points);
  data->SetPoints(places);
  vtkNew<vtkCellArray> vertices;
  for (Eigen::Index i = 0; i < points.cols(); ++i) vertices->InsertNextCell({i});
  data->SetVerts(vertices);
  if (form == PointForm::line) {
    vtkNew<vtkCellArray> lines;
    lines->InsertNextCell(static_cast<int>(points.cols()));
    for (Eigen::Index i = 0; i < points.cols(); ++i) lines->InsertCellPoint(i);
    data->SetLines(lines);
  }
  add_arrays(data->GetPointData(), arrays, points.cols(), path);
  const vtkNew<vtkXMLPolyDataWriter> writer;
  write_xml(path, writer, data);
}

}  // namespace isorim::io
