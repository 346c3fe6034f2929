// require_closed(): where a boundary is open.

#include <algorithm>
#include <limits>
#include <string>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/topology/orientation.h"

namespace isorim::geometry {
namespace {

template <int Dim>
std::string at(const Point<Dim>& point) {
  std::string text;
  for (int i = 0; i < Dim; ++i) text += fmt::format("{}{:.9g}", i == 0 ? "" : ", ", point(i));
  return "(" + text + ")";
}

/// How far one stretch is from another, end from end.
template <int Dim>
double gap(const FreeEdge<Dim>& a, const FreeEdge<Dim>& b) {
  const double along = std::max((a.from - b.from).norm(), (a.to - b.to).norm());
  const double against = std::max((a.from - b.to).norm(), (a.to - b.from).norm());
  return std::min(along, against);
}

std::string describe(const FreeEdge<2>& edge) {
  return fmt::format("{} at {}", edge.side == 0 ? "starts" : "ends", at<2>(edge.from));
}

std::string describe(const FreeEdge<3>& edge) {
  constexpr const char* sides[] = {"first v", "last u", "last v", "first u"};
  return fmt::format("has a free edge (at its {}) from {} to {}", sides[edge.side], at<3>(edge.from), at<3>(edge.to));
}

}  // namespace

template <int Dim>
void require_closed(const OrientedBoundary<Dim>& oriented) {
  const std::vector<FreeEdge<Dim>>& edges = oriented.topology.free_edges;
  if (oriented.topology.closed) return;
  const auto name = [&](const FreeEdge<Dim>& edge) {
    return oriented.boundary.patches[static_cast<std::size_t>(edge.patch)].name;
  };
  constexpr std::size_t most = 5;
  std::string text = "the boundary is not closed: ";
  for (std::size_t i = 0; i < std::min(edges.size(), most); ++i) {
    text += fmt::format("{}'{}' {}", i == 0 ? "" : "; ", name(edges[i]), describe(edges[i]));
    std::size_t nearest = edges.size();
    double distance = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < edges.size(); ++k) {
      if (k == i || gap(edges[i], edges[k]) >= distance) continue;
      nearest = k;
      distance = gap(edges[i], edges[k]);
    }
    if (nearest < edges.size()) {
      text += fmt::format(", a gap of {:.3g} to '{}' (tolerance {:.3g})", distance, name(edges[nearest]),
                          oriented.topology.tolerance);
    }
  }
  if (edges.size() > most) text += fmt::format("; and {} more", edges.size() - most);
  throw GeometryError(text);
}

template void require_closed<2>(const OrientedBoundary<2>&);
template void require_closed<3>(const OrientedBoundary<3>&);

}  // namespace isorim::geometry
