#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "io/case/value.h"
#include "io/results/compute.h"
#include "tests/io/cad/real_cases.h"

namespace isorim::io {
namespace {

/// In millimetres, whatever the file's unit.
CaseFile read_in_millimetres(const std::string& name) {
  return read_case_or_cad(real_cases() / (name + ".igs"), {"geometry.units=mm"});
}

struct RealFile {
  const char* name;
  int faces;
  double area;
  double area_rtol;
  double volume;
  double volume_rtol;
  std::vector<double> centroid;
  double centroid_atol;

  friend std::ostream& operator<<(std::ostream& out, const RealFile& file) { return out << file.name; }
};

class RealFiles : public ::testing::TestWithParam<RealFile> {
 protected:
  void SetUp() override {
    if (!std::filesystem::is_directory(real_cases())) GTEST_SKIP() << real_cases() << " is not there";
  }
};

double entry(const Report& report, const char* quantity, std::size_t index = 0) {
  const Quantity* found = report.find(quantity);
  if (!found || found->value.values.size() <= index) {
    ADD_FAILURE() << quantity << " has no value: " << (found ? found->reason : "not there");
    return 0.0;
  }
  return found->value.values[index];
}

TEST_P(RealFiles, IsClosedAndHasTheKnownValues) {
  const RealFile& expected = GetParam();
  const CaseFile file = read_in_millimetres(expected.name);
  ASSERT_TRUE(file.cad);
  EXPECT_EQ(file.cad->faces, expected.faces);
  const AnyModel model = build_model(file);
  const GeometrySummary summary = summarise(model);
  EXPECT_EQ(summary.patches, expected.faces);
  EXPECT_TRUE(summary.closed) << summary.free_edges << " free edges";
  EXPECT_EQ(summary.shells, 1);
  const Report report = compute(file, model);
  EXPECT_NEAR(entry(report, "area"), expected.area, expected.area_rtol * expected.area);
  EXPECT_NEAR(entry(report, "volume"), expected.volume, expected.volume_rtol * expected.volume);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(entry(report, "centroid", i), expected.centroid[i], expected.centroid_atol) << "xyz"[i];
  }
}

const double pi = 3.14159265358979323846;

/// Values: closed forms for the pipes, else what two other programs agree on (shared/cases/real/README.md), to the
/// digits printed there or to what those programs reach. The pipes write their angles with ten digits.
const RealFile real_files[] = {
    {"igesio_rounded_cube", 7, 14581.52669, 1e-9, 122585.73162, 1e-10, {0.426376419, 0.0, -0.426376419}, 1e-7},
    {"poseidon_Pump_Cover_Slide", 16, 3102.65203, 1e-6, 5112.29168, 1e-6, {-5.10442356, 49.1156931, -5.5401762}, 1e-4},
    {"poseidon_Pump_Carriage", 111, 12987.4711, 1e-6, 48191.3307, 1e-6, {-90.43340, 36.41398, 0.51345}, 1e-4},
    {"poseidon_Scope_Base", 248, 104099.768, 1e-6, 432795.835, 1e-6, {-74.9055503, 15.8613246, -128.446899}, 1e-4},
    {"pygem_test_pipe", 4, 2.2e7 * pi, 1e-10, 1e10 * pi, 1e-10, {0.0, 0.0, 5000.0}, 1e-6},
    {"pygem_test_pipe_hollow", 6, 3.672e7 * pi, 1e-10, 0.36e10 * pi, 1e-10, {0.0, 0.0, 5000.0}, 1e-6},
    {"bladex_shaft", 7, 203637.423, 1e-6, 2279519.4, 1e-6, {-499.99188, 0.0, 0.0}, 1e-3},
    {"bladex_propeller_and_shaft", 22, 283808.60, 1e-5, 2449555.85, 1e-3, {-465.03, 0.0, 0.0}, 0.5},
    {"ext2mesh_piece", 15, 15330.47615, 1e-9, 76276.44090, 1e-9, {15.5767586, 20.0, 31.5573701}, 1e-6},
    {"ext2mesh_srfOfRev", 14, 84319.06752, 1e-9, 1417409.711, 1e-9, {0.0, 127.0, 0.0}, 1e-6},
};

INSTANTIATE_TEST_SUITE_P(Solids, RealFiles, ::testing::ValuesIn(real_files),
                         [](const auto& one) { return std::string(one.param.name); });

class OtherRealFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::is_directory(real_cases())) GTEST_SKIP() << real_cases() << " is not there";
  }
};

TEST_F(OtherRealFiles, AnOpenSurfaceHasItsAreaAlone) {
  const CaseFile file = read_in_millimetres("bladex_upper");
  const Report report = compute(file, build_model(file));
  EXPECT_FALSE(report.geometry.closed);
  EXPECT_NEAR(entry(report, "area"), 8289.20499, 1e-6 * 8289.20499);
  EXPECT_TRUE(report.find("volume")->value.values.empty());
  EXPECT_THAT(report.find("volume")->reason, ::testing::HasSubstr("open"));
}

TEST_F(OtherRealFiles, AFileOfPointsSaysWhatItHolds) {
  try {
    read_in_millimetres("pyiges_sample");
    FAIL() << "nothing was refused";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), ::testing::AllOf(::testing::HasSubstr("4 points"), ::testing::HasSubstr("116"),
                                               ::testing::HasSubstr("322")));
  }
}

}  // namespace
}  // namespace isorim::io
