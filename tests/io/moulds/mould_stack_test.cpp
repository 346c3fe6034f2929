#include "io/moulds/mould_stack.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "geometry/propeller/propeller.h"
#include "geometry/propeller/series.h"
#include "geometry/shapes/solids.h"
#include "geometry/topology/orientation.h"
#include "io/drawing/annotations.h"
#include "io/moulds/mould_sheets.h"
#include "tests/io/drawing/overlaps.h"

namespace isorim::io {
namespace {

using ::testing::HasSubstr;

MouldKeys boards(double thickness) {
  MouldKeys keys;
  keys.board_thickness = thickness;
  return keys;
}

/// A sphere of radius 30 about (5, -3, 10).
MouldBody ball() {
  return {geometry::orient(geometry::sphere(30.0, {5.0, -3.0, 10.0})).boundary, std::nullopt, std::nullopt};
}

/// The first blade of a Ka 4-60 with P/D = 0.9 and D = 500 mm on a hub of 50 mm.
MouldBody blade_of(std::vector<geometry::BladeSection> sections) {
  geometry::Propeller screw;
  screw.sections = std::move(sections);
  screw.hub = geometry::Hub{50.0};
  MouldBody body{geometry::propeller(screw), 0, 50.0};
  std::erase_if(body.boundary.patches, [](const auto& patch) { return !patch.name.starts_with("blade_1"); });
  return body;
}

std::vector<geometry::BladeSection> reference_sections() {
  geometry::SeriesBlade blade;
  blade.diameter = 500.0;
  blade.pitch_ratio = geometry::RadialLaw(0.9);
  return geometry::series_sections(blade);
}

TEST(MouldStack, BoardsReachFromBelowToAboveTheBody) {
  const MouldStack stack = cut_moulds(ball(), boards(7.0), 1.0, 1);
  EXPECT_NEAR(stack.body_heights.first, -20.0, 1e-6);
  EXPECT_NEAR(stack.body_heights.last, 40.0, 1e-6);
  // -21, -14, ..., 42.
  ASSERT_EQ(stack.boards(), 9U);
  EXPECT_DOUBLE_EQ(stack.sections.front().height, -21.0);
  EXPECT_DOUBLE_EQ(stack.sections.back().height, 42.0);
  for (const MouldSection& section : stack.sections) {
    const double squared_radius = 900.0 - std::pow(section.height - 10.0, 2);
    EXPECT_EQ(section.has_area, squared_radius > 0.0);
    if (section.has_area) {
      EXPECT_NEAR(section.measured.area.value, std::numbers::pi * squared_radius, 1e-6);
    }
    EXPECT_FALSE(section.parting);
    EXPECT_FALSE(section.hub);
  }
}

TEST(MouldStack, PlanesThatOnlyTouchAreSaid) {
  MouldKeys keys;
  keys.heights = {-20.0, 0.0, 40.0, 41.0};
  const MouldStack stack = cut_moulds(ball(), keys, 1.0, 1);
  ASSERT_EQ(stack.sections.size(), 4U);
  EXPECT_EQ(stack.sections[0].remark, "the plane z = -20 mm only touches the body: nothing to cut");
  EXPECT_EQ(stack.sections[1].remark, "");
  EXPECT_EQ(stack.sections[2].remark, "the plane z = 40 mm only touches the body: nothing to cut");
  EXPECT_EQ(stack.sections[3].remark, "the plane z = 41 mm does not meet the body");
  EXPECT_EQ(stack.boards(), 0U);
}

TEST(MouldStack, RangesAreMetAsFarAsStepsReach) {
  MouldKeys keys;
  keys.from = 4.0;
  keys.to = 25.0;
  keys.step = 1.0;
  EXPECT_EQ(mould_heights(keys, 10.0, {0.0, 1.0}).size(), 22U);
  EXPECT_EQ(mould_heights(keys, 10.0, {0.0, 1.0}).back(), 250.0);
  keys.step = 2.0;
  EXPECT_EQ(mould_heights(keys, 10.0, {0.0, 1.0}).back(), 240.0);
  keys.step.reset();
  keys.board_thickness = 2.0;
  // The last board reaches the end, if need be beyond it.
  EXPECT_EQ(mould_heights(keys, 10.0, {0.0, 1.0}).back(), 260.0);
  EXPECT_THROW(static_cast<void>(mould_heights(boards(1e-4), 1.0, {0.0, 1.0})), InputError);
}

TEST(MouldStack, TheReferenceBladeNeedsAHundredAndFiveBoards) {
  const MouldStack stack = cut_moulds(blade_of(reference_sections()), boards(2.0), 1.0, 2);
  EXPECT_NEAR(stack.body_heights.first, 41.904, 0.001);
  EXPECT_NEAR(stack.body_heights.last, 250.0, 0.001);
  EXPECT_EQ(stack.boards(), 105U);
  EXPECT_THAT(stack.sections.front().remark, HasSubstr("z = 40 mm does not meet"));
  EXPECT_THAT(stack.sections.back().remark, HasSubstr("z = 250 mm only touches"));
  for (std::size_t i = 1; i + 1 < stack.sections.size(); ++i) {
    const MouldSection& section = stack.sections[i];
    EXPECT_EQ(section.remark, "") << section.height;
    EXPECT_TRUE(section.parting) << section.height;
    EXPECT_EQ(section.hub.has_value(), section.height < 50.0);
    // Above the hub the blade's sections close.
    EXPECT_EQ(section.measured.section->chains.empty(), section.height >= 50.0) << section.height;
  }
}

/// Garcia 1999 counts 108. His leading edge lies at a part of the local chord, not of that at 0.6 R, so his root
/// reaches down to 35.5 mm.
TEST(MouldStack, WithTheThesisRootThereAreAHundredAndEight) {
  auto sections = reference_sections();
  const double chord = sections[4].chord;
  for (geometry::BladeSection& section : sections) {
    const double leading_edge = section.leading_edge / chord * section.chord;
    section.outline.row(0).array() += leading_edge - section.leading_edge;
    section.leading_edge = leading_edge;
  }
  const MouldBody body = blade_of(sections);
  const geometry::Interval heights = height_range(geometry::PlaneCutter(body.boundary), body.boundary);
  EXPECT_NEAR(heights.first, 35.47, 0.01);
  EXPECT_EQ(mould_heights(boards(2.0), 1.0, heights).size(), 109U);
}

TEST(MouldStack, ChainsEndAtTheHubsRectangle) {
  MouldKeys keys;
  keys.heights = {44.0, 46.0, 48.0};
  const MouldStack stack = cut_moulds(blade_of(reference_sections()), keys, 1.0, 1);
  for (const MouldSection& section : stack.sections) {
    ASSERT_TRUE(section.hub);
    ASSERT_FALSE(section.measured.chains.empty());
    for (const auto& chain : section.measured.chains) {
      for (const double t : {chain->curve.domain().first, chain->curve.domain().last}) {
        const geometry::Point2 end = evaluate(chain->curve, t);
        EXPECT_NEAR(std::abs(end.y()), section.hub->half_width, 1e-4);
        EXPECT_GT(end.x(), section.hub->x.first - 1e-6);
        EXPECT_LT(end.x(), section.hub->x.last + 1e-6);
      }
    }
  }
}

TEST(MouldSheets, LayersAreNamedByTheirHeights) {
  EXPECT_EQ(section_layer(50.0), "CORTE50_");
  EXPECT_EQ(section_layer(50.25), "CORTE50_25");
  EXPECT_EQ(section_layer(-7.5), "CORTE-7_5");
}

TEST(MouldSheets, EveryBoardIsDrawnInTheSameRectangle) {
  const MouldStack stack = cut_moulds(ball(), boards(20.0), 1.0, 1);
  const drawing::Rectangle rectangle = mould_rectangle(stack);
  const auto sheets = mould_sheets(stack, "Ball");
  ASSERT_EQ(sheets.size(), stack.boards());
  for (const drawing::Sheet& sheet : sheets) {
    const auto& base = std::get<drawing::Polyline>(sheet.drawing.entities(sheet.drawing.layer("base")).at(0));
    EXPECT_EQ(base.points.col(0), rectangle.lower);
    EXPECT_EQ(base.points.col(2), rectangle.upper);
    EXPECT_TRUE(drawing::overlapping_texts(sheet.drawing).empty());
    EXPECT_TRUE(drawing::is_on_page(sheet));
  }
  // The board from 0 to 20 has both of its faces: circles of radius sqrt(800), a tenth of whose width goes round.
  const drawing::Drawing& middle = sheets.at(1).drawing;
  for (const char* layer : {"CORTE0_", "CORTE20_"}) {
    const drawing::Rectangle circle = drawing::extent(middle.entities(middle.layer(layer)).at(0));
    EXPECT_NEAR(circle.upper.x() - circle.lower.x(), 2.0 * std::sqrt(800.0), 1e-3);
  }
  EXPECT_EQ(middle.layers()[middle.layer("CORTE20_")].line_type, drawing::LineType::dashed);
  EXPECT_NEAR(rectangle.upper.x() - rectangle.lower.x(), 1.2 * 2.0 * std::sqrt(800.0), 1e-3);
}

TEST(MouldSheets, PartingLinesCutTheBoardFromEdgeToEdge) {
  MouldKeys keys;
  keys.heights = {46.0, 120.0, 240.0};
  const MouldStack stack = cut_moulds(blade_of(reference_sections()), keys, 1.0, 1);
  const drawing::Drawing overlay = mould_overlay(stack);
  const drawing::Rectangle rectangle = mould_rectangle(stack);
  for (const MouldSection& section : stack.sections) {
    const std::string name = section_layer(section.height) + "parting";
    const auto& line = std::get<drawing::Polyline>(overlay.entities(overlay.layer(name)).at(0)).points;
    for (Eigen::Index end : {0, 1}) {
      const double to_edge = std::min((line.col(end) - rectangle.lower).cwiseAbs().minCoeff(),
                                      (line.col(end) - rectangle.upper).cwiseAbs().minCoeff());
      EXPECT_NEAR(to_edge, 0.0, 1e-9);
    }
    const geometry::Vector2 along = (line.col(1) - line.col(0)).normalized();
    for (const geometry::Point2& point : {section.parting->from, section.parting->to}) {
      const geometry::Vector2 away = point - line.col(0);
      EXPECT_NEAR(away.x() * along.y() - away.y() * along.x(), 0.0, 1e-9);
      EXPECT_GT(away.dot(along), 0.0);
    }
  }
  // Over all sheets, with all their notes.
  for (const drawing::Sheet& sheet : mould_sheets(stack, "Ka 4-60, P/D 0.9, D 500 mm, right-handed")) {
    EXPECT_TRUE(drawing::overlapping_texts(sheet.drawing).empty());
    EXPECT_TRUE(drawing::is_on_page(sheet));
  }
}

TEST(MouldSheets, NothingToCutIsAnError) {
  MouldKeys keys;
  keys.heights = {100.0};
  EXPECT_THROW(static_cast<void>(mould_rectangle(cut_moulds(ball(), keys, 1.0, 1))), InputError);
}

}  // namespace
}  // namespace isorim::io
