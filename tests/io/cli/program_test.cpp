#include "tests/io/cli/program_test.h"

#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace isorim::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string circle =
    "title = 'A circle'\n[geometry]\ntype = 'circle'\nradius = 2\ncentre = [1, 3]\n[expect]\narea = { value = "
    "12.566370614359172, rtol = 1e-13 }\n";

class Program : public ProgramTest {
 protected:
  nlohmann::json results(const std::string& out = "out") const {
    return nlohmann::json::parse(read_file(folder() / out / "results.json"));
  }
};

TEST_F(Program, RunPrintsTheTableAndSucceeds) {
  const ProgramResult result = run_case(circle);
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_THAT(result.out, AllOf(HasSubstr("A circle"), HasSubstr("2D, 1 patch, 4 elements, closed"),
                                HasSubstr("perimeter"), HasSubstr("1 expectation of 1 met")));
}

TEST_F(Program, QuietPrintsNothing) {
  const ProgramResult result = run_case(circle, {"--quiet"});
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.out + result.err, "");
}

TEST_F(Program, MissedExpectationIsStatus1AndStillWritten) {
  const ProgramResult result = run_case(circle, {"--set", "expect.area.value=12.5"});
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.out, HasSubstr("MISSED"));
  EXPECT_THAT(result.err, HasSubstr("case.toml: the expectation of area is missed: off by 0.066; expected at most"));
  EXPECT_EQ(results()["status"], "expectation_missed");
  EXPECT_EQ(results()["expectations"][0]["met"], false);
}

TEST_F(Program, MissedToleranceIsStatus3AndSaidWithoutATable) {
  const ProgramResult result =
      run_case(circle + "[[integral]]\nname = 'jump'\nintegrand = '(x > 1.3) ? 1 : 0'\n", {"--quiet"});
  EXPECT_EQ(result.status, 3);
  EXPECT_THAT(result.err, HasSubstr("case.toml: the tolerance is not reached: jump"));
  EXPECT_EQ(results()["status"], "tolerance_not_reached");
}

TEST_F(Program, OverflowIsANumericalFailure) {
  const ProgramResult result = run_case(circle + "[properties]\ndensity = 1e308\n");
  EXPECT_EQ(result.status, 3);
  EXPECT_THAT(result.err, HasSubstr("case.toml: mass is inf; expected a finite number"));
  EXPECT_FALSE(fs::exists(folder() / "out"));
}

TEST_F(Program, WritesTheFilesThatTheCaseAsksFor) {
  run_case(circle);
  for (const char* name : {"results.json", "results.h5", "boundary.vtu", "boundary.svg"}) {
    EXPECT_TRUE(fs::exists(folder() / "out" / name)) << name;
  }
  fs::remove_all(folder() / "out");
  run_case(circle + "[output]\nvtk = false\nhdf5 = false\nsvg = false\n");
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder() / "out")) names.push_back(entry.path().filename());
  EXPECT_THAT(names, ::testing::ElementsAre("results.json"));
}

TEST_F(Program, JsonHasTheKeysOfTheContract) {
  run_case(circle + "[[integral]]\nname = 'second_moment'\nintegrand = '(x-1)^2 + (y-3)^2'\n", {"-j", "1"});
  const nlohmann::json json = results();
  EXPECT_EQ(json["case"], "A circle");
  EXPECT_EQ(json["status"], "ok");
  EXPECT_EQ(json["threads"], 1);
  EXPECT_EQ(json["geometry"]["dimension"], 2);
  EXPECT_EQ(json["geometry"]["patches"], 1);
  EXPECT_EQ(json["geometry"]["elements"], 4);
  EXPECT_EQ(json["geometry"]["trimmed_faces"], 0);
  EXPECT_EQ(json["geometry"]["closed"], true);
  EXPECT_LT(json["geometry"]["closure_defect"], 1e-15);
  EXPECT_TRUE(json["geometry"].contains("units"));
  const double pi = 3.14159265358979323846;
  EXPECT_NEAR(json["properties"]["perimeter"]["value"], 4 * pi, 1e-13);
  EXPECT_NEAR(json["properties"]["area"]["value"], 4 * pi, 1e-12);
  EXPECT_GT(json["properties"]["area"]["evaluations"], 0);
  EXPECT_NEAR(json["properties"]["centroid"]["value"][1], 3, 1e-13);
  EXPECT_EQ(json["properties"]["centroid"]["error"].size(), 2U);
  EXPECT_NEAR(json["properties"]["inertia"]["value"][0][0], 4 * pi, 1e-12);
  EXPECT_TRUE(json["properties"]["inertia"]["error"].is_number());
  EXPECT_NEAR(json["integrals"]["second_moment"]["value"], 8 * pi, 1e-11);
  EXPECT_LT(json["integrals"]["second_moment"]["error"], 1e-9);
  EXPECT_EQ(json["expectations"][0]["quantity"], "area");
  EXPECT_EQ(json["expectations"][0]["expected"], 12.566370614359172);
  EXPECT_EQ(json["expectations"][0]["met"], true);
  for (const char* stage : {"read", "integrate", "write"}) EXPECT_GE(json["timings"][stage], 0.0);
  EXPECT_FALSE(json["properties"].contains("volume"));
}

TEST_F(Program, DensityAddsTheMassAndScalesTheInertia) {
  run_case("[geometry]\ntype = 'box'\nsize = [1, 2, 3]\n[properties]\ndensity = 10\n");
  const nlohmann::json properties = results()["properties"];
  EXPECT_NEAR(properties["mass"]["value"], 60, 1e-11);
  // m (b^2 + c^2) / 12
  EXPECT_NEAR(properties["inertia"]["value"][0][0], 60.0 * 13 / 12, 1e-11);
  EXPECT_NEAR(properties["principal_moments"]["value"][0], 60.0 * 5 / 12, 1e-11);
}

TEST_F(Program, OpenBoundaryHasItsPerimeterAndAReasonForTheRest) {
  const ProgramResult result = run_case(
      "[geometry]\ntype = 'ellipse_arc'\nradii = [1, 1]\nangles = [0, 90]\n[expect]\nperimeter = { value = "
      "1.5707963267948966, rtol = 1e-13 }\n");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.err, AllOf(HasSubstr("case.toml: no area"), HasSubstr("2 free ends")));
  const nlohmann::json json = results();
  EXPECT_EQ(json["geometry"]["closed"], false);
  EXPECT_TRUE(json["properties"]["area"]["value"].is_null());
  EXPECT_THAT(json["properties"]["area"]["reason"].get<std::string>(), HasSubstr("the boundary is open"));
}

TEST_F(Program, OpenBoundaryIsIntegratedIfTheCaseSaysSo) {
  const std::string text =
      "[geometry]\ntype = 'ellipse_arc'\nradii = [1, 1]\nangles = [0, 90]\n[properties]\nopen_boundary = "
      "'integrate'\npole = [0, 0]\n";
  const ProgramResult result = run_case(text);
  EXPECT_EQ(result.status, 0) << result.err;
  // The sector that the pole closes.
  EXPECT_NEAR(results()["properties"]["area"]["value"], 0.78539816339744831, 1e-13);
}

TEST_F(Program, ExpectedVolumeOfAnOpenBoundaryIsMissed) {
  const ProgramResult result = run_case(
      "[geometry]\ntype = 'patches'\npatches = [{ type = 'disc', radius = 1 }]\n[expect]\nvolume = { value = "
      "1, rtol = 1 }\n");
  EXPECT_EQ(result.status, 1) << result.err;
  EXPECT_THAT(result.err, HasSubstr("no volume"));
}

TEST_F(Program, ToleranceThatIsNotReachedIsStatus3) {
  // A singularity inside the domain, on no ray's end.
  const ProgramResult result = run_case(
      "[geometry]\ntype = 'circle'\nradius = 1\n[[integral]]\nname = 'singular'\nintegrand = "
      "'1/sqrt((x-0.31)^2 + (y-0.17)^2)'\ntolerance = 1e-13\n");
  EXPECT_EQ(result.status, 3);
  EXPECT_EQ(results()["status"], "tolerance_not_reached");
  EXPECT_EQ(results()["integrals"]["singular"]["status"], "tolerance_not_reached");
}

TEST_F(Program, IntegrandThatIsUndefinedIsStatus3AndNothingIsWritten) {
  const ProgramResult result =
      run_case("[geometry]\ntype = 'circle'\nradius = 1\n[[integral]]\nname = 'root'\nintegrand = 'sqrt(x - 5)'\n");
  EXPECT_EQ(result.status, 3);
  EXPECT_THAT(result.err, AllOf(HasSubstr("case.toml:4"), HasSubstr("\"root\"")));
  EXPECT_FALSE(fs::exists(folder() / "out"));
}

TEST_F(Program, FixedGaussRuleIsOfTheThesis) {
  // Correia (2016), chapter 6: 4 points a knot span on the circle of radius 0.5.
  run_case("[geometry]\ntype = 'circle'\nradius = 0.5\ncentre = [1, 1]\n[properties]\ngauss_points = 4\n");
  EXPECT_NEAR(results()["properties"]["perimeter"]["value"], 3.1415810113695, 5e-14);
  EXPECT_NEAR(results()["properties"]["area"]["value"], 0.7853952528424, 5e-14);
  EXPECT_EQ(results()["properties"]["area"]["status"], "fixed_rule");
}

TEST_F(Program, SetOverridesKeysByTheirPath) {
  const ProgramResult result =
      run_case(circle, {"--set", "geometry.radius=1", "--set", "title=Small one", "--set", "expect={}"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(results()["case"], "Small one");
  EXPECT_NEAR(results()["properties"]["area"]["value"], 3.14159265358979323846, 1e-13);
  EXPECT_THAT(results()["resolved_case"].get<std::string>(), HasSubstr("radius = 1\n"));
}

TEST_F(Program, SetIsValidatedAndNamedInMessages) {
  ProgramResult result = run_case(circle, {"--set", "geometry.radius=big"});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("--set geometry.radius=big: geometry.radius: found the text \"big\""));
  result = run_case(circle, {"--set", "geometry.radius"});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("found no '='"));
  result = run_case(circle, {"--set", "geometry.radius.x=1"});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("\"radius\" is the integer 2"));
}

TEST_F(Program, ConvergenceStudyFallsAndIsWrittenAsCsvAndSvg) {
  const ProgramResult result = run_case(circle + "[convergence]\npoints = { from = 2, to = 8, step = 2 }\n");
  ASSERT_EQ(result.status, 0) << result.err;
  std::istringstream csv(read_file(folder() / "out/convergence.csv"));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "points,area");
  double previous = 1.0;
  int rows = 0;
  while (std::getline(csv, line)) {
    const double error = std::stod(line.substr(line.find(',') + 1));
    EXPECT_EQ(std::stoi(line), 2 * ++rows);
    EXPECT_LT(error, 0.1 * previous) << line;
    previous = error;
  }
  EXPECT_EQ(rows, 4);
  EXPECT_THAT(read_file(folder() / "out/convergence.svg"), AllOf(HasSubstr("<svg"), HasSubstr("A circle")));
}

TEST_F(Program, ResultsHaveTheSameBitsForAnyNumberOfThreads) {
  const std::string text =
      "[geometry]\ntype = 'torus'\nmajor_radius = 2\nminor_radius = 1\n[[integral]]\nname = "
      "'wave'\nintegrand = 'exp(x)*cos(y*z)'\n[output]\nhdf5 = false\nvtk = false\n";
  run_case(text, {"-j", "1"});
  const nlohmann::json one = results();
  run_case(text, {"-j", "3"});
  const nlohmann::json three = results();
  EXPECT_EQ(one["properties"], three["properties"]);
  EXPECT_EQ(one["integrals"], three["integrals"]);
  EXPECT_EQ(three["threads"], 3);
}

TEST_F(Program, CheckTellsWhatIsThereAndWritesNothing) {
  write("hollow.toml",
        "title = 'Hollow'\n[geometry]\ntype = 'patches'\npatches = [{ type = 'sphere', radius = 2, name = 'outside' }, "
        "{ type = 'sphere', radius = 1, name = 'inside' }]\n");
  const ProgramResult result = run({"check", path("hollow.toml")});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("3D, 2 patches, 16 elements, closed, 1 void"), HasSubstr("outside"),
                                HasSubstr("2 x 2"), HasSubstr("rational"), HasSubstr("shell 2 (void, closed): inside"),
                                HasSubstr("control net from (-2, -2, -2) to (2, 2, 2)")));
  write("open.toml",
        "[geometry]\ntype = 'patches'\npatches = [{ type = 'quadrilateral', corners = [[0,0,0], [1,0,0], "
        "[1,1,0], [0,1,0]] }]\n");
  const ProgramResult open = run({"check", path("open.toml")});
  EXPECT_EQ(open.status, 0);
  EXPECT_THAT(open.out,
              AllOf(HasSubstr("OPEN"), HasSubstr("free edge: v = first of patch_1 from (0, 0, 0) to (1, 0, 0)")));
  EXPECT_FALSE(fs::exists(folder() / "out"));
}

TEST_F(Program, VerifyIsStatus0WhenEverythingIsMet) {
  write("suite/a.toml", circle);
  write("suite/deep/b.toml", circle);
  write("suite/no_expectations.toml", "[geometry]\ntype = 'circle'\nradius = 1\n");
  const ProgramResult result = run({"verify", path("suite"), "--json", path("table.json")});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("deep/b"), HasSubstr("2 of 2 expectations met in 2 cases"),
                                Not(HasSubstr("no_expectations"))));
  const nlohmann::json json = nlohmann::json::parse(read_file(path("table.json")));
  EXPECT_EQ(json["status"], "ok");
  ASSERT_EQ(json["cases"].size(), 2U);
  EXPECT_EQ(json["cases"][0]["file"], "a");
  EXPECT_EQ(json["cases"][0]["expectations"][0]["met"], true);
}

TEST_F(Program, VerifyIsStatus1WhenOneIsMissed) {
  write("suite/a.toml", circle);
  write("suite/b.toml", circle + "perimeter = { value = 12, rtol = 1e-3 }\n");
  const ProgramResult result = run({"verify", path("suite")});
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.out, AllOf(HasSubstr("MISSED"), HasSubstr("2 of 3 expectations met in 2 cases")));
}

TEST_F(Program, VerifyRunsTheRestAndIsStatus2WhenACaseIsBad) {
  write("suite/a.toml", "[geometry]\ntype = 'circle'\n");
  write("suite/b.toml", circle + "perimeter = { value = 12, rtol = 1e-3 }\n");
  const ProgramResult result = run({"verify", path("suite"), "--json", path("table.json")});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("a.toml:1: geometry: the key \"radius\" (real) is missing"));
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("FAILED"), HasSubstr("1 of 2 expectations met in 1 cases; 1 case could not run")));
  EXPECT_EQ(nlohmann::json::parse(read_file(path("table.json")))["cases"][0]["status"], "failed");
}

TEST_F(Program, VerifyOfNothingIsRefused) {
  EXPECT_THAT(run({"verify", path("nowhere")}).err, HasSubstr("nowhere: no such folder"));
  fs::create_directories(folder() / "empty");
  const ProgramResult result = run({"verify", path("empty")});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("empty: found no case file"));
  write("silent/a.toml", "[geometry]\ntype = 'circle'\nradius = 1\n");
  const ProgramResult silent = run({"verify", path("silent")});
  EXPECT_EQ(silent.status, 2);
  EXPECT_THAT(silent.err, HasSubstr("silent: found no case with [expect]"));
  EXPECT_EQ(silent.out, "");
}

TEST_F(Program, VerifyPassesOverSweeps) {
  write("suite/a.toml", circle);
  write("suite/sweep.toml", "base = 'a.toml'\n[[parameter]]\nkey = 'geometry.radius'\nvalues = [1]\n");
  const ProgramResult result = run({"verify", path("suite")});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("1 of 1 expectations met in 1 cases"));
}

TEST_F(Program, VerifyDoesNotOverwriteACaseWithItsTable) {
  const std::string file = write("a.toml", circle);
  const ProgramResult result = run({"verify", "--json", file, path("suite")});
  EXPECT_EQ(result.status, 2);
  EXPECT_EQ(read_file(file), circle);
  write("suite/a.toml", circle);
  const ProgramResult swapped = run({"verify", path("suite"), "--json", file});
  EXPECT_EQ(swapped.status, 2);
  EXPECT_THAT(swapped.err, HasSubstr("found a case file in the place of the table's"));
  EXPECT_EQ(read_file(file), circle);
  EXPECT_THAT(run({"verify", path("suite"), "--json", path("suite")}).err, HasSubstr("suite': it is a folder"));
}

TEST_F(Program, OutputThatCannotBeWrittenIsRefusedBeforeComputing) {
  write("file", "");
  // What would be found out while computing.
  const std::string late = "[geometry]\ntype = 'circle'\nradius = 1\n[[integral]]\nname = 'i'\nintegrand = 'log(x)'\n";
  const auto refused = [&](const std::string& output) {
    const ProgramResult result = run({"run", write("case.toml", late), "-o", output});
    EXPECT_EQ(result.status, 2);
    return result.err;
  };
  EXPECT_THAT(refused(path("file/deeper")), HasSubstr("file' is a file"));
  EXPECT_THAT(refused(""), HasSubstr("the name of the output folder is empty"));
  if (geteuid() == 0) return;
  fs::create_directories(folder() / "locked");
  fs::permissions(folder() / "locked", fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_THAT(refused(path("locked/out")), HasSubstr("locked': Permission denied"));
}

TEST_F(Program, UnknownCommandsAreStatus2WithTheNearest) {
  const ProgramResult unknown = run({"rum", "case.toml"});
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.err, HasSubstr("found the command \"rum\" (did you mean \"run\"?)"));
  EXPECT_EQ(run({"run"}).status, 2);
  EXPECT_EQ(run({}).status, 2);
  EXPECT_EQ(run({"run", write("case.toml", circle), "-j", "0"}).status, 2);
  EXPECT_EQ(run({"run", write("case.toml", circle), "--nonsense"}).status, 2);
}

TEST_F(Program, HelpAndVersion) {
  const ProgramResult version = run({"--version"});
  EXPECT_EQ(version.status, 0);
  EXPECT_THAT(version.out, ::testing::MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+\n"));
  EXPECT_THAT(run({"help"}).out,
              AllOf(HasSubstr("verify"), HasSubstr("Exit status"), HasSubstr("convert"), HasSubstr("sweep")));
  EXPECT_THAT(run({"help", "run"}).out, HasSubstr("--set"));
  EXPECT_THAT(run({"help", "sweep"}).out, AllOf(HasSubstr("--shard"), HasSubstr("latin_hypercube")));
  EXPECT_THAT(run({"help", "sweep", "--markdown"}).out, AllOf(HasSubstr("## rows"), HasSubstr("| `csv` |")));
  EXPECT_THAT(run({"help", "case"}).out, AllOf(HasSubstr("properties"), HasSubstr("ellipsoid"), HasSubstr("hull")));
  EXPECT_THAT(run({"help", "case", "torus"}).out, AllOf(HasSubstr("major_radius"), HasSubstr("required")));
  const ProgramResult wrong = run({"help", "case", "tourus"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.err, HasSubstr("(did you mean \"torus\"?)"));
  EXPECT_THAT(run({"help", "--markdown"}).out, AllOf(HasSubstr("## torus"), HasSubstr("| `gauss_points` |")));
}

}  // namespace
}  // namespace isorim::testing
