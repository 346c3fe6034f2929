#include "io/drawing/tiles.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/drawing/annotations.h"
#include "io/drawing/ink.h"
#include "io/drawing/text_metrics.h"

namespace isorim::io::drawing {

namespace {

using geometry::Point2;
using geometry::Vector2;

constexpr int most_tiles = 10000;
constexpr double text_height = 2.2;
constexpr double bar_length = 50.0;
constexpr double map_size = 12.0;
/// Of what exceeds a page by rounding only.
constexpr double slack = 1e-9;

/// One way to lay the paper, and what that makes.
struct Grid {
  double paper_width = 0.0;
  double paper_height = 0.0;
  /// What a page can show.
  Vector2 window = Vector2::Zero();
  double overlap = 0.0;
  int columns = 1;
  int rows = 1;

  int count() const { return columns * rows; }
  /// From one page to the next.
  Vector2 step() const { return window.array() - overlap; }
};

int pages_for(double length, double window, double overlap) {
  if (length <= window + slack) return 1;
  const double pages = std::ceil((length - overlap - slack) / (window - overlap));
  return pages > most_tiles ? most_tiles + 1 : static_cast<int>(pages);
}

Grid grid_on(const Sheet& sheet, const Tiling& tiling, double paper_width, double paper_height) {
  Grid grid{paper_width, paper_height, {}, tiling.overlap};
  grid.window = {paper_width - 2.0 * tiling.margin, paper_height - tiling.margin - tiling.foot};
  if (grid.window.minCoeff() <= tiling.overlap) {
    throw InputError(
        fmt::format("tiles: paper of {} x {} mm has no room for margins of {}, a foot of {} and an overlap "
                    "of {} mm",
                    paper_width, paper_height, tiling.margin, tiling.foot, tiling.overlap));
  }
  grid.columns = pages_for(sheet.width(), grid.window.x(), tiling.overlap);
  grid.rows = pages_for(sheet.height(), grid.window.y(), tiling.overlap);
  return grid;
}

void check(const Tiling& tiling) {
  for (const double length : {tiling.paper_width, tiling.paper_height, tiling.margin, tiling.foot, tiling.overlap}) {
    if (!std::isfinite(length) || length < 0.0)
      throw InputError(fmt::format("tiles: a length of {} mm, expected 0 or more", length));
  }
}

Grid best_grid(const Sheet& sheet, const Tiling& tiling) {
  const Grid upright = grid_on(sheet, tiling, tiling.paper_width, tiling.paper_height);
  const Grid turned = grid_on(sheet, tiling, tiling.paper_height, tiling.paper_width);
  const bool is_upright =
      static_cast<double>(upright.columns) * upright.rows <= static_cast<double>(turned.columns) * turned.rows;
  const Grid& best = is_upright ? upright : turned;
  if (static_cast<double>(best.columns) * best.rows > most_tiles)
    throw InputError(fmt::format("sheet \"{}\": {} x {} mm need more than {} pages", sheet.title, sheet.width(),
                                 sheet.height(), most_tiles));
  return best;
}

std::string name_of(int row, int column) {
  return fmt::format("{}{}", row_name(row), column + 1);
}

/// Which pages of a grid there are.
class Pages {
 public:
  explicit Pages(const Grid& grid) : grid_(grid), has_(static_cast<std::size_t>(grid.count()), false) {}

  void take(int row, int column) {
    has_[index(row, column)] = true;
    ++count_;
  }
  bool has(int row, int column) const {
    return row >= 0 && row < grid_.rows && column >= 0 && column < grid_.columns && has_[index(row, column)];
  }
  int count() const { return count_; }

 private:
  std::size_t index(int row, int column) const { return static_cast<std::size_t>(row * grid_.columns + column); }

  const Grid& grid_;
  std::vector<bool> has_;
  int count_ = 0;
};

/// The marks of one tile, in the coordinates of its paper.
class Marks {
 public:
  Marks(const Sheet& sheet, const Grid& grid, const Pages& pages, const Tiling& tiling, Tile& tile)
      : sheet_(sheet), grid_(grid), pages_(pages), tiling_(tiling), tile_(tile) {
    lines_ = tile.marks.add_layer({"tile", {120, 120, 120}, 0.13, LineType::continuous});
    cuts_ = tile.marks.add_layer({"cut here", {120, 120, 120}, 0.13, LineType::dashed});
    label_ = tile.marks.add_layer({"tile label", black, 0.18, LineType::continuous});
  }

  void draw() {
    add_foot();
    if (grid_.count() == 1) return;
    add_map();
    for (const int side : {-1, 1}) {
      if (pages_.has(tile_.row, tile_.column + side)) add_join(side, Vector2::UnitX(), tile_.row, tile_.column + side);
      if (pages_.has(tile_.row + side, tile_.column)) add_join(-side, Vector2::UnitY(), tile_.row + side, tile_.column);
    }
  }

 private:
  void add_foot();
  void add_map();
  void add_join(int side, const Vector2& axis, int row, int column);

  const Sheet& sheet_;
  const Grid& grid_;
  const Pages& pages_;
  const Tiling& tiling_;
  Tile& tile_;
  std::size_t lines_ = 0;
  std::size_t cuts_ = 0;
  std::size_t label_ = 0;
};

/// The text shortened until it fits, with an ellipsis at its end.
std::string fitted(std::string text, double width, double height) {
  if (text_width(text, height) <= width) return text;
  while (!text.empty() && text_width(text + "…", height) > width) {
    while (!text.empty() && (static_cast<unsigned char>(text.back()) & 0xC0U) == 0x80U) text.pop_back();
    if (!text.empty()) text.pop_back();
  }
  return text + "…";
}

void Marks::add_foot() {
  const double left = tiling_.margin;
  const double right = grid_.paper_width - tiling_.margin;
  const double base = 0.5 * tiling_.foot - 2.0;
  const double bar = right - (grid_.count() == 1 ? 0.0 : map_size + 6.0) - bar_length - text_width("50 mm", 1.8);
  add_scale_bar(tile_.marks, label_, {bar, base}, bar_length, "50 mm", 1.8);
  const std::string place = grid_.count() == 1 ? "sheet 1 of 1"
                                               : fmt::format("row {}, column {}, sheet {} of {}", row_name(tile_.row),
                                                             tile_.column + 1, tile_.number, pages_.count());
  const double room = bar - left - 4.0;
  tile_.marks.add(label_, Text{fitted(sheet_.title, room, text_height), {left, base + 4.0}, text_height});
  tile_.marks.add(label_, Text{fitted(place + "; print at 100 %", room, text_height), {left, base}, text_height});
}

/// The pages that there are as boxes in the corner, this one full.
void Marks::add_map() {
  const double cell = map_size / std::max(grid_.columns, grid_.rows);
  const double height = cell * grid_.rows;
  const Point2 lower(grid_.paper_width - tiling_.margin - cell * grid_.columns, 0.5 * (tiling_.foot - height));
  const auto box = [&](int row, int column) {
    const Point2 corner = lower + cell * Vector2(column, grid_.rows - 1 - row);
    return outline({corner, corner + Vector2(cell, cell)});
  };
  const Polyline own = box(tile_.row, tile_.column);
  Chain square;
  for (Eigen::Index i = 0; i < 4; ++i) {
    geometry::Points<2> side(2, 2);
    side << own.points.col(i), own.points.col((i + 1) % 4);
    square.push_back(geometry::NurbsCurve<2>::from_points(geometry::KnotVector::bezier(1), side));
  }
  tile_.marks.add(lines_, Fill{{square}, {120, 120, 120}});
  for (int row = 0; row < grid_.rows; ++row)
    for (int column = 0; column < grid_.columns; ++column)
      if (pages_.has(row, column)) tile_.marks.add(lines_, box(row, column));
}

/// The line in the middle of the strip that the tile shares with a neighbour: to the right (axis x, side 1), above
/// (axis y, side 1), ...
void Marks::add_join(int side, const Vector2& axis, int row, int column) {
  const Point2 lower = tile_.place;
  const Point2 upper = tile_.place + (tile_.part.upper - tile_.part.lower);
  const Vector2 across(axis.y(), axis.x());
  const double at = side > 0 ? upper.dot(axis) - 0.5 * grid_.overlap : lower.dot(axis) + 0.5 * grid_.overlap;
  const double first = lower.dot(across);
  const double last = upper.dot(across);
  const auto place = [&](double along) { return Point2(at * axis + along * across); };
  tile_.marks.add(cuts_, line(place(first), place(last)));
  for (const double fraction : {0.2, 0.8})
    add_registration_mark(tile_.marks, lines_, place(first + fraction * (last - first)));
  const double beyond = 0.25 * grid_.overlap * side;
  tile_.marks.add(lines_, Text{name_of(row, column), place(0.5 * (first + last)) + beyond * axis, 2.0,
                               Horizontal::centre, Vertical::middle});
}

}  // namespace

std::string row_name(int row) {
  std::string name;
  for (int rest = row + 1; rest > 0; rest = (rest - 1) / 26)
    name.insert(name.begin(), static_cast<char>('A' + (rest - 1) % 26));
  return name;
}

namespace {

/// Where the page at a place in the grid begins.
class Places {
 public:
  /// The pages together show more than the sheet: what is left over lies evenly round it.
  Places(const Sheet& sheet, const Grid& grid) : grid_(grid) {
    const Vector2 shown = grid.window + Vector2(grid.columns - 1, grid.rows - 1).cwiseProduct(grid.step());
    corner_ = 0.5 * (sheet.page.lower + sheet.page.upper) - 0.5 * shown;
  }

  Point2 lower(int row, int column) const {
    return corner_ + Vector2(column, grid_.rows - 1 - row).cwiseProduct(grid_.step());
  }
  /// What is left of a page when it is cut where it meets its neighbours.
  Rectangle cell(int row, int column) const {
    const double half = 0.5 * grid_.overlap;
    const Point2 from = lower(row, column);
    const Point2 to = from + grid_.window;
    return {from + half * Vector2(column > 0 ? 1.0 : 0.0, row + 1 < grid_.rows ? 1.0 : 0.0),
            to - half * Vector2(column + 1 < grid_.columns ? 1.0 : 0.0, row > 0 ? 1.0 : 0.0)};
  }

 private:
  const Grid& grid_;
  Point2 corner_;
};

/// All, if nothing is drawn anywhere or there is one page only.
Pages inked_pages(const Sheet& sheet, const Grid& grid, const Places& places) {
  const Ink ink(sheet.drawing);
  const bool takes_all = grid.count() == 1 || !ink.meets(sheet.page);
  Pages pages(grid);
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      if (takes_all || ink.meets(places.cell(row, column))) pages.take(row, column);
  return pages;
}

}  // namespace

std::vector<Tile> tiles_of(const Sheet& sheet, const Tiling& tiling) {
  require_page(sheet);
  check(tiling);
  const Grid grid = best_grid(sheet, tiling);
  const Places places(sheet, grid);
  const Pages pages = inked_pages(sheet, grid, places);
  std::vector<Tile> tiles;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      if (!pages.has(row, column)) continue;
      Tile tile;
      tile.number = static_cast<int>(tiles.size()) + 1;
      tile.row = row;
      tile.column = column;
      tile.paper_width = grid.paper_width;
      tile.paper_height = grid.paper_height;
      const Point2 lower = places.lower(row, column);
      tile.part.lower = lower.cwiseMax(sheet.page.lower);
      tile.part.upper = (lower + grid.window).cwiseMin(sheet.page.upper);
      tile.place = Point2(tiling.margin, tiling.foot) + (tile.part.lower - lower);
      Marks(sheet, grid, pages, tiling, tile).draw();
      tiles.push_back(std::move(tile));
    }
  }
  return tiles;
}

AssemblyMap assembly_map(const Sheet& sheet, const std::vector<Tile>& tiles, const Tiling& tiling) {
  AssemblyMap map;
  const auto room_on = [&](double width, double height) {
    return Vector2(width - 2.0 * tiling.margin, height - tiling.margin - tiling.foot);
  };
  const auto factor_on = [&](double width, double height) {
    return room_on(width, height).cwiseQuotient(sheet.page.upper - sheet.page.lower).minCoeff();
  };
  map.paper_width = tiling.paper_width;
  map.paper_height = tiling.paper_height;
  if (factor_on(map.paper_height, map.paper_width) > factor_on(map.paper_width, map.paper_height))
    std::swap(map.paper_width, map.paper_height);
  const Vector2 room = room_on(map.paper_width, map.paper_height);
  const Vector2 size = sheet.page.upper - sheet.page.lower;
  map.factor = room.cwiseQuotient(size).minCoeff();
  map.place = Point2(tiling.margin, tiling.foot) + 0.5 * (room - map.factor * size);
  const std::size_t lines = map.marks.add_layer({"tile", {120, 120, 120}, 0.13, LineType::continuous});
  const std::size_t label = map.marks.add_layer({"tile label", black, 0.18, LineType::continuous});
  const auto on_paper = [&](const Point2& point) {
    return Point2(map.place + map.factor * (point - sheet.page.lower));
  };
  for (const Tile& tile : tiles) {
    const Rectangle box{on_paper(tile.part.lower), on_paper(tile.part.upper)};
    map.marks.add(lines, outline(box));
    map.marks.add(label, Text{name_of(tile.row, tile.column), 0.5 * (box.lower + box.upper), 5.0, Horizontal::centre,
                              Vertical::middle});
  }
  const double base = 0.5 * tiling.foot - 2.0;
  map.marks.add(label, Text{fitted(sheet.title, room.x(), text_height), {tiling.margin, base + 4.0}, text_height});
  map.marks.add(label, Text{fmt::format("how the {} sheets go together; not to scale", tiles.size()),
                            {tiling.margin, base},
                            text_height});
  return map;
}

}  // namespace isorim::io::drawing
