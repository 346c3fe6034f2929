#include "geometry/trimming/face_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/intersection/plane_pieces.h"
#include "geometry/trimming/loop_pieces.h"

namespace isorim::geometry {
namespace {

/// A place on the perimeter of a cell. Side 0 is the lower one; they follow counter-clockwise, each with its first
/// corner, and `along` increases along them (it is -u on the upper, -v on the left side).
struct PerimeterPlace {
  int side = 0;
  double along = 0.0;

  friend bool operator==(const PerimeterPlace&, const PerimeterPlace&) = default;
  friend bool operator<(const PerimeterPlace& a, const PerimeterPlace& b) {
    return a.side != b.side ? a.side < b.side : a.along < b.along;
  }
};

/// By how much the coverage of the perimeter, walked counter-clockwise, changes at a place: the boundary of the region
/// is closed, so what arrives there leaves again.
struct CoverageJump {
  PerimeterPlace place;
  int jump = 0;
};

struct Box {
  Point2 lower = Point2::Constant(std::numeric_limits<double>::infinity());
  Point2 upper = Point2::Constant(-std::numeric_limits<double>::infinity());

  void add(const Point2& point) {
    lower = lower.cwiseMin(point);
    upper = upper.cwiseMax(point);
  }
};

/// Widens the box until it holds the piece, by no more than a small part of its size too much.
void add_piece(Box& box, const PlanePiece& piece, int depth = 0) {
  constexpr int deepest = 5;
  constexpr double allowed_excess = 1.0 / 64.0;
  const Vector2 excess = (box.lower - piece.lower).cwiseMax(piece.upper - box.upper);
  if ((excess.array() <= 0.0).all()) return;
  if (depth == deepest || (excess.array() <= allowed_excess * (box.upper - box.lower).array()).all()) {
    box.add(piece.lower);
    box.add(piece.upper);
    return;
  }
  const auto [left, right] = bisect(piece);
  box.add(left.end());
  add_piece(box, left, depth + 1);
  add_piece(box, right, depth + 1);
}

/// The piece in the unit cell of a rectangle, reparametrised so that its end weights are 1: its ends are then the same
/// bits as those of its neighbours.
HomogeneousPoints<2> in_unit_cell(const CutPiece& piece, Interval u, Interval v) {
  const Eigen::Index degree = piece.net.cols() - 1;
  const double ratio = piece.net(2, 0) == piece.net(2, degree)
                           ? 1.0
                           : std::pow(piece.net(2, 0) / piece.net(2, degree), 1.0 / static_cast<double>(degree));
  const auto mapped = [&](const Point2& uv) {
    return Point2((uv.x() - u.first) / u.length(), (uv.y() - v.first) / v.length());
  };
  HomogeneousPoints<2> net(3, degree + 1);
  double factor = 1.0 / piece.net(2, 0);
  for (Eigen::Index i = 0; i <= degree; ++i, factor *= ratio) {
    const double weight = i == 0 || i == degree ? 1.0 : piece.net(2, i) * factor;
    net.col(i) << weight * mapped(piece.net.col(i).head<2>() / piece.net(2, i)), weight;
  }
  net.col(0).head<2>() = mapped(piece.start.uv());
  net.col(degree).head<2>() = mapped(piece.end.uv());
  return net;
}

/// One cell and the pieces inside it.
class CellWalk {
 public:
  explicit CellWalk(const ParameterGrid& grid) : grid_(grid) {}

  void move_to(int column, int row) {
    column_ = column;
    row_ = row;
    u_ = grid_.u.span(column);
    v_ = grid_.v.span(row);
  }

  /// coverage: of the left side just above the lower left corner. Returns that of the right side just above the lower
  /// right corner.
  int walk(int coverage, std::span<const CutPiece* const> pieces);

  /// The state of the cell after the walk; its region, if it has one, is appended.
  std::int32_t conclude(std::span<const CutPiece* const> pieces, std::vector<CellRegion>& regions) const;

 private:
  void add_jump(const GridPoint& point, int jump);
  void require_single_cover() const;
  Box bounding_box(std::span<const CutPiece* const> pieces) const;
  std::array<Interval, 2> rectangle(const Box& box) const;
  Point2 position(const PerimeterPlace& place) const;

  struct Edge {
    Point2 from;
    Point2 to;
    int coverage = 0;
  };

  const ParameterGrid& grid_;
  int column_ = 0;
  int row_ = 0;
  Interval u_;
  Interval v_;
  std::vector<CoverageJump> jumps_;
  std::vector<Edge> edges_;
};

void CellWalk::add_jump(const GridPoint& point, int jump) {
  const bool left = point.u.station == 2 * column_;
  const bool right = point.u.station == 2 * column_ + 2;
  const bool lower = point.v.station == 2 * row_;
  const bool upper = point.v.station == 2 * row_ + 2;
  if (lower && !right)
    jumps_.push_back({{0, point.u.value}, jump});
  else if (right && !upper)
    jumps_.push_back({{1, point.v.value}, jump});
  else if (upper && !left)
    jumps_.push_back({{2, -point.u.value}, jump});
  else if (left)
    jumps_.push_back({{3, -point.v.value}, jump});
}

Point2 CellWalk::position(const PerimeterPlace& place) const {
  switch (place.side) {
    case 0:
      return {place.along, v_.first};
    case 1:
      return {u_.last, place.along};
    case 2:
      return {-place.along, v_.last};
    default:
      return {u_.first, -place.along};
  }
}

int CellWalk::walk(int coverage, std::span<const CutPiece* const> pieces) {
  const std::array<PerimeterPlace, 4> corners{{{0, u_.first}, {1, v_.first}, {2, -u_.last}, {3, -v_.last}}};
  jumps_.clear();
  edges_.clear();
  for (const PerimeterPlace& corner : corners) jumps_.push_back({corner, 0});
  for (const CutPiece* piece : pieces) {
    add_jump(piece->start, -1);
    add_jump(piece->end, 1);
  }
  std::sort(jumps_.begin(), jumps_.end(),
            [](const CoverageJump& a, const CoverageJump& b) { return a.place < b.place; });

  const int initial = coverage;
  int right_side = coverage;
  Point2 here = position(corners[0]);
  for (std::size_t i = 0; i < jumps_.size();) {
    const PerimeterPlace place = jumps_[i].place;
    int jump = 0;
    for (; i < jumps_.size() && jumps_[i].place == place; ++i) jump += jumps_[i].jump;
    const bool is_corner = std::ranges::find(corners, place) != corners.end();
    if (jump == 0 && !is_corner) continue;
    const Point2 next = position(place);
    if (coverage != 0 && here != next) edges_.push_back({here, next, coverage});
    here = next;
    coverage += jump;
    if (place == corners[1]) right_side = coverage;
  }
  if (coverage != 0) edges_.push_back({here, position(corners[0]), coverage});
  if (coverage != initial)
    throw NumericalError(
        fmt::format("trimming: the curves in the cell u in [{:.9g}, {:.9g}], v in [{:.9g}, {:.9g}] "
                    "do not close",
                    u_.first, u_.last, v_.first, v_.last));
  return right_side;
}

/// For a cell without curves inside that is not covered once or never: only where that can be a small overlap.
void CellWalk::require_single_cover() const {
  constexpr double negligible = TrimmedSurface::parameter_tolerance;
  const int coverage = edges_.front().coverage;
  if (u_.length() <= negligible * grid_.u.length() || v_.length() <= negligible * grid_.v.length()) return;
  throw GeometryError(
      fmt::format("the loops run {} times around ({:.9g}, {:.9g}) in the surface's parameters; expected "
                  "once or never (loops overlap or run the wrong way round)",
                  coverage, u_.middle(), v_.middle()));
}

Box CellWalk::bounding_box(std::span<const CutPiece* const> pieces) const {
  Box box;
  for (const Edge& edge : edges_) {
    box.add(edge.from);
    box.add(edge.to);
  }
  for (const CutPiece* piece : pieces) {
    box.add(piece->start.uv());
    box.add(piece->end.uv());
  }
  for (const CutPiece* piece : pieces) add_piece(box, PlanePiece(piece->net));
  return box;
}

/// The box with the sides of the cell where they are near.
std::array<Interval, 2> CellWalk::rectangle(const Box& box) const {
  constexpr double near = 1.0 / 64.0;
  std::array<Interval, 2> sides{u_, v_};
  for (Eigen::Index d = 0; d < 2; ++d) {
    Interval& side = sides[static_cast<std::size_t>(d)];
    const double reach = near * side.length();
    if (box.lower[d] > side.first + reach) side.first = box.lower[d];
    if (box.upper[d] < side.last - reach) side.last = box.upper[d];
  }
  return sides;
}

std::int32_t CellWalk::conclude(std::span<const CutPiece* const> pieces, std::vector<CellRegion>& regions) const {
  if (pieces.empty()) require_single_cover();
  const Box box = bounding_box(pieces);
  const Vector2 rounding = 4.0 * Vector2(grid_.u.tolerance(), grid_.v.tolerance());
  if (((box.upper - box.lower).array() <= rounding.array()).any()) return FaceCells::outside;

  const auto [u, v] = rectangle(box);
  const Point2 corner(u.first, v.first);
  const Vector2 size(u.length(), v.length());
  CellRegion& cell = regions.emplace_back(CellRegion{u, v, {}});
  for (const CutPiece* piece : pieces) cell.region.curves.push_back(in_unit_cell(*piece, u, v));
  for (const Edge& edge : edges_) {
    Point2 from = (edge.from - corner).cwiseQuotient(size);
    Point2 to = (edge.to - corner).cwiseQuotient(size);
    if (edge.coverage < 0) std::swap(from, to);
    for (int i = 0; i < std::abs(edge.coverage); ++i) cell.region.curves.push_back(line_piece(from, to).net);
  }
  return static_cast<std::int32_t>(regions.size()) - 1;
}

/// The pieces inside the cells, cell by cell.
class SortedPieces {
 public:
  SortedPieces(std::span<const CutPiece> pieces, int columns) {
    std::vector<std::pair<std::int64_t, const CutPiece*>> keyed;
    keyed.reserve(pieces.size());
    for (const CutPiece& piece : pieces)
      if (!piece.is_along_line())
        keyed.emplace_back(cell_number(piece.station[0] / 2, piece.station[1] / 2, columns), &piece);
    std::ranges::sort(keyed);
    for (const auto& [cell, piece] : keyed) {
      cells_.push_back(cell);
      pieces_.push_back(piece);
    }
  }

  /// Cells must be asked for in increasing order.
  std::span<const CutPiece* const> take(int column, int row, int columns) {
    const std::int64_t cell = cell_number(column, row, columns);
    const std::size_t first = next_;
    while (next_ < cells_.size() && cells_[next_] == cell) ++next_;
    return std::span(pieces_).subspan(first, next_ - first);
  }

 private:
  static std::int64_t cell_number(int column, int row, int columns) {
    return column + static_cast<std::int64_t>(row) * columns;
  }

  std::vector<std::int64_t> cells_;
  std::vector<const CutPiece*> pieces_;
  std::size_t next_ = 0;
};

/// For each line of constant u and each row (lines fastest): how many pieces run upwards along the line just above the
/// lower end of the row, less those that run downwards. The cell on the left is covered that many times more than the
/// one on the right.
std::vector<int> runs_along_lines(std::span<const CutPiece> pieces, int columns, int rows) {
  const auto lines = static_cast<std::size_t>(columns) + 1;
  std::vector<int> runs(lines * static_cast<std::size_t>(rows), 0);
  for (const CutPiece& piece : pieces) {
    if (piece.station[0] % 2 != 0) continue;
    const int row = piece.station[1] / 2;
    int& run = runs[static_cast<std::size_t>(piece.station[0] / 2) + lines * static_cast<std::size_t>(row)];
    if (piece.start.v.station == 2 * row) ++run;
    if (piece.end.v.station == 2 * row) --run;
  }
  return runs;
}

/// The spans nearest to a knot span that count: itself, or its neighbours on both sides.
std::array<int, 2> nearest_spans(const std::vector<int>& spans, std::size_t index) {
  const auto counts = [](int span) { return span >= 0; };
  const auto here = spans.begin() + static_cast<std::ptrdiff_t>(index);
  const auto after = std::find_if(here, spans.end(), counts);
  const auto before = std::find_if(std::make_reverse_iterator(here + 1), spans.rend(), counts);
  const int lower = before != spans.rend() ? *before : *after;
  return {lower, after != spans.end() ? *after : lower};
}

/// The cells of all knot spans from those of the spans that count. The others are whole if they lie among whole ones.
FaceCells with_all_spans(FaceCells merged, const ParameterGrid& grid) {
  const std::vector<int>& in_u = grid.u.spans();
  const std::vector<int>& in_v = grid.v.spans();
  if (in_u.size() == static_cast<std::size_t>(merged.columns) && in_v.size() == static_cast<std::size_t>(merged.rows))
    return merged;
  FaceCells cells{static_cast<int>(in_u.size()), static_cast<int>(in_v.size()), {}, {}};
  for (std::size_t row = 0; row < in_v.size(); ++row)
    for (std::size_t column = 0; column < in_u.size(); ++column) {
      if (in_u[column] >= 0 && in_v[row] >= 0) {
        cells.state.push_back(merged.at(in_u[column], in_v[row]));
        continue;
      }
      bool whole = true;
      for (const int v : nearest_spans(in_v, row))
        for (const int u : nearest_spans(in_u, column)) whole = whole && merged.at(u, v) == FaceCells::whole;
      cells.state.push_back(whole ? FaceCells::whole : FaceCells::outside);
    }
  cells.regions = std::move(merged.regions);
  return cells;
}

}  // namespace

FaceCells assemble_cells(std::span<const CutPiece> pieces, const ParameterGrid& grid) {
  FaceCells cells;
  cells.columns = grid.u.span_count();
  cells.rows = grid.v.span_count();
  cells.state.reserve(static_cast<std::size_t>(cells.columns) * static_cast<std::size_t>(cells.rows));
  SortedPieces sorted(pieces, cells.columns);
  const std::vector<int> runs = runs_along_lines(pieces, cells.columns, cells.rows);
  CellWalk cell(grid);
  auto run = runs.begin();
  for (int row = 0; row < cells.rows; ++row) {
    // Outside the domain nothing is kept.
    int coverage = -*run++;
    for (int column = 0; column < cells.columns; ++column) {
      const std::span<const CutPiece* const> inside = sorted.take(column, row, cells.columns);
      if (inside.empty() && (coverage == 0 || coverage == 1)) {
        cells.state.push_back(coverage == 0 ? FaceCells::outside : FaceCells::whole);
      } else {
        cell.move_to(column, row);
        coverage = cell.walk(coverage, inside);
        cells.state.push_back(cell.conclude(inside, cells.regions));
      }
      coverage -= *run++;
    }
    if (coverage != 0)
      throw NumericalError(fmt::format("trimming: the curves in row {} of the surface's knot spans do not close", row));
  }
  return with_all_spans(std::move(cells), grid);
}

FaceCells cut_into_cells(const TrimmedSurface& face) {
  const ParameterGrid grid(face.surface());
  return assemble_cells(cut_at_knot_lines(face.loops(), grid), grid);
}

}  // namespace isorim::geometry
