#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "geometry/shapes/solids.h"
#include "io/iges/reader.h"
#include "io/results/compute.h"
#include "io/tspline/iga.h"
#include "tests/geometry/tspline/extracted_surfaces.h"
#include "tests/io/cli/program_test.h"
#include "tests/io/tspline/expect_same.h"

/// T-spline files as users meet them: run, check, convert, and cases of type "file".
namespace isorim::testing {
namespace {

using geometry::ExtractedSurface;
using ::testing::AllOf;
using ::testing::HasSubstr;

const double pi = 3.14159265358979323846;

/// A torus with hanging edges that looks inwards.
ExtractedSurface torus() {
  const geometry::Boundary<3> boundary = geometry::testing::extracted(geometry::torus(3.0, 1.0));
  const auto& whole = std::get<ExtractedSurface>(boundary.patches[0].shape);
  return reversed(geometry::testing::cut_element(geometry::testing::cut_element(whole, 3, 0, 0.3), 7, 1, 0.6));
}

ExtractedSurface without_element(const ExtractedSurface& surface, std::ptrdiff_t element) {
  std::vector<geometry::ExtractionElement> elements = surface.elements();
  elements.erase(elements.begin() + element);
  return {surface.homogeneous(), elements};
}

class TSplineFiles : public ProgramTest {
 protected:
  std::string write_torus() const { return write("torus.iga", io::tspline::iga_text(torus())); }
  nlohmann::json results() const { return nlohmann::json::parse(read_file(folder() / "out/results.json")); }
};

TEST_F(TSplineFiles, RunAlone) {
  const ProgramResult result = run({"run", write_torus(), "-o", path("out")});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("1 patch (1 T-spline), 18 elements, closed"), HasSubstr(".iga")));
  const nlohmann::json json = results();
  EXPECT_NEAR(json["properties"]["volume"]["value"], 6.0 * pi * pi, 1e-12);
  EXPECT_NEAR(json["properties"]["area"]["value"], 12.0 * pi * pi, 1e-11);
  EXPECT_EQ(json["geometry"]["t_splines"], 1);
  EXPECT_LE(json["geometry"]["partition_defect"], 1e-15);
  EXPECT_TRUE(json["geometry"]["units"].is_null());
}

TEST_F(TSplineFiles, AreShapesOfCases) {
  write_torus();
  const std::string text = "[geometry]\ntype = 'file'\npath = 'torus.iga'\ntransform = { scale = 2 }\n";
  const ProgramResult result = run_case(text + "[expect]\nvolume = { value = 473.741011252, rtol = 1e-12 }\n");
  EXPECT_EQ(result.status, 0) << result.err << result.out;
  EXPECT_THAT(run_case(text + "units = 'm'\n").err,
              AllOf(HasSubstr("torus.iga"), HasSubstr("know no units"), HasSubstr("transform")));
}

TEST_F(TSplineFiles, CanBeCut) {
  write_torus();
  const ProgramResult result = run_case(
      "[geometry]\ntype = 'file'\npath = 'torus.iga'\nclip = { point = [0, 0, 0], normal = [0, 1, 0] }\n"
      "[expect]\nvolume = { value = 29.60881320326807, rtol = 1e-11 }\n");
  EXPECT_EQ(result.status, 0) << result.err << result.out;
}

TEST_F(TSplineFiles, CheckTellsFunctionsAndFreeEdges) {
  const std::string file = write("open.iga", io::tspline::iga_text(without_element(torus(), 5)));
  const ProgramResult result = run({"check", file, "-o", path("out")});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("rational, T-spline"), HasSubstr("9 on an element, which sum to one"),
                                HasSubstr("OPEN"), HasSubstr(" of element "), HasSubstr("no unit")));
  EXPECT_TRUE(std::filesystem::exists(folder() / "out/free_edges.vtu"));
  const nlohmann::json json = nlohmann::json::parse(run({"check", write_torus(), "--json", "-o", path("out")}).out);
  EXPECT_EQ(json["patches"][0]["extraction"]["functions"], torus().function_count());
  EXPECT_EQ(json["patches"][0]["orientation"], -1);
  // Each of the two cuts ends at two sides.
  EXPECT_EQ(json["patches"][0]["extraction"]["hanging_sides"], 4);
}

TEST_F(TSplineFiles, CheckTellsFunctionsThatDoNotSumToOne) {
  std::vector<geometry::ExtractionElement> elements = torus().elements();
  elements[4].rows *= 1.25;
  const std::string file =
      write("defective.iga", io::tspline::iga_text(ExtractedSurface(torus().homogeneous(), elements)));
  EXPECT_THAT(run({"check", file}).out, HasSubstr("on 1 elements they do not sum to one, by up to 0.25"));
}

TEST_F(TSplineFiles, GoThroughIgesAndBack) {
  const std::string file = write_torus();
  ASSERT_EQ(run({"convert", file, path("torus.igs"), "--unit", "m"}).status, 0);
  const io::CadModel model = io::read_iges(path("torus.igs"));
  EXPECT_EQ(model.unit, "m");
  ASSERT_EQ(model.t_splines.size(), 1u);
  io::tspline::expect_same_bits(model.t_splines[0].surface, torus());
  const ProgramResult back = run({"convert", path("torus.igs"), path("back.iga")});
  EXPECT_EQ(back.status, 0) << back.err;
  EXPECT_THAT(back.out, HasSubstr("18 elements, " + std::to_string(torus().function_count()) + " functions"));
  // Turned outward.
  io::tspline::expect_same_bits(io::tspline::read_iga(path("back.iga")).t_splines[0].surface, reversed(torus()));
}

/// T-splines that have a T-mesh: with domains of their elements, and weights that no file's coordinates give.
TEST_F(TSplineFiles, CasesWithTMeshesGoThroughFilesBitForBit) {
  for (const char* name : {"sphere", "cylinder", "cushion"}) {
    const std::string file =
        (std::filesystem::path(ISORIM_SOURCE_DIR) / "cases/tspline" / (std::string(name) + ".toml")).string();
    const auto model = std::get<io::Model<3>>(io::build_model(io::read_case(file)));
    ASSERT_EQ(run({"convert", file, path("case.igs")}).status, 0);
    const io::CadModel back = io::read_iges(path("case.igs"));
    EXPECT_THAT(back.warnings, ::testing::IsEmpty());
    std::size_t next = 0;
    for (const auto& patch : model.oriented.boundary.patches) {
      const auto* surface = std::get_if<ExtractedSurface>(&patch.shape);
      if (!surface) continue;
      ASSERT_LT(next, back.t_splines.size());
      io::tspline::expect_same_bits(back.t_splines[next].surface, *surface);
      EXPECT_EQ(back.t_splines[next++].origin.name, patch.name);
    }
    EXPECT_EQ(next, back.t_splines.size());
    EXPECT_GT(next, 0u);
  }
}

TEST_F(TSplineFiles, NurbsCasesBecomeTSplines) {
  const std::string file = write("box.toml", "[geometry]\ntype = 'box'\nsize = [1, 2, 3]\n");
  ASSERT_EQ(run({"convert", file, path("box.iga")}).status, 0);
  const ProgramResult result = run({"run", path("box.iga"), "-o", path("out")});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NEAR(results()["properties"]["volume"]["value"], 6.0, 1e-13);
  EXPECT_EQ(results()["geometry"]["t_splines"], 6);
  const std::string plane = write("circle.toml", "[geometry]\ntype = 'circle'\nradius = 1\n");
  EXPECT_THAT(run({"convert", plane, path("circle.iga")}).err, HasSubstr("this is a shape of the plane"));
}

TEST_F(TSplineFiles, BadFilesAreRefusedWithTheirLine) {
  const std::string text = io::tspline::iga_text(torus());
  const std::string broken = write("broken.iga", text.substr(0, text.size() / 2));
  for (const char* command : {"run", "check"}) {
    const ProgramResult result = run({command, broken, "-o", path("out")});
    EXPECT_EQ(result.status, 2);
    EXPECT_THAT(result.err, AllOf(HasSubstr("broken.iga: line ")));
  }
  EXPECT_THAT(run({"run", write("data.json", "{\"results\": []}"), "-o", path("out")}).err,
              HasSubstr("data.json: nodes: is missing"));
}

}  // namespace
}  // namespace isorim::testing
