#include "io/drawing/tiles.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "geometry/shapes/curves.h"
#include "io/drawing/pdf_writer.h"
#include "tests/io/cli/program_test.h"
#include "tests/io/drawing/samples.h"

namespace isorim::io::drawing {
namespace {

using geometry::Point2;
using geometry::Vector2;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

Sheet big_sheet(double width, double height) {
  Drawing drawing;
  const std::size_t layer = drawing.add_layer({"ellipse", black, 0.5});
  const Point2 centre(100.0, -50.0);
  drawing.add(layer, Path{{geometry::ellipse_curve({0.45 * width, 0.4 * height}, centre, 0.1)}});
  drawing.add(layer, line(centre - 0.49 * Vector2(width, height), centre + 0.49 * Vector2(width, height)));
  return {"Big ellipse", drawing, {centre - 0.5 * Vector2(width, height), centre + 0.5 * Vector2(width, height)}};
}

std::vector<std::string> texts_of(const Tile& tile) {
  std::vector<std::string> result;
  for (std::size_t i = 0; i < tile.marks.layers().size(); ++i) {
    for (const Entity& entity : tile.marks.entities(i))
      if (const auto* text = std::get_if<Text>(&entity)) result.push_back(text->text);
  }
  return result;
}

/// The centres of registration marks, in the coordinates of the drawing.
std::vector<Point2> registration_marks(const Tile& tile) {
  std::vector<Point2> result;
  for (const Entity& entity : tile.marks.entities(tile.marks.layer("tile")))
    if (const auto* circle = std::get_if<Circle>(&entity))
      result.push_back(circle->centre - tile.place + tile.part.lower);
  return result;
}

TEST(Tiles, RowsAreNamedByLetters) {
  EXPECT_EQ(row_name(0), "A");
  EXPECT_EQ(row_name(25), "Z");
  EXPECT_EQ(row_name(26), "AA");
  EXPECT_EQ(row_name(701), "ZZ");
  EXPECT_EQ(row_name(702), "AAA");
}

TEST(Tiles, WhatFitsIsOnePageInItsMiddle) {
  const auto tiles = tiles_of(big_sheet(190.0, 267.0));
  ASSERT_EQ(tiles.size(), 1U);
  EXPECT_EQ(tiles[0].paper_width, 210.0);
  EXPECT_LT((tiles[0].place - Point2(10.0, 20.0)).norm(), 1e-12);
  EXPECT_THAT(texts_of(tiles[0]), ::testing::Contains(HasSubstr("sheet 1 of 1")));
  EXPECT_TRUE(registration_marks(tiles[0]).empty());
  // Wide sheets turn the paper.
  const auto wide = tiles_of(big_sheet(270.0, 100.0));
  ASSERT_EQ(wide.size(), 1U);
  EXPECT_EQ(wide[0].paper_width, 297.0);
  EXPECT_NEAR(wide[0].place.x(), 0.5 * (297.0 - 270.0), 1e-12);
}

TEST(Tiles, ShowTheWholeSheetWithItsOverlaps) {
  const Sheet sheet = big_sheet(600.0, 500.0);
  const auto tiles = tiles_of(sheet);
  // Upright 4 x 2 pages, as many as 2.. turned: 190 x 267 a page, 10 of overlap.
  ASSERT_EQ(tiles.size(), 8U - (tiles[0].paper_width > 250.0 ? 1U : 0U) * 2U);
  for (int i = 0; i < 200; ++i) {
    for (int j = 0; j < 200; ++j) {
      const Point2 point =
          sheet.page.lower + Vector2(sheet.width() * (i + 0.5) / 200.0, sheet.height() * (j + 0.5) / 200.0);
      const auto shows = [&](const Tile& tile) {
        return (tile.part.lower.array() <= point.array()).all() && (point.array() <= tile.part.upper.array()).all();
      };
      EXPECT_GE(std::count_if(tiles.begin(), tiles.end(), shows), 1);
    }
  }
  for (const Tile& tile : tiles) {
    EXPECT_GE(tile.place.x(), 10.0 - 1e-9);
    EXPECT_GE(tile.place.y(), 20.0 - 1e-9);
    EXPECT_LE((tile.place + tile.part.upper - tile.part.lower).x(), tile.paper_width - 10.0 + 1e-9);
    EXPECT_LE((tile.place + tile.part.upper - tile.part.lower).y(), tile.paper_height - 10.0 + 1e-9);
  }
  for (const Tile& tile : tiles) {
    for (const Tile& right : tiles) {
      if (right.row != tile.row || right.column != tile.column + 1) continue;
      EXPECT_NEAR(tile.part.upper.x() - right.part.lower.x(), 10.0, 1e-9);
    }
  }
}

TEST(Tiles, RegistrationMarksLieOnBothNeighbours) {
  const auto tiles = tiles_of(big_sheet(600.0, 700.0));
  ASSERT_GT(tiles.size(), 4U);
  for (const Tile& tile : tiles) {
    for (const Point2& mark : registration_marks(tile)) {
      int count = 0;
      for (const Tile& other : tiles) {
        for (const Point2& same : registration_marks(other)) count += (same - mark).norm() < 1e-9 ? 1 : 0;
      }
      EXPECT_EQ(count, 2) << tile.row << ' ' << tile.column << ": " << mark.transpose();
    }
  }
}

TEST(Tiles, AreLabelledInOrder) {
  const auto tiles = tiles_of(big_sheet(560.0, 1000.0));
  const int columns = tiles.back().column + 1;
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    const Tile& tile = tiles[i];
    EXPECT_EQ(tile.row * columns + tile.column, static_cast<int>(i));
    const auto texts = texts_of(tile);
    EXPECT_THAT(texts, ::testing::Contains("Big ellipse"));
    EXPECT_THAT(texts,
                ::testing::Contains(HasSubstr(fmt::format("row {}, column {}, sheet {} of {}", row_name(tile.row),
                                                          tile.column + 1, i + 1, tiles.size()))));
    EXPECT_THAT(texts, ::testing::Contains("50 mm"));
  }
  // The neighbours' names: the first tile has one on the right and one below.
  EXPECT_THAT(texts_of(tiles[0]), ::testing::IsSupersetOf({"A2", "B1"}));
}

/// Thin lines alone, so that most pages of the sheet are blank.
Sheet mostly_blank_sheet() {
  Drawing drawing;
  const std::size_t layer = drawing.add_layer({"lines", black, 0.35});
  drawing.add(layer, line({0.0, 0.0}, {900.0, 1100.0}));
  drawing.add(layer, Path{{geometry::circular_arc(300.0, {600.0, 300.0}, 0.1, 1.3)}});
  drawing.add(layer, Text{"corner", {20.0, 1090.0}, 3.5});
  return {"Lines", drawing, {{-5.0, -5.0}, {905.0, 1105.0}}};
}

TEST(Tiles, LeaveOutBlankPages) {
  const Sheet sheet = mostly_blank_sheet();
  const auto tiles = tiles_of(sheet);
  const auto has = [&](int row, int column) {
    return std::ranges::any_of(tiles, [&](const Tile& t) { return t.row == row && t.column == column; });
  };
  const auto full = tiles_of(big_sheet(910.0, 1110.0));
  EXPECT_LT(tiles.size(), full.size());
  // All that is drawn is on a page, and not next to its edge only.
  const auto shown = [&](const Point2& point) {
    return std::ranges::any_of(tiles, [&](const Tile& tile) {
      const auto inside = [&](double a, double low, double high, double first, double last) {
        return (low <= first || a >= low + 5.0 - 1e-9) && (high >= last || a <= high - 5.0 + 1e-9);
      };
      return inside(point.x(), tile.part.lower.x(), tile.part.upper.x(), sheet.page.lower.x(), sheet.page.upper.x()) &&
             inside(point.y(), tile.part.lower.y(), tile.part.upper.y(), sheet.page.lower.y(), sheet.page.upper.y()) &&
             (tile.part.lower.array() <= point.array()).all() && (point.array() <= tile.part.upper.array()).all();
    });
  };
  for (int i = 0; i <= 5000; ++i) {
    const double t = i / 5000.0;
    EXPECT_TRUE(shown(Point2(900.0 * t, 1100.0 * t)));
    const double angle = 0.1 + 1.2 * t;
    EXPECT_TRUE(shown(Point2(600.0 + 300.0 * std::cos(angle), 300.0 + 300.0 * std::sin(angle))));
  }
  EXPECT_TRUE(has(0, 0));
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    EXPECT_EQ(tiles[i].number, static_cast<int>(i) + 1);
    const auto texts = texts_of(tiles[i]);
    EXPECT_THAT(texts,
                ::testing::Contains(HasSubstr(fmt::format("row {}, column {}, sheet {} of {};", row_name(tiles[i].row),
                                                          tiles[i].column + 1, i + 1, tiles.size()))));
    // No line to cut, and no name, towards a page that is not there.
    for (const auto& [row, column] : {std::pair{0, 1}, std::pair{0, -1}, std::pair{1, 0}, std::pair{-1, 0}}) {
      const std::string name = row_name(tiles[i].row + row) + std::to_string(tiles[i].column + column + 1);
      EXPECT_EQ(std::ranges::count(texts, name), has(tiles[i].row + row, tiles[i].column + column) ? 1 : 0);
    }
  }
}

TEST(Tiles, HaveAMapThatNamesThem) {
  const Sheet sheet = mostly_blank_sheet();
  const auto tiles = tiles_of(sheet);
  const AssemblyMap map = assembly_map(sheet, tiles);
  std::vector<std::string> names;
  for (const Entity& entity : map.marks.entities(map.marks.layer("tile label"))) {
    const Text& text = std::get<Text>(entity);
    const auto tile = std::ranges::find_if(
        tiles, [&](const Tile& t) { return text.text == row_name(t.row) + std::to_string(t.column + 1); });
    if (tile == tiles.end()) continue;
    names.push_back(text.text);
    // In the middle of what the tile shows.
    const Point2 middle = 0.5 * (tile->part.lower + tile->part.upper);
    EXPECT_LE((map.place + map.factor * (middle - sheet.page.lower) - text.place).norm(), 1e-9);
  }
  EXPECT_EQ(names.size(), tiles.size());
  const Rectangle covered = extent(map.marks);
  EXPECT_GE(covered.lower.minCoeff(), 4.0);
  EXPECT_LE(covered.upper.x(), map.paper_width - 4.0);
  EXPECT_LE(covered.upper.y(), map.paper_height - 4.0);
  // Before the tiles.
  const std::string pdf = to_pdf({&sheet, 1}, {"", Tiling{}});
  EXPECT_THAT(pdf, HasSubstr(fmt::format("/Count {}", tiles.size() + 1)));
  EXPECT_THAT(pdf, HasSubstr("how the"));
}

TEST(Tiles, LabelsStayOnThePaper) {
  Sheet sheet = big_sheet(560.0, 1000.0);
  sheet.title = "A title that is far too long for the foot of the page, and that goes on and on, with ∇ and ä";
  for (const Tile& tile : tiles_of(sheet)) {
    const Rectangle covered = extent(tile.marks);
    EXPECT_GE(covered.lower.x(), 4.0);
    EXPECT_GE(covered.lower.y(), 4.0);
    EXPECT_LE(covered.upper.x(), tile.paper_width - 4.0);
    EXPECT_LE(covered.upper.y(), tile.paper_height - 4.0);
  }
}

TEST(Tiles, RefusePaperWithoutRoom) {
  const Sheet sheet = big_sheet(500.0, 500.0);
  EXPECT_THAT([&] { static_cast<void>(tiles_of(sheet, {.paper_width = 30.0})); },
              ThrowsMessage<InputError>(HasSubstr("no room for margins")));
  EXPECT_THAT([&] { static_cast<void>(tiles_of(sheet, {.overlap = -1.0})); },
              ThrowsMessage<InputError>(HasSubstr("a length of -1 mm")));
  EXPECT_THAT([&] { static_cast<void>(tiles_of(big_sheet(1e5, 1e5))); },
              ThrowsMessage<InputError>(HasSubstr("more than 10000 pages")));
}

/// Poppler's pictures of the tiles, laid over its picture of the whole sheet.
class TiledPdf : public ::isorim::testing::ProgramTest {};

TEST_F(TiledPdf, TilesFitTogether) {
  if (!has_program("pdftoppm")) GTEST_SKIP() << "poppler-utils is not installed";
  const Sheet sheet = big_sheet(420.0, 300.0);
  const auto tiles = tiles_of(sheet);
  write_pdf(folder() / "whole.pdf", {&sheet, 1});
  write_pdf(folder() / "tiles.pdf", {&sheet, 1}, {"", Tiling{}});
  const auto whole = render(folder() / "whole.pdf");
  auto pages = render(folder() / "tiles.pdf");
  ASSERT_EQ(whole.size(), 1U);
  ASSERT_EQ(pages.size(), tiles.size() + 1);
  pages.erase(pages.begin());  // The map of the tiles.
  ASSERT_GE(tiles.size(), 3U);
  int compared = 0;
  for (std::size_t k = 0; k < tiles.size(); ++k) {
    const Tile& tile = tiles[k];
    // From the pixel of the page to that of the whole sheet, both from the upper left corner.
    const double dx = 10.0 * (tile.part.lower.x() - sheet.page.lower.x() - tile.place.x());
    const double dy = 10.0 * (sheet.page.upper.y() - tile.part.lower.y() - tile.paper_height + tile.place.y());
    const auto in_sheet = [&](int x, int y) {
      return std::pair(static_cast<int>(std::lround(x + dx)), static_cast<int>(std::lround(y + dy)));
    };
    const int left = static_cast<int>(std::ceil(10.0 * tile.place.x())) + 3;
    const int bottom = static_cast<int>(std::floor(10.0 * (tile.paper_height - tile.place.y()))) - 3;
    const int right = left + static_cast<int>(10.0 * (tile.part.upper - tile.part.lower).x()) - 8;
    const int top = bottom - static_cast<int>(10.0 * (tile.part.upper - tile.part.lower).y()) + 8;
    for (int y = top; y < bottom; ++y) {
      for (int x = left; x < right; ++x) {
        const auto [sheet_x, sheet_y] = in_sheet(x, y);
        // The marks are grey, the drawing black.
        if (pages[k].at(x, y) < 64) {
          ++compared;
          ASSERT_TRUE(whole[0].is_dark_near(sheet_x, sheet_y, 128)) << k << ": " << x << ' ' << y;
        }
        if (whole[0].at(sheet_x, sheet_y) < 64) {
          ASSERT_TRUE(pages[k].is_dark_near(x, y, 128)) << k << ": " << x << ' ' << y;
        }
      }
    }
  }
  EXPECT_GT(compared, 10000);
}

}  // namespace
}  // namespace isorim::io::drawing
