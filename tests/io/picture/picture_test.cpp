#include "io/picture/picture.h"

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>
#include <vtkSmartPointer.h>

#include "geometry/shapes/solids.h"
#include "io/picture/views.h"
#include "io/vtk/bezier_writer.h"
#include "tests/io/cli/program_test.h"

namespace isorim::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// A PNG, read back; rows from the top.
class Picture {
 public:
  explicit Picture(const std::string& path) {
    const vtkNew<vtkPNGReader> reader;
    reader->SetFileName(path.c_str());
    reader->Update();
    image_ = reader->GetOutput();
  }

  int width() const { return image_->GetDimensions()[0]; }
  int height() const { return image_->GetDimensions()[1]; }
  bool has_alpha() const { return image_->GetNumberOfScalarComponents() == 4; }

  /// Red, green, blue, alpha in [0, 1].
  Eigen::Vector4d at(int x, int y) const {
    Eigen::Vector4d pixel = Eigen::Vector4d::Ones();
    for (int c = 0; c < image_->GetNumberOfScalarComponents(); ++c) {
      pixel[c] = image_->GetScalarComponentAsDouble(x, height() - 1 - y, 0, c) / 255.0;
    }
    return pixel;
  }

  /// Pixels that are covered, by their share.
  double covered() const {
    double sum = 0.0;
    for (int y = 0; y < height(); ++y) {
      for (int x = 0; x < width(); ++x) sum += at(x, y)[3];
    }
    return sum;
  }

 private:
  vtkSmartPointer<vtkImageData> image_;
};

/// Nothing here may need a display.
class PictureTest : public ProgramTest {
 protected:
  PictureTest() {
    unsetenv("DISPLAY");
    unsetenv("WAYLAND_DISPLAY");
  }

  ProgramResult draw(const std::string& input, std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"picture", input, "-o", path("view.png")});
    return run(more);
  }
  Picture drawn(const std::string& input, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> all = more;
    all.insert(all.end(), {"--background", "transparent"});
    const ProgramResult result = draw(input, all);
    EXPECT_EQ(result.status, 0) << result.err;
    return Picture(path("view.png"));
  }
  std::string case_file(const std::string& geometry) const { return write("case.toml", "[geometry]\n" + geometry); }

  /// A sphere of radius 1 with the field `height` = z and the vector field `place` = (x, y, z), exact in its basis.
  std::string sphere_with_fields() const {
    const auto table = geometry::bezier_elements(geometry::sphere(1.0));
    std::vector<double> heights;
    std::vector<double> places;
    for (const auto& element : table.elements) {
      const Eigen::Matrix3Xd points = table.net_matrix(element).colwise().hnormalized();
      for (Eigen::Index k = 0; k < points.cols(); ++k) {
        heights.push_back(points(2, k));
        places.insert(places.end(), points.col(k).begin(), points.col(k).end());
      }
    }
    io::VtuContent content;
    content.point_fields = {{"height", 1, heights}, {"place", 3, places}};
    io::write_vtu(folder() / "sphere.vtu", table, content);
    return path("sphere.vtu");
  }
};

/// Light makes colours darker or paler, but of one hue.
void expect_hue(const Eigen::Vector4d& pixel, const Eigen::Vector3d& expected) {
  const double cosine = pixel.head<3>().normalized().dot(expected.normalized());
  EXPECT_GT(cosine, 0.9985) << pixel.transpose() << " is not of the hue of " << expected.transpose();
}

TEST_F(PictureTest, SilhouetteOfASphereHasTheAreaOfItsDisc) {
  const Picture picture =
      drawn(case_file("type = \"sphere\"\nradius = 2.5\n"), {"--size", "400x300", "--lines", "none"});
  EXPECT_EQ(picture.width(), 400);
  EXPECT_EQ(picture.height(), 300);
  const double radius = 0.92 * 150.0;
  const double disc = std::numbers::pi * radius * radius;
  // Chords of a fifth of a pixel, nine samples a pixel.
  EXPECT_NEAR(picture.covered(), disc, 0.002 * disc);
  EXPECT_EQ(picture.at(200, 150)[3], 1.0);
  EXPECT_EQ(picture.at(5, 5)[3], 0.0);
}

TEST_F(PictureTest, HoleOfATrimmedBodyIsSeenThrough) {
  // A ring: a ball of radius 1 without a cylinder of radius 0.6.
  const Picture picture = drawn(case_file("type = \"sphere\"\nradius = 1\n"
                                          "clip = { type = \"cylinder\", point = [0, 0, 0], axis = [0, 0, 1], "
                                          "radius = 0.6, keep = \"outside\" }\n"),
                                {"--size", "500x500", "--lines", "none", "--view", "top"});
  const double radius = 0.92 * 250.0;
  const double ring = std::numbers::pi * radius * radius * (1.0 - 0.36);
  EXPECT_NEAR(picture.covered(), ring, 0.003 * ring);
  EXPECT_EQ(picture.at(250, 250)[3], 0.0);
}

TEST_F(PictureTest, StandardViewsShowTheirSides) {
  const std::string box = case_file("type = \"box\"\nsize = [1, 2, 3]\n");
  const auto area = [&](const std::string& view) {
    return drawn(box, {"--size", "300x300", "--lines", "none", "--view", view}).covered();
  };
  // The longer side fills 0.92 of the picture.
  const double whole = 276.0 * 276.0;
  for (const char* view : {"front", "back"}) EXPECT_NEAR(area(view), whole * 1.0 / 3.0, 600.0) << view;
  for (const char* view : {"left", "right"}) EXPECT_NEAR(area(view), whole * 2.0 / 3.0, 600.0) << view;
  for (const char* view : {"top", "bottom"}) EXPECT_NEAR(area(view), whole * 1.0 / 2.0, 600.0) << view;
}

TEST_F(PictureTest, ViewsHaveRightHandedAxes) {
  for (const char* text : {"iso", "iso_back", "front", "back", "left", "right", "top", "bottom", "-20.5,33"}) {
    const io::picture::View view = io::picture::views_from(text).front();
    EXPECT_NEAR(view.towards_eye.norm(), 1.0, 1e-15) << text;
    EXPECT_NEAR(view.up.norm(), 1.0, 1e-15) << text;
    EXPECT_NEAR(view.up.dot(view.towards_eye), 0.0, 1e-15) << text;
    EXPECT_GE(view.up.z(), -1e-15) << text;
  }
  EXPECT_NEAR((io::picture::views_from("front").front().right() - Eigen::Vector3d::UnitX()).norm(), 0.0, 1e-15);
  EXPECT_NEAR((io::picture::views_from("right").front().right() - Eigen::Vector3d::UnitY()).norm(), 0.0, 1e-15);
  EXPECT_NEAR((io::picture::views_from("top").front().right() - Eigen::Vector3d::UnitX()).norm(), 0.0, 1e-15);
  EXPECT_EQ(io::picture::views_from("all").size(), 4U);
}

TEST_F(PictureTest, SheetsHaveOneScale) {
  const std::string box = case_file("type = \"box\"\nsize = [1, 2, 3]\n");
  const Picture sheet = drawn(box, {"--size", "600x300", "--lines", "none", "--view", "front", "--view", "right"});
  // Two squares of 300: faces 1 x 3 and 2 x 3, the height of 3 filling 276.
  const double scale = 92.0;
  // Captions take a few pixels.
  EXPECT_NEAR(sheet.covered(), (3.0 + 6.0) * scale * scale, 1200.0);
  EXPECT_EQ(sheet.at(150, 150)[3], 1.0);
  EXPECT_EQ(sheet.at(150 + 60, 150)[3], 0.0);
  EXPECT_EQ(sheet.at(450 + 60, 150)[3], 1.0);
}

TEST_F(PictureTest, ColoursFollowTheField) {
  const std::string sphere = sphere_with_fields();
  const std::vector<std::string> size{"--size", "400x340", "--lines", "none", "--view", "front"};
  std::vector<std::string> by_height = size;
  by_height.insert(by_height.end(), {"--field", "height"});
  const Picture picture = drawn(sphere, by_height);
  // The legend leaves 340 x 340, of which the sphere fills 0.92.
  const auto row = [](double z) { return static_cast<int>(std::lround(170.0 - 156.4 * z)); };
  expect_hue(picture.at(170, row(0.0)), {0.128, 0.567, 0.551});
  expect_hue(picture.at(170, row(0.5)), {0.369, 0.789, 0.383});
  expect_hue(picture.at(170, row(-0.5)), {0.231, 0.318, 0.545});
  by_height.insert(by_height.end(), {"--range", "-0.5", "0.5"});
  expect_hue(drawn(sphere, by_height).at(170, row(0.5)), {0.993, 0.906, 0.144});
}

TEST_F(PictureTest, ComponentsAndMagnitudesOfVectorsAreShown) {
  const std::string sphere = sphere_with_fields();
  const std::vector<std::string> field{"--size", "400x340", "--lines", "none",       "--view",
                                       "front",  "--field", "place",   "--component"};
  const auto with = [&](const std::string& component) {
    std::vector<std::string> more = field;
    more.push_back(component);
    return drawn(sphere, more);
  };
  expect_hue(with("x").at(170 + 78, 170), {0.369, 0.789, 0.383});
  expect_hue(with("0").at(170 - 78, 170), {0.231, 0.318, 0.545});
  // |place| = 1: the middle of the colours, everywhere.
  for (const int x : {100, 170, 240}) expect_hue(with("magnitude").at(x, 170), {0.128, 0.567, 0.551});
}

TEST_F(PictureTest, RegionsOfThePlaneAreFilled) {
  const std::string plate = case_file(
      "type = \"region\"\nloops = [{ type = \"rectangle\", size = [4, 2], role = \"outer\" }, "
      "{ type = \"circle\", radius = 0.5, centre = [1, 1], role = \"hole\" }]\n");
  const Picture picture = drawn(plate, {"--size", "500x400"});
  const double scale = 460.0 / 4.0;
  const double area = 8.0 - std::numbers::pi * 0.25;
  const double perimeter = 12.0 + std::numbers::pi;
  // Half of the lines, which are 2.5 pixels wide, lies outside.
  EXPECT_NEAR(picture.covered(), area * scale * scale + perimeter * scale * 1.25, 0.01 * area * scale * scale);
  EXPECT_EQ(picture.at(20 + 115, 200)[3], 0.0);
  EXPECT_EQ(picture.at(20 + 345, 200)[3], 1.0);
}

TEST_F(PictureTest, LoopsMayTouchWhereTheyAreFilled) {
  // The hole touches the square at the middles of its four sides.
  const std::string square = case_file(
      "type = \"region\"\nloops = [{ type = \"rectangle\", size = [2, 2], role = \"outer\" }, "
      "{ type = \"circle\", radius = 1, centre = [1, 1], role = \"hole\" }]\n");
  const Picture picture = drawn(square, {"--size", "400x400"});
  for (const auto& [x, y] : {std::pair{45, 45}, {355, 45}, {45, 355}, {355, 355}}) {
    EXPECT_EQ(picture.at(x, y)[3], 1.0) << x << ", " << y;
  }
  EXPECT_EQ(picture.at(200, 200)[3], 0.0);
}

constexpr const char* disc_analysis = R"([geometry]
type = "circle"
radius = 1
[analysis]
equation = "laplace"
[[boundary_condition]]
kind = "value"
value = "x"
[discretisation]
degree = 2
refine = 1
[[grid]]
name = "inside"
from = [-1, -1]
to = [1, 1]
counts = [41, 41]
)";

TEST_F(PictureTest, AnalysesAreSolvedForTheirFields) {
  const std::string file = write("disc.toml", disc_analysis);
  const Picture picture = drawn(file, {"--size", "400x340", "--field", "potential"});
  expect_hue(picture.at(170 - 78, 170), {0.231, 0.318, 0.545});
  expect_hue(picture.at(170 + 78, 170), {0.369, 0.789, 0.383});
  const ProgramResult other = draw(file, {"--field", "pressure"});
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, AllOf(HasSubstr("disc.toml: found no field \"pressure\""), HasSubstr("gradient (x, y, z)"),
                               HasSubstr("potential")));
}

TEST_F(PictureTest, GridsAreDrawnWithoutHiddenPoints) {
  ASSERT_EQ(
      run({"run", write("disc.toml", disc_analysis + std::string("[output]\nvtk = true\n")), "-o", path("out")}).status,
      0);
  const Picture picture = drawn(path("out/grid_inside.vti"), {"--size", "300x300", "--view", "top", "--lines", "none"});
  // Squares of 1/20 within the circle: a little less than pi.
  EXPECT_EQ(picture.at(3, 3)[3], 0.0);
  EXPECT_EQ(picture.at(150, 150)[3], 1.0);
  EXPECT_EQ(picture.at(20, 20)[3], 0.0);
}

TEST_F(PictureTest, OpaquePicturesHaveTheirBackground) {
  ASSERT_EQ(run({"picture", case_file("type = \"box\"\nsize = [1, 1, 1]\n"), "-o", path("view.png"), "--background",
                 "#204080", "--size", "64x48"})
                .status,
            0);
  const Picture picture(path("view.png"));
  EXPECT_FALSE(picture.has_alpha());
  EXPECT_NEAR((picture.at(1, 1).head<3>() * 255.0 - Eigen::Vector3d(32, 64, 128)).norm(), 0.0, 1.0);
}

TEST_F(PictureTest, PatchesHaveColoursOfTheirOwn) {
  const std::string box = case_file("type = \"box\"\nsize = [1, 1, 1]\n");
  const Picture several = drawn(box, {"--size", "200x200", "--lines", "none"});
  const Picture plain = drawn(box, {"--size", "200x200", "--lines", "none", "--colours", "plain"});
  const auto hue = [](const Picture& picture, int x, int y) {
    return Eigen::Vector3d(picture.at(x, y).head<3>().normalized());
  };
  EXPECT_GT((hue(several, 100, 40) - hue(several, 60, 130)).norm(), 0.1);
  EXPECT_GT((hue(several, 100, 40) - hue(several, 140, 130)).norm(), 0.1);
  EXPECT_LT((hue(plain, 100, 40) - hue(plain, 60, 130)).norm(), 0.02);
}

TEST_F(PictureTest, MistakesAreToldWithWhatWasExpected) {
  const std::string sphere = sphere_with_fields();
  const auto expect_refused = [&](const std::string& input, const std::vector<std::string>& more,
                                  const std::string& fragment) {
    const ProgramResult result = draw(input, more);
    EXPECT_EQ(result.status, 2) << fragment;
    EXPECT_THAT(result.err, HasSubstr(fragment));
    EXPECT_FALSE(std::filesystem::exists(path("view.png"))) << fragment;
  };
  expect_refused(sphere, {"--field", "heigth"}, "found no field \"heigth\"; expected one of element, height");
  expect_refused(sphere, {"--field", "RationalWeights"}, "found no field \"RationalWeights\"");
  expect_refused(sphere, {"--field", "place", "--component", "w"}, "expected one of magnitude, x, y, z");
  expect_refused(sphere, {"--field", "place", "--component", "3"}, "expected one of magnitude, x, y, z");
  expect_refused(sphere, {"--field", "height", "--range", "1", "1"}, "the lower one first");
  expect_refused(sphere, {"--range", "0", "1"}, "belong to --field");
  expect_refused(sphere, {"--view", "topp"}, "found the view \"topp\" (did you mean \"top\"?)");
  expect_refused(sphere, {"--view", "0,91"}, "elevation between -90 and 90");
  expect_refused(sphere, {"--size", "300"}, "expected WIDTHxHEIGHT");
  expect_refused(sphere, {"--size", "10x10"}, "expected 32 to 8192");
  expect_refused(sphere, {"--map", "rainbow"}, "expected one of viridis, coolwarm, grey");
  expect_refused(sphere, {"--colours", "paint"}, "expected one of automatic, patch, plain");
  expect_refused(sphere, {"--background", "#12345"}, "expected #rrggbb");
  expect_refused(path("none.vtu"), {}, "none.vtu: there is no such file");
  expect_refused(write("broken.vtu", "<VTKFile type=\"UnstructuredGrid\""), {}, "broken.vtu: is no .vtu file");
  expect_refused(write("empty.vtu", R"(<VTKFile type="UnstructuredGrid"><UnstructuredGrid>
<Piece NumberOfPoints="0" NumberOfCells="0"><Points><DataArray type="Float64" NumberOfComponents="3" format="ascii"/></Points>
<Cells><DataArray type="Int32" Name="connectivity" format="ascii"/><DataArray type="Int32" Name="offsets" format="ascii"/>
<DataArray type="UInt8" Name="types" format="ascii"/></Cells></Piece></UnstructuredGrid></VTKFile>)"),
                 {}, "holds no cells");
  expect_refused(write("tetra.vtu", R"(<VTKFile type="UnstructuredGrid"><UnstructuredGrid>
<Piece NumberOfPoints="4" NumberOfCells="1">
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 0 1 0 0 0 1</DataArray></Points>
<Cells><DataArray type="Int32" Name="connectivity" format="ascii">0 1 2 3</DataArray>
<DataArray type="Int32" Name="offsets" format="ascii">4</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">10</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>)"),
                 {}, "found the cell type 10");
  const ProgramResult jpeg = run({"picture", sphere, "-o", path("view.jpg")});
  EXPECT_EQ(jpeg.status, 2);
  EXPECT_THAT(jpeg.err, HasSubstr("expected .png"));
  EXPECT_EQ(run({"picture", sphere, "-o", path("no_folder/view.png")}).status, 2);
}

}  // namespace
}  // namespace isorim::testing
