#include "geometry/spline/bspline.h"

#include <gtest/gtest.h>

#include "tests/geometry/expect_error.h"
#include "tests/geometry/random_splines.h"

namespace isorim::geometry {
namespace {

using testing::Random;
using testing::random_knots;
using testing::random_spline;

constexpr int trials = 200;

/// Both splines agree over the domain of the second, at random parameters and just beside the breakpoints.
void expect_same(const BSpline& expected, const BSpline& actual, Random& random, double tolerance = 1e-13) {
  const double size = expected.coefficients.cwiseAbs().maxCoeff();
  std::vector<double> parameters = actual.knots.breakpoints();
  for (int i = 0; i < 20; ++i) parameters.push_back(random.inside(actual.knots.domain()));
  for (const double u : parameters) {
    if (u == actual.knots.domain().last && u != expected.knots.domain().last) continue;
    const Eigen::VectorXd a = testing::reference_value(expected, u, 0);
    const Eigen::VectorXd b = testing::reference_value(actual, u, 0);
    EXPECT_LE((a - b).cwiseAbs().maxCoeff(), tolerance * size) << "at u = " << u;
  }
}

TEST(BSpline, BasisIsAPartitionOfUnity) {
  Random random(10);
  for (int trial = 0; trial < trials; ++trial) {
    const KnotVector knots = random_knots(random, random.integer(1, 8));
    const double u = random.inside(knots.domain());
    const Eigen::MatrixXd table = basis_derivatives(knots, knots.find_span(u), u, 3);
    EXPECT_GE(table.row(0).minCoeff(), 0.0);
    EXPECT_NEAR(table.row(0).sum(), 1.0, 4e-15);
    for (int d = 1; d <= 3; ++d) EXPECT_LE(std::abs(table.row(d).sum()), 1e-13 * (1 + table.row(d).cwiseAbs().sum()));
  }
}

TEST(BSpline, DerivativesMatchTheTextbookRecurrence) {
  Random random(11);
  for (int trial = 0; trial < trials; ++trial) {
    const KnotVector knots = random_knots(random, random.integer(1, 8));
    const BSpline spline = random_spline(random, knots, 3);
    std::vector<double> parameters = knots.breakpoints();
    parameters.push_back(random.inside(knots.domain()));
    parameters.push_back(knots.domain().first - 0.01);
    for (const double u : parameters) {
      const int orders = knots.degree() + 1;
      const Eigen::MatrixXd actual = evaluate_derivatives(spline, u, orders);
      const Eigen::MatrixXd basis = basis_derivatives(knots, knots.find_span(u), u, orders);
      for (int d = 0; d <= orders; ++d) {
        const Eigen::VectorXd expected = testing::reference_value(spline, u, d);
        EXPECT_LE((actual.col(d) - expected).cwiseAbs().maxCoeff(), 1e-13 * basis.row(d).cwiseAbs().sum());
      }
    }
  }
}

TEST(BSpline, DerivativesMatchFiniteDifferences) {
  Random random(12);
  for (int trial = 0; trial < trials; ++trial) {
    const KnotVector knots = random_knots(random, random.integer(1, 8));
    const BSpline spline = random_spline(random, knots, 2);
    const int span = knots.find_span(random.inside(knots.domain()));
    const double width = knots[span + 1] - knots[span];
    const double u = knots[span] + width * random.real(0.2, 0.8);
    const double h = 1e-5 * width;
    const Eigen::VectorXd difference = (evaluate(spline, u + h) - evaluate(spline, u - h)) / (2 * h);
    const Eigen::MatrixXd basis = basis_derivatives(knots, span, u, 3);
    const double size = basis.row(3).cwiseAbs().sum() * h * h + 1e-14 / h;
    EXPECT_LE((evaluate_derivatives(spline, u, 1).col(1) - difference).cwiseAbs().maxCoeff(), size + 1e-12);
  }
}

TEST(BSpline, CornerCuttingAgreesWithTheBasisAndKeepsEqualCoefficients) {
  Random random(13);
  for (int trial = 0; trial < trials; ++trial) {
    const KnotVector knots = random_knots(random, random.integer(1, 8));
    BSpline spline = random_spline(random, knots, 2);
    spline.coefficients.row(1).setConstant(0.1);
    const double u = random.inside(knots.domain());
    const Eigen::VectorXd value = evaluate(spline, u);
    EXPECT_NEAR(value[0], testing::reference_value(spline, u, 0)[0], 1e-14);
    EXPECT_EQ(value[1], 0.1);
  }
}

TEST(BSpline, KnotRefinementChangesNothing) {
  Random random(14);
  for (int trial = 0; trial < trials; ++trial) {
    const KnotVector knots = random_knots(random, random.integer(1, 8));
    const BSpline spline = random_spline(random, knots, 3);
    std::vector<double> new_knots;
    const std::vector<double> breakpoints = knots.breakpoints();
    for (const double u : breakpoints)
      new_knots.insert(new_knots.end(),
                       static_cast<std::size_t>(random.integer(0, knots.degree() + 1 - knots.multiplicity(u))), u);
    for (int i = random.integer(0, 8); i > 0; --i)
      new_knots.insert(new_knots.end(), static_cast<std::size_t>(random.integer(1, knots.degree() + 1)),
                       random.inside(knots.domain()));
    std::sort(new_knots.begin(), new_knots.end());
    expect_same(spline, refine_knots(spline, new_knots), random);
  }
}

TEST(BSpline, RefiningAtOnceEqualsRefiningKnotByKnot) {
  Random random(15);
  for (int trial = 0; trial < trials; ++trial) {
    const KnotVector knots = random_knots(random, random.integer(1, 6));
    const BSpline spline = random_spline(random, knots, 2);
    std::vector<double> new_knots;
    for (int i = 0; i < 5; ++i) new_knots.push_back(random.inside(knots.domain()));
    std::sort(new_knots.begin(), new_knots.end());
    BSpline one_by_one = spline;
    for (const double u : new_knots) one_by_one = refine_knots(one_by_one, std::vector<double>{u});
    const BSpline at_once = refine_knots(spline, new_knots);
    EXPECT_EQ(at_once.knots, one_by_one.knots);
    EXPECT_LE((at_once.coefficients - one_by_one.coefficients).cwiseAbs().maxCoeff(), 1e-14);
  }
}

TEST(BSpline, RemovalUndoesInsertion) {
  Random random(16);
  for (int trial = 0; trial < trials; ++trial) {
    const KnotVector knots = random_knots(random, random.integer(1, 8));
    const BSpline spline = random_spline(random, knots, 3);
    const double u = random.inside(knots.domain());
    const int times = random.integer(1, knots.degree() + 1);
    const BSpline refined = refine_knots(spline, std::vector<double>(static_cast<std::size_t>(times), u));
    const KnotRemoval result = remove_knot(refined, u, times, 1e-9);
    EXPECT_EQ(result.removed, times);
    EXPECT_EQ(result.spline.knots, knots);
    EXPECT_LE(result.error_bound, 1e-9);
    expect_same(spline, result.spline, random, 1e-15 + 2 * result.error_bound);
  }
}

TEST(BSpline, RemovalStaysWithinItsBoundAndTolerance) {
  Random random(17);
  int removed = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const KnotVector knots = random_knots(random, random.integer(1, 6));
    const double knot = random.inside(knots.domain());
    BSpline spline = refine_knots(random_spline(random, knots, 2), std::vector<double>{knot, knot});
    for (double& c : spline.coefficients.reshaped()) c += random.real(-0.01, 0.01);
    const KnotRemoval result = remove_knot(spline, knot, 2, 0.03);
    removed += result.removed;
    EXPECT_LE(result.error_bound, 0.03);
    EXPECT_EQ(result.removed == 0, result.error_bound == 0.0);
    for (int i = 0; i < 20; ++i) {
      const double u = random.inside(knots.domain());
      EXPECT_LE((evaluate(spline, u) - evaluate(result.spline, u)).norm(), result.error_bound + 1e-14);
    }
  }
  EXPECT_GT(removed, trials / 2);
  EXPECT_LT(removed, 2 * trials);
}

TEST(BSpline, DegreeElevationChangesNothing) {
  Random random(18);
  for (int trial = 0; trial < trials; ++trial) {
    const KnotVector knots = random_knots(random, random.integer(1, 8));
    const BSpline spline = random_spline(random, knots, 3);
    const int times = random.integer(0, 4);
    const BSpline elevated = elevate_degree(spline, times);
    EXPECT_EQ(elevated.knots.degree(), knots.degree() + times);
    EXPECT_TRUE(elevated.knots.is_clamped());
    EXPECT_EQ(elevated.knots.breakpoints(), knots.breakpoints());
    const std::vector<double> breakpoints = knots.breakpoints();
    for (std::size_t i = 1; i + 1 < breakpoints.size(); ++i)
      EXPECT_EQ(elevated.knots.multiplicity(breakpoints[i]), knots.multiplicity(breakpoints[i]) + times);
    expect_same(spline, elevated, random);
  }
}

TEST(BSpline, ClampingChangesNothing) {
  Random random(19);
  for (int trial = 0; trial < trials; ++trial) {
    const KnotVector knots = random_knots(random, random.integer(1, 8));
    const BSpline spline = random_spline(random, knots, 3);
    const BSpline clamped = clamp(spline);
    EXPECT_TRUE(clamped.knots.is_clamped());
    expect_same(spline, clamped, random);
  }
}

TEST(BSpline, ExtensionContinuesTheEndPieces) {
  Random random(41);
  for (int trial = 0; trial < 50; ++trial) {
    const BSpline spline = random_spline(random, random_knots(random, random.integer(1, 5)), 3);
    const Interval domain = spline.knots.domain();
    const Interval larger{domain.first - random.real(0.0, 0.3), domain.last + random.real(0.0, 0.3)};
    const BSpline extended = extend(spline, larger);
    EXPECT_TRUE(extended.knots.is_clamped());
    EXPECT_EQ(extended.knots.domain().first, larger.first);
    EXPECT_EQ(extended.knots.domain().last, larger.last);
    EXPECT_EQ(extended.knots.basis_count(), clamp(spline).knots.basis_count());
    for (int k = 0; k <= 40; ++k) {
      // Outside its domain a spline is evaluated as the polynomial of its end piece.
      const double u = std::lerp(larger.first, larger.last, k / 40.0);
      EXPECT_LE((evaluate_derivatives(extended, u, 0) - evaluate_derivatives(spline, u, 0)).norm(), 3e-10) << u;
    }
  }
}

TEST(BSpline, ExtensionRefusesASmallerDomain) {
  const BSpline spline{KnotVector::bezier(2), Eigen::MatrixXd::Ones(1, 3)};
  EXPECT_THROW(extend(spline, {0.1, 1.0}), GeometryError);
  EXPECT_THROW(extend(spline, {0.0, std::numeric_limits<double>::quiet_NaN()}), GeometryError);
}

TEST(BSpline, RestrictionChangesNothing) {
  Random random(20);
  for (int trial = 0; trial < trials; ++trial) {
    const KnotVector knots = random_knots(random, random.integer(1, 8));
    const BSpline spline = random_spline(random, knots, 3);
    const double a = random.inside(knots.domain());
    const double b = random.inside(knots.domain());
    const BSpline piece = restrict_to(spline, {std::min(a, b), std::max(a, b)});
    EXPECT_EQ(piece.knots.domain().first, std::min(a, b));
    EXPECT_EQ(piece.knots.domain().last, std::max(a, b));
    EXPECT_TRUE(piece.knots.is_clamped());
    expect_same(spline, piece, random);
  }
}

TEST(BSpline, ReversalMirrorsTheParameter) {
  Random random(21);
  for (int trial = 0; trial < trials; ++trial) {
    const KnotVector knots = random_knots(random, random.integer(1, 8));
    const BSpline spline = random_spline(random, knots, 2);
    const BSpline reversed = reverse(spline);
    EXPECT_EQ(reversed.knots.domain().first, knots.domain().first);
    EXPECT_EQ(reversed.knots.domain().last, knots.domain().last);
    for (int i = 0; i < 20; ++i) {
      const double u = random.inside(knots.domain());
      const double mirrored = knots.domain().first + (knots.domain().last - u);
      const Eigen::MatrixXd slope = evaluate_derivatives(spline, u, 1);
      EXPECT_LE((evaluate(reversed, mirrored) - slope.col(0)).norm(), 1e-13 + 1e-15 * slope.col(1).norm());
    }
  }
}

TEST(BSpline, BezierSegmentsEqualTheSpline) {
  Random random(22);
  for (int trial = 0; trial < trials; ++trial) {
    const KnotVector knots = random_knots(random, random.integer(1, 8));
    const BSpline spline = random_spline(random, knots, 3);
    const std::vector<BezierSegment> segments = bezier_segments(spline);
    ASSERT_EQ(segments.size(), knots.breakpoints().size() - 1);
    for (const BezierSegment& segment : segments) {
      const BSpline bezier{
          KnotVector::clamped(knots.degree(), std::vector<double>{segment.domain.first, segment.domain.last}),
          segment.coefficients};
      expect_same(spline, bezier, random, 2e-15 * (knots.degree() + 1));
    }
  }
}

TEST(BSpline, ExtractionOperatorsGiveTheBasisFromBernsteinPolynomials) {
  Random random(23);
  for (int trial = 0; trial < trials; ++trial) {
    const KnotVector knots = random_knots(random, random.integer(1, 8));
    const int p = knots.degree();
    for (const ExtractionOperator& extraction : extraction_operators(knots)) {
      EXPECT_GE(extraction.matrix.minCoeff(), 0.0);
      // The basis sums to 1, so each Bernstein polynomial is shared out completely: columns sum to 1.
      EXPECT_LE((extraction.matrix.colwise().sum().array() - 1.0).abs().maxCoeff(), 1e-14);
      const double s = random.real(0.0, 1.0);
      const double u = extraction.domain.first + s * extraction.domain.length();
      const KnotVector unit = KnotVector::bezier(p);
      const Eigen::VectorXd bernstein = basis_derivatives(unit, p, s, 0).transpose();
      const std::vector<long double> expected = testing::reference_basis(knots, u, 0);
      const Eigen::VectorXd actual = extraction.matrix * bernstein;
      for (int i = 0; i <= p; ++i)
        EXPECT_NEAR(actual[i], static_cast<double>(expected[static_cast<std::size_t>(extraction.first_function + i)]),
                    1e-14);
    }
  }
}

TEST(BSpline, ExtractionRowsGiveTheIntegralsOfTheBasis) {
  // A function of degree p integrates to (its support) / (p + 1), a Bernstein polynomial to (its cell) / (p + 1).
  Random random(24);
  for (int trial = 0; trial < trials; ++trial) {
    const int p = random.integer(1, 8);
    const KnotVector knots = random_knots(random, p, testing::Ends::clamped, random.integer(1, p + 1));
    Eigen::VectorXd sums = Eigen::VectorXd::Zero(knots.basis_count());
    for (const ExtractionOperator& extraction : extraction_operators(knots))
      sums.segment(extraction.first_function, p + 1) += extraction.domain.length() * extraction.matrix.rowwise().sum();
    for (int i = 0; i < knots.basis_count(); ++i) EXPECT_NEAR(sums[i], knots[i + p + 1] - knots[i], 1e-14 * 10);
  }
}

TEST(BSpline, ExtractionOfABezierSegmentIsTheIdentity) {
  const std::vector<ExtractionOperator> operators = extraction_operators(KnotVector::bezier(4));
  ASSERT_EQ(operators.size(), 1u);
  EXPECT_EQ(operators[0].matrix, Eigen::MatrixXd::Identity(5, 5));
}

TEST(BSpline, ExtractionOfTheQuadraticExampleIsThatOfThePaper) {
  // Uniform inner span of degree 2: functions share the segment as (1/2, 0, 0), (1/2, 1, 1/2), (0, 0, 1/2).
  const std::vector<ExtractionOperator> operators = extraction_operators(KnotVector(2, {0, 1, 2, 3, 4, 5}));
  Eigen::Matrix3d expected;
  expected << 0.5, 0, 0, 0.5, 1, 0.5, 0, 0, 0.5;
  ASSERT_EQ(operators.size(), 1u);
  EXPECT_EQ(operators[0].matrix, expected);
}

TEST(BSpline, RefusesBadInput) {
  const BSpline spline{KnotVector::clamped_uniform(2, 2), Eigen::MatrixXd::Zero(1, 4)};
  const BSpline short_of_one{KnotVector::clamped_uniform(2, 2), Eigen::MatrixXd::Zero(1, 3)};
  EXPECT_GEOMETRY_ERROR(evaluate(short_of_one, 0.5), "3 coefficients for 4 basis functions");
  EXPECT_GEOMETRY_ERROR(evaluate_derivatives(spline, 0.5, -1), "order -1");
  EXPECT_GEOMETRY_ERROR(basis_derivatives(spline.knots, 1, 0.5, 1), "1 is no non-empty span");
  EXPECT_GEOMETRY_ERROR(refine_knots(spline, std::vector<double>{1.5}), "new knot 1.5 lies outside the domain [0, 1]");
  EXPECT_GEOMETRY_ERROR(refine_knots(spline, std::vector<double>{0.6, 0.4}), "new knot 0.4 follows the larger 0.6");
  EXPECT_GEOMETRY_ERROR(refine_knots(spline, std::vector<double>{0.5, 0.5, 0.5}), "knot 0.5 occurs 4 times");
  EXPECT_GEOMETRY_ERROR(remove_knot(spline, 0.25, 1, 1.0), "0.25 is no knot strictly inside");
  EXPECT_GEOMETRY_ERROR(remove_knot(spline, 0.0, 1, 1.0), "0 is no knot strictly inside");
  EXPECT_GEOMETRY_ERROR(elevate_degree(spline, 29), "degree 2 cannot be raised by 29");
  EXPECT_GEOMETRY_ERROR(elevate_degree(spline, -1), "cannot be raised by -1");
  EXPECT_GEOMETRY_ERROR(restrict_to(spline, {0.5, 0.5}), "piece [0.5, 0.5] is no interval inside the domain");
  EXPECT_GEOMETRY_ERROR(restrict_to(spline, {0.5, 1.5}), "piece [0.5, 1.5]");
}

}  // namespace
}  // namespace isorim::geometry
