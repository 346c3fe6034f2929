#include "io/propeller/overview.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "geometry/propeller/series.h"
#include "tests/io/drawing/overlaps.h"

namespace isorim::io {
namespace {

using drawing::Rectangle;

PropellerFacts facts_of(const geometry::SeriesBlade& blade, geometry::Hand hand) {
  PropellerFacts facts;
  facts.screw.sections = geometry::series_sections(blade);
  facts.screw.blades = blade.blades;
  facts.screw.surface.hand = hand;
  facts.screw.hub = geometry::Hub{0.1 * blade.diameter};
  facts.diameter = blade.diameter;
  facts.hub_radius = 0.1 * blade.diameter;
  facts.hub = geometry::propeller_model(facts.screw).hub;
  return facts;
}

PropellerFacts reference() {
  geometry::SeriesBlade blade;
  blade.diameter = 500.0;
  blade.pitch_ratio = geometry::RadialLaw(0.9);
  return facts_of(blade, geometry::Hand::right);
}

PropellerFacts b_screw() {
  geometry::SeriesBlade blade;
  blade.series = geometry::BladeSeries::wageningen_b;
  blade.diameter = 5.2;
  blade.blades = 5;
  blade.area_ratio = 0.75;
  blade.pitch_ratio = geometry::RadialLaw("pitch_ratio", {0.2, 1.0}, {0.8, 1.0});
  blade.rake = geometry::RadialLaw("rake", {0.0, 1.0}, {0.0, 0.7});
  return facts_of(blade, geometry::Hand::left);
}

/// The extents of the entities of a layer, from the left.
std::vector<Rectangle> extents(const drawing::Drawing& drawing, const char* layer) {
  std::vector<Rectangle> result;
  for (const drawing::Entity& entity : drawing.entities(drawing.layer(layer))) result.push_back(extent(entity));
  std::ranges::sort(result, {}, [](const Rectangle& bounds) { return bounds.lower.x(); });
  return result;
}

TEST(PropellerOverview, FitsOnA3AtAScaleOfItsChoice) {
  const Overview overview = propeller_overview(reference(), "Ka 4-60");
  EXPECT_EQ(overview.scale, 2.0);
  EXPECT_LE(overview.sheet.width(), 420.0);
  EXPECT_LE(overview.sheet.height(), 297.0);
  // A screw in metres.
  EXPECT_EQ(propeller_overview(b_screw(), "B 5-75", {.millimetres = 1000.0}).scale, 20.0);
  EXPECT_EQ(propeller_overview(reference(), "Ka 4-60", {.scale = 5.0}).scale, 5.0);
  EXPECT_THROW(static_cast<void>(propeller_overview(reference(), "", {.scale = -1.0})), InputError);
}

TEST(PropellerOverview, TextsNeitherOverlapNorLeaveThePage) {
  for (const PropellerFacts& facts : {reference(), b_screw()}) {
    const double millimetres = facts.diameter < 100.0 ? 1000.0 : 1.0;
    const double diameter = millimetres * facts.diameter;
    for (const double scale : {0.0, diameter / 400.0, diameter / 60.0}) {
      const drawing::Sheet sheet = propeller_overview(facts, "A screw with a title", {millimetres, scale}).sheet;
      EXPECT_THAT(drawing::overlapping_texts(sheet.drawing), ::testing::IsEmpty()) << scale;
      EXPECT_TRUE(drawing::is_on_page(sheet)) << scale;
    }
  }
}

TEST(PropellerOverview, ViewsAreTrueToScale) {
  const PropellerFacts facts = reference();
  const drawing::Sheet sheet = propeller_overview(facts, "Ka 4-60", {.scale = 2.0}).sheet;
  // The sections on the expanded outline are as long as their chords; the last of the layer is the pitch.
  const auto sections = extents(sheet.drawing, "sections");
  ASSERT_EQ(sections.size(), facts.screw.sections.size() + 1);
  std::vector<double> widths;
  for (const Rectangle& bounds : sections) widths.push_back(bounds.upper.x() - bounds.lower.x());
  std::ranges::sort(widths);
  std::vector<double> chords{0.0};
  for (const auto& section : facts.screw.sections) chords.push_back(0.5 * section.chord);
  std::ranges::sort(chords);
  // Leading edges are blunt: outlines reach a little beyond their chord.
  for (std::size_t i = 0; i < chords.size(); ++i) EXPECT_NEAR(widths[i], chords[i], 0.01 * chords[i] + 1e-9);
  // The hub: a rectangle and a circle of 50 mm radius.
  const auto hub = extents(sheet.drawing, "hub");
  ASSERT_EQ(hub.size(), 2U);
  for (const Rectangle& bounds : hub) EXPECT_NEAR(bounds.upper.y() - bounds.lower.y(), 50.0, 1e-3);
  EXPECT_NEAR(hub[1].upper.x() - hub[1].lower.x(), 50.0, 1e-3);
  // Nothing of the blade stands out of the disc by more than its surface does.
  for (const Rectangle& bounds : extents(sheet.drawing, "outline")) EXPECT_LT(bounds.upper.y(), 125.001);
}

TEST(PropellerOverview, LeftHandedScrewsAreTheMirrorImages) {
  PropellerFacts left = reference();
  left.screw.surface.hand = geometry::Hand::left;
  const auto right_outline = extents(propeller_overview(reference(), "", {.scale = 2.0}).sheet.drawing, "outline");
  const auto left_outline = extents(propeller_overview(left, "", {.scale = 2.0}).sheet.drawing, "outline");
  ASSERT_EQ(right_outline.size(), left_outline.size());
  // The expanded outline's root reaches from the trailing to the leading edge: the mirrored one the other way round.
  const auto root = [](const std::vector<Rectangle>& all) {
    return *std::ranges::find_if(all, [](const Rectangle& bounds) {
      return bounds.lower.y() == bounds.upper.y() && std::abs(bounds.lower.y() - 25.0) < 1e-9;
    });
  };
  const double width = root(right_outline).upper.x() - root(right_outline).lower.x();
  EXPECT_NEAR(root(left_outline).upper.x() - root(left_outline).lower.x(), width, 1e-9);
  EXPECT_NEAR(width, 0.5 * 99.16, 0.01);
}

}  // namespace
}  // namespace isorim::io
