#include "solver/bem/boundary_locator.h"

#include <cmath>
#include <functional>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "geometry/bezier/element_jet.h"
#include "geometry/intersection/clip.h"
#include "geometry/shapes/regions.h"
#include "geometry/shapes/solids.h"
#include "geometry/topology/orientation.h"

namespace isorim::solver {
namespace {

using geometry::Boundary;
using geometry::Point;
using geometry::Point2;
using geometry::Point3;

/// A body whose inside is known without its boundary.
template <int Dim>
struct Body {
  std::string name;
  Boundary<Dim> boundary;
  std::function<bool(const Point<Dim>&)> holds;
};

/// `step` on either side of random points of the boundary that are not cut off (the sides tell which).
template <int Dim>
std::vector<Point<Dim>> points_beside(const geometry::ElementTable<Dim>& table, double step, int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0.02, 0.98);
  std::vector<Point<Dim>> points;
  for (int k = 0; k < count; ++k) {
    const auto& element = table.elements[static_cast<std::size_t>(k) % table.elements.size()];
    Point<Dim - 1> place;
    for (Eigen::Index d = 0; d + 1 < Dim; ++d) place[d] = unit(random);
    const geometry::ElementJet<Dim> jet = geometry::evaluate_jet(table, element, place);
    points.push_back(jet.position + step * jet.normal());
    points.push_back(jet.position - step * jet.normal());
  }
  return points;
}

template <int Dim>
std::vector<Point<Dim>> points_about(const geometry::ElementTable<Dim>& table, int count) {
  const geometry::BoundingBox<Dim> box = geometry::bounding_box(table);
  const double margin = 0.1 * box.diagonal();
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<Point<Dim>> points;
  for (int k = 0; k < count; ++k) {
    Point<Dim> x;
    for (Eigen::Index d = 0; d < Dim; ++d)
      x[d] = box.lower[d] - margin + unit(random) * (box.upper[d] - box.lower[d] + 2.0 * margin);
    points.push_back(x);
  }
  return points;
}

/// What cells say at once, and what solid angles say of all points, is so; cells leave few points out that are spread
/// over the box.
template <int Dim>
void expect_located(const Body<Dim>& body) {
  const auto table = geometry::bezier_elements(geometry::orient(body.boundary).boundary);
  const double diagonal = geometry::bounding_box(table).diagonal();
  BoundaryLocator<Dim> locator(table);
  locator.prepare(Dim == 2 ? 2000 : 30000, 1e-10 * diagonal, 1);
  quadrature::NodeBuffer<Dim> buffer;
  std::vector<Point<Dim>> points = points_about(table, 2000);
  for (const double step : {1e-9, 1e-6, 1e-3, 0.05}) {
    const auto more = points_beside(table, step * diagonal, 60);
    points.insert(points.end(), more.begin(), more.end());
  }
  int left = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::optional<bool> known = locator.known_inside(points[i]);
    if (known) {
      EXPECT_EQ(*known, body.holds(points[i])) << body.name << " at " << points[i].transpose();
    } else if (i < 2000) {
      ++left;
    }
    if (i >= 2000 || i % 10 == 0) {
      EXPECT_EQ(locator.winding_number(points[i], buffer) > 0.5, body.holds(points[i]))
          << body.name << " at " << points[i].transpose();
    }
  }
  EXPECT_LT(left, 500) << body.name;
}

bool in_box(const Point3& x, const Point3& lower, const Point3& upper) {
  return (x.array() > lower.array()).all() && (x.array() < upper.array()).all();
}

Body<3> drilled_block() {
  const geometry::CylinderTool tool{{1.0, 0.9, 0.0}, {0.0, 0.0, 1.0}, 0.35, geometry::KeptSide::outside};
  return {"drilled block", geometry::clip(geometry::box({2.0, 2.0, 1.0}), tool), [](const Point3& x) {
            return in_box(x, {0, 0, 0}, {2, 2, 1}) && std::hypot(x[0] - 1.0, x[1] - 0.9) > 0.35;
          }};
}

Body<3> bitten_sphere() {
  const geometry::SphereTool tool{{0.9, 0.0, 0.3}, 0.6, geometry::KeptSide::outside};
  return {"bitten sphere", geometry::clip(geometry::sphere(1.0), tool),
          [](const Point3& x) { return x.norm() < 1.0 && (x - Point3(0.9, 0.0, 0.3)).norm() > 0.6; }};
}

/// Spheres in a lattice, every other one hollow, the cavity with a core in it.
Body<3> many_shells() {
  Body<3> body{"many shells", {}, {}};
  const auto add = [&](double radius, const Point3& centre) {
    for (geometry::Patch<3> patch : geometry::sphere(radius, centre).patches) {
      patch.name = std::to_string(body.boundary.patches.size());
      body.boundary.patches.push_back(std::move(patch));
    }
  };
  for (int k = 0; k < 8; ++k) {
    const Point3 centre(k % 2, k / 2 % 2, k / 4 % 2);
    add(0.45, centre);
    if (k % 2 == 0) continue;
    add(0.3, centre);
    add(0.1, centre);
  }
  body.holds = [](const Point3& x) {
    for (int k = 0; k < 8; ++k) {
      const double r = (x - Point3(k % 2, k / 2 % 2, k / 4 % 2)).norm();
      if (r < 0.45) return k % 2 == 0 || r > 0.3 || r < 0.1;
    }
    return false;
  };
  return body;
}

Body<3> slender_torus() {
  return {"slender torus", geometry::torus(1.0, 0.02),
          [](const Point3& x) { return std::hypot(std::hypot(x[0], x[1]) - 1.0, x[2]) < 0.02; }};
}

TEST(BoundaryLocator, AgreesWithBodiesThatAreKnown) {
  expect_located(drilled_block());
  expect_located(bitten_sphere());
  expect_located(many_shells());
  expect_located(slender_torus());
}

TEST(BoundaryLocator, AgreesWithRegionsThatAreKnown) {
  expect_located<2>({"ellipse", geometry::elliptic_disc({2.0, 0.1}),
                     [](const Point2& x) { return std::hypot(x[0] / 2.0, x[1] / 0.1) < 1.0; }});
  geometry::Points<2> corners(2, 6);
  corners << 0, 3, 3, 1, 1, 0, /**/ 0, 0, 1, 1, 3, 3;
  expect_located<2>({"angle", geometry::polygon(corners), [](const Point2& x) {
                       const bool low = x[0] > 0 && x[0] < 3 && x[1] > 0 && x[1] < 1;
                       return low || (x[0] > 0 && x[0] < 1 && x[1] > 0 && x[1] < 3);
                     }});
}

/// Cells that a gap joins to others are not told apart: all points are left to the solid angle.
TEST(BoundaryLocator, AnOpenBoundaryIsNotTrusted) {
  Boundary<3> open = geometry::box({1.0, 1.0, 1.0});
  open.patches.pop_back();
  const auto table = geometry::bezier_elements(open);
  BoundaryLocator<3> locator(table);
  locator.prepare(8000, 1e-10, 1);
  EXPECT_EQ(locator.known_inside({0.5, 0.5, 0.5}), std::nullopt);
}

TEST(CellRegions, WithoutPositiveWeightsNothingIsKnown) {
  auto table = geometry::bezier_elements(geometry::sphere(1.0));
  table.nets[3] = -0.1;
  const CellRegions<3> regions(table, 20, 1e-10);
  EXPECT_EQ(regions.count(), 0);
  EXPECT_EQ(regions.region({9.0, 0.0, 0.0}), CellRegions<3>::touched);
}

TEST(CellRegions, RegionsAreThoseThatTheBoundaryParts) {
  const auto table = geometry::bezier_elements(geometry::torus(1.0, 0.4));
  const CellRegions<3> regions(table, 40, 1e-10);
  EXPECT_EQ(regions.count(), 2);
  EXPECT_EQ(regions.region({0.0, 0.0, 0.0}), regions.region({0.0, 0.0, 50.0}));
  EXPECT_NE(regions.region({0.0, 0.0, 0.0}), regions.region({-1.0, 0.0, 0.0}));
  EXPECT_EQ(regions.region({0.0, 1.4, 0.0}), CellRegions<3>::touched);
}

}  // namespace
}  // namespace isorim::solver
