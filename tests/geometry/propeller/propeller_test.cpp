#include "geometry/propeller/propeller.h"

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "geometry/propeller/blade_areas.h"
#include "geometry/propeller/series.h"
#include "tests/geometry/refusals.h"

namespace isorim::geometry {
namespace {

using ::testing::HasSubstr;
using testing::refusal;

Propeller reference(BladeSeries series, int blades = 4) {
  SeriesBlade blade;
  blade.series = series;
  blade.diameter = 500.0;
  blade.blades = blades;
  blade.area_ratio = 0.6;
  blade.pitch_ratio = RadialLaw(0.9);
  Propeller screw;
  screw.sections = series_sections(blade);
  screw.blades = blades;
  return screw;
}

std::vector<std::string> names_of(const Boundary<3>& boundary) {
  std::vector<std::string> names;
  for (const Patch<3>& patch : boundary.patches) names.push_back(patch.name);
  return names;
}

TEST(Propeller, StandsWithoutAHub) {
  const Boundary<3> screw = propeller(reference(BladeSeries::kaplan, 3));
  EXPECT_EQ(names_of(screw),
            (std::vector<std::string>{"blade_1", "blade_1_root", "blade_1_tip", "blade_2", "blade_2_root",
                                      "blade_2_tip", "blade_3", "blade_3_root", "blade_3_tip"}));
}

TEST(Propeller, JoinsBladesAndHub) {
  for (const BladeSeries series : {BladeSeries::kaplan, BladeSeries::wageningen_b}) {
    for (const int blades : {3, 4, 5}) {
      Propeller screw = reference(series, blades);
      screw.hub = Hub{50.0};
      const Boundary<3> joined = propeller(screw);
      const std::size_t a_blade = series == BladeSeries::kaplan ? 2 : 1;
      ASSERT_EQ(joined.patches.size(), a_blade * static_cast<std::size_t>(blades) + 3);
      const Patch<3>& hub = joined.patches[joined.patches.size() - 3];
      EXPECT_EQ(hub.name, "hub");
      EXPECT_EQ(hub.orientation, 1);
      EXPECT_EQ(trim_loops(hub.shape).size(), static_cast<std::size_t>(blades) + 1);
    }
  }
}

// The roots of five wide blades cover every angle round the hub, so blades lie across the seam of its surface.
TEST(Propeller, JoinsBladesThatLieAcrossTheSeamOfTheHub) {
  SeriesBlade blade;
  blade.series = BladeSeries::wageningen_b;
  blade.diameter = 500.0;
  blade.blades = 5;
  blade.area_ratio = 0.75;
  blade.pitch_ratio = RadialLaw("pitch ratio", {0.2, 0.6, 1.0}, {0.85, 1.0, 1.0});
  Propeller screw;
  screw.sections = series_sections(blade);
  screw.blades = 5;
  screw.hub = Hub{45.0};
  const Boundary<3> joined = propeller(screw);
  ASSERT_EQ(joined.patches.size(), 8u);
  EXPECT_EQ(joined.patches[5].name, "hub");
  EXPECT_GE(trim_loops(joined.patches[5].shape).size(), 1u);
}

// All knots of all sections merged: some lie so near to each other that the curve on the hub is cut into pieces shorter
// than the distance at which ends count as one.
TEST(Propeller, JoinsBladesOfMergedKnots) {
  Propeller screw = reference(BladeSeries::wageningen_b);
  screw.surface.fit = BladeFit::own_parameters;
  screw.hub = Hub{50.0};
  const PropellerModel model = propeller_model(screw);
  EXPECT_EQ(model.knots.control_points_round, 389);
  EXPECT_EQ(model.knots.merged_control_points, 389);
}

TEST(Propeller, TakesHubsOfOtherSizesAndBothHands) {
  for (const double radius : {42.0, 50.0, 75.0, 130.0}) {
    Propeller screw = reference(BladeSeries::kaplan);
    screw.surface.hand = radius < 60.0 ? Hand::left : Hand::right;
    screw.hub = Hub{radius, -80.0, 95.0};
    const Boundary<3> joined = propeller(screw);
    // The disc at the forward end lies where it was asked for.
    const NurbsSurface<3>& forward = surface_of(joined.patches.back().shape);
    const Points<3> net = forward.control_points();
    EXPECT_LE((net.row(0).array() - 95.0).abs().maxCoeff(), 1e-11);
    EXPECT_NEAR(std::hypot(net(1, 1), net(2, 1)), radius, 1e-11);
  }
}

/// A cylinder of radius 50 from X = -60 to 70, a cap that ends on the shaft aft and a step and a plane end forward.
std::vector<NurbsCurve<2>> boss() {
  Points<2> cap(2, 3);
  cap << -110.0, -110.0, -60.0, 0.0, 50.0, 50.0;
  Points<2> rest(2, 4);
  rest << -60.0, 70.0, 80.0, 80.0, 50.0, 50.0, 40.0, 40.0;
  rest.col(3) << 95.0, 40.0;
  return {NurbsCurve<2>::from_points(KnotVector::bezier(2), cap, std::vector<double>{1.0, std::sqrt(0.5), 1.0}),
          NurbsCurve<2>::from_points(KnotVector(1, {0, 0, 1, 2, 3, 3}), rest)};
}

TEST(HubByProfile, FindsTheCylinderThatTheBladesStandOn) {
  for (const bool is_reversed : {false, true}) {
    std::vector<NurbsCurve<2>> profile = boss();
    if (is_reversed) profile = {reverse(profile[1]), reverse(profile[0])};
    const Hub hub = hub_by_profile(profile);
    EXPECT_EQ(hub.radius, 50.0);
    EXPECT_EQ(*hub.aft, -60.0);
    EXPECT_EQ(*hub.forward, 70.0);
    EXPECT_EQ(hub.beyond_aft.size(), 1u);
    EXPECT_EQ(hub.beyond_forward.size(), 2u);
    // From the cylinder outwards.
    EXPECT_NEAR(evaluate(hub.beyond_aft[0], hub.beyond_aft[0].domain().first).x(), -60.0, 1e-12);
    EXPECT_NEAR(evaluate(hub.beyond_aft[0], hub.beyond_aft[0].domain().last).y(), 0.0, 1e-12);
  }
}

TEST(Propeller, JoinsBladesToAHubByItsProfile) {
  for (const BladeSeries series : {BladeSeries::kaplan, BladeSeries::wageningen_b}) {
    Propeller screw = reference(series);
    screw.hub = hub_by_profile(boss());
    const PropellerModel model = propeller_model(screw);
    const std::vector<std::string> names = names_of(*model.hub);
    EXPECT_EQ(names, (std::vector<std::string>{"hub", "hub_aft_1", "hub_forward_1", "hub_forward_2", "hub_forward_3"}));
    EXPECT_EQ(model.boundary.patches.size(), (series == BladeSeries::kaplan ? 8u : 4u) + 5u);
  }
}

TEST(HubByProfile, RefusesProfilesOfNoHub) {
  const auto refused = [](auto change) {
    std::vector<NurbsCurve<2>> profile = boss();
    change(profile);
    return refusal([&] { hub_by_profile(profile); });
  };
  EXPECT_THAT(refused([](auto& p) { p.clear(); }), HasSubstr("no curves"));
  EXPECT_THAT(refused([](auto& p) {
                Points<2> disc(2, 2);
                disc << 10.0, 10.0, 0.0, 50.0;
                p = {NurbsCurve<2>::from_points(KnotVector::bezier(1), disc)};
              }),
              HasSubstr("no piece of the profile runs along the shaft"));
  EXPECT_THAT(refused([](auto& p) { p[1] = reverse(p[1]); }), HasSubstr("a gap of 155"));
  AffineMap<2> mirrored;
  mirrored.linear(1, 1) = -1.0;
  EXPECT_THAT(refused([&](auto& p) { p[1] = transform(p[1], mirrored); }), HasSubstr("reaches the radius -50"));
}

// A cone of half angle atan 0.1 and a generator line that leans aft by 0.2: they meet where r = 60 + 0.1 (0.2 r).
TEST(HubByProfile, KnowsItsRadiusAtTheGeneratorLine) {
  Points<2> cone(2, 2);
  cone << -100.0, 100.0, 70.0, 50.0;
  Propeller screw = reference(BladeSeries::kaplan);
  for (BladeSection& section : screw.sections) section.station.rake = 0.2 * section.station.radius;
  const Hub hub = hub_by_profile({NurbsCurve<2>::from_points(KnotVector::bezier(1), cone)});
  EXPECT_EQ(hub.radius, 0.0);
  EXPECT_NEAR(radius_at_generator_line(hub, screw.sections), 60.0 / 0.98, 1e-12);
  EXPECT_EQ(radius_at_generator_line(Hub{50.0}, screw.sections), 50.0);
}

/// A cone, a smooth spline or a cone and a cylinder with a corner where the blades stand; ends far enough.
std::vector<NurbsCurve<2>> curved_profile(unsigned seed, double radius) {
  Points<2> points(2, 4);
  points << -180.0, -20.0, 25.0, 190.0, 1.15, 1.0, 0.97, 0.9;
  points.row(1) *= radius;
  if (seed % 3 == 0) return {NurbsCurve<2>::from_points(KnotVector::bezier(1), points(Eigen::all, {0, 3}))};
  if (seed % 3 == 1) return {NurbsCurve<2>::from_points(KnotVector(2, {0, 0, 0, 1, 2, 2, 2}), points)};
  return {NurbsCurve<2>::from_points(KnotVector(1, {0, 0, 1, 2, 3, 3}), points)};
}

/// Of all numbers of blades, both hands, both series, on hubs of many sizes.
Propeller random_screw(unsigned seed) {
  std::mt19937 random(seed);
  const auto between = [&](double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
  };
  SeriesBlade blade;
  blade.series = seed % 2 == 0 ? BladeSeries::wageningen_b : BladeSeries::kaplan;
  blade.diameter = 500.0;
  blade.blades = 3 + static_cast<int>(seed / 2 % 5);
  blade.area_ratio = between(0.3, 1.05);
  const double pitch = between(0.5, 1.5);
  blade.pitch_ratio =
      RadialLaw("pitch", {0.2, 0.6, 1.0}, {pitch * between(0.8, 1.1), pitch, pitch * between(0.8, 1.1)});
  blade.rake = RadialLaw("rake", {0.0, 1.0}, {0.0, between(-60.0, 100.0)});
  blade.skew = RadialLaw("skew", {0.2, 0.6, 1.0}, {0.0, between(-0.1, 0.2), between(-0.2, 0.8)});
  Propeller screw;
  screw.sections = series_sections(blade);
  screw.blades = blade.blades;
  screw.surface.hand = seed % 3 == 0 ? Hand::left : Hand::right;
  if (seed % 4 == 3) screw.surface.fit = BladeFit::own_parameters;
  screw.hub = Hub{250.0 * between(0.17, 0.32)};
  return screw;
}

// Closed, as propeller() requires. Where wide blades overlap at the hub there is no such boundary: that is said.
TEST(Propeller, ClosesOrSaysWhyNot) {
  int closed = 0;
  for (unsigned seed = 0; seed < 30; ++seed) {
    const std::string why = refusal([&] {
      propeller(random_screw(seed));
      throw GeometryError("closed");
    });
    if (why == "closed") ++closed;
    EXPECT_THAT(why, ::testing::AnyOf("closed", HasSubstr("cross"), HasSubstr("propeller"))) << seed;
  }
  EXPECT_GE(closed, 20);
}

/// In the range in which the series were tested, on the hubs that go with them, both hands, raked and skewed.
Propeller screw_of_the_tested_range(unsigned seed) {
  std::mt19937 random(seed);
  const auto between = [&](double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
  };
  const bool is_ducted = seed % 2 != 0;
  SeriesBlade blade;
  blade.series = is_ducted ? BladeSeries::kaplan : BladeSeries::wageningen_b;
  blade.diameter = 500.0;
  blade.blades = 3 + static_cast<int>(seed / 2 % (is_ducted ? 3 : 5));
  blade.area_ratio = is_ducted ? between(0.55, 0.75) : between(0.3, 1.05);
  const double pitch = between(0.5, is_ducted ? 1.8 : 1.4);
  blade.pitch_ratio =
      RadialLaw("pitch", {0.2, 0.7, 1.0}, {pitch * between(0.8, 1.0), pitch, pitch * between(0.8, 1.0)});
  blade.rake = RadialLaw("rake", {0.0, 1.0}, {0.0, between(-60.0, 100.0)});
  blade.skew = RadialLaw("skew", {0.2, 0.6, 1.0}, {0.0, between(-0.1, 0.2), between(-0.2, 0.8)});
  EXPECT_TRUE(outside_tested_range(blade).empty());
  Propeller screw;
  screw.sections = series_sections(blade);
  screw.blades = blade.blades;
  screw.surface.hand = seed % 3 == 0 ? Hand::left : Hand::right;
  screw.hub = Hub{250.0 * between(1.0 / 6.0, 0.2)};
  return screw;
}

TEST(Propeller, ClosesInTheTestedRangeOfTheSeries) {
  for (unsigned seed = 100; seed < 124; ++seed) {
    const Propeller screw = screw_of_the_tested_range(seed);
    EXPECT_NO_THROW(propeller(screw)) << seed;
    EXPECT_NO_THROW(blade_areas(screw.sections, screw.hub->radius)) << seed;
  }
}

TEST(Propeller, ClosesOnCurvedHubsOrSaysWhyNot) {
  int closed = 0;
  constexpr unsigned count = 18;
  for (unsigned seed = 200; seed < 200 + count; ++seed) {
    Propeller screw = screw_of_the_tested_range(seed);
    screw.hub = hub_by_profile(curved_profile(seed, 1.15 * screw.hub->radius));
    const std::string why = refusal([&] {
      EXPECT_TRUE(propeller_model(screw).feet) << seed;
      throw GeometryError("closed");
    });
    if (why == "closed") ++closed;
    EXPECT_THAT(why, ::testing::AnyOf("closed", HasSubstr("cross"), HasSubstr("propeller"))) << seed;
  }
  EXPECT_EQ(closed, count);
}

TEST(Propeller, RefusesProfilesThatDoNotFit) {
  const auto refused = [](double from, double to, double radius) {
    Points<2> cone(2, 2);
    cone << from, to, radius, 0.8 * radius;
    Propeller screw = reference(BladeSeries::kaplan);
    screw.hub = hub_by_profile({NurbsCurve<2>::from_points(KnotVector::bezier(1), cone)});
    return refusal([&] { propeller(screw); });
  };
  EXPECT_THAT(refused(-100.0, 20.0, 60.0),
              HasSubstr("runs along the shaft from X = -100 to 20; the blades on it need"));
  EXPECT_THAT(refused(-100.0, 100.0, 25.0), HasSubstr("too far outside the hub of radius"));
  EXPECT_THAT(refused(-100.0, 100.0, 300.0), HasSubstr("does not stand on the hub"));
}

TEST(Propeller, RefusesHubsThatDoNotFit) {
  const auto refused = [](const Hub& hub, int blades = 4) {
    Propeller screw = reference(BladeSeries::kaplan);
    screw.hub = hub;
    screw.blades = blades;
    return refusal([&] { propeller(screw); });
  };
  EXPECT_THAT(refused({-1.0}), HasSubstr("radius is -1"));
  EXPECT_THAT(refused({50.0, -10.0, 95.0}), HasSubstr("it runs from X = -10 to 95; the blades on it need -3"));
  EXPECT_THAT(refused({20.0}), HasSubstr("too far outside the hub of radius 20"));
  EXPECT_THAT(refused({260.0}), HasSubstr("nothing"));
  EXPECT_THAT(refused({50.0}, 0), HasSubstr("0 blades"));
}

}  // namespace
}  // namespace isorim::geometry
