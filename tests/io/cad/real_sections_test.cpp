#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "io/results/compute.h"
#include "solver/plane_sections.h"
#include "solver/properties.h"
#include "tests/io/cad/real_cases.h"

/// Plane sections of files by other people's CAD.
namespace isorim::io {
namespace {

class RealSections : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (!std::filesystem::is_directory(real_cases())) GTEST_SKIP() << real_cases() << " is not there";
  }
};

/// Every loop is closed, and the areas of oblique slices add up to the volume: they are continuous in the offset, so
/// the sum over equal slices is of second order.
TEST_P(RealSections, AreClosedAndAddUpToTheVolume) {
  const CaseFile file = read_case_or_cad(real_cases() / (std::string(GetParam()) + ".igs"), {});
  const AnyModel any = build_model(file);
  const auto& model = std::get<Model<3>>(any);
  const geometry::Boundary<3>& boundary = model.oriented.boundary;
  geometry::SectionOptions options;
  options.gap_tolerance =
      std::max(1e-6, 2.0 * model.oriented.topology.largest_gap / geometry::PlaneCutter(boundary).size());
  const geometry::PlaneCutter cutter(boundary, options);
  const geometry::Vector3 normal = geometry::Vector3(0.31, 0.52, 0.79).normalized();
  const geometry::BoundingBox<3> box = geometry::bounding_box(model.table);
  const double middle = normal.dot(box.middle());
  const double half = 0.5 * (box.upper - box.lower).dot(normal);
  std::array<double, 2> errors{};
  solver::PropertyOptions<3> how;
  how.integration.tolerance = 1e-9;
  const double volume = solver::geometric_properties<3>(model.table, how).domain->measure.value;
  const std::array<int, 2> counts{20, 80};
  for (std::size_t level = 0; level < 2; ++level) {
    const int n = counts[level];
    std::vector<geometry::PlaneFrame> planes;
    for (int k = 0; k < n; ++k)
      planes.push_back(geometry::plane_frame((middle + half * ((2.0 * k + 1.0) / n - 1.0)) * normal, normal));
    double sum = 0.0;
    for (const solver::MeasuredSection& measured :
         solver::measure_sections(cutter, planes, {.tolerance = 1e-9, .fit_tolerance = 0.0})) {
      ASSERT_TRUE(measured.section) << measured.failure;
      EXPECT_TRUE(measured.section->chains.empty());
      EXPECT_EQ(measured.section->shift, 0.0);
      EXPECT_LE(measured.section->largest_gap, 100.0 * options.gap_tolerance * cutter.size());
      sum += 2.0 * half / n * measured.area.value;
    }
    errors[level] = std::abs(sum / volume - 1.0);
  }
  EXPECT_LE(errors[1], 2e-3);
  EXPECT_LE(errors[1], std::max(0.3 * errors[0], 2e-4));
}

INSTANTIATE_TEST_SUITE_P(Files, RealSections,
                         ::testing::Values("ext2mesh_piece", "igesio_rounded_cube", "poseidon_Pump_Carriage",
                                           "poseidon_Pump_Cover_Slide", "poseidon_Scope_Base",
                                           "pygem_test_pipe_hollow"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace isorim::io
