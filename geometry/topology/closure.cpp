// require_closed(): where a boundary is open.

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <variant>
#include <vector>

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

/// The free end nearest to another one, and how far; -1 if there is no other.
std::pair<int, double> nearest(const std::vector<FreeEdge<2>>& ends, std::size_t own) {
  std::pair<int, double> best{-1, std::numeric_limits<double>::infinity()};
  for (std::size_t k = 0; k < ends.size(); ++k) {
    const double distance = (ends[k].from - ends[own].from).norm();
    if (k != own && distance < best.second) best = {static_cast<int>(k), distance};
  }
  return best;
}

std::pair<int, double> nearest(const std::vector<FreeEdge<3>>& edges, std::size_t own) {
  return {edges[own].nearest, edges[own].gap};
}

std::string describe(const Patch<2>& /*patch*/, const FreeEdge<2>& edge) {
  return fmt::format("{} at {}", edge.side == 0 ? "starts" : "ends", at<2>(edge.from));
}

std::string describe(const Patch<3>& patch, const FreeEdge<3>& edge) {
  struct Place {
    const FreeEdge<3>& edge;

    std::string operator()(const NurbsSurface<3>&) const {
      constexpr const char* sides[] = {"first v", "last u", "last v", "first u"};
      return fmt::format("at its {}", sides[edge.curve]);
    }
    std::string operator()(const TrimmedSurface&) const {
      return fmt::format("in curve {} of loop {}", edge.curve + 1, edge.loop + 1);
    }
    std::string operator()(const ExtractedSurface&) const {
      constexpr const char* sides[] = {"t = 0", "s = 1", "t = 1", "s = 0"};
      return fmt::format("at {} of element {}", sides[edge.curve], edge.loop);
    }
  };
  return fmt::format("has a free edge ({}) from {} to {}", std::visit(Place{edge}, patch.shape), at<3>(edge.from),
                     at<3>(edge.to));
}

}  // namespace

template <int Dim>
void require_closed(const OrientedBoundary<Dim>& oriented) {
  const std::vector<FreeEdge<Dim>>& edges = oriented.topology.free_edges;
  if (oriented.topology.closed) return;
  const auto patch = [&](const FreeEdge<Dim>& edge) -> const Patch<Dim>& {
    return oriented.boundary.patches[static_cast<std::size_t>(edge.patch)];
  };
  constexpr std::size_t most = 5;
  std::string text = "the boundary is not closed: ";
  for (std::size_t i = 0; i < std::min(edges.size(), most); ++i) {
    const Patch<Dim>& own = patch(edges[i]);
    text += fmt::format("{}'{}' {}", i == 0 ? "" : "; ", own.name, describe(own, edges[i]));
    const auto [other, distance] = nearest(edges, i);
    if (other < 0) continue;
    text += fmt::format(", a gap of {:.3g} to '{}' (tolerance {:.3g})", distance,
                        patch(edges[static_cast<std::size_t>(other)]).name,
                        std::max(oriented.topology.tolerance, oriented.topology.largest_tolerance));
  }
  if (edges.size() > most) text += fmt::format("; and {} more", edges.size() - most);
  throw GeometryError(text);
}

template void require_closed<2>(const OrientedBoundary<2>&);
template void require_closed<3>(const OrientedBoundary<3>&);

}  // namespace isorim::geometry
