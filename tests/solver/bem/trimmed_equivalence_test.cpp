#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/intersection/clip.h"
#include "geometry/shapes/curves.h"
#include "geometry/shapes/regions.h"
#include "geometry/shapes/solids.h"
#include "geometry/shapes/swept_solids.h"
#include "solver/bem/evaluation.h"
#include "solver/bem/solve.h"
#include "tests/solver/bem/exact_problem.h"

// The same bodies by trimmed faces and by whole patches: solutions of a problem whose solution lies in neither space.
namespace isorim::solver {
namespace {

using geometry::Boundary;
using geometry::CylinderTool;
using geometry::NurbsCurve;
using geometry::Point2;
using geometry::Point3;
using geometry::Vector3;
using Kinds = std::vector<ConditionKind>;

Boundary<3> drilled_block() {
  return geometry::clip(geometry::box({2.0, 2.0, 1.0}),
                        CylinderTool{{1.0, 0.9, 0.0}, {0.0, 0.0, 1.0}, 0.4, geometry::KeptSide::outside});
}

Boundary<3> extruded_block() {
  geometry::Points<2> corners(2, 5);
  corners << 0, 2, 2, 0, 0,  //
      0, 0, 2, 2, 0;
  const std::vector<std::vector<NurbsCurve<2>>> loops{{geometry::polyline<2>(corners)},
                                                      {geometry::circle_curve(0.4, {1.0, 0.9})}};
  return geometry::extrude(geometry::region(loops), Vector3(0.0, 0.0, 1.0));
}

/// A sphere of six patches with a bore of half its radius, all of whose faces are trimmed across their parameters.
Boundary<3> bored_sphere() {
  return geometry::clip(geometry::six_patch_sphere(1.0),
                        CylinderTool{{0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, 0.5, geometry::KeptSide::outside});
}

Boundary<3> revolved_ring() {
  const double height = std::sqrt(0.75);
  const double angle = std::numbers::pi / 3.0;
  geometry::Points<3> wall(3, 2);
  wall << 0.5, 0.5,  //
      0.0, 0.0,      //
      height, -height;
  // The arc, turned from the plane z = 0 into that of the axis.
  const NurbsCurve<3> arc = geometry::embed(geometry::circular_arc(1.0, Point2::Zero(), -angle, angle));
  geometry::HomogeneousPoints<3> net = arc.homogeneous();
  net.row(2).swap(net.row(1));
  const std::vector<NurbsCurve<3>> curves{NurbsCurve<3>(arc.knots(), net), geometry::polyline<3>(wall)};
  return geometry::revolve_solid(curves, {Point3::Zero(), Vector3::UnitZ()});
}

/// e^x cos(0.6 y) cos(0.8 z).
test::ExactField<3> harmonic() {
  return {[](const Point3& x) -> Eigen::VectorXd {
            return Eigen::VectorXd::Constant(1, std::exp(x[0]) * std::cos(0.6 * x[1]) * std::cos(0.8 * x[2]));
          },
          [](const Point3& x) -> Eigen::MatrixXd {
            const double e = std::exp(x[0]);
            Eigen::MatrixXd gradient(1, 3);
            gradient << e * std::cos(0.6 * x[1]) * std::cos(0.8 * x[2]),
                -0.6 * e * std::sin(0.6 * x[1]) * std::cos(0.8 * x[2]),
                -0.8 * e * std::cos(0.6 * x[1]) * std::sin(0.8 * x[2]);
            return gradient;
          }};
}

struct Outcome {
  int functions = 0;
  test::Errors errors;
  /// Inside.
  std::vector<double> values;
};

Outcome solve_on(const Boundary<3>& boundary, int degree, int refine, const Kinds& kinds,
                 const geometry::Points<3>& probes) {
  const FieldSpace<3> space = test::space_on(boundary, degree, refine);
  const Problem<3> problem = test::problem_from(harmonic(), test::laplace_on(space), space, kinds);
  SolveOptions options;
  options.tolerance = 1e-9;
  const Solution<3> solution = solve(problem, space, options);
  Outcome outcome{space.function_count(), test::errors_of(solution, harmonic(), problem, space), {}};
  for (const auto& found : evaluate_at<3>(problem, space, solution, probes, {1e-9, 0}))
    outcome.values.push_back(found.field.value[0]);
  return outcome;
}

TEST(TrimmedEquivalence, DrilledBlockConvergesLikeTheExtrudedOne) {
  geometry::Points<3> probes(3, 3);
  probes << 0.4, 1.0, 1.7,  //
      0.5, 0.3, 1.6,        //
      0.5, 0.7, 0.1;
  for (const Kinds& kinds : {Kinds{ConditionKind::value}, Kinds{ConditionKind::value, ConditionKind::flux}}) {
    std::vector<double> sizes;
    std::vector<double> trimmed_errors;
    std::vector<double> whole_errors;
    for (const int refine : {0, 1, 2}) {
      const Outcome trimmed = solve_on(drilled_block(), 2, refine, kinds, probes);
      const Outcome whole = solve_on(extruded_block(), 2, refine, kinds, probes);
      // The block by clip has half as many functions.
      EXPECT_LT(trimmed.functions, whole.functions);
      EXPECT_LT(trimmed.errors.potential, 2.5 * whole.errors.potential) << refine;
      EXPECT_LT(trimmed.errors.flux, 3.0 * whole.errors.flux) << refine;
      for (std::size_t i = 0; i < trimmed.values.size(); ++i)
        EXPECT_NEAR(trimmed.values[i], whole.values[i], trimmed.errors.potential) << refine;
      sizes.push_back(std::pow(0.5, refine));
      trimmed_errors.push_back(trimmed.errors.potential);
      whole_errors.push_back(whole.errors.potential);
    }
    const double order = test::observed_order(sizes, trimmed_errors);
    EXPECT_GT(order, 2.5);
    EXPECT_GT(order, test::observed_order(sizes, whole_errors) - 0.2);
  }
}

TEST(TrimmedEquivalence, BoredSphereIsAsGoodAsTheRevolvedRing) {
  geometry::Points<3> probes(3, 2);
  probes << 0.7, 0.0,  //
      0.0, -0.55,      //
      0.1, 0.6;
  const Kinds kinds{ConditionKind::value, ConditionKind::flux};
  const Outcome trimmed = solve_on(bored_sphere(), 4, 1, kinds, probes);
  const Outcome whole = solve_on(revolved_ring(), 4, 1, kinds, probes);
  EXPECT_LT(trimmed.functions, 1.1 * whole.functions);
  EXPECT_LT(trimmed.errors.potential, 2.0 * whole.errors.potential);
  EXPECT_LT(trimmed.errors.flux, 2.0 * whole.errors.flux);
  for (std::size_t i = 0; i < trimmed.values.size(); ++i)
    EXPECT_NEAR(trimmed.values[i], whole.values[i], trimmed.errors.potential);
}

}  // namespace
}  // namespace isorim::solver
