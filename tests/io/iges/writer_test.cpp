#include "io/iges/writer.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "geometry/shapes/curves.h"
#include "geometry/shapes/regions.h"
#include "geometry/shapes/solids.h"
#include "geometry/shapes/transforms.h"
#include "geometry/trimming/lifted_curve.h"
#include "io/iges/file.h"
#include "tests/geometry/expect_error.h"
#include "tests/geometry/trimming/faces.h"
#include "tests/io/iges/boundaries.h"
#include "tests/io/iges/entities.h"

namespace isorim::io::iges {
namespace {

using geometry::Boundary;
using geometry::NurbsCurve;
using geometry::NurbsSurface;
using geometry::Point2;
using geometry::Point3;
using geometry::Points;
using geometry::TrimLoop;
using geometry::TrimmedSurface;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

constexpr const char* date = "20260101.120000";

/// What is written, read by the lexical layer, which must find nothing to complain of: lines, numbers, back pointers,
/// counts.
template <int Dim>
File written(const Boundary<Dim>& boundary, WriterOptions options = {}) {
  options.date = date;
  const IgesText text = iges_text(orient(boundary), options);
  File file = parse(text.text, "written.igs");
  EXPECT_THAT(file.warnings, IsEmpty());
  for (const Entity& entity : file.entities) EXPECT_EQ(entity.complaint, "");
  return file;
}

std::vector<const Entity*> entities_of(const File& file, int type) {
  std::vector<const Entity*> found;
  for (const Entity& entity : file.entities) {
    if (entity.type == type) found.push_back(&entity);
  }
  return found;
}

TEST(IgesWriter, GlobalSectionSaysWhatTheFileIs) {
  WriterOptions options;
  options.title = "A part; with, delimiters";
  options.unit = "in";
  const File file = written(geometry::cube(2.0), options);
  EXPECT_EQ(file.global.product, options.title);
  EXPECT_EQ(file.global.unit, "in");
  EXPECT_EQ(file.global.unit_name, "IN");
  EXPECT_EQ(file.global.version_flag, 11);
  EXPECT_EQ(file.global.date, date);
  EXPECT_EQ(file.global.largest_coordinate, 2.0);
  EXPECT_THAT(file.global.native_system, HasSubstr("isorim"));
  EXPECT_THAT(file.start, ElementsAre(options.title + ", written by isorim"));
}

TEST(IgesWriter, AllUnitsThatIgesKnowsAreWritten) {
  for (const char* unit : {"in", "mm", "ft", "mi", "m", "km", "mil", "um", "cm", "uin"}) {
    WriterOptions options;
    options.unit = unit;
    EXPECT_EQ(written(geometry::cube(1.0), options).global.unit, unit);
  }
  WriterOptions options;
  options.unit = "furlong";
  try {
    iges_text(orient(geometry::cube(1.0)), options);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("IGES has no unit \"furlong\"; expected one of in, mm, ft"));
  }
}

TEST(IgesWriter, WholeSurfacesAreSurfacesBitForBit) {
  Boundary<3> boundary = geometry::torus(2.0, 0.5);
  append(boundary, geometry::cube(1.0, {5, 0, 0}), "_cube");
  const File file = written(boundary, {.form = Form::faces});
  const auto surfaces = entities_of(file, 128);
  ASSERT_EQ(surfaces.size(), boundary.patches.size());
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    EXPECT_EQ(surfaces[i]->subordinate, 0);
    expect_same_bits(surface_of_128(file, *surfaces[i]), surface_of(boundary.patches[i].shape));
  }
  EXPECT_THAT(entities_of(file, 144), IsEmpty());
}

TEST(IgesWriter, NamesLevelsAndColoursAreKept) {
  Boundary<3> boundary = geometry::cube(1.0);
  boundary.patches[0].name =
      "Spitze; \xC3\xBC"
      "ber, 45 Grad, ein Name der viel laenger als eine Zeile der Datei ist";
  WriterOptions options;
  for (std::size_t i = 0; i < 6; ++i) options.looks.push_back({Colour{1.0, 0.25, 0.0}, static_cast<int>(i)});
  options.looks[5].colour.reset();
  for (const Form form : {Form::faces, Form::solids}) {
    options.form = form;
    const File file = written(boundary, options);
    const auto faces = entities_of(file, form == Form::faces ? 128 : 510);
    ASSERT_EQ(faces.size(), 6U);
    ASSERT_EQ(entities_of(file, 314).size(), 1U);
    const Entity& colour = *entities_of(file, 314)[0];
    EXPECT_THAT(Parameters(file, colour).reals(3), ElementsAre(100.0, 25.0, 0.0));
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_EQ(faces[i]->level, static_cast<int>(i));
      EXPECT_EQ(faces[i]->colour, i < 5 ? -colour.sequence : 0);
      Parameters parameters(file, *faces[i]);
      parameters.skip(parameters.remaining() - 3);
      const TrailingPointers groups = parameters.trailing_pointers();
      ASSERT_EQ(groups.properties.size(), 1U);
      const Entity& name = *file.find(groups.properties[0]);
      EXPECT_EQ(name.type, 406);
      EXPECT_EQ(name.form, 15);
      Parameters text(file, name);
      EXPECT_EQ(text.integer(), 1);
      EXPECT_EQ(text.text(), boundary.patches[i].name);
    }
  }
  options.looks.pop_back();
  EXPECT_GEOMETRY_ERROR(iges_text(orient(boundary), options), "looks are given for 5 patches, but there are 6");
}

/// The pcurves and the curves in space of a 142.
struct BoundaryOnSurface {
  std::vector<NurbsCurve<2>> pcurves;
  std::vector<NurbsCurve<3>> curves;
};

std::vector<const Entity*> parts_of(const File& file, const Entity& curve) {
  if (curve.type != 102) return {&curve};
  Parameters parameters(file, curve);
  std::vector<const Entity*> parts;
  for (const int part : parameters.pointers(parameters.count())) parts.push_back(file.find(part));
  return parts;
}

BoundaryOnSurface boundary_of_142(const File& file, const Entity& entity, int surface) {
  BoundaryOnSurface boundary;
  EXPECT_EQ(entity.type, 142);
  Parameters parameters(file, entity);
  parameters.skip();
  EXPECT_EQ(parameters.pointer(), surface);
  for (const Entity* part : parts_of(file, parameters.target())) {
    EXPECT_EQ(part->use, 5);
    boundary.pcurves.push_back(curve_of_126<2>(file, *part));
  }
  for (const Entity* part : parts_of(file, parameters.target())) {
    EXPECT_EQ(part->use, 0);
    boundary.curves.push_back(curve_of_126<3>(file, *part));
  }
  EXPECT_EQ(parameters.integer(), 1);
  return boundary;
}

/// The largest distance of the curve from the image of the pcurve, at equal parameters.
double deviation(const NurbsSurface<3>& surface, const NurbsCurve<2>& pcurve, const NurbsCurve<3>& curve) {
  EXPECT_EQ(curve.domain().first, pcurve.domain().first);
  EXPECT_EQ(curve.domain().last, pcurve.domain().last);
  double largest = 0.0;
  constexpr int samples = 5000;
  for (int i = 0; i <= samples; ++i) {
    const double t = pcurve.domain().first + pcurve.domain().length() * i / samples;
    largest = std::max(largest, (lifted_point(surface, pcurve, t) - evaluate(curve, t)).norm());
  }
  return largest;
}

TEST(IgesWriter, TrimmedSurfacesKeepTheirPcurvesBitForBit) {
  const Boundary<3> boundary = trimmed_sphere();
  WriterOptions options{.form = Form::faces};
  for (const double tolerance : {1e-5, 1e-8, 1e-10}) {
    options.curve_tolerance = tolerance;
    const File file = written(boundary, options);
    const auto& face = std::get<TrimmedSurface>(boundary.patches[0].shape);
    const auto surfaces = entities_of(file, 128);
    ASSERT_EQ(surfaces.size(), 1U);
    EXPECT_EQ(surfaces[0]->subordinate, 1);
    expect_same_bits(surface_of_128(file, *surfaces[0]), face.surface());
    const auto faces = entities_of(file, 144);
    ASSERT_EQ(faces.size(), 1U);
    Parameters parameters(file, *faces[0]);
    EXPECT_EQ(parameters.pointer(), surfaces[0]->sequence);
    EXPECT_EQ(parameters.integer(), 1);
    EXPECT_EQ(parameters.integer(), 0);
    const BoundaryOnSurface outer = boundary_of_142(file, parameters.target(), surfaces[0]->sequence);
    ASSERT_EQ(outer.pcurves.size(), 1U);
    ASSERT_EQ(outer.curves.size(), 1U);
    expect_same_bits(outer.pcurves[0], face.loops()[0].curves[0]);
    const double diagonal = 2.0 * std::sqrt(3.0);
    EXPECT_LE(deviation(face.surface(), outer.pcurves[0], outer.curves[0]), tolerance * diagonal);
  }
}

TEST(IgesWriter, TheNaturalBoundaryNeedsNoLoop) {
  const Boundary<3> plate = drilled_plate();
  const File file = written(plate, {.form = Form::faces});
  const auto faces = entities_of(file, 144);
  ASSERT_EQ(faces.size(), 2U);
  for (const Entity* face : faces) {
    Parameters parameters(file, *face);
    const Entity& surface = parameters.target();
    EXPECT_EQ(parameters.integer(), 0);
    EXPECT_EQ(parameters.integer(), 1);
    EXPECT_EQ(parameters.pointer(), 0);
    const BoundaryOnSurface hole = boundary_of_142(file, parameters.target(), surface.sequence);
    ASSERT_EQ(hole.pcurves.size(), 1U);
    expect_same_bits(hole.pcurves[0], clockwise_circle(0.25, {0.5, 0.5}));
    // On a plane the image of a circle is a circle.
    EXPECT_EQ(hole.curves[0].degree(), 2);
    EXPECT_LE(deviation(surface_of_128(file, surface), hole.pcurves[0], hole.curves[0]), 1e-15);
  }
}

TEST(IgesWriter, DegenerateStretchesHaveNoCurveInSpace) {
  Boundary<3> boundary = geometry::sphere(1.0);
  const NurbsSurface<3> surface = surface_of(boundary.patches[0].shape);
  TrimLoop loop = domain_loop(surface);
  std::rotate(loop.curves.begin(), loop.curves.begin() + 1, loop.curves.end());
  boundary.patches[0].shape = TrimmedSurface(surface, {loop});
  const File file = written(boundary, {.form = Form::faces});
  ASSERT_EQ(entities_of(file, 142).size(), 1U);
  const BoundaryOnSurface outer =
      boundary_of_142(file, *entities_of(file, 142)[0], entities_of(file, 128)[0]->sequence);
  EXPECT_EQ(outer.pcurves.size(), 4U);
  EXPECT_EQ(outer.curves.size(), 2U);
}

TEST(IgesWriter, PartsThatHangTogetherAreFaces) {
  const NurbsSurface<3> surface = geometry::testing::plane_surface(1, {0, 1}, {0, 1});
  const auto square = [](double corner, double side) {
    return geometry::testing::polygon(
        {{corner, corner}, {corner + side, corner}, {corner + side, corner + side}, {corner, corner + side}});
  };
  const auto hole = [&](double corner, double side) { return geometry::testing::reversed(square(corner, side)); };
  // An island in a hole, each with a hole of its own; apart from them another square. Their order is mixed.
  Boundary<3> boundary;
  boundary.patches.push_back(
      {"sheet",
       TrimmedSurface(surface, {hole(0.3, 0.1), hole(0.1, 0.5), square(0.2, 0.3), square(0.05, 0.6), square(0.7, 0.2)}),
       1});
  const File file = written(boundary, {.form = Form::faces});
  ASSERT_EQ(entities_of(file, 128).size(), 1U);
  std::vector<std::pair<double, std::vector<double>>> corners;
  for (const Entity* face : entities_of(file, 144)) {
    Parameters parameters(file, *face);
    const int on = parameters.pointer();
    EXPECT_EQ(parameters.integer(), 1);
    const int holes = parameters.integer();
    const auto corner = [&](const Entity& entity) {
      return boundary_of_142(file, entity, on).pcurves[0].control_points()(0, 0);
    };
    corners.emplace_back(corner(parameters.target()), std::vector<double>{});
    for (int i = 0; i < holes; ++i) {
      Parameters curve(file, parameters.target());
      curve.skip(2);
      double least = 1.0;
      for (const Entity* part : parts_of(file, curve.target())) {
        least = std::min(least, curve_of_126<2>(file, *part).control_points().row(0).minCoeff());
      }
      corners.back().second.push_back(least);
    }
  }
  using Face = std::pair<double, std::vector<double>>;
  EXPECT_THAT(corners, UnorderedElementsAre(Face{0.2, {0.3}}, Face{0.05, {0.1}}, Face{0.7, {}}));
}

/// A manifold solid, followed from the 186 down, and checked on the way.
class SolidCheck {
 public:
  explicit SolidCheck(const File& file) : file_(file) {}

  struct Shell {
    std::vector<int> outward;
    std::vector<NurbsSurface<3>> surfaces;
  };

  std::vector<Shell> read(const Entity& solid) {
    Parameters parameters(file_, solid);
    std::vector<Shell> shells{read_shell(parameters.target())};
    EXPECT_TRUE(parameters.logical());
    for (int voids = parameters.count(2); voids > 0; --voids) {
      shells.push_back(read_shell(parameters.target()));
      EXPECT_TRUE(parameters.logical());
    }
    for (const auto& [edge, uses] : uses_) EXPECT_EQ(uses, (std::multiset<int>{0, 1})) << edge.second;
    EXPECT_EQ(uses_.size(), edges_.size());
    return shells;
  }

  double largest_gap() const { return largest_gap_; }

 private:
  struct Edge {
    NurbsCurve<3> curve;
    Point3 from;
    Point3 to;
  };
  using EdgeKey = std::pair<int, int>;

  Shell read_shell(const Entity& entity) {
    EXPECT_EQ(entity.type, 514);
    EXPECT_EQ(entity.form, 1);
    Parameters parameters(file_, entity);
    Shell shell;
    for (int faces = parameters.count(2); faces > 0; --faces) {
      const Entity& face = parameters.target();
      outward_ = parameters.logical();
      shell.outward.push_back(outward_ ? 1 : -1);
      shell.surfaces.push_back(read_face(face));
    }
    return shell;
  }

  NurbsSurface<3> read_face(const Entity& entity) {
    EXPECT_EQ(entity.type, 510);
    Parameters parameters(file_, entity);
    NurbsSurface<3> surface = surface_of_128(file_, parameters.target());
    const int loops = parameters.integer();
    EXPECT_TRUE(parameters.logical());
    for (int i = 0; i < loops; ++i) read_loop(parameters.target(), surface);
    return surface;
  }

  void read_loop(const Entity& entity, const NurbsSurface<3>& surface) {
    EXPECT_EQ(entity.type, 508);
    Parameters parameters(file_, entity);
    std::vector<Point2> ends;
    for (int count = parameters.integer(); count > 0; --count) {
      const bool is_vertex = parameters.logical();
      const Entity& list = parameters.target();
      const int index = parameters.integer();
      const bool forward = parameters.logical();
      EXPECT_EQ(parameters.integer(), 1);
      parameters.skip();
      const NurbsCurve<2> pcurve = curve_of_126<2>(file_, parameters.target());
      ends.push_back(evaluate(pcurve, pcurve.domain().first));
      ends.push_back(evaluate(pcurve, pcurve.domain().last));
      if (is_vertex) {
        check_pole(surface, pcurve, vertex(list, index));
      } else {
        // Seen from outside the material.
        uses_[{list.sequence, index}].insert(forward == outward_ ? 1 : 0);
        check_edge(surface, pcurve, edge({list.sequence, index}), forward);
      }
    }
    for (std::size_t i = 1; i < ends.size(); i += 2) {
      EXPECT_LE((ends[(i + 1) % ends.size()] - ends[i]).norm(), 1e-14);
    }
  }

  void check_pole(const NurbsSurface<3>& surface, const NurbsCurve<2>& pcurve, const Point3& pole) {
    for (const double s : {0.0, 0.3, 1.0}) {
      EXPECT_LE((lifted_point(surface, pcurve, pcurve.domain().first + s * pcurve.domain().length()) - pole).norm(),
                1e-12);
    }
  }

  /// The edge's curve and the image of the pcurve are the same curve, though not at equal parameters.
  void check_edge(const NurbsSurface<3>& surface, const NurbsCurve<2>& pcurve, const Edge& edge, bool forward) {
    const auto at = [](const auto& curve, double s) { return curve.domain().first + s * curve.domain().length(); };
    EXPECT_LE((lifted_point(surface, pcurve, at(pcurve, 0.0)) - (forward ? edge.from : edge.to)).norm(), 1e-12);
    EXPECT_LE((lifted_point(surface, pcurve, at(pcurve, 1.0)) - (forward ? edge.to : edge.from)).norm(), 1e-12);
    for (double s = 0.0; s <= 1.0; s += 0.125) {
      const double gap = closest_point(edge.curve, lifted_point(surface, pcurve, at(pcurve, s))).distance;
      largest_gap_ = std::max(largest_gap_, gap);
    }
  }

  Point3 vertex(const Entity& list, int index) {
    EXPECT_EQ(list.type, 502);
    Parameters parameters(file_, list);
    EXPECT_LE(index, parameters.count(3));
    parameters.skip(3 * (index - 1));
    return read_points<3>(parameters, 1).col(0);
  }

  const Edge& edge(const EdgeKey& key) {
    if (const auto known = edges_.find(key); known != edges_.end()) return known->second;
    Parameters parameters(file_, *file_.find(key.first));
    EXPECT_LE(key.second, parameters.count(5));
    parameters.skip(5 * (key.second - 1));
    const NurbsCurve<3> curve = curve_of_126<3>(file_, parameters.target());
    const Entity& from_list = parameters.target();
    const Point3 from = vertex(from_list, parameters.integer());
    const Entity& to_list = parameters.target();
    const Point3 to = vertex(to_list, parameters.integer());
    EXPECT_LE((evaluate(curve, curve.domain().first) - from).norm(), 1e-12);
    EXPECT_LE((evaluate(curve, curve.domain().last) - to).norm(), 1e-12);
    return edges_.emplace(key, Edge{curve, from, to}).first->second;
  }

  const File& file_;
  bool outward_ = true;
  std::map<EdgeKey, Edge> edges_;
  std::map<EdgeKey, std::multiset<int>> uses_;
  double largest_gap_ = 0.0;
};

TEST(IgesWriter, SolidsAreManifoldAndFaceOutwards) {
  const Boundary<3> shapes[] = {geometry::cube(1.0), geometry::sphere(1.0),        geometry::torus(2.0, 0.5),
                                drilled_plate(),     geometry::cylinder(1.0, 2.0), geometry::cone(1.0, 0.0, 2.0)};
  for (const Boundary<3>& boundary : shapes) {
    const auto oriented = orient(boundary);
    const File file = written(boundary);
    ASSERT_EQ(entities_of(file, 186).size(), 1U);
    SolidCheck check(file);
    const auto shells = check.read(*entities_of(file, 186)[0]);
    EXPECT_LE(check.largest_gap(), 1e-12);
    ASSERT_EQ(shells.size(), 1U);
    ASSERT_EQ(shells[0].surfaces.size(), boundary.patches.size());
    const auto& patches = oriented.topology.shells[0].patches;
    for (std::size_t i = 0; i < shells[0].surfaces.size(); ++i) {
      const auto& patch = oriented.boundary.patches[static_cast<std::size_t>(patches[i])];
      EXPECT_EQ(shells[0].outward[i], patch.orientation);
      expect_same_bits(shells[0].surfaces[i], surface_of(patch.shape));
    }
    // All but the solid depends on something, or is a property or colour.
    for (const Entity& entity : file.entities) EXPECT_EQ(entity.subordinate, entity.type == 186 ? 0 : 1);
  }
}

TEST(IgesWriter, EdgesThatMeetSeveralShorterOnesAreCut) {
  // A cube of which one side is two patches.
  Boundary<3> boundary = geometry::cube(1.0);
  const auto [lower, upper] = split(surface_of(boundary.patches[0].shape), geometry::Direction::u, 0.25);
  const std::string name = boundary.patches[0].name;
  boundary.patches[0] = {name + "_a", lower, 1};
  boundary.patches.push_back({name + "_b", upper, 1});
  const File file = written(boundary);
  ASSERT_EQ(entities_of(file, 186).size(), 1U);
  SolidCheck check(file);
  const auto shells = check.read(*entities_of(file, 186)[0]);
  EXPECT_EQ(shells[0].surfaces.size(), 7U);
  EXPECT_LE(check.largest_gap(), 1e-15);
  Parameters edges(file, *entities_of(file, 504)[0]);
  EXPECT_EQ(edges.integer(), 15);
}

/// A unit cube of which each face is cut out of a surface that reaches ten times as far.
Boundary<3> cube_of_large_surfaces(const Point3& corner) {
  Boundary<3> cube = geometry::cube(1.0, corner);
  const geometry::KnotVector knots(1, {-10.0, -10.0, 11.0, 11.0});
  for (auto& patch : cube.patches) {
    const NurbsSurface<3> face = surface_of(patch.shape);
    Points<3> points(3, 4);
    for (int i = 0; i < 4; ++i) points.col(i) = evaluate(face, {i % 2 == 0 ? -10.0 : 11.0, i < 2 ? -10.0 : 11.0});
    const TrimLoop square = geometry::testing::polygon({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    patch.shape = TrimmedSurface(NurbsSurface<3>::from_points(knots, knots, points), {square});
  }
  return cube;
}

TEST(IgesWriter, SurfacesOfVoidsMayReachBeyondTheSolid) {
  Boundary<3> boundary = geometry::sphere(3.0);
  append(boundary, cube_of_large_surfaces({0, 0, 0}), "_void");
  append(boundary, geometry::sphere(3.0, {7, 0, 0}), "_apart");
  const IgesText text = iges_text(orient(boundary));
  EXPECT_EQ(text.report.solids, 2);
  EXPECT_EQ(text.report.solid_faces, 8);
  const File file = parse(text.text, "void.igs");
  std::vector<std::size_t> shells;
  for (const Entity* solid : entities_of(file, 186)) shells.push_back(SolidCheck(file).read(*solid).size());
  EXPECT_THAT(shells, UnorderedElementsAre(2U, 1U));
}

TEST(IgesWriter, VoidsBelongToTheirSolids) {
  Boundary<3> boundary = geometry::sphere(3.0);
  append(boundary, geometry::cube(1.0, {-2, 0, 0}), "_void");
  append(boundary, geometry::sphere(0.5, {1, 0, 0}), "_void");
  // A solid with a void inside another void, which the first's box encloses too.
  append(boundary, geometry::sphere(0.4, {1, 0, 0}), "_kernel");
  append(boundary, geometry::sphere(0.3, {1, 0, 0}), "_kernel_void");
  append(boundary, geometry::cube(1.0, {7, 0, 0}), "_apart");
  const File file = written(boundary);
  std::vector<std::vector<double>> sizes;
  for (const Entity* solid : entities_of(file, 186)) {
    sizes.emplace_back();
    for (const auto& shell : SolidCheck(file).read(*solid)) {
      double largest = 0.0;
      for (const auto& surface : shell.surfaces) {
        const Points<3> points = surface.control_points();
        largest = std::max(largest, (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).maxCoeff());
      }
      sizes.back().push_back(largest);
    }
  }
  using ::testing::DoubleEq;
  EXPECT_THAT(sizes, UnorderedElementsAre(UnorderedElementsAre(DoubleEq(6.0), DoubleEq(1.0), DoubleEq(1.0)),
                                          ElementsAre(DoubleEq(0.8), DoubleEq(0.6)), ElementsAre(DoubleEq(1.0))));
}

TEST(IgesWriter, OpenShellsAreFacesWhateverTheForm) {
  Boundary<3> boundary = geometry::cube(1.0);
  boundary.patches.pop_back();
  append(boundary, geometry::sphere(1.0, {5, 0, 0}), "_closed");
  const IgesText text = iges_text(orient(boundary));
  EXPECT_EQ(text.report.solids, 1);
  EXPECT_EQ(text.report.solid_faces, 1);
  EXPECT_EQ(text.report.loose_faces, 5);
  const File file = parse(text.text, "open.igs");
  EXPECT_EQ(entities_of(file, 186).size(), 1U);
  EXPECT_EQ(std::count_if(file.entities.begin(), file.entities.end(),
                          [](const Entity& entity) { return entity.type == 128 && entity.subordinate == 0; }),
            5);
}

TEST(IgesWriter, PlaneLoopsAreCompositeCurvesBitForBit) {
  const Boundary<2> boundary = geometry::rectangle({2.0, 1.0}, {0.5, -3.0});
  const File file = written(boundary);
  ASSERT_EQ(entities_of(file, 102).size(), 1U);
  Point2 end;
  bool is_first = true;
  for (const Entity* part : parts_of(file, *entities_of(file, 102)[0])) {
    EXPECT_EQ(part->subordinate, 1);
    const NurbsCurve<2> curve = curve_of_126<2>(file, *part);
    const Point2 start = evaluate(curve, curve.domain().first);
    EXPECT_TRUE(is_first || start == end);
    is_first = false;
    end = evaluate(curve, curve.domain().last);
    EXPECT_TRUE(std::any_of(boundary.patches.begin(), boundary.patches.end(), [&](const auto& patch) {
      return patch.shape.knots() == curve.knots() && patch.shape.homogeneous() == curve.homogeneous();
    }));
  }
}

TEST(IgesWriter, PlaneLoopsThatRunClockwiseStayAsTheyAre) {
  Boundary<2> boundary = geometry::rectangle({2.0, 1.0}, {0.5, -3.0});
  for (auto& patch : boundary.patches) patch.shape = reverse(patch.shape);
  std::reverse(boundary.patches.begin(), boundary.patches.end());
  std::swap(boundary.patches[0], boundary.patches[2]);
  const File file = written(boundary);
  ASSERT_EQ(entities_of(file, 102).size(), 1U);
  const auto parts = parts_of(file, *entities_of(file, 102)[0]);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const NurbsCurve<2> curve = curve_of_126<2>(file, *parts[i]);
    const NurbsCurve<2> next = curve_of_126<2>(file, *parts[(i + 1) % parts.size()]);
    EXPECT_EQ(evaluate(curve, curve.domain().last), evaluate(next, next.domain().first));
  }
}

TEST(IgesWriter, PlaneLoopsOfMixedDirectionsAreCurvesAlone) {
  Boundary<2> boundary = geometry::rectangle({2.0, 1.0}, {0.5, -3.0});
  boundary.patches[1].shape = reverse(boundary.patches[1].shape);
  const File file = written(boundary);
  EXPECT_THAT(entities_of(file, 102), IsEmpty());
  const auto curves = entities_of(file, 126);
  ASSERT_EQ(curves.size(), 4U);
  for (const Entity* curve : curves) EXPECT_EQ(curve->subordinate, 0);
}

TEST(IgesWriter, FilesAppearWholeOrNotAtAll) {
  const auto folder = std::filesystem::path(::testing::TempDir()) / "isorim_iges_writer";
  std::filesystem::create_directories(folder);
  const auto path = folder / "cube.igs";
  EXPECT_EQ(write_iges(path, orient(geometry::cube(1.0))).solids, 1);
  EXPECT_EQ(entities_of(read_file(path), 186).size(), 1U);
  EXPECT_THROW(write_iges(folder / "no_such_folder" / "cube.igs", orient(geometry::cube(1.0))), InputError);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace isorim::io::iges
