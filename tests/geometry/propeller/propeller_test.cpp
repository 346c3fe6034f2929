#include "geometry/propeller/propeller.h"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

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
