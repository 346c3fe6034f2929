#include "io/iges/nurbs_records.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "geometry/shapes/curves.h"
#include "geometry/shapes/solids.h"
#include "io/iges/file.h"
#include "io/iges/free_format.h"
#include "io/iges/parameters.h"
#include "tests/geometry/expect_error.h"
#include "tests/geometry/random_splines.h"
#include "tests/io/iges/entities.h"

namespace isorim::io::iges {
namespace {

using geometry::Direction;
using geometry::KnotVector;
using geometry::NurbsCurve;
using geometry::NurbsSurface;
using geometry::Points;

/// One entity as a file.
File file_of(int type, const Record& record) {
  EntityList entities;
  entities.add(type, record);
  return parse(entities.file_text("test", global_record()), "test.igs");
}

TEST(IgesEntityList, RealsAreShortAndComeBackBitForBit) {
  EXPECT_EQ(real_text(0.0), "0.");
  EXPECT_EQ(real_text(-0.0), "-0.");
  EXPECT_EQ(real_text(1.0), "1.");
  EXPECT_EQ(real_text(0.1), "0.1");
  EXPECT_EQ(real_text(-2.5), "-2.5");
  EXPECT_EQ(real_text(1e22), "1.E+22");
  EXPECT_EQ(real_text(1.5e-7), "1.5E-07");
  std::mt19937_64 random(3);
  for (int i = 0; i < 50000; ++i) {
    double value = 0.0;
    const std::uint64_t bits = random();
    std::memcpy(&value, &bits, sizeof value);
    if (!std::isfinite(value)) continue;
    const std::string text = real_text(value);
    ASSERT_NE(text.find('.'), std::string::npos) << text;
    ASSERT_LE(text.size(), 25U) << text;
    ASSERT_EQ(parse_real(text), value) << text;
  }
}

TEST(IgesEntityList, StringsMayCrossLinesAndNumbersMayNot) {
  for (std::size_t length = 1; length < 200; ++length) {
    Record record = EntityList::parameters(406);
    const std::string name(length, 'n');
    record.integer(1).text(name).real(1.0 / 3.0).text(name).real(-1.0 / 3.0);
    const File file = file_of(406, record);
    ASSERT_EQ(file.warnings, std::vector<std::string>{}) << length;
    Parameters parameters(file, file.entities[0]);
    parameters.skip();
    ASSERT_EQ(parameters.text(), name);
    ASSERT_EQ(parameters.real(), 1.0 / 3.0);
    ASSERT_EQ(parameters.text(), name);
    ASSERT_EQ(parameters.real(), -1.0 / 3.0);
    ASSERT_EQ(parameters.remaining(), 0);
  }
}

TEST(IgesNurbsRecords, CoordinatesMultiplyBackToTheSameBitsWhereADoubleDoes) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int i = 0; i < 200000; ++i) {
    const double weight = std::exp(5.0 * uniform(random));
    const double coordinate = std::exp(20.0 * uniform(random)) * uniform(random);
    const double product = weight * coordinate;
    ASSERT_EQ(weight * cartesian_coordinate(product, weight), product);
  }
  EXPECT_EQ(cartesian_coordinate(0.0, 3.0), 0.0);
}

TEST(IgesNurbsRecords, OtherProductsComeBackWithinOneUnitInTheLastPlace) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(1.0, 2.0);
  int missed = 0;
  for (int i = 0; i < 100000; ++i) {
    const double weight = uniform(random);
    const double product = uniform(random);
    const double back = weight * cartesian_coordinate(product, weight);
    ASSERT_LE(std::abs(back - product), std::numeric_limits<double>::epsilon());
    // Once written and read it stays.
    ASSERT_EQ(weight * cartesian_coordinate(back, weight), back);
    missed += back != product ? 1 : 0;
    ASSERT_EQ(2.0 * cartesian_coordinate(product, 2.0), product);
    ASSERT_EQ(0.125 * cartesian_coordinate(product, 0.125), product);
  }
  // Where the doubles are sparser than the products. If none were missed, the header would promise too little.
  EXPECT_GT(missed, 0);
  EXPECT_LT(missed, 40000);
  EXPECT_GEOMETRY_ERROR(cartesian_coordinate(1e300, 1e-100), "too far away for a file");
}

TEST(IgesNurbsRecords, SurfacesComeBackBitForBit) {
  geometry::testing::Random random(11);
  for (int i = 0; i < 50; ++i) {
    const KnotVector u = geometry::testing::random_knots(random, random.integer(1, 5));
    const KnotVector v = geometry::testing::random_knots(random, random.integer(1, 5));
    const NurbsSurface<3> surface = geometry::testing::random_surface<3>(random, u, v);
    const File file = file_of(128, surface_record(surface));
    EXPECT_EQ(file.warnings, std::vector<std::string>{});
    expect_same_bits(surface_of_128(file, file.entities[0]), surface);
  }
}

TEST(IgesNurbsRecords, CurvesComeBackBitForBit) {
  geometry::testing::Random random(12);
  for (int i = 0; i < 50; ++i) {
    const KnotVector knots = geometry::testing::random_knots(random, random.integer(1, 7));
    const NurbsCurve<3> curve = geometry::testing::random_curve<3>(random, knots);
    const File file = file_of(126, curve_record(curve));
    expect_same_bits(curve_of_126<3>(file, file.entities[0]), curve);
    const NurbsCurve<2> pcurve = geometry::testing::random_curve<2>(random, knots);
    const File plane = file_of(126, curve_record(pcurve));
    expect_same_bits(curve_of_126<2>(plane, plane.entities[0]), pcurve);
  }
}

TEST(IgesNurbsRecords, UnclampedKnotsKeepTheirRange) {
  const KnotVector knots(2, {0.0, 0.1, 0.3, 0.4, 0.7, 0.9, 1.0});
  Points<2> points(2, 4);
  points << 0.0, 1.0, 2.0, 3.0, 0.0, 1.0, -1.0, 0.0;
  const File file = file_of(126, curve_record(NurbsCurve<2>::from_points(knots, points)));
  expect_same_bits(curve_of_126<2>(file, file.entities[0]).knots(), knots);
  Parameters parameters(file, file.entities[0]);
  parameters.skip(6 + 7 + 4 + 12);
  EXPECT_EQ(parameters.real(), 0.3);
  EXPECT_EQ(parameters.real(), 0.7);
}

struct CurveFlags {
  int planar;
  int closed;
  int polynomial;
  friend bool operator==(const CurveFlags&, const CurveFlags&) = default;
};

template <int Dim>
CurveFlags flags_of(const NurbsCurve<Dim>& curve) {
  const File file = file_of(126, curve_record(curve));
  Parameters parameters(file, file.entities[0]);
  parameters.skip(2);
  const int planar = parameters.integer();
  const int closed = parameters.integer();
  const int polynomial = parameters.integer();
  return {planar, closed, polynomial};
}

NurbsCurve<3> space_curve(const std::vector<geometry::Point3>& points) {
  Points<3> columns(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) columns.col(static_cast<Eigen::Index>(i)) = points[i];
  return NurbsCurve<3>::from_points(KnotVector::bezier(static_cast<int>(points.size()) - 1), columns);
}

TEST(IgesNurbsRecords, FlagsOfCurvesSayWhatIs) {
  EXPECT_EQ(flags_of(geometry::circle_curve(1.0)), (CurveFlags{1, 1, 0}));
  EXPECT_EQ(flags_of(embed(geometry::circle_curve(1.0))), (CurveFlags{1, 1, 0}));
  EXPECT_EQ(flags_of(space_curve({{0, 0, 0}, {1, 2, 3}})), (CurveFlags{1, 0, 1}));
  EXPECT_EQ(flags_of(space_curve({{0, 0, 0}, {1, 2, 3}, {2, 0, 1}})), (CurveFlags{1, 0, 1}));
  EXPECT_EQ(flags_of(space_curve({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 1}})), (CurveFlags{0, 0, 1}));
  EXPECT_EQ(flags_of(space_curve({{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 0, 1}})), (CurveFlags{1, 1, 1}));
}

TEST(IgesNurbsRecords, ThePlaneOfACurveIsItsOwn) {
  const NurbsCurve<3> curve = space_curve({{0, 0, 1}, {0, 2, 1}, {0, 1, 5}, {0, -7, 2}});
  const File file = file_of(126, curve_record(curve));
  Parameters parameters(file, file.entities[0]);
  parameters.skip(parameters.remaining() - 3);
  EXPECT_EQ(std::abs(parameters.real()), 1.0);
  EXPECT_EQ(parameters.real(), 0.0);
  EXPECT_EQ(parameters.real(), 0.0);
}

TEST(IgesNurbsRecords, FlagsOfSurfacesSayWhatIs) {
  const auto flags = [](const geometry::SurfaceShape& shape) {
    const File file = file_of(128, surface_record(surface_of(shape)));
    Parameters parameters(file, file.entities[0]);
    parameters.skip(4);
    std::vector<int> values;
    for (int i = 0; i < 3; ++i) values.push_back(parameters.integer());
    return values;
  };
  EXPECT_EQ(flags(geometry::torus(2.0, 0.5).patches[0].shape), (std::vector<int>{1, 1, 0}));
  const std::vector<int> sphere = flags(geometry::sphere(1.0).patches[0].shape);
  EXPECT_EQ(std::count(sphere.begin(), sphere.end(), 1), 1);
  EXPECT_EQ(sphere[2], 0);
  EXPECT_EQ(flags(geometry::cube(1.0).patches[0].shape), (std::vector<int>{0, 0, 1}));
}

}  // namespace
}  // namespace isorim::io::iges
