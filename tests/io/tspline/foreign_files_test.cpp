#include <filesystem>
#include <ostream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "io/cad/read_cad.h"
#include "io/iges/reader.h"
#include "io/iges/writer.h"
#include "io/results/compute.h"
#include "io/tspline/iga.h"
#include "tests/io/tspline/expect_same.h"
#include "tests/io/tspline/t_spline_cases.h"

/// Files of other programs; the values are those of an independent program (README beside the files).
namespace isorim::io {
namespace {

using geometry::ExtractedSurface;
using geometry::OrientedBoundary;

struct ForeignFile {
  const char* name;
  int elements;
  int functions;
  bool closed;
  double area;
  double volume;
  /// Relative, of both: the digits that are known.
  double rtol;
  double partition_defect;
  /// The elements look inwards.
  bool turned;

  friend std::ostream& operator<<(std::ostream& out, const ForeignFile& file) { return out << file.name; }
};

const ForeignFile foreign_files[] = {
    {"pagliosa_beam.be", 224, 226, true, 4200.0, 10000.0, 1e-12, 1e-6, false},
    {"pagliosa_cylinder96.be", 96, 96, true, 42.3829, 9.41327, 2e-6, 1e-6, false},
    {"pagliosa_tee.be", 682, 728, true, 0.0, 1885.48, 5e-6, 2e-2, true},
    {"msolve_cantilever_shell.iga", 21, 60, false, 50.0, 0.0, 1e-14, 0.0, false},
    {"msolve_cylinder.iga", 84, 120, false, 0.0, 0.0, 0.0, 0.0, false},
};

class ForeignTSplines : public ::testing::TestWithParam<ForeignFile> {
 protected:
  void SetUp() override {
    if (!std::filesystem::is_directory(t_spline_cases())) GTEST_SKIP() << t_spline_cases() << " is not there";
  }
  static CaseFile read(const std::string& name) { return read_case_or_cad(t_spline_cases() / name); }
};

const ExtractedSurface& surface_of(const OrientedBoundary<3>& oriented) {
  return std::get<ExtractedSurface>(oriented.boundary.patches[0].shape);
}

TEST_P(ForeignTSplines, HaveTheKnownValues) {
  const ForeignFile& expected = GetParam();
  const CaseFile file = read(expected.name);
  const AnyModel model = build_model(file);
  const OrientedBoundary<3>& oriented = std::get<Model<3>>(model).oriented;
  ASSERT_EQ(oriented.boundary.patches.size(), 1u);
  EXPECT_EQ(surface_of(oriented).elements().size(), static_cast<std::size_t>(expected.elements));
  EXPECT_EQ(surface_of(oriented).function_count(), expected.functions);
  EXPECT_EQ(oriented.topology.closed, expected.closed);
  EXPECT_EQ(oriented.boundary.patches[0].orientation, expected.turned ? -1 : 1);
  const Report report = compute(file, model);
  EXPECT_NEAR(report.geometry.partition_defect, expected.partition_defect, 1e-8);
  const double area = report.find("area")->value.values.at(0);
  if (expected.area > 0.0) {
    EXPECT_NEAR(area, expected.area, expected.rtol * expected.area);
  }
  const Quantity& volume = *report.find("volume");
  ASSERT_EQ(volume.value.values.empty(), !expected.closed);
  if (expected.closed) {
    EXPECT_NEAR(volume.value.values[0], expected.volume, expected.rtol * expected.volume);
  }
}

TEST_P(ForeignTSplines, GoThroughIgaAndIgesBitForBit) {
  const CaseFile file = read(GetParam().name);
  const AnyModel model = build_model(file);
  const OrientedBoundary<3>& oriented = std::get<Model<3>>(model).oriented;
  tspline::ExtractionData data = tspline::parse_iga(tspline::iga_text(surface_of(oriented)));
  tspline::expect_same_bits(ExtractedSurface(data.points, data.elements), surface_of(oriented));
  const CadModel written = read_iges(iges::parse(iges::iges_text(oriented).text, "written.igs"));
  EXPECT_THAT(written.warnings, ::testing::IsEmpty());
  ASSERT_EQ(written.t_splines.size(), 1u);
  tspline::expect_same_bits(written.t_splines[0].surface, surface_of(oriented));
}

INSTANTIATE_TEST_SUITE_P(Files, ForeignTSplines, ::testing::ValuesIn(foreign_files), [](const auto& one) {
  const std::string name = one.param.name;
  return name.substr(0, name.find('.'));
});

class OtherForeignTSplines : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::is_directory(t_spline_cases())) GTEST_SKIP() << t_spline_cases() << " is not there";
  }
};

TEST_F(OtherForeignTSplines, TheRimsOfATubeAreFree) {
  const CaseFile file = read_case_or_cad(t_spline_cases() / "msolve_cylinder.iga");
  EXPECT_EQ(summarise(build_model(file)).free_edges, 24);
}

TEST_F(OtherForeignTSplines, GapsAtHangingEdgesAreMeasured) {
  const CaseFile file = read_case_or_cad(t_spline_cases() / "pagliosa_tee.be");
  const AnyModel model = build_model(file);
  const auto& topology = std::get<Model<3>>(model).oriented.topology;
  // Sides of elements that face two others.
  EXPECT_EQ(2 * topology.edges.size() - 4u * 682u, 48u);
  EXPECT_GT(topology.largest_gap, 1e-6);
  EXPECT_LT(topology.largest_gap, 5e-5 * 38.0);
}

TEST_F(OtherForeignTSplines, BextCurvesAreCurves) {
  const CadModel model = read_cad(t_spline_cases() / "coreformiga_p2_4elem_curve_bext.json");
  ASSERT_EQ(model.curves.size(), 4u);
  EXPECT_NEAR(evaluate(model.curves[0].curve, 0.0).x(), -3.14159, 1e-12);
  EXPECT_NEAR(evaluate(model.curves[3].curve, 1.0).x(), 3.14159, 1e-12);
  for (std::size_t i = 1; i < 4; ++i)
    EXPECT_LE((evaluate(model.curves[i - 1].curve, 1.0) - evaluate(model.curves[i].curve, 0.0)).norm(), 1e-15);
}

}  // namespace
}  // namespace isorim::io
