#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/io/cli/program_test.h"
#include "tests/io/iges/file_text.h"

/// CAD files as users meet them: run, check, and case files of type "file".
namespace isorim::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::string cad_file(const std::string& name) {
  return (fs::path(ISORIM_SOURCE_DIR) / "cases/cad" / name).string();
}

class CadFiles : public ProgramTest {
 protected:
  nlohmann::json results() const { return nlohmann::json::parse(read_file(folder() / "out/results.json")); }
  std::string file_case(const std::string& name, const std::string& more = "") const {
    fs::copy_file(cad_file(name), folder() / name, fs::copy_options::skip_existing);
    return "[geometry]\ntype = 'file'\npath = '" + name + "'\n" + more;
  }
  /// Four points and nothing else.
  std::string write_points() const {
    io::iges::FileText file;
    for (int i = 0; i < 4; ++i) file.entities.push_back({.type = 116, .parameters = {"116,1.,2.,3.,0;"}});
    return write("points.igs", file.text());
  }
};

TEST_F(CadFiles, RunsAFileByItself) {
  const ProgramResult result = run({"run", cad_file("sphere_nurbs_faces_p17.igs"), "-o", path("out")});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("sphere_nurbs_faces_p17"), HasSubstr("3D, 1 patch"), HasSubstr("closed"),
                                HasSubstr("unit mm")));
  const nlohmann::json json = results();
  EXPECT_EQ(json["geometry"]["units"], "mm");
  EXPECT_EQ(json["geometry"]["reader"], "isorim");
  EXPECT_THAT(json["geometry"]["format"].get<std::string>(), HasSubstr("IGES"));
  EXPECT_EQ(json["geometry"]["closed"], true);
  EXPECT_EQ(json["cad"]["faces"], 1);
  EXPECT_GE(json["cad"]["entities"].size(), 3U);
  EXPECT_NEAR(json["properties"]["volume"]["value"], 4.18879020478639, 1e-12);
}

TEST_F(CadFiles, OverridesWorkOnAFileByItself) {
  const ProgramResult result =
      run({"run", cad_file("sphere_nurbs_faces_p17.igs"), "-o", path("out"), "--set", "properties.density=3"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NEAR(results()["properties"]["mass"]["value"], 3 * 4.18879020478639, 1e-11);
}

TEST_F(CadFiles, UnitsAreConverted) {
  const ProgramResult result = run_case(file_case("box_cyl_hole_nurbs_faces_p17.igs", "units = 'cm'\n"));
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(results()["geometry"]["units"], "cm");
  EXPECT_EQ(results()["cad"]["file_unit"], "mm");
  EXPECT_NEAR(results()["properties"]["volume"]["value"], 3.21460183660255e-3, 1e-15);
}

TEST_F(CadFiles, TransformsAndNamesAreThoseOfAnyShape) {
  const ProgramResult result = run_case(file_case("box_cyl_hole_nurbs_faces_p17.igs",
                                                  "name = 'plate'\ntransform = { mirror = { normal = [1, 0, 0] }, "
                                                  "translate = [1, 2, 3] }\n"));
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NEAR(results()["properties"]["volume"]["value"], 3.21460183660255, 1e-12);
  EXPECT_NEAR(results()["properties"]["centroid"]["value"][2], 3.5, 1e-12);
}

TEST_F(CadFiles, DrawingsAreRegionsOfThePlane) {
  const ProgramResult result = run({"run", cad_file("wire_rounded_rect_nurbs_p17.igs"), "-o", path("out")});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(results()["geometry"]["dimension"], 2);
  EXPECT_NEAR(results()["properties"]["area"]["value"], 7.78539816339744831, 1e-13);
}

TEST_F(CadFiles, ChecksAClosedSolid) {
  const ProgramResult result = run({"check", cad_file("cube_blind_hole_nurbs_solid.igs"), "-o", path("out")});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("IGES"), HasSubstr("read by isorim"), HasSubstr("written by"),
                                HasSubstr("unit mm"), HasSubstr("186"), HasSubstr("11 patches"), HasSubstr("closed"),
                                HasSubstr("shell 1 (outer, closed)"), HasSubstr("closure defect")));
  EXPECT_FALSE(fs::exists(folder() / "out"));
}

TEST_F(CadFiles, ChecksAnOpenFaceAndWritesItsEdges) {
  const ProgramResult result = run({"check", cad_file("plate_ellipse_hole_nurbs_p17.igs"), "-o", path("out")});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("OPEN"), HasSubstr("free edge: loop 1, curve 1"), HasSubstr("free_edges.vtu"),
                                HasSubstr("dimension = 2")));
  EXPECT_THAT(read_file(folder() / "out/free_edges.vtu"), HasSubstr("VTKFile"));
}

TEST_F(CadFiles, CheckAsJsonHoldsEverything) {
  const ProgramResult result = run({"check", cad_file("viviani_cut_nurbs_solid.igs"), "--json", "-o", path("out")});
  EXPECT_EQ(result.status, 0) << result.err;
  const nlohmann::json json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["geometry"]["closed"], true);
  EXPECT_EQ(json["geometry"]["patches"].get<std::size_t>(), json["patches"].size());
  EXPECT_EQ(json["patches"][0]["solid"], 0);
  EXPECT_THAT(json["patches"][0]["entity"].get<std::string>(), HasSubstr("510"));
  EXPECT_EQ(json["shells"].size(), 1U);
  EXPECT_TRUE(json["free_edges"].empty());
  EXPECT_LT(json["geometry"]["closure_defect"], 1e-6);
}

TEST_F(CadFiles, SaysWhatIsThereInsteadOfAShape) {
  for (const char* command : {"run", "check"}) {
    const ProgramResult result = run({command, write_points()});
    EXPECT_EQ(result.status, 2);
    EXPECT_THAT(result.err, AllOf(HasSubstr("points.igs: found 0 faces, 0 curves and 4 points"), HasSubstr("116")));
  }
}

TEST_F(CadFiles, BadKeysAreRefusedWithTheirPlace) {
  const std::string sphere = "sphere_nurbs_faces_p17.igs";
  EXPECT_THAT(run_case(file_case(sphere, "units = 'metre'\n")).err,
              AllOf(HasSubstr("case.toml:4: geometry.units"), HasSubstr("expected one of")));
  EXPECT_THAT(run_case(file_case(sphere, "dimension = 4\n")).err, HasSubstr("case.toml:4: geometry.dimension"));
  EXPECT_THAT(run_case(file_case(sphere, "levels = [77]\n")).err,
              AllOf(HasSubstr("case.toml:1: geometry"), HasSubstr("no face is selected"), HasSubstr("the levels 0")));
  EXPECT_THAT(run_case(file_case(sphere, "dimension = 2\n")).err, HasSubstr("face_1 (144"));
  EXPECT_THAT(run_case("[geometry]\ntype = 'file'\n").err, HasSubstr("the key \"path\""));
  EXPECT_THAT(run_case("[geometry]\ntype = 'file'\npath = 'no.igs'\n").err,
              AllOf(HasSubstr("case.toml:1: geometry"), HasSubstr("no.igs")));
  EXPECT_THAT(run_case("[geometry]\ntype = 'file'\npath = 'case.toml'\n").err, HasSubstr("no format that is known"));
}

TEST_F(CadFiles, ExpectationsAreCheckedAgainstTheDimensionOfTheFile) {
  const ProgramResult result =
      run_case(file_case("wire_circle_nurbs_p17.igs", "[expect]\nvolume = { value = 1, rtol = 1 }\n"));
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("found the quantity \"volume\""));
}

TEST_F(CadFiles, ABrokenFileIsRefusedByRunAndByCheck) {
  const std::string text = read_file(cad_file("sphere_nurbs_faces_p17.igs"));
  const std::string broken = write("broken.igs", text.substr(0, text.size() / 2));
  EXPECT_EQ(run({"run", broken, "-o", path("out")}).status, 2);
  EXPECT_EQ(run({"check", broken, "-o", path("out")}).status, 2);
  EXPECT_FALSE(fs::exists(folder() / "out"));
}

}  // namespace
}  // namespace isorim::testing
