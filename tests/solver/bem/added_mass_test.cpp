#include "solver/bem/added_mass.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "geometry/shapes/solids.h"
#include "tests/solver/hydrostatics/wigley.h"

namespace isorim::solver {
namespace {

using geometry::Point3;
using geometry::Vector3;
using std::numbers::pi;

AddedMassOptions options_of(int degree, int refine) {
  AddedMassOptions options;
  options.degree = degree;
  options.refine = refine;
  options.solve.tolerance = 1e-8;
  return options;
}

// physical_references.toml: Lamb, Hydrodynamics, articles 114 and 115, added over displaced mass and inertia.
// Translations are linear functions of the position, hence exact; the potentials of turns converge with the degree.
TEST(AddedMass, OfAnEllipsoidIsLambs) {
  const Vector3 d(3.0, 2.0, 1.0);
  const AddedMass found = added_mass(geometry::orient(geometry::ellipsoid(d)), options_of(4, 1));
  const double k[6] = {0.1852564042809872, 0.3645432395608983, 1.361527473150915,
                       0.3832672904125120, 0.7082361248165249, 0.05990028090901212};
  const auto coefficients = found.coefficients();
  EXPECT_NEAR(found.volume, 4.0 / 3.0 * pi * d.prod(), 1e-10 * d.prod());
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(coefficients[i], k[i], 1e-10) << i;
  for (int i = 3; i < 6; ++i) {
    const double inertia = found.inertia(i - 3, i - 3);
    EXPECT_NEAR(coefficients[i], k[i], found.error(i, i) / inertia) << i;
    EXPECT_LT(found.error(i, i), 1e-3 * inertia) << i;
  }
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < i; ++j)
      EXPECT_NEAR(found.matrix(i, j), 0.0, std::max(found.error(i, j), 1e-9 * found.volume)) << i << ", " << j;
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
  EXPECT_NEAR(found.inertia(1, 1), 4.0 / 3.0 * pi * (0.4 + 0.25), 1e-10);
}

TEST(AddedMass, KnowsNothingOfVoids) {
  geometry::Boundary<3> hollow;
  for (const double radius : {2.0, 1.0, 0.5})
    for (geometry::Patch<3> patch : geometry::sphere(radius).patches) {
      patch.name += std::to_string(radius);
      hollow.patches.push_back(std::move(patch));
    }
  const AddedMass whole = added_mass(geometry::orient(geometry::sphere(2.0)), options_of(2, 1));
  const AddedMass found = added_mass(geometry::orient(hollow), options_of(2, 1));
  EXPECT_EQ(found.matrix, whole.matrix);
  EXPECT_EQ(found.volume, whole.volume);
  EXPECT_NEAR(found.matrix(0, 0), 16.0 / 3.0 * pi, 1e-9);
}

TEST(AddedMass, RefusesADiscretisationThatCannotBeEstimated) {
  const auto sphere = geometry::orient(geometry::sphere(1.0));
  EXPECT_THROW(added_mass(sphere, options_of(2, 0)), InputError);
  AddedMassOptions options = options_of(2, 1);
  options.edges.ratio = 0.5;
  EXPECT_THROW(added_mass(sphere, options), InputError);
  options.edges = {13, 0.25};
  EXPECT_THROW(added_mass(sphere, options), InputError);
}

// The same body whole and with a knot line where nothing is: sides that continue smoothly are no edges.
TEST(EdgeGrading, IsForEdgesAlone) {
  const auto knots = [](const geometry::OrientedBoundary<3>& boundary, std::size_t patch, geometry::Direction d) {
    return std::get<geometry::NurbsSurface<3>>(boundary.boundary.patches[patch].shape).knots(d).breakpoints();
  };
  const EdgeGrading two{2, 0.25};
  const auto ball = geometry::orient(geometry::sphere(1.0));
  EXPECT_EQ(knots(graded_to_edges(ball, two), 0, geometry::Direction::u), knots(ball, 0, geometry::Direction::u));
  const auto cube = graded_to_edges(geometry::orient(geometry::cube(1.0)), two);
  for (std::size_t p = 0; p < 6; ++p)
    for (const auto d : {geometry::Direction::u, geometry::Direction::v})
      EXPECT_EQ(knots(cube, p, d), (std::vector<double>{0.0, 0.0625, 0.25, 0.75, 0.9375, 1.0})) << p;
  // Stem, stern and keel are edges, the waterline of a wall-sided double body is none.
  const auto hull = graded_to_edges(geometry::orient(double_body(solver::testing::wigley_hull(), 0.0)), two);
  for (std::size_t p = 0; p < 4; ++p) {
    EXPECT_EQ(knots(hull, p, geometry::Direction::u), (std::vector<double>{0.0, 0.0625, 0.25, 0.75, 0.9375, 1.0}));
    EXPECT_EQ(knots(hull, p, geometry::Direction::v), (std::vector<double>{0.0, 0.0625, 0.25, 1.0}));
  }
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
// 0.6551 times the displaced mass, to 2e-5, 1e-3 and 2e-4.
constexpr double wigley_coefficients[3] = {0.02150, 1.761, 0.6551};
constexpr double wigley_uncertainty[3] = {2e-5, 1e-3, 2e-4};

TEST(AddedMass, OfTheWigleyDoubleBody) {
  const auto body = geometry::orient(double_body(solver::testing::wigley_hull(), 0.0));
  const AddedMass found = added_mass(body, options_of(2, 1));
  const double mass = 2.0 * 4.0 / 9.0 * 10.0 * 0.625;
  EXPECT_NEAR(found.volume, mass, 1e-12 * mass);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(found.coefficients()[i], wigley_coefficients[i], found.error(i, i) / mass + wigley_uncertainty[i]) << i;
    EXPECT_LT(found.error(i, i), 5e-3 * found.matrix(i, i)) << i;
  }
}

// Around the sharp ends, of 22.6 degrees at the waterline, the potential of sway varies like the distance to the power
// 180 / 337.4 = 0.5335, and the fluid's energy in elements of constant size is off by h^1.067: the change with a
// bisection halves at best. Towards graded elements of degree p the resolved part falls like h^(2 p + 1) in energy.
TEST(AddedMass, ConvergesThroughTheSharpEdgesOfTheWigleyDoubleBody) {
  const auto body = geometry::orient(double_body(solver::testing::wigley_hull(), 0.0));
  const auto changes = [&](int layers) {
    std::vector<double> list;
    for (const int refine : {1, 2}) {
      AddedMassOptions options = options_of(2, refine);
      options.edges.layers = layers;
      options.solve.tolerance = 1e-6;
      list.push_back(added_mass(body, options).error(1, 1));
    }
    return list;
  };
  const std::vector<double> uniform = changes(0);
  EXPECT_LT(uniform[0] / uniform[1], 2.5);
  const std::vector<double> graded = changes(2);
  EXPECT_GT(graded[0] / graded[1], 3.0);
  EXPECT_LT(graded[1], 0.1 * uniform[1]);
}

TEST(SolveAll, IsWhatEachSolveIsAlone) {
  DiscretisationOptions<3> discretisation;
  discretisation.degree = 2;
  discretisation.refine = 1;
  const FieldSpace<3> space = field_space(geometry::orient(geometry::cube(1.0)), discretisation);
  std::vector<Problem<3>> problems(2);
  for (int k = 0; k < 2; ++k) {
    Problem<3>& problem = problems[static_cast<std::size_t>(k)];
    problem.equation = Laplace<3>{};
    // A given value on one side, a flux on the others.
    const auto value = [k]() -> quadrature::Integrand<3> {
      return [k](const auto& points, const auto&, std::span<double> values) {
        for (Eigen::Index q = 0; q < points.cols(); ++q) values[static_cast<std::size_t>(q)] = 1.0 + k * points(1, q);
      };
    };
    problem.conditions = {{"held", {{ConditionKind::value, value, {}}}, {}},
                          {"free", {{ConditionKind::flux, value, {}}}, {}}};
    for (const auto& element : space.table.elements) problem.condition_of.push_back(element.patch == 0 ? 0 : 1);
  }
  for (const SolveMethod method : {SolveMethod::dense, SolveMethod::compressed}) {
    SolveOptions options;
    options.method = method;
    const auto together = solve_all<3>(problems, space, options);
    ASSERT_EQ(together.size(), 2U);
    for (std::size_t k = 0; k < 2; ++k) {
      const Solution<3> alone = solve(problems[k], space, options);
      EXPECT_LT((together[k].potential - alone.potential).norm(), 1e-9 * alone.potential.norm()) << k;
      EXPECT_LT((together[k].flux - alone.flux).norm(), 1e-9 * alone.flux.norm()) << k;
    }
    EXPECT_GT((together[0].flux - together[1].flux).norm(), 1e-2);
  }
  problems[1].conditions[1].components[0].kind = ConditionKind::value;
  EXPECT_THROW(solve_all<3>(problems, space, {}), InputError);
}

}  // namespace
}  // namespace isorim::solver
