#include "geometry/tspline/tmesh.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"

namespace isorim::geometry {
namespace {

std::array<int, 2> degrees_of(const KnotVector& u, const KnotVector& v) {
  return {u.degree(), v.degree()};
}

std::array<int, 2> line_counts(const KnotVector& u, const KnotVector& v) {
  return {static_cast<int>(u.knots().size()), static_cast<int>(v.knots().size())};
}

}  // namespace

TMesh::TMesh(KnotVector knots_u, KnotVector knots_v, IndexMesh mesh)
    : knots_{std::move(knots_u), std::move(knots_v)}, mesh_(std::move(mesh)) {
  for (const Direction d : {Direction::u, Direction::v}) {
    const int count = static_cast<int>(knots(d).knots().size());
    if (mesh_.line_count(d) != count || mesh_.degree(d) != degree(d))
      throw GeometryError(
          fmt::format("T-mesh: {} lines for degree {} and {} knots for degree {} in direction {}; expected the same",
                      mesh_.line_count(d), mesh_.degree(d), count, degree(d), "uv"[index(d)]));
  }
  require_joined();
  anchors_ = mesh_.anchors();
  gather_local_knots();
  gather_supports();
}

TMesh::TMesh(const KnotVector& knots_u, const KnotVector& knots_v)
    : TMesh(knots_u, knots_v, IndexMesh(degrees_of(knots_u, knots_v), line_counts(knots_u, knots_v))) {}

std::array<Interval, 2> TMesh::face_domain(int face) const {
  const IndexBox& box = mesh_.faces()[static_cast<std::size_t>(face)];
  return {Interval{knots_[0][box.first[0]], knots_[0][box.last[0]]},
          Interval{knots_[1][box.first[1]], knots_[1][box.last[1]]}};
}

std::span<const int> TMesh::local_lines(int k, Direction d) const {
  const Eigen::MatrixXi& lines = local_lines_[index(d)];
  return {lines.col(k).data(), static_cast<std::size_t>(lines.rows())};
}

std::span<const double> TMesh::local_knots(int k, Direction d) const {
  const Eigen::MatrixXd& local = local_knots_[index(d)];
  return {local.col(k).data(), static_cast<std::size_t>(local.rows())};
}

void TMesh::require_joined() const {
  const auto require = [&](const IndexBox& box, Direction d) {
    const std::size_t across = index(d);
    const Direction line_direction = other(d);
    for (int line = box.first[index(line_direction)] + 1; line < box.last[index(line_direction)]; ++line) {
      if (!mesh_.has_edge(line_direction, line, box.first[across] - 1)) continue;
      if (!mesh_.has_edge(line_direction, line, box.last[across])) continue;
      throw GeometryError(
          fmt::format("T-mesh: the face u = {} to {}, v = {} to {} has T-junctions at {} = {} on both of its sides; "
                      "they must be joined by an edge",
                      knots_[0][box.first[0]], knots_[0][box.last[0]], knots_[1][box.first[1]], knots_[1][box.last[1]],
                      "uv"[index(line_direction)], knots_[index(line_direction)][line]));
    }
  };
  for (const IndexBox& box : mesh_.faces())
    for (const Direction d : {Direction::u, Direction::v}) require(box, d);
}

void TMesh::gather_local_knots() {
  for (const Direction d : {Direction::u, Direction::v}) {
    Eigen::MatrixXi& lines = local_lines_[index(d)];
    Eigen::MatrixXd& local = local_knots_[index(d)];
    lines.resize(degree(d) + 2, function_count());
    local.resize(degree(d) + 2, function_count());
    for (int k = 0; k < function_count(); ++k) {
      const std::vector<int> own = mesh_.local_lines(anchors_[static_cast<std::size_t>(k)], d);
      for (Eigen::Index row = 0; row < lines.rows(); ++row) {
        lines(row, k) = own[static_cast<std::size_t>(row)];
        local(row, k) = knots(d)[lines(row, k)];
      }
    }
  }
}

void TMesh::gather_supports() {
  functions_on_faces_.resize(mesh_.faces().size());
  const IndexBox whole = mesh_.domain();
  for (int k = 0; k < function_count(); ++k) {
    IndexBox support;
    for (std::size_t d = 0; d < 2; ++d) {
      support.first[d] = std::max(whole.first[d], local_lines_[d](0, k));
      support.last[d] = std::min(whole.last[d], local_lines_[d](local_lines_[d].rows() - 1, k));
    }
    for (int j = support.first[1]; j < support.last[1]; ++j) {
      if (knots_[1][j] == knots_[1][j + 1]) continue;
      for (int i = support.first[0]; i < support.last[0]; ++i) {
        if (knots_[0][i] == knots_[0][i + 1]) continue;
        std::vector<int>& functions = functions_on_faces_[static_cast<std::size_t>(mesh_.face_at(i, j))];
        if (functions.empty() || functions.back() != k) functions.push_back(k);
      }
    }
  }
}

std::vector<ExtensionConflict> extension_conflicts(const IndexMesh& mesh) {
  // Extensions in v by the line that they run on: those that one in u meets lie on the lines it crosses.
  std::vector<std::vector<Extension>> in_v(static_cast<std::size_t>(mesh.line_count(Direction::u)));
  std::vector<Extension> in_u;
  for (const TJunction& junction : mesh.t_junctions()) {
    if (junction.along == Direction::u) {
      in_u.push_back(mesh.extension(junction));
    } else {
      in_v[static_cast<std::size_t>(junction.at[0])].push_back(mesh.extension(junction));
    }
  }
  std::vector<ExtensionConflict> conflicts;
  for (const Extension& extension : in_u) {
    const int line_v = extension.junction.at[1];
    for (int line = extension.first; line <= extension.last; ++line)
      for (const Extension& crossing : in_v[static_cast<std::size_t>(line)])
        if (crossing.first <= line_v && line_v <= crossing.last)
          conflicts.push_back({extension.junction, crossing.junction});
  }
  return conflicts;
}

}  // namespace isorim::geometry
