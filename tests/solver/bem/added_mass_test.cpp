#include "solver/bem/added_mass.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "geometry/shapes/solids.h"
#include "tests/solver/hydrostatics/wigley.h"

namespace isorim::solver {
namespace {

using geometry::Point3;
using geometry::Vector3;
using std::numbers::pi;

AddedMassOptions options_of(int degree, int refine) {
  AddedMassOptions options;
  options.discretisation.degree = degree;
  options.discretisation.refine = refine;
  options.solve.tolerance = 1e-8;
  return options;
}

// physical_references.toml: Lamb, Hydrodynamics, articles 114 and 115, added over displaced mass and inertia.
TEST(AddedMass, OfAnEllipsoidIsLambs) {
  const Vector3 d(3.0, 2.0, 1.0);
  const AddedMass found = added_mass(geometry::orient(geometry::ellipsoid(d)), options_of(3, 1));
  const double mass = 4.0 / 3.0 * pi * d.prod();
  const double k[6] = {0.1852564042809872, 0.3645432395608983, 1.361527473150915,
                       0.3832672904125120, 0.7082361248165249, 0.05990028090901212};
  const double inertia[6] = {
      mass, mass, mass, mass / 5.0 * (4.0 + 1.0), mass / 5.0 * (9.0 + 1.0), mass / 5.0 * (9.0 + 4.0)};
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      EXPECT_NEAR(found.matrix(i, j), i == j ? k[i] * inertia[i] : 0.0, (i < 3 && j < 3 ? 1e-10 : 1e-3) * mass)
          << i << ", " << j;
  EXPECT_LT(found.asymmetry, 2e-4 * mass);
}

TEST(AddedMass, AboutAnotherPointMovesLikeAnInertia) {
  const auto sphere = geometry::orient(geometry::sphere(1.0, {0.5, 0.0, 0.0}));
  const AddedMass found = added_mass(sphere, options_of(2, 1));
  // A sphere of added mass m at (1/2, 0, 0): turns about y and z move it.
  const double m = 2.0 / 3.0 * pi;
  EXPECT_NEAR(found.matrix(4, 4), 0.25 * m, 1e-9 * m);
  EXPECT_NEAR(found.matrix(1, 5), 0.5 * m, 1e-9 * m);
  EXPECT_NEAR(found.matrix(2, 4), -0.5 * m, 1e-9 * m);
  EXPECT_NEAR(found.matrix(3, 3), 0.0, 1e-9 * m);
}

TEST(DoubleBodies, AreClosedAndTwiceTheVolume) {
  const geometry::Boundary<3> hull = solver::testing::wigley_hull();
  const geometry::OrientedBoundary<3> whole = geometry::orient(double_body(hull, 0.0));
  EXPECT_TRUE(whole.topology.closed);
  EXPECT_EQ(whole.boundary.patches.size(), 4U);
  const geometry::OrientedBoundary<3> shallow = geometry::orient(double_body(hull, -0.2));
  EXPECT_TRUE(shallow.topology.closed);
  EXPECT_TRUE(geometry::orient(double_body(geometry::sphere(1.0), 0.3)).topology.closed);
}

// physical_references.toml: constant sources on flat quadrilaterals, extrapolated; surge 0.02150, sway 1.761, heave
// 0.6551 times the displaced mass, to 2e-5, 1e-3 and 2e-4. Around the sharp ends the potential in sway has a root's
// singularity, which uniform refinement resolves to first order; so it is extrapolated.
TEST(AddedMass, OfTheWigleyDoubleBody) {
  const auto body = geometry::orient(double_body(solver::testing::wigley_hull(), 0.0));
  const AddedMass coarse = added_mass(body, options_of(3, 1));
  const AddedMass fine = added_mass(body, options_of(3, 2));
  const double mass = 2.0 * 4.0 / 9.0 * 10.0 * 0.625;
  EXPECT_NEAR(fine.matrix(0, 0) / mass, 0.02150, 6e-5);
  EXPECT_NEAR((2.0 * fine.matrix(1, 1) - coarse.matrix(1, 1)) / mass, 1.761, 1e-2);
  EXPECT_NEAR(fine.matrix(2, 2) / mass, 0.6551, 2e-4);
}

}  // namespace
}  // namespace isorim::solver
