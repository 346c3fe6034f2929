#include "geometry/tspline/partial_lines.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "geometry/errors.h"

namespace isorim::geometry {
namespace {

/// Which unit edges of the domain's lines are there.
class Drawing {
 public:
  Drawing(const KnotVector& knots_u, const KnotVector& knots_v) : knots_{&knots_u, &knots_v} {
    for (std::size_t d = 0; d < 2; ++d)
      edges_[d].assign(knots_[d]->knots().size(), std::vector<char>(knots_[1 - d]->knots().size(), 1));
  }

  const KnotVector& knots(Direction d) const { return *knots_[index(d)]; }
  std::vector<char>& line(Direction d, int line) { return edges_[index(d)][static_cast<std::size_t>(line)]; }
  bool has_edge(Direction d, int line, int cell) const {
    return edges_[index(d)][static_cast<std::size_t>(line)][static_cast<std::size_t>(cell)] != 0;
  }

 private:
  std::array<const KnotVector*, 2> knots_;
  std::array<std::vector<std::vector<char>>, 2> edges_;
};

char letter(Direction d) {
  return "uv"[index(d)];
}

/// Lines first to last of the domain have this knot. Throws GeometryError if none has.
struct Lines {
  int first = 0;
  int last = 0;
};
Lines lines_of(const KnotVector& knots, double value, const std::string& what) {
  const auto begin = knots.knots().begin() + knots.degree();
  const auto end = knots.knots().begin() + knots.basis_count() + 1;
  const auto [lower, upper] = std::equal_range(begin, end, value);
  if (lower == upper)
    throw GeometryError(
        fmt::format("T-mesh: {} at {}, which is no knot between {} and {}", what, value, *begin, *(end - 1)));
  const auto start = knots.knots().begin();
  return {static_cast<int>(lower - start), static_cast<int>(upper - start) - 1};
}

Lines partial_lines(const KnotVector& knots, double value, Direction d) {
  const Interval domain = knots.domain();
  if (!(domain.first < value && value < domain.last))
    throw GeometryError(
        fmt::format("T-mesh: the line {} = {} cannot be given by parts; expected a knot between {} and {}", letter(d),
                    value, domain.first, domain.last));
  return lines_of(knots, value, fmt::format("a line {} is drawn", letter(d)));
}

void draw(Drawing& drawing, Direction d, std::span<const PartialLine> parts) {
  for (const PartialLine& part : parts) {
    const Lines lines = partial_lines(drawing.knots(d), part.knot, d);
    for (int line = lines.first; line <= lines.last; ++line)
      std::fill(drawing.line(d, line).begin(), drawing.line(d, line).end(), char{0});
  }
  const Direction along = other(d);
  for (const PartialLine& part : parts) {
    const std::string what = fmt::format("the line {} = {} has an end", letter(d), part.knot);
    if (!(part.range.first < part.range.last))
      throw GeometryError(fmt::format("T-mesh: the line {} = {} runs from {} = {} to {}; expected a larger value",
                                      letter(d), part.knot, letter(along), part.range.first, part.range.last));
    const int first = lines_of(drawing.knots(along), part.range.first, what).last;
    const int last = lines_of(drawing.knots(along), part.range.last, what).first;
    const Lines lines = partial_lines(drawing.knots(d), part.knot, d);
    for (int line = lines.first; line <= lines.last; ++line)
      std::fill(drawing.line(d, line).begin() + first, drawing.line(d, line).begin() + last, char{1});
  }
}

/// Faces are rectangles exactly when no line ends between others or turns a corner.
void require_rectangles(const Drawing& drawing, const IndexBox& domain) {
  for (int j = domain.first[1] + 1; j < domain.last[1]; ++j) {
    for (int i = domain.first[0] + 1; i < domain.last[0]; ++i) {
      const bool left = drawing.has_edge(Direction::v, j, i - 1);
      const bool right = drawing.has_edge(Direction::v, j, i);
      const bool below = drawing.has_edge(Direction::u, i, j - 1);
      const bool above = drawing.has_edge(Direction::u, i, j);
      if ((left == right && below == above) || (left && right) || (below && above)) continue;
      const std::string place = fmt::format("({}, {})", drawing.knots(Direction::u)[i], drawing.knots(Direction::v)[j]);
      if (left != right && below != above)
        throw GeometryError(fmt::format("T-mesh: two lines end in a corner at (u, v) = {}; one must run on", place));
      const Direction d = left != right ? Direction::v : Direction::u;
      throw GeometryError(fmt::format("T-mesh: the line {} = {} ends at (u, v) = {}, where no line crosses it",
                                      letter(d), drawing.knots(d)[d == Direction::v ? j : i], place));
    }
  }
}

/// The rectangles that the lines bound, from their lower corners.
std::vector<IndexBox> faces(const Drawing& drawing, const IndexBox& domain) {
  const auto is_border = [&](Direction d, int line) {
    return line == domain.first[index(d)] || line == domain.last[index(d)];
  };
  const auto divided = [&](Direction d, int line, int cell) {
    return is_border(d, line) || drawing.has_edge(d, line, cell);
  };
  std::vector<IndexBox> result;
  for (int j = domain.first[1]; j < domain.last[1]; ++j) {
    for (int i = domain.first[0]; i < domain.last[0]; ++i) {
      if (!divided(Direction::u, i, j) || !divided(Direction::v, j, i)) continue;
      IndexBox box{{i, j}, {i + 1, j + 1}};
      while (!divided(Direction::u, box.last[0], j)) ++box.last[0];
      while (!divided(Direction::v, box.last[1], i)) ++box.last[1];
      result.push_back(box);
    }
  }
  return result;
}

}  // namespace

TMesh mesh_of_lines(const KnotVector& knots_u, const KnotVector& knots_v, std::span<const PartialLine> lines_u,
                    std::span<const PartialLine> lines_v) {
  Drawing drawing(knots_u, knots_v);
  draw(drawing, Direction::u, lines_u);
  draw(drawing, Direction::v, lines_v);
  const std::array<int, 2> degrees{knots_u.degree(), knots_v.degree()};
  const std::array<int, 2> counts{static_cast<int>(knots_u.knots().size()), static_cast<int>(knots_v.knots().size())};
  const IndexBox domain = IndexMesh(degrees, counts).domain();
  require_rectangles(drawing, domain);
  return {knots_u, knots_v, IndexMesh(degrees, counts, faces(drawing, domain))};
}

}  // namespace isorim::geometry
