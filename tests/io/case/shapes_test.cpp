#include <algorithm>
#include <cmath>
#include <numbers>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "io/results/compute.h"

/// Every type of shape that a case file can hold, with exact measures.
namespace isorim::io {
namespace {

constexpr double pi = std::numbers::pi;

struct ShapeCase {
  std::string name;
  std::string geometry;
  double boundary;
  double domain;
  std::vector<double> centroid;

  friend std::ostream& operator<<(std::ostream& out, const ShapeCase& shape) { return out << shape.name; }
};

class Shape : public ::testing::TestWithParam<ShapeCase> {};

TEST_P(Shape, HasItsExactMeasures) {
  const ShapeCase& expected = GetParam();
  const CaseFile file = read_case(parse_toml("[geometry]\n" + expected.geometry, "case.toml"), "case.toml");
  const Report report = compute(file, build_model(file));
  EXPECT_TRUE(report.geometry.closed);
  EXPECT_EQ(report.status, RunStatus::ok);
  const double size = std::max(1.0, std::abs(expected.centroid[0]));
  EXPECT_NEAR(report.properties[0].value.values[0], expected.boundary, 2e-13 * expected.boundary);
  EXPECT_NEAR(report.properties[1].value.values[0], expected.domain, 2e-13 * expected.domain);
  const Quantity* centroid = report.find("centroid");
  for (std::size_t i = 0; i < expected.centroid.size(); ++i) {
    EXPECT_NEAR(centroid->value.values[i], expected.centroid[i], 1e-12 * size) << i;
  }
}

const std::vector<ShapeCase> plane{
    {"Circle", "type = 'circle'\nradius = 2\ncentre = [1, 2]", 4 * pi, 4 * pi, {1, 2}},
    {"Ellipse", "type = 'ellipse'\nradii = [1, 1]\nrotation = 20", 2 * pi, pi, {0, 0}},
    {"Rectangle", "type = 'rectangle'\nsize = [4, 3]", 14, 12, {2, 1.5}},
    {"Polygon", "type = 'polygon'\npoints = [[0, 0], [0, 3], [4, 0]]", 12, 6, {4.0 / 3, 1}},
    {"MovedRectangle",
     "type = 'rectangle'\nsize = [2, 1]\ntransform = { scale = [2, 3], rotate = { angle = 90 }, translate = [10, 0] }",
     14,
     12,
     {8.5, 2}},
    {"TransformsInTheirOrder",
     "type = 'rectangle'\nsize = [2, 1]\ntransform = [{ translate = [1, 0] }, { mirror = { normal = [1, 0] } }]",
     6,
     2,
     {-2, 0.5}},
    {"RegionWithAHole",
     "type = 'region'\nloops = [{ type = 'rectangle', size = [4, 4], role = 'outer' }, { type = 'circle', radius = 1, "
     "centre = [2, 2], role = 'hole' }]",
     16 + 2 * pi,
     16 - pi,
     {2, 2}},
    {"HalfDiscOfCurves",
     "type = 'region'\nloops = [{ curves = [{ type = 'arc', radius = 1, angles = [0, 180] }, { type = 'line', from = "
     "[-1, 0], to = [1, 0] }] }]",
     2 + pi,
     pi / 2,
     {0, 4 / (3 * pi)}},
    {"NurbsTriangleByHomogeneousPoints",
     "type = 'nurbs'\ncurves = [{ degree = 1, knots = [0, 0, 1, 2, 3, 3], homogeneous = [[0, 0, 1], [8, 0, 2], [0, 3, "
     "1], [0, 0, 1]] }]",
     12,
     6,
     {4.0 / 3, 1}},
    // Four parabolas between the middles of the edges of the unit square, each with a corner as its control point:
    // each adds 2/3 of the triangle of its control points to the square of the middles.
    {"PeriodicQuadratic",
     "type = 'nurbs'\ncurves = [{ degree = 2, periodic = true, knots = [0, 1, 2, 3, 4], points = [[0, 0], [1, 0], [1, "
     "1], [0, 1]] }]",
     2 + std::sqrt(2.0) * std::asinh(1.0),
     5.0 / 6,
     {0.5, 0.5}},
};

const std::vector<ShapeCase> space{
    {"Sphere", "type = 'sphere'\nradius = 3\ncentre = [1, 2, 3]", 36 * pi, 36 * pi, {1, 2, 3}},
    {"SphereOfSixPatches", "type = 'sphere'\nradius = 3\ncentre = [1, 2, 3]\npatches = 6", 36 * pi, 36 * pi, {1, 2, 3}},
    {"TorusOfSixteenPatches",
     "type = 'torus'\nmajor_radius = 2\nminor_radius = 1\npatches = 16",
     8 * pi* pi,
     4 * pi* pi,
     {0, 0, 0}},
    {"Ellipsoid", "type = 'ellipsoid'\nradii = [1, 1, 1]", 4 * pi, 4 * pi / 3, {0, 0, 0}},
    {"Torus", "type = 'torus'\nmajor_radius = 2\nminor_radius = 1", 8 * pi* pi, 4 * pi* pi, {0, 0, 0}},
    {"Cylinder", "type = 'cylinder'\nradius = 1\nheight = 2\nbase = [0, 0, 1]", 6 * pi, 2 * pi, {0, 0, 2}},
    {"Cone", "type = 'cone'\nradius = 3\nheight = 4", 24 * pi, 12 * pi, {0, 0, 1}},
    {"Box", "type = 'box'\nsize = [1, 2, 3]\ncorner = [1, 1, 1]", 22, 6, {1.5, 2, 2.5}},
    {"RevolvedProfile",
     "type = 'revolve'\naxis = {}\nprofile = [{ type = 'polyline', points = [[0, 0, 0], [1, 0, 0], [1, 0, 2], [0, 0, "
     "2]] }]",
     6 * pi,
     2 * pi,
     {0, 0, 1}},
    {"RevolvedRegionByAQuarter",
     "type = 'revolve'\nangle = 90\naxis = { direction = [0, 1, 0] }\nregion = { type = 'rectangle', size = [1, 2], "
     "corner = [1, 0] }",
     4.5 * pi + 4,
     1.5 * pi,
     {28 / (9 * pi), 1, -28 / (9 * pi)}},
    {"ExtrudedAnnulus",
     "type = 'extrude'\nvector = [0, 0, 2]\nregion = { loops = [{ type = 'circle', radius = 2 }, { type = 'circle', "
     "radius = 1 }] }",
     2 * 3 * pi + 2 * 6 * pi,
     6 * pi,
     {0, 0, 1}},
    {"LoftOfSquares",
     "type = 'loft'\ndegree = 1\nends = 'caps'\nsections = [{ type = 'rectangle', size = [1, 1] }, { type = "
     "'rectangle', size = [1, 1], transform = { translate = [0, 0, 3] } }]",
     14,
     3,
     {0.5, 0.5, 1.5}},
    {"PatchesOfSeveralKinds",
     "type = 'patches'\npatches = [{ type = 'ruled', curves = [{ type = 'circle', radius = 1 }, { type = 'circle', "
     "radius = 1, transform = { translate = [0, 0, 2] } }] }, { type = 'disc', radius = 1, normal = [0, 0, -1] }, { "
     "type = 'disc', radius = 1, centre = [0, 0, 2], normal = [0, 0, 5] }]",
     6 * pi,
     2 * pi,
     {0, 0, 1}},
    {"HollowSphere",
     "type = 'patches'\npatches = [{ type = 'sphere', radius = 2 }, { type = 'sphere', radius = 1 }]",
     20 * pi,
     28 * pi / 3,
     {0, 0, 0}},
    {"TiltedDiscs",
     "type = 'patches'\npatches = [{ type = 'extrude', vector = [2, 0, 0], profile = [{ type = 'circle', radius = 1, "
     "transform = { rotate = { axis = [0, 1, 0], angle = 90 } } }] }, { type = 'disc', radius = 1, normal = [1, 0, 0] "
     "}, { type = 'disc', radius = 1, normal = [-3, 0, 0], centre = [2, 0, 0] }]",
     6 * pi,
     2 * pi,
     {1, 0, 0}},
    {"Tetrahedron",
     "type = 'nurbs'\npatches = [\n"
     "{ degrees = [1, 1], knots_u = [0, 0, 1, 1], knots_v = [0, 0, 1, 1], points = [[0,0,0], [1,0,0], [0,0,0], "
     "[0,1,0]] },\n"
     "{ degrees = [1, 1], knots_u = [0, 0, 1, 1], knots_v = [0, 0, 1, 1], points = [[[0,0,0], [1,0,0]], [[0,0,0], "
     "[0,0,1]]] },\n"
     "{ degrees = [1, 1], knots_u = [0, 0, 1, 1], knots_v = [0, 0, 1, 1], homogeneous = [[0,0,0,1], [0,1,0,1], "
     "[0,0,0,1], [0,0,1,1]] },\n"
     "{ degrees = [1, 1], knots_u = [0, 0, 1, 1], knots_v = [0, 0, 1, 1], points = [[1,0,0], [0,1,0], [1,0,0], "
     "[0,0,1]] }]",
     1.5 + std::sqrt(3.0) / 2,
     1.0 / 6,
     {0.25, 0.25, 0.25}},
    {"CutInAList",
     "type = 'patches'\npatches = [{ type = 'box', size = [1, 1, 1], clip = { point = [0, 0, 0.5], normal = [0, 0, 1] "
     "} "
     "}]",
     4,
     0.5,
     {0.5, 0.5, 0.25}},
    {"FacesWithTrims",
     // A square frame around a round hole: two trimmed faces, the hole told by its nesting and by its role.
     "type = 'patches'\npatches = ["
     "{ type = 'quadrilateral', corners = [[0,0,0], [4,0,0], [4,4,0], [0,4,0]], trims = [{ type = 'rectangle', size = "
     "[0.75, 0.75], corner = [0.125, 0.125] }, { type = 'circle', radius = 0.25, centre = [0.5, 0.5] }] },"
     "{ type = 'quadrilateral', corners = [[0,0,1], [4,0,1], [4,4,1], [0,4,1]], trims = [{ type = 'circle', radius = "
     "0.25, centre = [0.5, 0.5], role = 'hole' }, { type = 'rectangle', size = [0.75, 0.75], corner = [0.125, 0.125], "
     "role = 'outer' }] },"
     "{ type = 'extrude', profile = [{ type = 'circle', radius = 1, centre = [2, 2] }], vector = [0, 0, 1] },"
     "{ type = 'extrude', profile = [{ type = 'rectangle', size = [3, 3], corner = [0.5, 0.5] }], vector = [0, 0, 1] "
     "}]",
     2 * (9 - pi) + 2 * pi + 12,
     9 - pi,
     {2, 2, 0.5}},
    {"MovedThenCut",
     "type = 'sphere'\nradius = 1\ntransform = { translate = [5, 0, 0] }\nclip = { normal = [1, 0, 0], point = [5, 0, "
     "0] }",
     3 * pi,
     2 * pi / 3,
     {5 - 0.375, 0, 0}},
    {"CutTwice",
     "type = 'box'\nsize = [2, 2, 1]\ncorner = [-1, -1, 0]\nclip = [{ type = 'cylinder', radius = 0.5, keep = "
     "'outside' }, "
     "{ type = 'plane', normal = [1, 0, 0] }]",
     4 - pi / 4 + 2 * 1 + 2 + 1 + pi / 2,
     2 - pi / 8,
     {-(1 - 1.0 / 12) / (2 - pi / 8), 0, 0.5}},
    {"TSplineOfASolid",
     "type = 'tspline'\nfrom = { type = 'torus', major_radius = 2, minor_radius = 1 }\nrefine = [{ where = 'x > 1 && "
     "y > 0' }, { u = [0.3, 0.6], v = [0.2, 0.3], levels = 2, direction = 'v' }, { box = [[0, 0, 0], [1, 1, 1]] }]\n"
     "transform = { translate = [1, 0, 0] }",
     8 * pi* pi,
     4 * pi* pi,
     {1, 0, 0}},
    {"TSplinesOfAList",
     "type = 'tspline'\ndegrees = [3, 3]\nrefine = { where = 'z > 0.9', levels = 2 }\nfrom = [{ type = 'disc', radius "
     "= 1 }, { type = 'disc', radius = 1, centre = [0, 0, 1] }, { type = 'extrude', profile = [{ type = 'circle', "
     "radius = 1 }], vector = [0, 0, 1] }]",
     4 * pi,
     pi,
     {0, 0, 0.5}},
    {"TSplineByItsMesh",
     // The top of a box of 3 x 3 x 1: bilinear, so its control points are the vertices of the T-mesh.
     "type = 'patches'\npatches = [{ type = 'tspline', degrees = [1, 1], knots_u = [0, 0, 1, 2, 3, 3], knots_v = [0, "
     "0, "
     "1, 2, 3, 3], lines_v = [{ at = 1, from = 1, to = 3 }], homogeneous = [[0, 0, 1, 1], [1, 0, 1, 1], [2, 0, 1, 1], "
     "[3, 0, 1, 1], [1, 1, 1, 1], [2, 1, 1, 1], [3, 1, 1, 1], [0, 2, 1, 1], [1, 2, 1, 1], [2, 2, 1, 1], [3, 2, 1, 1], "
     "[0, 3, 1, 1], [1, 3, 1, 1], [2, 3, 1, 1], [3, 3, 1, 1]], refine = { levels = 1 } },"
     "{ type = 'quadrilateral', corners = [[0,0,0], [3,0,0], [3,3,0], [0,3,0]] },"
     "{ type = 'extrude', profile = [{ type = 'rectangle', size = [3, 3] }], vector = [0, 0, 1] }]",
     30,
     9,
     {1.5, 1.5, 0.5}},
    {"TSplineThatIsCut",
     "type = 'tspline'\nfrom = { type = 'sphere', radius = 1 }\nrefine = { where = 'x > 0' }\nclip = { normal = [0, 0, "
     "1] }",
     3 * pi,
     2 * pi / 3,
     {0, 0, -0.375}},
};

std::string shape_name(const ::testing::TestParamInfo<ShapeCase>& info) {
  return info.param.name;
}
INSTANTIATE_TEST_SUITE_P(Plane, Shape, ::testing::ValuesIn(plane), shape_name);
INSTANTIATE_TEST_SUITE_P(Space, Shape, ::testing::ValuesIn(space), shape_name);

TEST(PatchNames, AreTheAuthorsOrMade) {
  const auto names = [](const std::string& geometry) {
    const CaseFile file = read_case(parse_toml("[geometry]\n" + geometry, "case.toml"), "case.toml");
    std::vector<std::string> result;
    std::visit(
        [&](const auto& built) {
          for (const auto& patch : built.boundary.patches) result.push_back(patch.name);
        },
        file.shape);
    return result;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(names("type = 'sphere'\nradius = 1"), Names{"sphere"});
  EXPECT_EQ(names("type = 'sphere'\nradius = 1\nname = 'ball'"), Names{"ball"});
  EXPECT_EQ(names("type = 'cylinder'\nradius = 1\nheight = 1"), (Names{"bottom", "side", "top"}));
  EXPECT_EQ(names("type = 'cylinder'\nradius = 1\nheight = 1\nname = 'can'"),
            (Names{"can_bottom", "can_side", "can_top"}));
  EXPECT_EQ(names("type = 'patches'\npatches = [{ type = 'disc', radius = 1 }, { type = 'disc', radius = 1, name = "
                  "'lid' }]"),
            (Names{"patch_1", "lid"}));
  EXPECT_EQ(names("type = 'region'\nloops = [{ type = 'circle', radius = 1 }, { curves = [{ type = 'arc', radius = "
                  "0.5, angles = [0, 180], name = 'bow' }, { type = 'line', from = [-0.5, 0], to = [0.5, 0] }] }]"),
            (Names{"loop_1", "loop_2_bow", "loop_2_curve_2"}));
  EXPECT_EQ(names("type = 'sphere'\nradius = 1\nclip = { normal = [0, 0, 1] }"), (Names{"sphere", "cap"}));
  EXPECT_EQ(
      names("type = 'sphere'\nradius = 1\nname = 'hull'\nclip = [{ normal = [0, 0, 1] }, { normal = [1, 0, 0] }]"),
      (Names{"hull_sphere", "hull_cap", "hull_cap_2"}));
}

}  // namespace
}  // namespace isorim::io
