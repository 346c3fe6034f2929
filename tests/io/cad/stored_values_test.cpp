#include <filesystem>
#include <ostream>
#include <string>

#include <gtest/gtest.h>

#include "io/results/compute.h"

namespace isorim::io {
namespace {

/// What a file stores, as opposed to the ideal shape that it approximates: the volume by 20-point Gauss rules along the
/// parameter curves of the file with the pole at the origin, computed by a program of its own (cases/cad/README.md).
struct StoredVolume {
  const char* name;
  double volume;

  friend std::ostream& operator<<(std::ostream& out, const StoredVolume& stored) { return out << stored.name; }
};

class CadFile : public ::testing::TestWithParam<StoredVolume> {};

TEST_P(CadFile, HasTheVolumeThatItStores) {
  const std::filesystem::path folder = std::filesystem::path(ISORIM_SOURCE_DIR) / "cases/cad";
  const CaseFile file =
      read_case_or_cad(folder / (std::string(GetParam().name) + ".igs"), {"properties.pole=[0, 0, 0]"});
  const Report report = compute(file, build_model(file));
  const Quantity* volume = report.find("volume");
  ASSERT_NE(volume, nullptr);
  ASSERT_EQ(volume->value.values.size(), 1U) << volume->reason;
  EXPECT_NEAR(volume->value.values[0], GetParam().volume, 1e-12 * GetParam().volume);
}

constexpr StoredVolume stored_volumes[] = {
    {"sphere_analytic_faces_p17", 4.18879020478639},
    {"sphere_analytic_faces", 4.18879020466666},
    {"sphere_nurbs_faces_p17", 4.18879020478639},
    {"sphere_nurbs_faces", 4.18879020654241},
    {"torus_analytic_faces_p17", 4.93480220054467},
    {"torus_analytic_faces", 4.93480219998049},
    {"torus_nurbs_faces_p17", 4.93480220054467},
    {"torus_nurbs_faces", 4.93480220215209},
    {"ellipsoid_nurbs_faces_p17", 8.37758040957278},
    {"ellipsoid_nurbs_faces", 8.37758041213922},
    {"cube_blind_hole_nurbs_faces_p17", 0.875},
    {"cube_blind_hole_nurbs_faces", 0.875},
    {"box_cyl_hole_nurbs_faces_p17", 3.21460183660255},
    {"box_cyl_hole_nurbs_faces", 3.21460183640706},
    {"cyl_oblique_nurbs_faces_p17", 6.28318530703547},
    {"cyl_oblique_nurbs_faces", 6.28318530806664},
    {"steinmetz_analytic_faces_p17", 5.33333332644607},
    {"steinmetz_analytic_faces", 5.3333333280123},
    {"steinmetz_nurbs_faces_p17", 5.33333329625242},
    {"steinmetz_nurbs_faces", 5.33333329643134},
    {"napkin_ring_analytic_faces_p17", 2.14466058485063},
    {"napkin_ring_analytic_faces", 2.14466058478528},
    {"napkin_ring_nurbs_faces_p17", 2.14466058485057},
    {"napkin_ring_nurbs_faces", 2.14466058487111},
    {"viviani_analytic_faces_p17", 1.20550619645928},
    {"viviani_analytic_faces", 1.20550619644756},
    {"viviani_nurbs_faces_p17", 1.20550620641243},
    {"viviani_nurbs_faces", 1.20550620637785},
    {"viviani_cut_analytic_faces_p17", 2.98328400832711},
    {"viviani_cut_analytic_faces", 2.9832840082257},
    {"viviani_cut_nurbs_faces_p17", 2.98328412137278},
    {"viviani_cut_nurbs_faces", 2.98328412241698},
    {"sphere_offset_hole_analytic_faces_p17", 3.27582687618227},
    {"sphere_offset_hole_analytic_faces", 3.27582687503379},
    {"sphere_offset_hole_nurbs_faces_p17", 3.27582687666359},
    {"sphere_offset_hole_nurbs_faces", 3.27582687670019},
    {"vase_nurbs_faces_p17", 6.5003165104592},
    {"vase_nurbs_faces", 6.50031651045271},
};

INSTANTIATE_TEST_SUITE_P(Faces, CadFile, ::testing::ValuesIn(stored_volumes),
                         [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace isorim::io
