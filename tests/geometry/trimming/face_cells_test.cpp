#include "geometry/trimming/face_cells.h"

#include <algorithm>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "tests/geometry/expect_error.h"
#include "tests/geometry/trimming/faces.h"

namespace isorim::geometry {
namespace {

using testing::blob;
using testing::circle_loop;
using testing::Exponential;
using testing::green_integral;
using testing::GreenSum;
using testing::plane_surface;
using testing::polygon;
using testing::Random;
using testing::reversed;

const std::vector<double> thirds{0.0, 0.1 + 0.2, 0.5, 0.6, 1.0};
const std::vector<double> quarters{0.0, 0.25, 0.5, 0.75, 1.0};

ElementTable<3> elements_of(const TrimmedSurface& face) {
  return bezier_elements<3>({{{"face", face}}});
}

/// Twice the total of a chain's ends: each point must start as many curves as it ends.
void expect_closed(const TrimmedRegion& region, const std::string& where) {
  std::vector<std::pair<double, double>> starts;
  std::vector<std::pair<double, double>> ends;
  for (const HomogeneousPoints<2>& net : region.curves) {
    EXPECT_EQ(net(2, 0), 1.0);
    EXPECT_EQ(net(2, net.cols() - 1), 1.0);
    starts.emplace_back(net(0, 0), net(1, 0));
    ends.emplace_back(net(0, net.cols() - 1), net(1, net.cols() - 1));
  }
  std::ranges::sort(starts);
  std::ranges::sort(ends);
  EXPECT_EQ(starts, ends) << where;
}

void expect_in_unit_cell(const TrimmedRegion& region, double tolerance, const std::string& where) {
  for (const HomogeneousPoints<2>& net : region.curves) {
    const PlanePiece piece(net);
    for (int k = 0; k <= 16; ++k) {
      const Point2 point = evaluate(piece, k / 16.0);
      EXPECT_GE(point.minCoeff(), -tolerance) << where;
      EXPECT_LE(point.maxCoeff(), 1.0 + tolerance) << where;
    }
  }
}

/// How often the region runs around the point: 0 outside the element, 1 inside a whole one.
std::optional<int> cover(const ElementTable<3>& table, const Point2& uv) {
  int total = 0;
  for (const BezierElement<3>& element : table.elements) {
    if (!element.domain[0].contains(uv.x()) || !element.domain[1].contains(uv.y())) continue;
    if (!element.is_cut()) {
      ++total;
      continue;
    }
    std::vector<PlanePiece> pieces;
    for (const HomogeneousPoints<2>& net : table.regions[static_cast<std::size_t>(element.region)].curves)
      pieces.emplace_back(net);
    const Point2 st((uv.x() - element.domain[0].first) / element.domain[0].length(),
                    (uv.y() - element.domain[1].first) / element.domain[1].length());
    const std::optional<int> winding = winding_number(pieces, st, 1e-9);
    if (!winding) return std::nullopt;
    total += *winding;
  }
  return total;
}

/// Everything that must hold for a cut face.
void expect_sound(const TrimmedSurface& face, const std::string& where, int samples = 20) {
  const ElementTable<3> table = elements_of(face);
  const Exponential g;
  GreenSum parts;
  for (const BezierElement<3>& element : table.elements) {
    parts += green_integral(table, element, g);
    if (!element.is_cut()) continue;
    const TrimmedRegion& region = table.regions[static_cast<std::size_t>(element.region)];
    expect_closed(region, where);
    const double least = std::min(element.domain[0].length(), element.domain[1].length());
    expect_in_unit_cell(region, 1e-14 / least, where);
  }
  const GreenSum whole = green_integral(face.loops(), g);
  EXPECT_NEAR(parts.value, whole.value, 2e-15 * (parts.magnitude + whole.magnitude)) << where;

  Random random(5);
  const std::vector<PlanePiece> chain = loop_pieces(face.loops());
  for (int i = 0; i < samples; ++i) {
    const Point2 uv(random.inside(face.surface().knots_u().domain()), random.inside(face.surface().knots_v().domain()));
    const std::optional<int> expected = winding_number(chain, uv, 1e-9);
    const std::optional<int> found = cover(table, uv);
    if (expected && found) {
      EXPECT_EQ(*found, *expected) << where << " at " << uv.transpose();
    }
  }
}

int cut_count(const ElementTable<3>& table) {
  return static_cast<int>(std::ranges::count_if(table.elements, &BezierElement<3>::is_cut));
}

TEST(FaceCells, TheDomainsRectangleGivesTheElementsOfTheWholeSurface) {
  Random random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const NurbsSurface<3> surface =
        testing::random_surface<3>(random, testing::random_knots(random, random.integer(1, 4)),
                                   testing::random_knots(random, random.integer(1, 4)));
    const ElementTable<3> whole = bezier_elements<3>({{{"face", surface, -1}}});
    const ElementTable<3> table = bezier_elements<3>({{{"face", TrimmedSurface(surface, {domain_loop(surface)}), -1}}});
    ASSERT_EQ(table.elements.size(), whole.elements.size());
    EXPECT_EQ(table.nets, whole.nets);
    EXPECT_TRUE(table.regions.empty());
    for (std::size_t e = 0; e < table.elements.size(); ++e) {
      EXPECT_FALSE(table.elements[e].is_cut());
      EXPECT_EQ(table.elements[e].offset, whole.elements[e].offset);
      EXPECT_EQ(table.elements[e].orientation, -1);
      for (std::size_t d = 0; d < 2; ++d) {
        EXPECT_EQ(table.elements[e].domain[d].first, whole.elements[e].domain[d].first);
        EXPECT_EQ(table.elements[e].domain[d].last, whole.elements[e].domain[d].last);
      }
    }
  }
}

TEST(FaceCells, RectanglesOnKnotLinesGiveWholeElements) {
  const NurbsSurface<3> surface = plane_surface(2, thirds, quarters);
  const TrimLoop outer = polygon({{0.3, 0.25}, {1.0, 0.25}, {1.0, 1.0}, {0.1 + 0.2, 1.0}});
  const TrimLoop hole = reversed(polygon({{0.5, 0.5}, {0.6, 0.5}, {0.6, 0.75}, {0.5, 0.75}}));
  const ElementTable<3> table = elements_of({surface, {outer, hole}});
  EXPECT_EQ(cut_count(table), 0);
  EXPECT_EQ(table.elements.size(), 8u);
  expect_sound({surface, {outer, hole}}, "rectangles");
}

TEST(FaceCells, CirclesTouchingKnotLinesAndCorners) {
  const NurbsSurface<3> surface = plane_surface(2, thirds, quarters);
  // They touch knot lines and the domain's edges, cross each other's corners, sit on corners.
  for (const double radius : {0.05, 0.1, 0.125, 0.2, 0.25, 0.3, 0.4, 0.5})
    for (const Point2& centre : {Point2(0.5, 0.5), Point2(0.55, 0.625), Point2(0.4, 0.5), Point2(0.5, 0.375)}) {
      if ((centre.array() - radius).minCoeff() < 0.0 || (centre.array() + radius).maxCoeff() > 1.0) continue;
      const TrimLoop loop = circle_loop(radius, centre);
      const std::string where = "radius " + std::to_string(radius) + " centre " + std::to_string(centre.x());
      expect_sound({surface, {loop}}, where);
      expect_sound({surface, {domain_loop(surface), reversed(loop)}}, where + " hole");
    }
}

TEST(FaceCells, CutElementsAreNarrowedExactly) {
  Random random(2);
  for (int trial = 0; trial < 100; ++trial) {
    const KnotVector knots_u = KnotVector::clamped(random.integer(1, 4), thirds);
    const KnotVector knots_v = KnotVector::clamped(random.integer(1, 4), quarters);
    const NurbsSurface<3> surface = testing::random_surface<3>(random, knots_u, knots_v);
    const ElementTable<3> table = elements_of({surface, {blob(random, {0.5, 0.5}, 0.5, 3)}});
    EXPECT_GT(cut_count(table), 0);
    for (const BezierElement<3>& element : table.elements) {
      const NurbsSurface<3> cell(KnotVector::bezier(element.degree[0]), KnotVector::bezier(element.degree[1]),
                                 table.net_matrix(element));
      const Point2 s(random.real(0, 1), random.real(0, 1));
      const Point2 uv(element.domain[0].first + s[0] * element.domain[0].length(),
                      element.domain[1].first + s[1] * element.domain[1].length());
      EXPECT_LE((evaluate(cell, s) - evaluate(surface, uv)).norm(), 2e-13);
      if (!element.is_cut()) continue;
      Point2 lower(1.0, 1.0);
      Point2 upper(0.0, 0.0);
      for (const HomogeneousPoints<2>& net : table.regions[static_cast<std::size_t>(element.region)].curves)
        for (int k = 0; k <= 200; ++k) {
          const Point2 point = evaluate(PlanePiece(net), k / 200.0);
          lower = lower.cwiseMin(point);
          upper = upper.cwiseMax(point);
        }
      EXPECT_LE(lower.maxCoeff(), 0.04);
      EXPECT_GE(upper.minCoeff(), 0.96);
    }
  }
}

TEST(FaceCells, PolygonsWithCornersOnTheGrid) {
  Random random(3);
  const NurbsSurface<3> surface = plane_surface(1, thirds, quarters);
  for (int trial = 0; trial < 500; ++trial) {
    // Star-shaped about the centre, so it is simple; half of the corners on grid points.
    std::vector<Point2> corners;
    for (double v : quarters)
      for (double u : thirds)
        if (random.integer(0, 2) == 0) corners.emplace_back(u, v);
    for (int i = 0; i < 4; ++i) corners.emplace_back(random.real(0, 1), random.real(0, 1));
    const Point2 centre(0.4321, 0.5678);
    std::ranges::sort(corners, {}, [&](const Point2& p) { return std::atan2(p.y() - centre.y(), p.x() - centre.x()); });
    const TrimLoop loop = polygon(corners);
    if (green_integral(std::vector<TrimLoop>{loop}, Exponential()).value < 1e-3) continue;
    expect_sound({surface, {loop}}, "polygon " + std::to_string(trial));
  }
}

TEST(FaceCells, RandomBlobsWithHoles) {
  Random random(4);
  for (int trial = 0; trial < 500; ++trial) {
    const NurbsSurface<3> surface = plane_surface(random.integer(1, 3), thirds, quarters);
    std::vector<TrimLoop> loops{blob(random, {0.5, 0.5}, 0.5, random.integer(1, 5))};
    if (random.integer(0, 1) == 0) loops.push_back(reversed(blob(random, {0.5, 0.5}, 0.08, random.integer(1, 4))));
    const std::string where = "blob " + std::to_string(trial);
    expect_sound({surface, loops}, where);
    std::vector<TrimLoop> inverse{domain_loop(surface)};
    for (const TrimLoop& loop : loops) inverse.push_back(reversed(loop));
    expect_sound({surface, inverse}, where + " inverse");
  }
}

}  // namespace
}  // namespace isorim::geometry
