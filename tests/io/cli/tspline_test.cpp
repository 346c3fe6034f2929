#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/io/cli/program_test.h"

/// What the program writes for T-splines beside the results.
namespace isorim::testing {
namespace {

using ::testing::HasSubstr;

class TSplineCase : public ProgramTest {};

const std::string cylinder =
    "[geometry]\ntype = 'tspline'\nrefine = { where = 'x > 0' }\n"
    "from = { type = 'cylinder', radius = 1, height = 2, name = 'my can' }\n";

TEST_F(TSplineCase, DrawsTheMeshOfEachPatch) {
  const ProgramResult result = run_case(cylinder);
  ASSERT_EQ(result.status, 0) << result.err;
  for (const char* patch : {"side", "bottom", "top"}) {
    const std::string text = read_file(folder() / "out" / ("tmesh_my_can_" + std::string(patch) + ".svg"));
    EXPECT_THAT(text, HasSubstr("T-mesh of my can_" + std::string(patch)));
    EXPECT_THAT(text, HasSubstr("T-junction"));
  }
}

TEST_F(TSplineCase, DrawsNothingOfWhatIsCutOrNotAsked) {
  EXPECT_EQ(run_case(cylinder + "clip = { normal = [0, 0, 1], point = [0, 0, 1] }\n").status, 0);
  EXPECT_EQ(run_case(cylinder + "[output]\nsvg = false\n").status, 0);
  for (const auto& entry : std::filesystem::directory_iterator(folder() / "out"))
    EXPECT_NE(entry.path().extension(), ".svg") << entry.path();
}

TEST_F(TSplineCase, PatchesOfSimilarNamesHaveADrawingEach) {
  const std::string plane = "{ type = 'tspline', from = { type = 'disc', radius = 1, centre = [0, 0, ";
  const ProgramResult result = run_case("[geometry]\ntype = 'patches'\npatches = [" + plane + "0] }, name = 'a b' }, " +
                                        plane + "1] }, name = 'a_b' }, " + plane + "2] }, name = 'a.b' }]\n");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(read_file(folder() / "out/tmesh_a_b.svg"), HasSubstr("T-mesh of a b"));
  EXPECT_THAT(read_file(folder() / "out/tmesh_a_b_2.svg"), HasSubstr("T-mesh of a_b"));
  EXPECT_THAT(read_file(folder() / "out/tmesh_a_b_3.svg"), HasSubstr("T-mesh of a.b"));
}

TEST_F(TSplineCase, NamesPatchesInListsByTheirPlace) {
  const ProgramResult result = run_case(
      "[geometry]\ntype = 'patches'\npatches = [{ type = 'disc', radius = 1 }, { type = 'tspline', from = { type = "
      "'disc', radius = 1, centre = [0, 0, 1] } }]\n");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(std::filesystem::exists(folder() / "out/tmesh_patch_2.svg"));
  EXPECT_FALSE(std::filesystem::exists(folder() / "out/tmesh_patch_1.svg"));
}

}  // namespace
}  // namespace isorim::testing
