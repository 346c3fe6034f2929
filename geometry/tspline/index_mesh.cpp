#include "geometry/tspline/index_mesh.h"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

#include "geometry/errors.h"

namespace isorim::geometry {
namespace {

std::string describe(const IndexBox& box) {
  return fmt::format("lines {} to {} of u and {} to {} of v", box.first[0], box.last[0], box.first[1], box.last[1]);
}

void require_inside(const IndexBox& box, const IndexBox& domain, std::size_t number) {
  for (std::size_t d = 0; d < 2; ++d) {
    if (box.first[d] >= box.last[d])
      throw GeometryError(fmt::format("T-mesh: face {} holds no cell: {}", number, describe(box)));
    if (box.first[d] < domain.first[d] || box.last[d] > domain.last[d])
      throw GeometryError(
          fmt::format("T-mesh: face {} ({}) leaves the domain, which has {}", number, describe(box), describe(domain)));
  }
}

/// The beam from an anchor crosses as many lines on each side as half the degree asks for.
void walk(const IndexMesh& mesh, Direction d, int from, int step, int count, int first, int last,
          std::vector<int>& lines) {
  for (int line = from + step; count > 0; line += step) {
    if (!mesh.covers(d, line, first, last)) continue;
    lines.push_back(line);
    --count;
  }
}

}  // namespace

IndexMesh::IndexMesh(std::array<int, 2> degrees, std::array<int, 2> line_counts, std::span<const IndexBox> merged)
    : degrees_(degrees), line_counts_(line_counts) {
  for (std::size_t d = 0; d < 2; ++d)
    if (degrees[d] < 1 || line_counts[d] < 2 * (degrees[d] + 1))
      throw GeometryError(fmt::format("T-mesh: {} lines of direction {} for degree {}; expected at least {}",
                                      line_counts[d], "uv"[d], degrees[d], 2 * (degrees[d] + 1)));
  face_of_cell_.assign(static_cast<std::size_t>(cells(Direction::u)) * static_cast<std::size_t>(cells(Direction::v)),
                       -1);
  for (std::size_t k = 0; k < merged.size(); ++k) {
    require_inside(merged[k], domain(), k);
    claim_cells(merged, k);
  }
  gather_faces(merged);
  number_cells();
}

void IndexMesh::claim_cells(std::span<const IndexBox> merged, std::size_t k) {
  for (int j = merged[k].first[1]; j < merged[k].last[1]; ++j) {
    for (int i = merged[k].first[0]; i < merged[k].last[0]; ++i) {
      std::int32_t& face = face_of(i, j);
      if (face >= 0)
        throw GeometryError(fmt::format("T-mesh: faces {} and {} overlap: {}; {}", face, k,
                                        describe(merged[static_cast<std::size_t>(face)]), describe(merged[k])));
      face = static_cast<std::int32_t>(k);
    }
  }
}

void IndexMesh::gather_faces(std::span<const IndexBox> merged) {
  const IndexBox whole = domain();
  for (int j = whole.first[1]; j < whole.last[1]; ++j) {
    for (int i = whole.first[0]; i < whole.last[0]; ++i) {
      const std::int32_t face = face_of(i, j);
      if (face < 0) {
        faces_.push_back({{i, j}, {i + 1, j + 1}});
      } else if (merged[static_cast<std::size_t>(face)].first == std::array<int, 2>{i, j}) {
        faces_.push_back(merged[static_cast<std::size_t>(face)]);
      }
    }
  }
}

IndexBox IndexMesh::domain() const {
  return {degrees_, {line_counts_[0] - 1 - degrees_[0], line_counts_[1] - 1 - degrees_[1]}};
}

std::int32_t& IndexMesh::face_of(int i, int j) {
  return face_of_cell_[static_cast<std::size_t>(j - degrees_[1]) * static_cast<std::size_t>(cells(Direction::u)) +
                       static_cast<std::size_t>(i - degrees_[0])];
}

int IndexMesh::face_at(int i, int j) const {
  return face_of_cell_[static_cast<std::size_t>(j - degrees_[1]) * static_cast<std::size_t>(cells(Direction::u)) +
                       static_cast<std::size_t>(i - degrees_[0])];
}

void IndexMesh::number_cells() {
  face_of_cell_.resize(static_cast<std::size_t>(cells(Direction::u)) * static_cast<std::size_t>(cells(Direction::v)));
  for (std::size_t face = 0; face < faces_.size(); ++face)
    for (int j = faces_[face].first[1]; j < faces_[face].last[1]; ++j)
      for (int i = faces_[face].first[0]; i < faces_[face].last[0]; ++i)
        face_of(i, j) = static_cast<std::int32_t>(face);
}

IndexBox IndexMesh::box_at(int i, int j) const {
  const IndexBox whole = domain();
  const std::array<int, 2> cell{i, j};
  std::array<int, 2> inside{};
  for (std::size_t d = 0; d < 2; ++d) inside[d] = std::clamp(cell[d], whole.first[d], whole.last[d] - 1);
  IndexBox box = faces_[static_cast<std::size_t>(face_at(inside[0], inside[1]))];
  for (std::size_t d = 0; d < 2; ++d) {
    if (inside[d] == cell[d]) continue;
    box.first[d] = cell[d];
    box.last[d] = cell[d] + 1;
  }
  return box;
}

bool IndexMesh::has_edge(Direction d, int line, int cell) const {
  const IndexBox whole = domain();
  const std::size_t across = index(d);
  const std::size_t along = index(other(d));
  if (line <= whole.first[across] || line >= whole.last[across]) return true;
  std::array<int, 2> beyond{};
  beyond[across] = line;
  beyond[along] = std::clamp(cell, whole.first[along], whole.last[along] - 1);
  std::array<int, 2> before = beyond;
  --before[across];
  return face_at(before[0], before[1]) != face_at(beyond[0], beyond[1]);
}

bool IndexMesh::touches(Direction d, int line, int at) const {
  const int last = line_counts_[index(other(d))] - 1;
  return (at > 0 && has_edge(d, line, at - 1)) || (at < last && has_edge(d, line, at));
}

bool IndexMesh::covers(Direction d, int line, int first, int last) const {
  if (first == last) return touches(d, line, first);
  for (int cell = first; cell < last; ++cell)
    if (!has_edge(d, line, cell)) return false;
  return true;
}

std::vector<IndexBox> IndexMesh::anchors() const {
  const std::array<bool, 2> odd{degrees_[0] % 2 == 1, degrees_[1] % 2 == 1};
  // The active region: as far from the ends as half the lines of a local knot vector.
  std::array<int, 2> first{};
  std::array<int, 2> last{};
  for (std::size_t d = 0; d < 2; ++d) {
    first[d] = (degrees_[d] + 1) / 2;
    last[d] = line_counts_[d] - 1 - first[d] - (odd[d] ? 0 : 1);
  }
  std::vector<IndexBox> result;
  for (int j = first[1]; j <= last[1]; ++j) {
    for (int i = first[0]; i <= last[0]; ++i) {
      if (!odd[0] && !odd[1]) {
        const IndexBox box = box_at(i, j);
        if (box.first == std::array<int, 2>{i, j}) result.push_back(box);
        continue;
      }
      if (!is_vertex(i, j)) continue;
      IndexBox box{{i, j}, {i, j}};
      if (!odd[0]) {
        if (!has_edge(Direction::v, j, i)) continue;
        do ++box.last[0];
        while (!is_vertex(box.last[0], j));
      }
      if (!odd[1]) {
        if (!has_edge(Direction::u, i, j)) continue;
        do ++box.last[1];
        while (!is_vertex(i, box.last[1]));
      }
      result.push_back(box);
    }
  }
  return result;
}

std::vector<int> IndexMesh::local_lines(const IndexBox& anchor, Direction d) const {
  const std::size_t along = index(d);
  const std::size_t across = index(other(d));
  const int each_side = (degrees_[along] + 1) / 2;
  std::vector<int> lines;
  walk(*this, d, anchor.first[along], -1, each_side, anchor.first[across], anchor.last[across], lines);
  std::reverse(lines.begin(), lines.end());
  lines.push_back(anchor.first[along]);
  if (anchor.last[along] != anchor.first[along]) lines.push_back(anchor.last[along]);
  walk(*this, d, anchor.last[along], +1, each_side, anchor.first[across], anchor.last[across], lines);
  return lines;
}

std::vector<TJunction> IndexMesh::t_junctions() const {
  const IndexBox whole = domain();
  std::vector<TJunction> result;
  for (int j = whole.first[1] + 1; j < whole.last[1]; ++j) {
    for (int i = whole.first[0] + 1; i < whole.last[0]; ++i) {
      const bool left = has_edge(Direction::v, j, i - 1);
      const bool right = has_edge(Direction::v, j, i);
      const bool below = has_edge(Direction::u, i, j - 1);
      const bool above = has_edge(Direction::u, i, j);
      if (left != right) result.push_back({{i, j}, Direction::u, left ? 1 : -1});
      if (below != above) result.push_back({{i, j}, Direction::v, below ? 1 : -1});
    }
  }
  return result;
}

Extension IndexMesh::extension(const TJunction& junction) const {
  const std::size_t along = index(junction.along);
  const int at = junction.at[index(other(junction.along))];
  const int p = degrees_[along];
  std::vector<int> forward;
  std::vector<int> backward{junction.at[along]};
  walk(*this, junction.along, junction.at[along], junction.sense, (p + 1) / 2, at, at, forward);
  walk(*this, junction.along, junction.at[along], -junction.sense, p / 2, at, at, backward);
  const auto [first, last] = std::minmax(forward.back(), backward.back());
  return {junction, first, last, forward.back()};
}

void IndexMesh::split(int face, Direction d, int line) {
  IndexBox& box = faces_[static_cast<std::size_t>(face)];
  IndexBox second = box;
  box.last[index(d)] = line;
  second.first[index(d)] = line;
  const auto number = static_cast<std::int32_t>(faces_.size());
  for (int j = second.first[1]; j < second.last[1]; ++j)
    for (int i = second.first[0]; i < second.last[0]; ++i) face_of(i, j) = number;
  faces_.push_back(second);
}

void IndexMesh::insert_lines(Direction d, std::span<const int> cells_cut) {
  const auto moved = [&](int line) {
    return line + static_cast<int>(std::lower_bound(cells_cut.begin(), cells_cut.end(), line) - cells_cut.begin());
  };
  for (IndexBox& box : faces_) {
    box.first[index(d)] = moved(box.first[index(d)]);
    box.last[index(d)] = moved(box.last[index(d)]);
  }
  line_counts_[index(d)] += static_cast<int>(cells_cut.size());
  number_cells();
}

}  // namespace isorim::geometry
