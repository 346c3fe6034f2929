#include "geometry/topology/enclosed_volume.h"

#include <cmath>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/topology/orientation.h"
#include "tests/geometry/topology/trimmed_solids.h"

namespace isorim::geometry {
namespace {

using namespace testing;

std::vector<SurfacePiece> pieces_of(const ElementTable<3>& table, int sign = 1) {
  std::vector<SurfacePiece> pieces;
  for (const BezierElement<3>& element : table.elements) pieces.push_back(surface_piece(table, element, sign));
  return pieces;
}

TEST(WindingNumber, TellsInsideFromOutsideOfTrimmedSolids) {
  Random random(2);
  const Boundary<3> solid = orient(holed_box(0.4)).boundary;
  const ElementTable<3> table = bezier_elements(solid);
  const std::vector<SurfacePiece> shell = pieces_of(table);
  int near = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const Point3 point(random.real(-1.3, 1.3), random.real(-1.3, 1.3), random.real(-0.3, 1.3));
    const double radius = point.head<2>().norm();
    const double side = point.head<2>().cwiseAbs().maxCoeff();
    const bool inside = radius > 0.5 && side < 1.0 && point.z() > 0.0 && point.z() < 1.0;
    const double clearance =
        std::min({std::abs(radius - 0.5), std::abs(side - 1.0), std::abs(point.z()), std::abs(point.z() - 1.0)});
    if (clearance < 0.02) {
      ++near;
      continue;
    }
    EXPECT_EQ(winding_number(shell, point, 1e-6), inside ? 1 : 0) << point.transpose();
  }
  EXPECT_LT(near, 100);
  EXPECT_EQ(winding_number(shell, Point3(0.75, 0.3, 1.0), 1e-6), std::nullopt);
  // In the middle of what was cut away.
  EXPECT_EQ(winding_number(shell, Point3(0.0, 0.0, 1.0), 1e-6), 0);
  EXPECT_EQ(winding_number(shell, Point3(0.1, 0.2, 0.5), 1e-6), 0);
}

TEST(VolumeSign, IsThatOfTheNormals) {
  const ElementTable<3> table = bezier_elements(orient(holed_box()).boundary);
  EXPECT_EQ(volume_sign(pieces_of(table)), 1);
  EXPECT_EQ(volume_sign(pieces_of(table, -1)), -1);
}

/// Between z = 0 and a bump of the given height over the unit square, far from the origin.
ElementTable<3> thin_lens(double height) {
  const KnotVector knots = KnotVector::bezier(2);
  Points<3> flat(3, 9);
  Points<3> bump(3, 9);
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      flat.col(i + 3 * j) << 0.5 * i, 0.5 * j, 0.0;
      bump.col(i + 3 * j) << 0.5 * i, 0.5 * j, i == 1 && j == 1 ? height : 0.0;
    }
  }
  Boundary<3> lens;
  lens.patches.push_back({"flat", NurbsSurface<3>::from_points(knots, knots, flat), -1});
  lens.patches.push_back({"bump", NurbsSurface<3>::from_points(knots, knots, bump), 1});
  return bezier_elements(lens);
}

TEST(VolumeSign, SeesThinShells) {
  for (const double height : {1e-2, 1e-6, 1e-10}) {
    EXPECT_EQ(volume_sign(pieces_of(thin_lens(height))), 1) << height;
    EXPECT_EQ(volume_sign(pieces_of(thin_lens(-height))), -1) << height;
  }
  EXPECT_EQ(volume_sign(pieces_of(thin_lens(0.0))), std::nullopt);
}

}  // namespace
}  // namespace isorim::geometry
