#include "io/picture/sheet.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <vtkActor.h>
#include <vtkAutoInit.h>
#include <vtkCamera.h>
#include <vtkCellData.h>
#include <vtkImageData.h>
#include <vtkLight.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkPointData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkScalarBarActor.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWindowToImageFilter.h>

#include "io/picture/colours.h"
#include "io/picture/offscreen_window.h"

VTK_MODULE_INIT(vtkRenderingOpenGL2)
VTK_MODULE_INIT(vtkRenderingFreeType)

namespace isorim::io::picture {
namespace {

/// What is left free around the drawing, of each side.
constexpr double margin = 0.04;
/// The legend's share of the width.
constexpr double legend_width = 0.15;

/// Part of the picture: left, bottom, right, top in [0, 1].
using Viewport = std::array<double, 4>;

std::vector<Viewport> viewports(std::size_t count, double right) {
  const auto columns = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count))));
  const std::size_t rows = (count + columns - 1) / columns;
  std::vector<Viewport> list;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t from_top = k / columns;
    const auto column = static_cast<double>(k % columns);
    const auto row = static_cast<double>(rows - 1 - from_top);
    const double width = right / static_cast<double>(columns);
    const double height = 1.0 / static_cast<double>(rows);
    list.push_back({column * width, row * height, (column + 1.0) * width, (row + 1.0) * height});
  }
  return list;
}

/// The rectangle that everything covers in a view: along right and up, and the depth.
struct Extent {
  Eigen::Vector3d lower = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d upper = -lower;
};

Extent extent_of(const std::vector<Drawable>& drawables, const View& view) {
  Eigen::Matrix3d axes;
  axes << view.right(), view.up, view.towards_eye;
  Extent extent;
  for (const Drawable& drawable : drawables) {
    for (vtkPolyData* part : {drawable.faces.Get(), drawable.curves.Get(), drawable.points.Get()}) {
      for (vtkIdType i = 0; i < part->GetNumberOfPoints(); ++i) {
        Eigen::Vector3d point;
        part->GetPoint(i, point.data());
        const Eigen::Vector3d seen = axes.transpose() * point;
        extent.lower = extent.lower.cwiseMin(seen);
        extent.upper = extent.upper.cwiseMax(seen);
      }
    }
  }
  return extent;
}

bool is_plane(const std::vector<Drawable>& drawables) {
  return std::all_of(drawables.begin(), drawables.end(), [](const Drawable& drawable) {
    for (vtkPolyData* part : {drawable.faces.Get(), drawable.curves.Get(), drawable.points.Get()}) {
      std::array<double, 6> box{};
      part->GetBounds(box.data());
      if (part->GetNumberOfPoints() > 0 && (box[4] != 0.0 || box[5] != 0.0)) return false;
    }
    return true;
  });
}

/// How many pixels are drawn for one of the picture, either way: smooths what has edges, without help from OpenGL.
int supersampling(const PictureOptions& options) {
  constexpr int most = 8192;
  const int larger = std::max(options.width, options.height);
  return larger * 3 <= most ? 3 : larger * 2 <= most ? 2 : 1;
}

/// Each pixel the mean of factor x factor ones, colours weighted by their alpha.
vtkSmartPointer<vtkImageData> averaged(vtkImageData* fine, int factor) {
  std::array<int, 3> size{};
  fine->GetDimensions(size.data());
  const int components = fine->GetNumberOfScalarComponents();
  const int columns = size[0] / factor;
  const int rows = size[1] / factor;
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(columns, rows, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, components);
  const auto* source = static_cast<const unsigned char*>(fine->GetScalarPointer());
  auto* target = static_cast<unsigned char*>(image->GetScalarPointer());
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x, target += components) {
      std::array<double, 4> sum{};
      double weight = 0.0;
      for (int k = 0; k < factor * factor; ++k) {
        const std::ptrdiff_t row = std::ptrdiff_t{y} * factor + k / factor;
        const unsigned char* pixel = source + (row * size[0] + x * factor + k % factor) * components;
        const double alpha = components == 4 ? pixel[3] : 255.0;
        for (std::size_t c = 0; c < 3; ++c) sum[c] += alpha * pixel[c];
        weight += alpha;
      }
      sum[3] = weight * weight / (factor * factor);
      for (std::size_t c = 0; c < static_cast<std::size_t>(components); ++c) {
        target[c] = static_cast<unsigned char>(weight > 0.0 ? std::lround(sum[c] / weight) : 0);
      }
    }
  }
  return image;
}

class SheetDrawer {
 public:
  SheetDrawer(const Sheet& sheet, const PictureOptions& options)
      : sheet_(sheet),
        options_(options),
        is_plane_(is_plane(sheet.drawables)),
        views_(options.views),
        factor_(supersampling(options)),
        width_(options.width * factor_),
        height_(options.height * factor_),
        // Wide enough for pictures of any size.
        pixel_(factor_ * std::max(1.0, std::min(options.width, options.height) / 900.0)),
        window_(width_, height_) {
    if (views_.empty()) views_ = is_plane_ ? std::vector<View>{plane_view()} : views_from("iso");
    if (options.field) table_ = lookup_table(options.field->map, sheet.range);
    has_light_background_ =
        options.transparent ||
        0.3 * options.background[0] + 0.6 * options.background[1] + 0.1 * options.background[2] > 0.5;
  }

  std::string draw() {
    add_views();
    if (options_.field) add_legend();
    if (options_.transparent) window_.get()->AlphaBitPlanesOn();
    window_.get()->Render();
    const vtkNew<vtkWindowToImageFilter> grabber;
    grabber->SetInput(window_.get());
    if (options_.transparent) grabber->SetInputBufferTypeToRGBA();
    grabber->ReadFrontBufferOff();
    grabber->ShouldRerenderOff();
    grabber->Update();
    const vtkSmartPointer<vtkImageData> image = averaged(grabber->GetOutput(), factor_);
    const vtkNew<vtkPNGWriter> writer;
    writer->WriteToMemoryOn();
    writer->SetInputData(image);
    writer->Write();
    const auto* bytes = reinterpret_cast<const char*>(writer->GetResult()->GetPointer(0));
    return {bytes, static_cast<std::size_t>(writer->GetResult()->GetNumberOfValues())};
  }

 private:
  vtkSmartPointer<vtkRenderer> add_renderer(const Viewport& place) {
    auto renderer = vtkSmartPointer<vtkRenderer>::New();
    renderer->SetViewport(place.data());
    renderer->SetBackground(options_.background.data());
    renderer->SetBackgroundAlpha(options_.transparent ? 0.0 : 1.0);
    window_.get()->AddRenderer(renderer);
    return renderer;
  }

  void add_views() {
    const std::vector<Viewport> places = viewports(views_.size(), options_.field ? 1.0 - legend_width : 1.0);
    const double width = (places[0][2] - places[0][0]) * width_;
    const double height = (places[0][3] - places[0][1]) * height_;
    std::vector<Extent> extents;
    double half_height = 0.0;
    for (const View& view : views_) {
      extents.push_back(extent_of(sheet_.drawables, view));
      const Eigen::Vector3d sides = extents.back().upper - extents.back().lower;
      half_height = std::max({half_height, 0.5 * sides[1], 0.5 * sides[0] * height / width});
    }
    half_height = half_height > 0.0 ? half_height / (1.0 - 2.0 * margin) : 1.0;
    for (std::size_t k = 0; k < views_.size(); ++k) {
      vtkRenderer* renderer = add_renderer(places[k]);
      for (const Drawable& drawable : sheet_.drawables) add_actors(renderer, drawable);
      set_camera(renderer, views_[k], extents[k], half_height);
      if (views_.size() > 1) add_caption(renderer, views_[k].name);
      add_lights(renderer);
    }
  }

  /// One from the eye, a stronger one from above on the left, a faint one from the right: the three sides of a box
  /// that the view iso shows differ.
  static void add_lights(vtkRenderer* renderer) {
    const auto add = [renderer](double right, double up, double intensity) {
      const vtkNew<vtkLight> light;
      light->SetLightTypeToCameraLight();
      light->SetPosition(right, up, 1.0);
      light->SetFocalPoint(0.0, 0.0, 0.0);
      light->SetIntensity(intensity);
      renderer->AddLight(light);
    };
    add(0.0, 0.0, 0.4);
    add(-0.46, 0.72, 0.45);
    add(0.75, -0.13, 0.3);
  }

  void set_camera(vtkRenderer* renderer, const View& view, const Extent& extent, double half_height) const {
    const Eigen::Vector3d middle = 0.5 * (extent.lower + extent.upper);
    const Eigen::Vector3d focus = view.right() * middle[0] + view.up * middle[1] + view.towards_eye * middle[2];
    const double depth = std::max(extent.upper[2] - extent.lower[2], half_height);
    const Eigen::Vector3d eye = focus + 2.0 * depth * view.towards_eye;
    vtkCamera* camera = renderer->GetActiveCamera();
    camera->ParallelProjectionOn();
    camera->SetFocalPoint(focus.data());
    camera->SetPosition(eye.data());
    camera->SetViewUp(view.up.data());
    camera->SetParallelScale(half_height);
    camera->SetClippingRange(depth, 3.0 * depth);
  }

  void add_actors(vtkRenderer* renderer, const Drawable& drawable) const {
    if (drawable.faces->GetNumberOfCells() > 0) add_faces(renderer, drawable);
    if (drawable.borders->GetNumberOfCells() > 0 && options_.lines == Lines::elements) {
      add_borders(renderer, drawable);
    }
    if (drawable.curves->GetNumberOfCells() > 0) add_curves(renderer, drawable);
    if (drawable.points->GetNumberOfCells() > 0) add_points(renderer, drawable);
  }

  vtkSmartPointer<vtkActor> actor_of(vtkPolyData* part, bool has_field) const {
    const vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(part);
    mapper->ScalarVisibilityOff();
    if (has_field) {
      mapper->ScalarVisibilityOn();
      mapper->SetScalarModeToUsePointFieldData();
      mapper->SelectColorArray("shown");
      mapper->SetLookupTable(table_);
      mapper->UseLookupTableScalarRangeOn();
      // Else colours between two points are those between their colours.
      mapper->InterpolateScalarsBeforeMappingOn();
    }
    auto actor = vtkSmartPointer<vtkActor>::New();
    actor->SetMapper(mapper);
    return actor;
  }

  /// Colours of the cells by patch or as the file has them; whether there are any.
  bool colour_cells(vtkPolyData* part) const {
    auto* of_file = part->GetCellData()->GetArray("colour");
    auto* patches = part->GetCellData()->GetArray("patch");
    const bool by_file = of_file != nullptr && options_.colours == FaceColours::automatic;
    std::array<double, 2> range{};
    if (patches != nullptr) patches->GetRange(range.data());
    if (options_.colours == FaceColours::plain || (!by_file && range[0] == range[1])) return false;
    const vtkNew<vtkUnsignedCharArray> colours;
    colours->SetName("cell_colours");
    colours->SetNumberOfComponents(3);
    for (vtkIdType cell = 0; cell < part->GetNumberOfCells(); ++cell) {
      Colour colour = by_file ? Colour{} : patch_colour(static_cast<int>(patches->GetComponent(cell, 0)));
      if (by_file) of_file->GetTuple(cell, colour.data());
      for (const double component : colour) {
        colours->InsertNextValue(static_cast<unsigned char>(std::lround(255.0 * std::clamp(component, 0.0, 1.0))));
      }
    }
    part->GetCellData()->AddArray(colours);
    return true;
  }

  void use_cell_colours(vtkActor* actor) const {
    vtkMapper* mapper = actor->GetMapper();
    mapper->ScalarVisibilityOn();
    mapper->SetScalarModeToUseCellFieldData();
    mapper->SelectColorArray("cell_colours");
    mapper->SetColorModeToDirectScalars();
  }

  void add_faces(vtkRenderer* renderer, const Drawable& drawable) const {
    const vtkSmartPointer<vtkActor> actor = actor_of(drawable.faces, drawable.has_field);
    vtkProperty* property = actor->GetProperty();
    property->SetColor(plain_colour[0], plain_colour[1], plain_colour[2]);
    if (options_.field && !drawable.has_field) property->SetColor(0.8, 0.8, 0.8);
    if (!options_.field && colour_cells(drawable.faces)) use_cell_colours(actor);
    property->SetInterpolationToPhong();
    property->SetAmbient(options_.field ? 0.4 : 0.25);
    property->SetDiffuse(options_.field ? 0.6 : 0.8);
    if (!options_.field) {
      property->SetSpecular(0.2);
      property->SetSpecularPower(25.0);
    }
    if (is_plane_) property->LightingOff();
    // Lines lie in front of the faces that they are on.
    actor->GetMapper()->SetResolveCoincidentTopologyToPolygonOffset();
    actor->GetMapper()->SetRelativeCoincidentTopologyPolygonOffsetParameters(1.0, 40.0);
    renderer->AddActor(actor);
  }

  void add_borders(vtkRenderer* renderer, const Drawable& drawable) const {
    const vtkSmartPointer<vtkActor> actor = actor_of(drawable.borders, false);
    actor->GetProperty()->SetColor(0.12, 0.14, 0.16);
    actor->GetProperty()->SetLineWidth(static_cast<float>(0.8 * pixel_));
    actor->GetProperty()->LightingOff();
    renderer->AddActor(actor);
  }

  void add_curves(vtkRenderer* renderer, const Drawable& drawable) const {
    if (is_plane_) add_region(renderer, drawable);
    const vtkSmartPointer<vtkActor> actor = actor_of(drawable.curves, drawable.has_field);
    actor->GetProperty()->SetColor(0.12, 0.25, 0.42);
    actor->GetProperty()->SetLineWidth(static_cast<float>((drawable.has_field ? 5.0 : 2.5) * pixel_));
    actor->GetProperty()->LightingOff();
    if (!options_.field && colour_cells(drawable.curves)) use_cell_colours(actor);
    renderer->AddActor(actor);
  }

  void add_region(vtkRenderer* renderer, const Drawable& drawable) const {
    // Where there are faces they show what is inside.
    for (const Drawable& other : sheet_.drawables) {
      if (other.faces->GetNumberOfCells() > 0) return;
    }
    const vtkSmartPointer<vtkActor> actor = actor_of(filled_region(drawable.curves), false);
    actor->GetProperty()->SetColor(0.86, 0.89, 0.93);
    actor->GetProperty()->LightingOff();
    actor->GetMapper()->SetResolveCoincidentTopologyToPolygonOffset();
    actor->GetMapper()->SetRelativeCoincidentTopologyPolygonOffsetParameters(1.0, 40.0);
    renderer->AddActor(actor);
  }

  void add_points(vtkRenderer* renderer, const Drawable& drawable) const {
    const vtkSmartPointer<vtkActor> actor = actor_of(drawable.points, drawable.has_field);
    actor->GetProperty()->SetColor(0.75, 0.2, 0.1);
    actor->GetProperty()->SetPointSize(static_cast<float>(5.0 * pixel_));
    actor->GetProperty()->RenderPointsAsSpheresOn();
    renderer->AddActor(actor);
  }

  void style(vtkTextProperty* text, double share) const {
    const double dark = has_light_background_ ? 0.1 : 0.92;
    text->SetColor(dark, dark, dark);
    text->SetFontFamilyToArial();
    text->SetFontSize(std::max(9, static_cast<int>(std::lround(share * std::min(width_, height_)))));
    text->BoldOff();
    text->ItalicOff();
    text->ShadowOff();
  }

  void add_caption(vtkRenderer* renderer, const std::string& name) const {
    const vtkNew<vtkTextActor> caption;
    caption->SetInput(name.c_str());
    style(caption->GetTextProperty(), 0.022);
    caption->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
    caption->SetPosition(0.02, 0.02);
    renderer->AddActor2D(caption);
  }

  void add_legend() {
    vtkRenderer* renderer = add_renderer({1.0 - legend_width, 0.0, 1.0, 1.0});
    const vtkNew<vtkScalarBarActor> bar;
    bar->SetLookupTable(table_);
    bar->SetTitle(legend_title(*options_.field).c_str());
    bar->SetNumberOfLabels(5);
    bar->SetMaximumNumberOfColors(256);
    bar->SetLabelFormat("%-#.4g");
    bar->UnconstrainedFontSizeOn();
    style(bar->GetTitleTextProperty(), 0.022);
    style(bar->GetLabelTextProperty(), 0.02);
    bar->SetVerticalTitleSeparation(static_cast<int>(12.0 * pixel_));
    bar->SetDrawFrame(0);
    bar->SetBarRatio(0.2);
    bar->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
    bar->SetPosition(0.05, 0.12);
    bar->SetPosition2(0.9, 0.76);
    renderer->AddActor2D(bar);
  }

  const Sheet& sheet_;
  const PictureOptions& options_;
  bool is_plane_;
  std::vector<View> views_;
  int factor_;
  int width_;
  int height_;
  double pixel_;
  bool has_light_background_ = true;
  vtkSmartPointer<vtkLookupTable> table_;
  OffscreenWindow window_;
};

}  // namespace

std::string draw_sheet(const Sheet& sheet, const PictureOptions& options) {
  return SheetDrawer(sheet, options).draw();
}

}  // namespace isorim::io::picture
