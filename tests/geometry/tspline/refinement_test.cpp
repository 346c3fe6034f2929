#include "geometry/tspline/refinement.h"

#include <gtest/gtest.h>

#include "geometry/shapes/solids.h"
#include "tests/geometry/expect_error.h"
#include "tests/geometry/tspline/random_tmeshes.h"

namespace isorim::geometry {
namespace {

using testing::Ends;
using testing::Random;

/// The largest distance between two T-splines and between their derivatives over the latter's size, at random places.
double difference(Random& random, const TSpline& a, const TSpline& b, int places) {
  double largest = 0.0;
  for (int k = 0; k < places; ++k) {
    const Point2 uv = testing::random_parameters(random, a.mesh());
    const SurfaceJet<3> first = evaluate_jet(a, uv);
    const SurfaceJet<3> second = evaluate_jet(b, uv);
    largest =
        std::max({largest, (first.point - second.point).norm(), (first.du - second.du).norm() / (1.0 + first.du.norm()),
                  (first.dv - second.dv).norm() / (1.0 + first.dv.norm())});
  }
  return largest;
}

TEST(Refinement, LeavesTheSurfaceAndStaysSuitable) {
  Random random(11);
  int local = 0;
  for (int p = 1; p <= 4; ++p) {
    for (int q = 1; q <= 4; ++q) {
      for (int trial = 0; trial < 4; ++trial) {
        const Ends ends = trial % 2 == 0 ? Ends::clamped : Ends::unclamped;
        TSpline surface = testing::random_tspline(
            random, testing::random_suitable_tmesh(random, testing::random_knots(random, p, ends, p + 1),
                                                   testing::random_knots(random, q, ends, q + 1)));
        for (int level = 0; level < 3; ++level) {
          const TSpline fine = refine(surface, testing::random_cuts(random, surface.mesh(), 4));
          EXPECT_TRUE(is_analysis_suitable(fine.mesh()));
          EXPECT_LE(difference(random, surface, fine, 40), 1e-13) << p << ' ' << q << ' ' << trial;
          const int tensor =
              fine.mesh().knots(Direction::u).basis_count() * fine.mesh().knots(Direction::v).basis_count();
          local += fine.mesh().function_count() < tensor ? 1 : 0;
          surface = fine;
        }
      }
    }
  }
  EXPECT_GE(local, 100);
}

TEST(Refinement, OfACornerAddsAHandfulOfFunctions) {
  const KnotVector knots = KnotVector::clamped_uniform(3, 16);
  Random random(12);
  const TSpline coarse = testing::random_tspline(random, TMesh(knots, knots));
  TSpline fine = coarse;
  for (int level = 0; level < 4; ++level) {
    const std::vector<int> faces =
        faces_where(fine, [](const Point3&, const Point2& uv) { return uv[0] < 0.2 && uv[1] < 0.2; });
    fine = refine(fine, bisections(fine.mesh(), faces, Bisection::both));
  }
  EXPECT_LE(difference(random, coarse, fine, 100), 1e-13);
  // 3.2 of 16 spans are divided by 16: the corner alone needs some 64 x 64.
  EXPECT_GT(fine.mesh().function_count(), 19 * 19 + 48 * 48);
  EXPECT_LT(fine.mesh().function_count(), 19 * 19 + 70 * 70);
}

TEST(Refinement, OfASphereKeepsItRound) {
  const auto sphere = std::get<NurbsSurface<3>>(geometry::sphere(1.0, Point3::Zero()).patches.front().shape);
  TSpline surface(sphere);
  for (int level = 0; level < 3; ++level) {
    const std::vector<int> faces = faces_where(surface, [](const Point3& x, const Point2&) { return x.z() > 0.5; });
    surface = refine(surface, bisections(surface.mesh(), faces, Bisection::both));
  }
  EXPECT_FALSE(surface.mesh().index_mesh().t_junctions().empty());
  Random random(13);
  for (int k = 0; k < 200; ++k)
    EXPECT_NEAR(evaluate(surface, testing::random_parameters(random, surface.mesh())).norm(), 1.0, 1e-13);
}

TEST(Refinement, KeepsEqualWeightsEqual) {
  Random random(14);
  const KnotVector knots = KnotVector::clamped_uniform(2, 5);
  Points<3> points = Points<3>::Random(3, 49);
  const TSpline surface = TSpline::from_points(TMesh(knots, knots), points, std::vector<double>(49, 0.3));
  const TSpline fine = refine(surface, testing::random_cuts(random, surface.mesh(), 6));
  EXPECT_TRUE((fine.weights().array() == 0.3).all());
}

TEST(Refinement, RefusesCutsThatMissTheirFace) {
  const KnotVector knots = KnotVector::clamped_uniform(2, 2);
  const TMesh mesh(knots, knots);
  const std::vector<FaceCut> beyond{{4, Direction::u, 0.25}};
  EXPECT_GEOMETRY_ERROR(refine(mesh, beyond), "face 4 is to be cut; there are faces 0 to 3");
  const std::vector<FaceCut> outside{{0, Direction::v, 0.5}};
  EXPECT_GEOMETRY_ERROR(refine(mesh, outside), "face 0 is to be cut at v = 0.5; expected a value between 0 and 0.5");
}

}  // namespace
}  // namespace isorim::geometry
