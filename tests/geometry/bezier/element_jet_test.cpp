#include "geometry/bezier/element_jet.h"

#include <cmath>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "geometry/shapes/regions.h"
#include "geometry/shapes/solids.h"

namespace isorim::geometry {
namespace {

double binomial(int n, int k) {
  double result = 1.0;
  for (int i = 1; i <= k; ++i) result *= static_cast<double>(n - k + i) / i;
  return result;
}

TEST(BernsteinJet, ValuesAndDerivativesAreThoseOfTheFormula) {
  for (const int p : {1, 2, 5, 12, 30})
    for (const double s : {0.0, 0.125, 0.6, 1.0}) {
      const BernsteinJet jet = bernstein_jet(p, s);
      const auto value = [s](int n, int i) {
        return i < 0 || i > n ? 0.0 : binomial(n, i) * std::pow(s, i) * std::pow(1.0 - s, n - i);
      };
      for (int i = 0; i <= p; ++i) {
        EXPECT_NEAR(jet.values[static_cast<std::size_t>(i)], value(p, i), 2e-15);
        EXPECT_NEAR(jet.derivatives[static_cast<std::size_t>(i)], p * (value(p - 1, i - 1) - value(p - 1, i)), 2e-13);
      }
    }
}

TEST(ElementJet, AgreesWithTheSurface) {
  Boundary<3> boundary = torus(2.0, 0.5, Point3(1.0, 2.0, 3.0));
  boundary.patches[0].orientation = -1;
  const NurbsSurface<3>& surface = surface_of(boundary.patches[0].shape);
  const ElementTable<3> table = bezier_elements(boundary);
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (const BezierElement<3>& element : table.elements) {
    const Point2 place(uniform(generator), uniform(generator));
    const Vector2 lengths(element.domain[0].length(), element.domain[1].length());
    const Point2 uv(element.domain[0].first + place.x() * lengths.x(),
                    element.domain[1].first + place.y() * lengths.y());
    const auto jet = evaluate_jet<3>(table, element, place);
    const SurfaceJet<3> expected = evaluate_jet(surface, uv);
    EXPECT_LT((jet.position - expected.point).norm(), 1e-14);
    EXPECT_LT((jet.tangents.col(0) - expected.du * lengths.x()).norm(), 1e-13);
    EXPECT_LT((jet.tangents.col(1) - expected.dv * lengths.y()).norm(), 1e-13);
    EXPECT_LT((jet.normal() + expected.du.cross(expected.dv).normalized()).norm(), 1e-14);
  }
}

TEST(ElementJet, NormalOfADiscPointsOutwardWithTheSpeedAsItsJacobian) {
  const ElementTable<2> table = bezier_elements(disc(2.0));
  for (const BezierElement<2>& element : table.elements) {
    const auto jet = evaluate_jet<2>(table, element, Point<1>(0.3));
    EXPECT_LT((jet.normal() - 0.5 * jet.position).norm(), 1e-15);
    EXPECT_NEAR(jet.area_vector.norm(), jet.tangents.norm(), 1e-15);
  }
}

TEST(ElementJet, NormalVanishesAtAPole) {
  const ElementTable<3> table = bezier_elements(sphere(1.0));
  EXPECT_EQ(evaluate_jet<3>(table, table.elements[0], Point2(0.5, 0.0)).normal(), Vector3::Zero());
}

}  // namespace
}  // namespace isorim::geometry
