#include "geometry/trimming/face_cells.h"

#include <algorithm>
#include <array>
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
using testing::transformed;

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

TEST(FaceCells, CutElementsOfPolynomialSurfacesStayPolynomial) {
  Random random(9);
  const KnotVector knots = KnotVector::clamped(3, thirds);
  Points<3> points = Points<3>::Random(3, knots.basis_count() * knots.basis_count());
  const std::vector<double> weights(static_cast<std::size_t>(points.cols()), 0.3);
  const NurbsSurface<3> surface = NurbsSurface<3>::from_points(knots, knots, points, weights);
  const ElementTable<3> table = elements_of({surface, {blob(random, {0.5, 0.5}, 0.5, 2)}});
  EXPECT_GT(cut_count(table), 4);
  for (const BezierElement<3>& element : table.elements) {
    EXPECT_TRUE(element.polynomial);
    EXPECT_TRUE((table.net_matrix(element).row(3).array() == 1.0).all());
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
  for (int trial = 0; trial < 250; ++trial) {
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

TEST(FaceCells, NearlyTouchingKnotLinesAndCorners) {
  // Circles whose extreme points lie beside a knot line, and triangles whose corners lie beside a grid point, by
  // anything from nothing to a visible amount.
  const NurbsSurface<3> surface = plane_surface(2, thirds, quarters);
  for (const double size : {0.0, 1e-17, 1e-16, 3e-16, 1e-15, 3e-15, 1e-14, 1e-13, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4})
    for (const double sign : {-1.0, 1.0}) {
      const double off = sign * size;
      const std::string where = "off by " + std::to_string(off * 1e16) + "e-16";
      expect_sound({surface, {circle_loop(0.25 + off, {0.5, 0.5})}}, where);
      expect_sound({surface, {circle_loop(0.25, {0.5 + off, 0.5 - off})}}, where);
      expect_sound({surface, {domain_loop(surface), reversed(circle_loop(0.25, {0.5 - off, 0.5 + off}))}}, where);
      expect_sound({surface, {circle_loop(std::sqrt(0.05 + off * off) / 2.0, {0.55, 0.375})}}, where);
      for (const double other : {0.0, 1e-16, -1e-15, 1e-9}) {
        const Point2 corner(0.5 + off, 0.5 + other);
        expect_sound({surface, {polygon({{0.2, 0.1}, {0.9, 0.3}, corner})}}, where);
        expect_sound({surface, {polygon({{0.2, 0.1}, corner, {0.1, 0.9}})}}, where);
        expect_sound({surface, {polygon({corner, {0.9, 0.3}, {0.9, 0.9}})}}, where);
        expect_sound({surface, {polygon({{0.1, 0.1}, {0.9, 0.1 + off}, {0.9, 0.9}, {0.1 + other, 0.9}})}}, where);
        // An edge along a knot line, nearly.
        expect_sound({surface, {polygon({{0.5 + off, 0.1}, {0.9, 0.3}, {0.5 - other, 0.9}})}}, where);
        expect_sound({surface, {polygon({{0.1, 0.5 - off}, {0.9, 0.5 + other}, {0.5, 0.9}})}}, where);
      }
    }
}

TEST(FaceCells, DomainsFarFromTheOriginSmallAndStretched) {
  Random random(6);
  for (int trial = 0; trial < 300; ++trial) {
    AffineMap<2> map;
    Vector2 relative_rounding;
    for (Eigen::Index d = 0; d < 2; ++d) {
      map.linear(d, d) = std::pow(10.0, random.integer(-6, 6));
      map.translation[d] = map.linear(d, d) * (random.integer(0, 1) == 0 ? 0.0 : random.real(-1e3, 1e3));
      relative_rounding[d] = 1.0 + std::abs(map.translation[d]) / map.linear(d, d);
    }
    const auto mapped = [&](const std::vector<double>& lines, Eigen::Index d) {
      std::vector<double> result;
      for (const double line : lines) result.push_back(map.translation[d] + map.linear(d, d) * line);
      return result;
    };
    const NurbsSurface<3> surface = plane_surface(2, mapped(thirds, 0), mapped(quarters, 1));
    std::vector<TrimLoop> loops{transformed(blob(random, {0.5, 0.5}, 0.5, random.integer(1, 4)), map)};
    if (trial % 2 == 0) loops.push_back(reversed(transformed(circle_loop(0.05, {0.5, 0.5}), map)));
    const TrimmedSurface face(surface, loops);
    const ElementTable<3> table = elements_of(face);
    Exponential g;
    g.a = 0.7 / map.linear(0, 0);
    g.b = -0.4 / map.linear(1, 1);
    g.origin = map.translation;
    GreenSum parts;
    for (const BezierElement<3>& element : table.elements) {
      parts += green_integral(table, element, g);
      if (element.is_cut()) expect_closed(table.regions[static_cast<std::size_t>(element.region)], "stretched");
    }
    const GreenSum whole = green_integral(face.loops(), g);
    EXPECT_NEAR(parts.value, whole.value, 2e-15 * relative_rounding.maxCoeff() * (parts.magnitude + whole.magnitude))
        << trial;
  }
}

TEST(FaceCells, GapsAreClosedByStraightLinesAndExcursionsCutOff) {
  Random random(7);
  const NurbsSurface<3> surface = plane_surface(2, thirds, quarters);
  for (int trial = 0; trial < 300; ++trial) {
    const double reach = std::pow(10.0, random.real(-16.0, -6.1));
    std::vector<Point2> corners{{0.0, 0.0}, {0.5, 0.0}, {1.0, 0.0}, {1.0, 0.5}, {1.0, 1.0}, {0.3, 1.0}, {0.0, 0.25}};
    TrimLoop loop = polygon(corners);
    for (NurbsCurve<2>& curve : loop.curves) {
      HomogeneousPoints<2> net = curve.homogeneous();
      for (Eigen::Index i = 0; i < 2; ++i) net.col(i).head<2>() += 0.5 * reach * Vector2::Random();
      curve = NurbsCurve<2>(curve.knots(), net);
    }
    const TrimmedSurface face(surface, {loop});
    const ElementTable<3> table = elements_of(face);
    const Exponential g;
    GreenSum parts;
    for (const BezierElement<3>& element : table.elements) {
      parts += green_integral(table, element, g);
      EXPECT_GE(element.domain[0].first, 0.0);
      EXPECT_LE(element.domain[0].last, 1.0);
      EXPECT_GE(element.domain[1].first, 0.0);
      EXPECT_LE(element.domain[1].last, 1.0);
      if (element.is_cut()) expect_closed(table.regions[static_cast<std::size_t>(element.region)], "gaps");
    }
    const GreenSum exact = green_integral(std::vector<TrimLoop>{polygon(corners)}, g);
    EXPECT_NEAR(parts.value, exact.value, 4.0 * reach + 1e-14) << trial;
  }
}

TEST(FaceCells, LoopsThatTouch) {
  const NurbsSurface<3> surface = plane_surface(2, thirds, quarters);
  const std::vector<std::vector<TrimLoop>> faces{
      // A hole that touches the outer loop from inside, on and off a knot line.
      {circle_loop(0.5, {0.5, 0.5}), reversed(circle_loop(0.25, {0.25, 0.5}))},
      {circle_loop(0.4, {0.5, 0.5}), reversed(circle_loop(0.1, {0.5 + 0.3 * 0.6, 0.5 + 0.3 * 0.8}))},
      // Two holes that touch each other at a corner of cells; two islands that do.
      {domain_loop(surface), reversed(circle_loop(0.2, {0.3, 0.5})), reversed(circle_loop(0.2, {0.7, 0.5}))},
      {circle_loop(0.2, {0.3, 0.5}), circle_loop(0.2, {0.7, 0.5})},
      // A figure of eight as one loop that passes twice through the same corner of cells.
      {polygon({{0.5, 0.5}, {0.9, 0.2}, {0.9, 0.8}, {0.5, 0.5}, {0.1, 0.8}, {0.1, 0.2}})},
      // Checkerboard: cells that touch at their corners only, as one loop.
      {polygon({{0.0, 0.0}, {0.5, 0.0}, {0.5, 0.5}, {1.0, 0.5}, {1.0, 1.0}, {0.5, 1.0}, {0.5, 0.5}, {0.0, 0.5}})},
      // A hole within one cell, an island in the hole.
      {domain_loop(surface), reversed(circle_loop(0.04, {0.55, 0.625})), circle_loop(0.02, {0.55, 0.625})},
      // A hole that is a cell, and one that touches it along an edge.
      {domain_loop(surface), reversed(polygon({{0.5, 0.5}, {0.6, 0.5}, {0.6, 0.75}, {0.5, 0.75}})),
       reversed(polygon({{0.6, 0.55}, {0.7, 0.6}, {0.6, 0.65}}))},
      // A slit: out and back along the same line; and one along a knot line.
      {polygon({{0, 0}, {1, 0}, {1, 1}, {0.45, 1}, {0.45, 0.3}, {0.45, 1}, {0, 1}})},
      {polygon({{0, 0}, {1, 0}, {1, 1}, {0.5, 1}, {0.5, 0.3}, {0.5, 1}, {0, 1}})},
      // A strip along a knot line, on either side of it.
      {polygon({{0.5, 0.1}, {0.5, 0.9}, {0.45, 0.9}, {0.45, 0.1}})},
      {polygon({{0.5, 0.1}, {0.55, 0.1}, {0.55, 0.9}, {0.5, 0.9}})}};
  for (std::size_t i = 0; i < faces.size(); ++i)
    expect_sound({surface, faces[i]}, "touching " + std::to_string(i), 200);
}

TEST(FaceCells, HighDegreesAndManySpans) {
  Random random(8);
  for (int trial = 0; trial < 100; ++trial) {
    std::vector<double> us{0.0};
    std::vector<double> vs{0.0};
    for (int i = random.integer(0, 40); i-- > 0;) us.push_back(us.back() + random.real(1e-6, 1.0));
    for (int i = random.integer(0, 40); i-- > 0;) vs.push_back(vs.back() + random.real(1e-6, 1.0));
    for (std::vector<double>* lines : {&us, &vs}) {
      lines->push_back(lines->back() + 0.5);
      for (double& line : *lines) line /= lines->back();
    }
    us.back() = vs.back() = 1.0;
    const NurbsSurface<3> surface = plane_surface(1, us, vs);
    expect_sound({surface, {blob(random, {0.5, 0.5}, 0.5, random.integer(1, 10))}}, "grid " + std::to_string(trial),
                 50);
  }
}

TEST(FaceCells, KnotLinesThatRoundingCannotTellApart) {
  const double ulp = 1.2e-16;
  const std::vector<double> us{0.0, ulp, 0.3, 0.5, 0.5 + ulp, 0.5 + 2 * ulp, 0.8, 1.0 - ulp, 1.0};
  const std::vector<double> vs{0.0, 0.5 - ulp, 0.5, 1.0};
  const NurbsSurface<3> surface = plane_surface(1, us, vs);
  EXPECT_EQ(elements_of({surface, {domain_loop(surface)}}).elements.size(), 24u);
  EXPECT_EQ(cut_count(elements_of({surface, {domain_loop(surface)}})), 0);
  const ElementTable<3> half = elements_of({surface, {polygon({{0.5 + ulp, 0}, {1, 0}, {1, 1}, {0.5, 1}})}});
  EXPECT_EQ(cut_count(half), 0);
  EXPECT_EQ(half.elements.size(), 9u);
  expect_sound({surface, {circle_loop(0.5, {0.5, 0.5})}}, "circle");
  expect_sound({surface, {circle_loop(0.25, {0.25, 0.5})}}, "touching circle");
  expect_sound({surface, {polygon({{0.5, 0.5}, {1.0, 0.5 - ulp}, {1.0, 1.0}})}}, "triangle");
}

/// One of the lines, most often, or a little beside it.
double near_some_line(Random& random, const std::vector<double>& lines) {
  double x = random.real(0, 1);
  if (random.integer(0, 2) > 0)
    x = lines[static_cast<std::size_t>(random.integer(0, static_cast<int>(lines.size()) - 1))];
  if (random.integer(0, 3) == 0) x += random.integer(-40, 40) * 1.1e-16;
  if (random.integer(0, 3) == 0) x += random.real(-1, 1) * std::pow(10.0, random.real(-17, -7));
  return std::clamp(x, 0.0, 1.0);
}

/// Curves of degree 1 to 4 with all their control points near knot lines: every kind of tangency, curves along lines,
/// cusps, loops that cross themselves.
TrimLoop wild_loop(Random& random, const std::vector<double>& us, const std::vector<double>& vs) {
  const auto point = [&] {
    const double u = near_some_line(random, us);
    return Point2(u, near_some_line(random, vs));
  };
  std::vector<Point2> joints(static_cast<std::size_t>(random.integer(2, 6)));
  for (Point2& joint : joints) joint = point();
  TrimLoop loop;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const KnotVector knots = KnotVector::clamped_uniform(random.integer(1, 4), random.integer(1, 2));
    const Point2 first = joints[i];
    const Point2 last = joints[(i + 1) % joints.size()];
    const bool along_u = random.integer(0, 4) == 0;
    const bool along_v = random.integer(0, 4) == 0;
    Points<2> points(2, knots.basis_count());
    std::vector<double> weights;
    for (Eigen::Index k = 0; k < points.cols(); ++k) {
      const Point2 free = point();
      points.col(k) << (along_u ? first.x() : free.x()), (along_v ? first.y() : free.y());
      weights.push_back(random.integer(0, 1) == 0 ? 1.0 : random.real(0.5, 2.0));
    }
    points.leftCols<1>() = first;
    points.rightCols<1>() = last;
    loop.curves.push_back(NurbsCurve<2>::from_points(knots, points, weights));
  }
  return loop;
}

TEST(FaceCells, WildLoopsAreAccountedForAsOftenAsTheyRunRound) {
  int sound = 0;
  for (unsigned trial = 0; trial < 800; ++trial) {
    Random random(1000 + trial);
    std::vector<double> us{0.0, 1.0};
    std::vector<double> vs{0.0, 1.0};
    for (std::vector<double>* lines : {&us, &vs}) {
      for (int i = random.integer(0, 3); i-- > 0;)
        lines->push_back(random.integer(0, 3) > 0 ? 0.1 * random.integer(1, 9) : random.real(0, 1));
      std::ranges::sort(*lines);
      lines->erase(std::unique(lines->begin(), lines->end()), lines->end());
    }
    std::vector<TrimLoop> loops;
    for (int i = random.integer(1, 3); i-- > 0;) loops.push_back(wild_loop(random, us, vs));
    const double area = green_integral(loops, Exponential()).value;
    if (std::abs(area) < 1e-6) continue;
    if (area < 0.0) std::ranges::transform(loops, loops.begin(), reversed);
    try {
      expect_sound({plane_surface(1, us, vs), loops}, "wild " + std::to_string(trial), 5);
      ++sound;
    } catch (const GeometryError&) {
      // Whole cells that are covered twice are refused, and so are loops whose weighted area alone is positive.
    }
  }
  EXPECT_GT(sound, 700);
}

/// The areas of the regions of the cells of a grid with one row of two columns, by column.
std::array<double, 2> areas_by_column(const FaceCells& cells) {
  std::array<double, 2> areas{};
  for (int column = 0; column < 2; ++column) {
    if (cells.at(column, 0) < 0) continue;
    const CellRegion& kept = cells.regions[static_cast<std::size_t>(cells.at(column, 0))];
    Boundary<2> boundary;
    for (const HomogeneousPoints<2>& net : kept.region.curves)
      boundary.patches.push_back({"curve", {KnotVector::bezier(static_cast<int>(net.cols()) - 1), net}});
    areas[static_cast<std::size_t>(column)] = testing::measures(boundary).content * kept.u.length() * kept.v.length();
  }
  return areas;
}

TEST(FaceCells, OneMissedCrossingIsSeen) {
  // A circle of which a segment lies beyond the knot line u = 0.6.
  const NurbsSurface<3> surface = plane_surface(1, {0.0, 0.6, 1.0}, {0.0, 1.0});
  const double r = 0.3;
  const double d = 0.1;
  const double segment = r * r * std::acos(d / r) - d * std::sqrt(r * r - d * d);
  const double rest = std::numbers::pi * r * r - segment;
  const ParameterGrid grid(surface);
  std::vector<CutPiece> pieces = cut_at_knot_lines(std::vector<TrimLoop>{circle_loop(r, {0.5, 0.5})}, grid);
  const std::array<double, 2> areas = areas_by_column(assemble_cells(pieces, grid));
  EXPECT_NEAR(areas[0], rest, 1e-15);
  EXPECT_NEAR(areas[1], segment, 1e-15);

  // Where the curve leaves its cell and comes back unnoticed, the segment is counted to the wrong cell.
  std::vector<CutPiece> misplaced = pieces;
  for (CutPiece& piece : misplaced) piece.station[0] = 1;
  const std::array<double, 2> wrong = areas_by_column(assemble_cells(misplaced, grid));
  EXPECT_NEAR(wrong[0], rest + segment, 1e-15);
  EXPECT_EQ(wrong[1], 0.0);

  // Where one crossing alone is missed, the chains in the two cells do not close.
  const auto crossing = std::ranges::find_if(
      pieces, [](const CutPiece& piece) { return piece.station[0] == 1 && piece.end.u.is_on_line(); });
  ASSERT_NE(crossing, pieces.end());
  crossing->end = (crossing + 1)->end;
  pieces.erase(crossing + 1);
  EXPECT_THROW(assemble_cells(pieces, grid), NumericalError);
}

TEST(FaceCells, OverlappingAndWronglyDirectedLoopsAreRefused) {
  const NurbsSurface<3> surface = plane_surface(2, quarters, quarters);
  EXPECT_GEOMETRY_ERROR(
      elements_of({surface, {domain_loop(surface), polygon({{0.2, 0.2}, {0.8, 0.2}, {0.8, 0.8}, {0.2, 0.8}})}}),
      "patch \"face\": the loops run 2 times around");
  EXPECT_GEOMETRY_ERROR(elements_of({surface,
                                     {polygon({{0.0, 0.0}, {0.5, 0.0}, {0.5, 1.0}, {0.0, 1.0}}),
                                      reversed(polygon({{0.6, 0.2}, {1.0, 0.2}, {1.0, 0.8}, {0.6, 0.8}}))}}),
                        "run -1 times around (0.875, 0.375)");
}

}  // namespace
}  // namespace isorim::geometry
