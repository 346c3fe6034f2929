#include "io/drawing/drawing.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "geometry/shapes/curves.h"
#include "io/drawing/annotations.h"
#include "io/drawing/text_metrics.h"

namespace isorim::io::drawing {
namespace {

using geometry::Point2;
using geometry::Vector2;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

Drawing one_layer() {
  Drawing drawing;
  drawing.add_layer({"0"});
  return drawing;
}

template <class Kind>
std::vector<Kind> all_of_kind(const Drawing& drawing, std::size_t layer = 0) {
  std::vector<Kind> result;
  for (const Entity& entity : drawing.entities(layer))
    if (const auto* kind = std::get_if<Kind>(&entity)) result.push_back(*kind);
  return result;
}

TEST(Drawing, RefusesLayersThatCadProgramsRefuse) {
  Drawing drawing;
  drawing.add_layer({"Outline"});
  const auto add = [&](const Layer& layer) { return [&drawing, layer] { drawing.add_layer(layer); }; };
  EXPECT_THAT(add({"outline"}), ThrowsMessage<InputError>(HasSubstr("there is a layer of this name")));
  EXPECT_THAT(add({""}), ThrowsMessage<InputError>(HasSubstr("1 to 255 bytes")));
  EXPECT_THAT(add({"a/b"}), ThrowsMessage<InputError>(HasSubstr("layer \"a/b\"")));
  EXPECT_THAT(add({"thin", black, 0.0}), ThrowsMessage<InputError>(HasSubstr("line_width is 0, expected more")));
  EXPECT_EQ(drawing.layer("OUTLINE"), 0U);
  EXPECT_THAT([&] { static_cast<void>(drawing.layer("inline")); },
              ThrowsMessage<InputError>(HasSubstr("no layer \"inline\"")));
}

TEST(Drawing, RefusesEntitiesThatCannotBeDrawn) {
  Drawing drawing = one_layer();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(drawing.add(1, Circle{}), InputError);
  EXPECT_THROW(drawing.add(0, Circle{{0.0, nan}, 1.0}), InputError);
  EXPECT_THROW(drawing.add(0, Circle{{0.0, 0.0}, 0.0}), InputError);
  EXPECT_THROW(drawing.add(0, Path{}), InputError);
  EXPECT_THROW(drawing.add(0, Fill{}), InputError);
  EXPECT_THROW(drawing.add(0, line({0.0, 0.0}, {nan, 1.0})), InputError);
  EXPECT_THROW(drawing.add(0, Polyline{geometry::Points<2>::Zero(2, 1)}), InputError);
  EXPECT_THROW(drawing.add(0, Text{"x", {0.0, 0.0}, -1.0}), InputError);
  EXPECT_TRUE(drawing.entities(0).empty());
  EXPECT_TRUE(extent(drawing).is_empty());
}

TEST(Drawing, ExtentIsThatOfTheCurveItself) {
  const double turn = 0.4;
  const Rectangle bounds = extent(Entity(Path{{geometry::ellipse_curve({30.0, 10.0}, {5.0, -2.0}, turn)}}));
  // The ellipse's support function along the axes.
  const double half_width = std::hypot(30.0 * std::cos(turn), 10.0 * std::sin(turn));
  const double half_height = std::hypot(30.0 * std::sin(turn), 10.0 * std::cos(turn));
  EXPECT_NEAR(bounds.lower.x(), 5.0 - half_width, 1e-4);
  EXPECT_NEAR(bounds.upper.x(), 5.0 + half_width, 1e-4);
  EXPECT_NEAR(bounds.lower.y(), -2.0 - half_height, 1e-4);
  EXPECT_NEAR(bounds.upper.y(), -2.0 + half_height, 1e-4);
}

TEST(Drawing, TurnedTextsCoverWhatTheyWrite) {
  // Helvetica: H 722, x 500, g 556 thousandths of the font size, capitals 718.
  const double width = 1.778 / 0.718 * 5.0;
  EXPECT_NEAR(text_width("Hxg", 5.0), width, 1e-12);
  const Text text{"Hxg", {10.0, 20.0}, 5.0, Horizontal::right, Vertical::top, 90.0};
  // It runs upwards and ends at the place; its top looks to the left.
  const Rectangle bounds = extent(Entity(text));
  EXPECT_NEAR(bounds.upper.y(), 20.0, 1e-12);
  EXPECT_NEAR(bounds.lower.y(), 20.0 - width, 1e-12);
  EXPECT_NEAR(bounds.lower.x(), 10.0, 1e-12);
  EXPECT_NEAR(bounds.upper.x(), 10.0 + 1.3 * 5.0, 1e-12);
}

TEST(Drawing, ScalesEverythingAlike) {
  const std::vector<Entity> entities{Circle{{1.0, 2.0}, 3.0}, line({0.0, 1.0}, {4.0, -1.0}),
                                     Path{{geometry::circle_curve(2.0, {1.0, 1.0})}},
                                     Fill{{{geometry::circle_curve(2.0, {1.0, 1.0})}}, red},
                                     Text{"text", {3.0, 4.0}, 2.5, Horizontal::centre, Vertical::middle, 30.0}};
  const Vector2 offset(7.0, -3.0);
  for (const Entity& entity : entities) {
    const Rectangle before = extent(entity);
    const Rectangle after = extent(scaled(entity, 2.5, offset));
    EXPECT_LT((after.lower - (2.5 * before.lower + offset)).norm(), 1e-3);
    EXPECT_LT((after.upper - (2.5 * before.upper + offset)).norm(), 1e-3);
  }
}

TEST(Drawing, PutsDrawingsTogetherByTheNamesOfLayers) {
  Drawing base;
  base.add_layer({"frame"});
  Drawing part;
  part.add_layer({"holes", red});
  part.add_layer({"Frame"});
  part.add(0, Circle{{0.0, 0.0}, 2.0});
  part.add(1, line({0.0, 0.0}, {1.0, 0.0}));
  base.add(part, {10.0, 20.0});
  base.add(part, {30.0, 20.0});
  ASSERT_EQ(base.layers().size(), 2U);
  EXPECT_EQ(base.layers()[1].colour, red);
  const auto circles = all_of_kind<Circle>(base, 1);
  ASSERT_EQ(circles.size(), 2U);
  EXPECT_EQ(circles[1].centre, Point2(30.0, 20.0));
  EXPECT_EQ(all_of_kind<Polyline>(base, 0).size(), 2U);
}

TEST(Drawing, SheetsNeedAnArea) {
  Drawing drawing = one_layer();
  EXPECT_THROW(sheet_round("empty", drawing), InputError);
  drawing.add(0, Circle{{0.0, 0.0}, 10.0});
  const Sheet sheet = sheet_round("circle", drawing, 5.0);
  EXPECT_NEAR(sheet.width(), 30.0, 1e-12);
  EXPECT_NEAR(sheet.height(), 30.0, 1e-12);
  EXPECT_THAT(
      [&] {
        require_page({"flat", drawing, {{0.0, 0.0}, {10.0, 0.0}}});
      },
      ThrowsMessage<InputError>(HasSubstr("sheet \"flat\"")));
}

TEST(TextMetrics, TakeEveryCharacterFromTheFontThatHasIt) {
  const auto runs = text_runs("A\u00b1\u2207\u03b1\u20ac");
  ASSERT_EQ(runs.size(), 3U);
  EXPECT_EQ(runs[0].bytes, "A\xB1");
  EXPECT_EQ(runs[1].font, Font::symbol);
  EXPECT_EQ(runs[1].bytes, "\xD1\x61");
  EXPECT_EQ(runs[2].bytes, "\x80");
  EXPECT_NEAR(runs[0].width, 0.667 + 0.584, 1e-12);
  EXPECT_EQ(text_runs("\u4e00").at(0).bytes, "?");
}

TEST(TextMetrics, BytesThatAreNotUtf8AreReplaced) {
  // A lone continuation, a cut sequence, an overlong '/', a surrogate, beyond Unicode.
  for (const char* bad : {"\x80", "\xE2\x88", "\xC0\xAF", "\xED\xA0\x80", "\xF4\x90\x80\x80"}) {
    for (const char32_t c : code_points(bad)) EXPECT_EQ(c, 0xFFFDU) << bad;
  }
  EXPECT_EQ(code_points("\xF0\x9F\x9A\xA2").at(0), 0x1F6A2U);
}

TEST(Annotations, DimensionsAreReadFromBelowOrFromTheRight) {
  for (const double degrees : {0.0, 30.0, 90.0, 120.0, 180.0, 210.0, 270.0, 300.0}) {
    Drawing drawing = one_layer();
    const double angle = degrees * std::numbers::pi / 180.0;
    const Vector2 along(std::cos(angle), std::sin(angle));
    add_dimension(drawing, 0, Point2::Zero(), 40.0 * along, 8.0, "40");
    const auto texts = all_of_kind<Text>(drawing);
    ASSERT_EQ(texts.size(), 1U);
    EXPECT_GT(texts[0].rotation, -90.0 - 1e-6);
    EXPECT_LT(texts[0].rotation, 90.0 + 1e-6);
    // The text lies along the line, on its upper side, at the middle.
    const double turned = texts[0].rotation * std::numbers::pi / 180.0;
    const Vector2 reading(std::cos(turned), std::sin(turned));
    EXPECT_NEAR(std::abs(reading.dot(along)), 1.0, 1e-9);
    const Point2 middle = 20.0 * along + 8.0 * Vector2(-along.y(), along.x());
    EXPECT_NEAR((texts[0].place - middle).dot(reading), 0.0, 1e-9);
    EXPECT_NEAR((texts[0].place - middle).dot(Vector2(-reading.y(), reading.x())), 1.0, 1e-9);
  }
}

TEST(Annotations, ArrowsPointAtTheEndsFromInsideOrOutside) {
  for (const double length : {40.0, 5.0}) {
    Drawing drawing = one_layer();
    add_dimension(drawing, 0, {0.0, 0.0}, {length, 0.0}, 10.0, "length");
    const auto arrows = all_of_kind<Fill>(drawing);
    ASSERT_EQ(arrows.size(), 2U);
    EXPECT_LT((evaluate(arrows[0].chains[0][0], 0.0) - Point2(0.0, 10.0)).norm(), 1e-12);
    EXPECT_LT((evaluate(arrows[1].chains[0][0], 0.0) - Point2(length, 10.0)).norm(), 1e-12);
    const double inwards = extent(Entity(arrows[0])).upper.x();
    EXPECT_NEAR(inwards, length > 10.0 ? 2.5 : 0.0, 1e-9);
  }
  Drawing drawing = one_layer();
  EXPECT_THROW(add_dimension(drawing, 0, {1.0, 1.0}, {1.0, 1.0}, 5.0, ""), InputError);
}

TEST(Annotations, ScaleBarsAreAsLongAsTheySay) {
  Drawing drawing = one_layer();
  add_scale_bar(drawing, 0, {5.0, 5.0}, 100.0, "100 mm");
  const auto lines = all_of_kind<Polyline>(drawing);
  ASSERT_EQ(lines.size(), 12U);
  EXPECT_EQ(lines[0].points.col(0), Point2(5.0, 5.0));
  EXPECT_EQ(lines[0].points.col(1), Point2(105.0, 5.0));
  for (int i = 0; i <= 10; ++i) EXPECT_DOUBLE_EQ(lines[static_cast<std::size_t>(i) + 1].points(0, 0), 5.0 + 10.0 * i);
  EXPECT_THROW(add_scale_bar(drawing, 0, {0.0, 0.0}, -1.0, ""), InputError);
}

TEST(Annotations, TitleBlocksHoldTheirTexts) {
  const TitleBlock block{"A title that is rather long for the smallest block that there may be, as titles are",
                         "1:1",
                         {{"material", "plywood of 2 mm thickness, glued"}, {"number of boards", "108"}}};
  Drawing drawing = one_layer();
  add_title_block(drawing, 0, block, {200.0, 10.0});
  const Vector2 size = title_block_size(block);
  for (const Text& text : all_of_kind<Text>(drawing)) {
    const Rectangle bounds = extent(Entity(text));
    EXPECT_GT(bounds.lower.x(), 200.0 - size.x());
    EXPECT_LT(bounds.upper.x(), 200.0);
    EXPECT_GT(bounds.lower.y(), 10.0);
    EXPECT_LT(bounds.upper.y(), 10.0 + size.y());
  }
  EXPECT_EQ(all_of_kind<Text>(drawing).size(), 7U);
}

}  // namespace
}  // namespace isorim::io::drawing
