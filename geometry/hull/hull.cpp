#include "geometry/hull/hull.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/shapes/checks.h"
#include "geometry/shapes/sweeps.h"
#include "geometry/shapes/transforms.h"
#include "geometry/topology/orientation.h"

namespace isorim::geometry {
namespace {

AffineMap<3> to_starboard() {
  return mirroring<3>(Point3::Zero(), Vector3::UnitY());
}

/// The parts of an edge off the centre plane: the domains of its spans that are not wholly in it, joined.
std::vector<Interval> open_parts(const NurbsCurve<3>& edge) {
  const KnotVector& knots = edge.knots();
  const std::vector<double> breaks = knots.breakpoints();
  std::vector<Interval> parts;
  for (std::size_t s = 0; s + 1 < breaks.size(); ++s) {
    const int span = knots.find_span(breaks[s]);
    const int p = knots.degree();
    if ((edge.homogeneous().row(1).segment(span - p, p + 1).array() == 0.0).all()) continue;
    if (!parts.empty() && parts.back().last == breaks[s]) {
      parts.back().last = breaks[s + 1];
    } else {
      parts.push_back({breaks[s], breaks[s + 1]});
    }
  }
  return parts;
}

/// Without the edges at which one piece of a band goes on as the next.
void drop_joined(std::vector<NurbsCurve<3>>& ends, std::vector<NurbsCurve<3>>& beginnings) {
  for (auto end = ends.begin(); end != ends.end();) {
    const auto next = std::find_if(beginnings.begin(), beginnings.end(), [&](const NurbsCurve<3>& beginning) {
      return end->homogeneous().cols() == beginning.homogeneous().cols() &&
             end->homogeneous() == beginning.homogeneous();
    });
    if (next == beginnings.end()) {
      ++end;
    } else {
      beginnings.erase(next);
      end = ends.erase(end);
    }
  }
}

/// Adds surfaces ruled from the edges to their images; several are numbered.
void add_ruled(Boundary<3>& hull, const std::string& name, const std::vector<NurbsCurve<3>>& edges) {
  std::vector<NurbsSurface<3>> pieces;
  for (const NurbsCurve<3>& edge : edges) {
    for (const Interval& part : open_parts(edge)) {
      const NurbsCurve<3> port = restrict_to(edge, part);
      pieces.push_back(ruled(port, transform(port, to_starboard())));
    }
  }
  for (std::size_t i = 0; i < pieces.size(); ++i)
    hull.patches.push_back({pieces.size() == 1 ? name : fmt::format("{}_{}", name, i + 1), pieces[i]});
}

}  // namespace

Boundary<3> close_hull(std::span<const NurbsSurface<3>> port) {
  Boundary<3> hull;
  for (const bool is_image : {false, true}) {
    const std::string side = is_image ? "starboard" : "port";
    for (std::size_t k = 0; k < port.size(); ++k) {
      hull.patches.push_back({port.size() == 1 ? side : fmt::format("{}_{}", side, k + 1),
                              is_image ? transform(port[k], to_starboard()) : port[k]});
    }
  }
  // v = first, u = last, v = last, u = first.
  std::array<std::vector<NurbsCurve<3>>, 4> edges;
  for (const NurbsSurface<3>& band : port) {
    const std::array<NurbsCurve<3>, 4> sides = boundary_curves(band);
    for (std::size_t k = 0; k < sides.size(); ++k) edges[k].push_back(sides[k]);
  }
  drop_joined(edges[1], edges[3]);
  add_ruled(hull, "bottom", {edges[0].front()});
  add_ruled(hull, "deck", {edges[2].back()});
  add_ruled(hull, "stern", edges[3]);
  add_ruled(hull, "stem", edges[1]);
  OrientedBoundary<3> oriented = orient(hull);
  require_closed(oriented);
  return std::move(oriented.boundary);
}

Boundary<3> hull_solid(const OffsetTable& table, const HullSurfaceOptions& options) {
  try {
    return close_hull(hull_surface(hull_sections(table), options));
  } catch (GeometryError& error) {
    if (std::string_view(error.what()).find(table.name) == std::string_view::npos)
      error.add_context(fmt::format("hull \"{}\"", table.name));
    throw;
  }
}

NurbsSurface<3> wigley_surface(double length, double beam, double draught) {
  checks::positive("wigley hull", "length", length);
  checks::positive("wigley hull", "beam", beam);
  checks::positive("wigley hull", "draught", draught);
  // Bernstein coefficients of 4 u (1 - u) and of 2 v - v^2.
  const std::array<double, 3> along{0.0, 2.0, 0.0};
  const std::array<double, 3> up{0.0, 1.0, 1.0};
  Points<3> net(3, 9);
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      net.col(i + 3 * j) << 0.5 * length * (i - 1), 0.5 * beam * along[std::size_t(i)] * up[std::size_t(j)],
          0.5 * draught * j;
    }
  }
  return NurbsSurface<3>::from_points(KnotVector::bezier(2), KnotVector::bezier(2), net);
}

OffsetTable wigley_offsets(double length, double beam, double draught, int stations, int waterlines) {
  OffsetTable table;
  table.name = "Wigley";
  table.source = "y = (B/2) (1 - (2x/L)^2) (1 - ((z - T)/T)^2)";
  table.length = length;
  table.beam = beam;
  table.draught = draught;
  table.after_perpendicular = -0.5 * length;
  table.half_breadths.resize(waterlines, stations);
  for (int j = 0; j < waterlines; ++j) table.waterlines.push_back(draught * j / (waterlines - 1));
  for (int i = 0; i < stations; ++i) {
    const double x = (2.0 * i - (stations - 1)) / (stations - 1);
    table.stations.push_back(0.5 * length * x);
    table.station_names.push_back(fmt::format("{}", i));
    for (int j = 0; j < waterlines; ++j) {
      const double below = 1.0 - 1.0 * j / (waterlines - 1);
      table.half_breadths(j, i) = 0.5 * beam * ((1.0 - x) * (1.0 + x)) * ((1.0 - below) * (1.0 + below));
    }
  }
  check(table);
  return table;
}

}  // namespace isorim::geometry
