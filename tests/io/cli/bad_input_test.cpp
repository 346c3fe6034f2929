#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/io/cli/bad_case.h"

namespace isorim::testing {
namespace {

using ::testing::HasSubstr;

class BadInput : public BadCaseTest {};

TEST_P(BadInput, IsRefusedWithStatus2AndNothingWritten) {
  expect_refusal();
}

const std::string circle = "[geometry]\ntype = 'circle'\nradius = 1\n";
const std::string sphere = "[geometry]\ntype = 'sphere'\nradius = 1\n";

std::string nurbs(const std::string& knots, const std::string& more) {
  return "[geometry]\ntype = 'nurbs'\ncurves = [{ degree = 1, knots = " + knots + ", " + more + " }]\n";
}

std::string polygon(const std::string& points) {
  return "[geometry]\ntype = 'polygon'\npoints = " + points + "\n";
}

std::string region(const std::string& loops) {
  return "[geometry]\ntype = 'region'\nloops = [" + loops + "]\n";
}

const std::vector<BadCase> syntax{
    {"NotToml", "[geometry\n", {"case.toml:1:", "not TOML"}},
    {"KeyTwice", "title = 'a'\ntitle = 'b'\n", {"case.toml:2:", "not TOML"}},
    {"EmptyFile", "", {"the key \"geometry\" (table) is missing"}},
};

const std::vector<BadCase> keys{
    {"UnknownKey",
     "[geometry]\ntype = 'circle'\nradius = 1\nradii = 2\n",
     {"case.toml:4: geometry.radii: unknown key (did you mean \"radius\"?)"}},
    {"UnknownSection",
     circle + "[propertis]\ntolerance = 1e-9\n",
     {"case.toml:4: propertis: unknown key (did you mean \"properties\"?)"}},
    {"UnknownKeyNearNothing",
     "[geometry]\ntype = 'circle'\nradius = 1\nzzzzzzzzz = 2\n",
     {"geometry.zzzzzzzzz: unknown key; expected one of radius, centre, name, transform"}},
    {"UnknownKeyInExpect",
     circle + "[expect]\narea = { value = 3, rtoll = 1 }\n",
     {"case.toml:5: expect.area.rtoll: unknown key (did you mean \"rtol\"?)"}},
    {"MissingKey", "[geometry]\ntype = 'circle'\n", {"geometry: the key \"radius\" (real) is missing"}},
    {"MissingType", "[geometry]\nradius = 1\n", {"case.toml:1: geometry: the key \"type\" is missing"}},
    {"UnknownType",
     "[geometry]\ntype = 'circel'\n",
     {"case.toml:2: geometry.type: found the text \"circel\"", "(did you mean \"circle\"?)"}},
    {"LaterKey", circle + "clip = { normal = [1, 0] }\n", {"geometry.clip: not available in this version"}},
};

/// A box, and the section that follows.
std::string afloat(const std::string& text) {
  return "[geometry]\ntype = 'box'\nsize = [4, 2, 1]\n[hydrostatics]\n" + text;
}

const std::vector<BadCase> hydrostatics{
    {"InThePlane", circle + "[hydrostatics]\ndraught = 1\n", {"hydrostatics are for solids; the shape is plane"}},
    {"NeitherDraughtNorLoading", afloat("trim = 1\n"), {"expected a \"draught\" or a \"loading\""}},
    {"DraughtsThatFall",
     afloat("draught = 1\ncurves_of_form = { draughts = [0.5, 0.2] }\n"),
     {"hydrostatics.curves_of_form.draughts: found 0.2 after 0.5; expected rising numbers"}},
    {"RangeWithoutStep",
     afloat("draught = 1\ncurves_of_form = { draughts = { from = 0, to = 1 } }\n"),
     {"draughts: expected either \"step\" or \"count\""}},
    {"RangeThatFalls",
     afloat("draught = 1\ncurves_of_form = { draughts = { from = 1, to = 0, step = 0.1 } }\n"),
     {"found from = 1 and to = 0; expected a range that rises"}},
    {"ArmsWithoutLoading",
     afloat("draught = 1\nrighting_arms = { heels = [0, 10] }\n"),
     {"hydrostatics.righting_arms: righting arms need a \"loading\""}},
    {"MassOfZero",
     afloat("loading = { mass = 0, centre_of_gravity = [0, 0, 0] }\n"),
     {"hydrostatics.loading.mass: found 0; expected"}},
    {"CentreInThePlane",
     afloat("loading = { mass = 1, centre_of_gravity = [0, 0] }\n"),
     {"found 2 coordinates; expected 3"}},
    {"UnknownTrim",
     afloat("loading = { mass = 1, centre_of_gravity = [0, 0, 0] }\nrighting_arms = { heels = [0], trim = 'fre' }\n"),
     {"(did you mean \"free\"?)"}},
    {"UnknownQuantity",
     afloat("draught = 1\n[expect]\n'hydrostatics.volum' = { value = 1, rtol = 1 }\n"),
     {"did you mean \"hydrostatics.volume\"?"}},
};

const std::vector<BadCase> types{
    {"TextForReal",
     "[geometry]\ntype = 'circle'\nradius = 'one'\n",
     {"case.toml:3: geometry.radius: found the text \"one\"; expected a real"}},
    {"BooleanForReal", "[geometry]\ntype = 'circle'\nradius = true\n", {"found the boolean true; expected a real"}},
    {"DateForText", "title = 2016-01-01\n" + circle, {"title: found the date or time 2016-01-01; expected a text"}},
    {"RealForInteger",
     circle + "[properties]\ngauss_points = 4.0\n",
     {"properties.gauss_points: found the real 4; expected an integer"}},
    {"IntegerForBoolean", circle + "[output]\nvtk = 1\n", {"output.vtk: found the integer 1; expected true or false"}},
    {"IntegerForText", "title = 3\n" + circle, {"case.toml:1: title: found the integer 3; expected a text in quotes"}},
    {"ListForTable", "geometry = [1]\n", {"geometry: found a list of 1; expected a table"}},
    {"TextForTable", "properties = 'none'\n" + circle, {"properties: found the text \"none\"; expected a table"}},
    {"TableForList",
     circle + "[integral]\nname = 'a'\n",
     {"integral: found a table; expected a list of tables, [[integral]]"}},
    {"ControlCharacters",
     circle + "[[integral]]\nname = \"a\\u0000\\u001b[31m\"\nintegrand = 'x'\n",
     {"integral[1].name: found \"a\\x00\\x1b[31m\"; expected letters"}},
    {"LongText",
     "[geometry]\ntype = '" + std::string(100000, 'a') + "'\n",
     {"geometry.type: found the text \"" + std::string(60, 'a') + "...\""}},
    {"LongKey", circle + std::string(100000, 'b') + " = 1\n", {std::string(20, 'b') + "...: unknown key"}},
    {"NotANumber", "[geometry]\ntype = 'circle'\nradius = nan\n", {"geometry.radius", "expected a finite real"}},
    {"Infinity", "[geometry]\ntype = 'circle'\nradius = inf\n", {"geometry.radius", "expected a finite real"}},
    {"TooFewCoordinates",
     circle + "centre = [1]\n",
     {"geometry.centre: found a list of 1; expected a list of 2 reals"}},
    {"TextAmongCoordinates",
     circle + "centre = [1, 'b']\n",
     {"geometry.centre[2]: found the text \"b\"; expected a real"}},
    {"UnknownChoice",
     circle + "[[integral]]\nname = 'a'\nover = 'domian'\nintegrand = 'x'\n",
     {"integral[1].over: found the text \"domian\"; expected one of \"domain\", \"boundary\" (did you mean "
      "\"domain\"?)"}},
    {"RaggedExpectation",
     sphere + "[expect]\ninertia = { value = [[1, 0, 0], [0, 1]], rtol = 1 }\n",
     {"expect.inertia.value[2]: found a list of 2; expected a list of 3 reals"}},
};

const std::vector<BadCase> ranges{
    {"NegativeRadius",
     "[geometry]\ntype = 'circle'\nradius = -1\n",
     {"case.toml:3: geometry.radius: found -1; expected a number > 0"}},
    {"ZeroRadius", "[geometry]\ntype = 'sphere'\nradius = 0\n", {"geometry.radius: found 0; expected a number > 0"}},
    {"NegativeSize",
     "[geometry]\ntype = 'box'\nsize = [1, -2, 3]\n",
     {"geometry.size[2]: found -2; expected a number > 0"}},
    {"ZeroTolerance",
     circle + "[properties]\ntolerance = 0\n",
     {"properties.tolerance: found 0; expected a number > 0 and <= 0.1"}},
    {"NegativeDensity", circle + "[properties]\ndensity = -1\n", {"properties.density: found -1"}},
    {"TooManyGaussPoints",
     circle + "[properties]\ngauss_points = 1000\n",
     {"properties.gauss_points: found 1000; expected a number from 0 to 128"}},
    {"SpindleTorus",
     "[geometry]\ntype = 'torus'\nmajor_radius = 1\nminor_radius = 2\n",
     {"expected minor_radius < major_radius"}},
    {"ConeWithoutRadius", "[geometry]\ntype = 'cone'\nheight = 1\n", {"found neither; expected exactly one of"}},
    {"ConeOfNoWidth", "[geometry]\ntype = 'cone'\nradii = [0, 0]\nheight = 1\n", {"at least one radius > 0"}},
    {"PoleInTheWrongSpace",
     circle + "[properties]\npole = [0, 0, 0]\n",
     {"properties.pole: found 3 coordinates; expected 2"}},
    {"AxisWithoutDirection",
     "[geometry]\ntype = 'revolve'\naxis = { direction = [0, 0, 0] }\nprofile = [{ type = 'line', from = [1, 0], to = "
     "[1, 1] }]\n",
     {"geometry.axis: the key \"direction\" is [0, 0, 0]"}},
    {"TurnOfNothing",
     "[geometry]\ntype = 'revolve'\naxis = {}\nangle = 0\nprofile = [{ type = 'line', from = [1, 0], to = [1, 1] }]\n",
     {"geometry.angle: found 0; expected a number > 0 and <= 360"}},
};

const std::vector<BadCase> shapes{
    {"OpenLoop",
     region("{ curves = [{ type = 'polyline', points = [[0, 0], [1, 0], [1, 1]] }] }"),
     {"case.toml:3: geometry.loops[1]", "the boundary is not closed"}},
    {"OpenNurbsLoop",
     region("{ type = 'nurbs', degree = 1, knots = [0, 0, 1, 2, 2], points = [[0, 0], [1, 0], [1, 1]] }"),
     {"geometry.loops[1]", "the boundary is not closed"}},
    {"FallingKnots",
     nurbs("[0, 0, 2, 1, 3, 3]", "points = [[0, 0], [1, 0], [1, 1], [0, 0]]"),
     {"geometry.curves[1]", "knot"}},
    {"TooFewKnots", nurbs("[0, 0, 1, 1]", "points = [[0, 0], [1, 0], [1, 1], [0, 0]]"), {"geometry.curves[1]", "4"}},
    {"NegativeWeight",
     nurbs("[0, 0, 1, 1]", "points = [[0, 0], [1, 0]], weights = [1, -1]"),
     {"geometry.curves[1].weights[2]: found -1; expected a number > 0"}},
    {"HomogeneousWeightZero",
     nurbs("[0, 0, 1, 1]", "homogeneous = [[0, 0, 1], [1, 0, 0]]"),
     {"geometry.curves[1]", "weight"}},
    {"TooFewWeights",
     nurbs("[0, 0, 1, 1]", "points = [[0, 0], [1, 0]], weights = [1]"),
     {"geometry.curves[1]: found 1 weights for 2 points; expected one each"}},
    {"PointsTwice",
     nurbs("[0, 0, 1, 1]", "points = [[0, 0], [1, 0]], homogeneous = [[0, 0, 1], [1, 0, 1]]"),
     {"found both; expected exactly one of \"points\" and \"homogeneous\""}},
    {"PointsOfSpaceInThePlane",
     nurbs("[0, 0, 1, 1]", "points = [[0, 0, 0], [1, 0, 0]]"),
     {"geometry.curves[1].points[1]: found 3 coordinates; expected 2"}},
    {"RaggedPoints",
     nurbs("[0, 0, 1, 1]", "points = [[0, 0], [1, 0, 0]]"),
     {"geometry.curves[1].points[2]: found 3 numbers"}},
    {"PeriodicWithClampedKnots",
     nurbs("[0, 1, 2, 3]", "periodic = true, points = [[0, 0], [1, 0], [1, 1], [0, 1]]"),
     {"geometry.curves[1]", "control points"}},
    {"WrongNet",
     "[geometry]\ntype = 'nurbs'\n[[geometry.patches]]\ndegrees = [1, 1]\nknots_u = [0, 0, 1, 1]\nknots_v = [0, 0, 1, "
     "1]\npoints = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\n",
     {"case.toml:7: geometry.patches[1].points: found 3 control points; the degrees and knots ask for 2 x 2 = 4"}},
    {"RealDegree",
     "[geometry]\ntype = 'nurbs'\n[[geometry.patches]]\ndegrees = [1, 1.5]\nknots_u = [0, 0, 1, 1]\nknots_v = [0, 0, "
     "1, 1]\npoints = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]\n",
     {"geometry.patches[1].degrees[2]: found the real 1.5; expected an integer"}},
    {"CrossingLoop", polygon("[[0, 0], [2, 2], [2, 0], [0, 1]]"), {"geometry", "cross"}},
    {"LoopsThatCross",
     region("{ type = 'circle', radius = 1 }, { type = 'circle', radius = 1, centre = [1, 0] }"),
     {"geometry", "cross"}},
    {"LoopWithoutArea", polygon("[[0, 0], [1, 0], [2, 0]]"), {"geometry"}},
    {"TwoCorners", polygon("[[0, 0], [1, 0]]"), {"geometry: found 2 corners; expected at least 3"}},
    {"NoLoops", region(""), {"geometry: found 0 loops; expected at least 1"}},
    {"RepeatedPoint", polygon("[[0, 0], [1, 0], [1, 0], [0, 1]]"), {"case.toml:1: geometry"}},
    {"HoleOutside",
     region("{ type = 'circle', radius = 1, role = 'hole' }"),
     {"geometry.loops[1]: the role is \"hole\", but the loop lies in no other one"}},
    {"OuterInside",
     region("{ type = 'circle', radius = 1, role = 'outer' }, { type = 'circle', radius = 0.5, role = 'outer' }"),
     {"geometry.loops[2]: the role is \"outer\", but the loop lies inside another one"}},
    {"PatchNameTwice",
     region("{ type = 'circle', radius = 1, name = 'a' }, { type = 'circle', radius = 0.5, name = 'a' }"),
     {"two patches have the name \"a\""}},
    {"RegionAcrossTheAxis",
     "[geometry]\ntype = 'revolve'\naxis = { direction = [0, 1, 0] }\nregion = { type = 'circle', radius = 1 }\n",
     {"geometry"}},
    {"ShellsThatCross",
     "[geometry]\ntype = 'patches'\npatches = [{ type = 'sphere', radius = 1 }, { type = 'sphere', radius = 1, centre "
     "= [1, 0, 0] }]\n",
     {"case.toml:1: geometry: two shells cross near ("}},
    {"ProfileAcrossTheAxis",
     "[geometry]\ntype = 'revolve'\naxis = { direction = [0, 1, 0] }\nprofile = [{ type = 'circle', radius = 1, "
     "centre = [0.5, 0] }]\n",
     {"case.toml:1: geometry: revolve: curve 1 of the profile reaches 0.5 beyond the axis"}},
    {"ProfileThatCrossesItself",
     "[geometry]\ntype = 'revolve'\naxis = { direction = [0, 1, 0] }\nprofile = [{ type = 'polyline', points = "
     "[[0, 0], [2, 2], [2, 0], [0, 3]] }]\n",
     {"case.toml:1: geometry: a loop crosses itself"}},
    {"ExtrusionInThePlane",
     "[geometry]\ntype = 'extrude'\nvector = [1, 0, 0]\nregion = { type = 'circle', radius = 1 }\n",
     {"geometry"}},
    {"AxisInThePlane",
     circle + "transform = { rotate = { axis = [0, 0, 1], angle = 30 } }\n",
     {"geometry.transform.rotate: found an \"axis\""}},
    {"ShiftInTheWrongSpace",
     circle + "transform = { translate = [1, 2, 3] }\n",
     {"geometry.transform.translate: found 3 coordinates; expected 2"}},
    {"WeightsFarApart",
     nurbs("[0, 0, 1, 2, 2]", "points = [[0, 0], [1, 0], [1, 1]], weights = [1, 1e15, 1]"),
     {"geometry.curves[1]", "the weights range from 1 to 1e+15; expected a ratio of at most 1e+10"}},
    {"LargerThanNumbersReach",
     "[geometry]\ntype = 'sphere'\nradius = 1e100\n",
     {"case.toml:1: geometry: the boundary has the size 3.46e+100; expected a size from 1e-60 to 1e+60"}},
    {"SmallerThanNumbersReach",
     "[geometry]\ntype = 'sphere'\nradius = 1e-100\n",
     {"geometry: the boundary has the size 3.46e-100; expected"}},
    {"TooFarFromTheOrigin",
     polygon("[[0.1, 0], [1, 0.3], [0.2, 0.7]]") + "transform = { translate = [1e12, 1e12] }\n",
     {"geometry: points nearer than 1.1e-06 are to count as the same, but coordinates up to 1e+12 are rounded"}},
    {"ClosureToleranceBelowRounding",
     polygon("[[0.1, 0], [1, 0.3], [0.2, 0.7]]") + "[properties]\nclosure_tolerance = 1e-300\n",
     {"expected a larger closure tolerance"}},
    {"SideWithinTheClosureTolerance",
     "[geometry]\ntype = 'rectangle'\nsize = [1000, 0.001]\n",
     {"patch 'right': the whole curve lies at (1000, 0), within the closure tolerance 0.001"}},
    {"ScaledToNothing", circle + "transform = { scale = 0 }\n", {"geometry.transform.scale"}},
};

const std::string cube = "[geometry]\ntype = 'box'\nsize = [1, 1, 1]\n";

/// A square face with the loops given.
std::string face(const std::string& loops) {
  return "[geometry]\ntype = 'patches'\n[[geometry.patches]]\ntype = 'quadrilateral'\n"
         "corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]\ntrims = [" +
         loops + "]\n";
}

const std::vector<BadCase> cuts{
    {"ClipWithoutNormal",
     cube + "clip = { point = [0, 0, 0] }\n",
     {"case.toml:4: geometry.clip: the key \"type\" is missing; expected one of \"plane\", \"sphere\", "
      "\"cylinder\", \"cone\""}},
    {"ClipByAnUnknownTool",
     cube + "clip = { type = 'cilinder', radius = 1, keep = 'inside' }\n",
     {"geometry.clip.type: found the text \"cilinder\"", "(did you mean \"cylinder\"?)"}},
    {"ClipWithoutASide",
     cube + "clip = { type = 'sphere', radius = 1 }\n",
     {"geometry.clip: the key \"keep\" (text) is missing"}},
    {"ClipWithoutADirection",
     cube + "clip = { normal = [0, 0, 0] }\n",
     {"geometry.clip: the key \"normal\" is [0, 0, 0]; expected a direction"}},
    {"ClipByAConeThatIsAPlane",
     cube + "clip = { type = 'cone', half_angle = 90, keep = 'inside' }\n",
     {"geometry.clip.half_angle: found 90; expected a number > 0 and < 90"}},
    {"ClipOfEverything",
     cube + "clip = [{ normal = [0, 0, 1], point = [0, 0, 0.5] }, { normal = [0, 0, 1] }]\n",
     {"case.toml:4: geometry.clip[2]: clip: nothing is left of the solid"}},
    {"ClipOfAnOpenBoundary",
     "[geometry]\ntype = 'patches'\nclip = { normal = [1, 0, 0] }\n[[geometry.patches]]\ntype = 'disc'\nradius = 1\n",
     {"geometry: the boundary is not closed: 'patch_1' has a free edge"}},
    {"ClipOfCurves",
     "[geometry]\ntype = 'nurbs'\nclip = { normal = [1, 0, 0] }\n[[geometry.curves]]\ndegree = 1\nknots = [0, 0, 1, 2, "
     "2]\n"
     "points = [[0, 0], [1, 0], [0, 0]]\n",
     {"a shape of the plane cannot be clipped"}},
    {"TrimOutsideTheDomain",
     face("{ type = 'circle', radius = 0.5, centre = [0.6, 0.5] }"),
     {"geometry.patches[1].trims: curve 1 of loop 1 leaves the surface's domain"}},
    {"TrimsThatCross",
     face("{ type = 'circle', radius = 0.2, centre = [0.4, 0.5] }, { type = 'circle', radius = 0.2, centre = [0.6, "
          "0.5] }"),
     {"geometry.patches[1].trims: two loops cross: patches 'loop_1' and 'loop_2' at (0.5, 0."}},
    {"TrimThatIsOpen",
     face("{ curves = [{ type = 'line', from = [0, 0], to = [1, 0] }] }"),
     {"case.toml:6: geometry.patches[1].trims[1]: ", "the boundary is not closed"}},
    {"TrimInTheWrongRole",
     face("{ type = 'circle', radius = 0.4, centre = [0.5, 0.5] }, { type = 'circle', radius = 0.2, centre = [0.5, "
          "0.5], "
          "role = 'outer' }"),
     {"geometry.patches[1].trims[2]: the role is \"outer\", but the loop lies inside another one"}},
};

/// Bilinear on [0, 3] x [0, 3], with more keys.
std::string tspline(const std::string& more) {
  return "[geometry]\ntype = 'tspline'\ndegrees = [1, 1]\nknots_u = [0, 0, 1, 2, 3, 3]\nknots_v = [0, 0, 3, 3]\n"
         "points = [[0,0,0], [1,0,0], [2,0,0], [3,0,0], [0,3,0], [1,3,0], [2,3,0], [3,3,0]]\n" +
         more + "\n";
}

const std::vector<BadCase> tsplines{
    {"TSplineOfNothing",
     "[geometry]\ntype = 'tspline'\n",
     {"case.toml:1: geometry: the key \"degrees\" is missing", "found no \"from\", and \"knots_u\" or \"knots_v\""}},
    {"TSplineTwice",
     tspline("from = { type = 'sphere', radius = 1 }"),
     {"case.toml:1: geometry: found \"from\" beside a T-mesh"}},
    {"TSplineWithTooFewPoints",
     "[geometry]\ntype = 'tspline'\ndegrees = [1, 1]\nknots_u = [0, 0, 1, 1]\nknots_v = [0, 0, 1, 1]\n"
     "points = [[0,0,0], [1,0,0], [0,1,0]]\n",
     {"geometry: T-spline: 3 control points given; the T-mesh has 4 anchors"}},
    {"TSplineWithBadKnots",
     "[geometry]\ntype = 'tspline'\ndegrees = [1, 1]\nknots_u = [0, 0, 1, 1]\nknots_v = [0, 0, 2, 1]\n"
     "points = [[0,0,0], [1,0,0], [0,1,0], [1,1,0]]\n",
     {"geometry.knots_v: knot vector: "}},
    {"LineAtNoKnot",
     tspline("lines_u = [{ at = 1.5, from = 0, to = 3 }]"),
     {"T-mesh: a line u is drawn at 1.5, which is no knot between 0 and 3"}},
    {"LineWithoutAnEnd",
     tspline("lines_u = [{ at = 1, from = 0 }]"),
     {"case.toml:7: geometry.lines_u[1]: the key \"to\" (real) is missing"}},
    {"TSplineOfATrimmedFace",
     "[geometry]\ntype = 'tspline'\nfrom = { type = 'quadrilateral', corners = [[0,0,0], [1,0,0], [1,1,0], [0,1,0]], "
     "trims = [{ type = 'circle', radius = 0.2, centre = [0.5, 0.5] }] }\n",
     {"geometry.from: the patch \"quadrilateral\" is trimmed; only whole surfaces become T-splines"}},
    {"RefineByAnUnknownVariable",
     tspline("refine = { where = 'u > 1' }"),
     {"geometry.refine.where: at character 1: found the unknown name \"u\"; expected x, y, z"}},
    {"RefineOfNothing",
     "[geometry]\ntype = 'tspline'\nfrom = { type = 'sphere', radius = 1 }\nrefine = [{ levels = 1 }, { where = 'z > "
     "2' "
     "}]\n",
     {"case.toml:4: geometry.refine[2]: no part of the surface lies in the region"}},
    {"RefineByNoNumber",
     tspline("refine = { where = 'sqrt(-1 - x)' }"),
     {"case.toml:7: geometry.refine: the condition is not a number at (0.1, 0.3"}},
    {"RefineByABoxOfOneCorner",
     tspline("refine = { box = [[0, 0, 0]] }"),
     {"geometry.refine: found a box of 1 corners; expected 2"}},
    {"RefineByAFallingRange", tspline("refine = { u = [2, 1] }"), {"geometry.refine: found u = [2, 1]"}},
    {"RefineOfAnUnsuitableMesh",
     // Both lines end before the empty middle of the mesh.
     "[geometry]\ntype = 'tspline'\ndegrees = [1, 1]\nknots_u = [0, 0, 1, 2, 3, 3]\nknots_v = [0, 0, 1, 2, 3, 4, 4]\n"
     "lines_u = [{ at = 2, from = 3, to = 4 }]\nlines_v = [{ at = 2, from = 0, to = 1 }]\n"
     "points = [[0,0,0], [1,0,0], [3,0,0], [0,1,0], [1,1,0], [3,1,0], [0,2,0], [1,2,0], [0,3,0], [1,3,0], [2,3,0], "
     "[3,3,0], [0,4,0], [1,4,0], [2,4,0], [3,4,0]]\nrefine = { levels = 1 }\n",
     {"geometry.refine: T-mesh: it is not analysis-suitable", "the T-junctions at (u, v) = (1, 2) and (2, 3) meet"}},
};

const std::vector<BadCase> quantities{
    {"IntegrandThatDoesNotParse",
     circle + "[[integral]]\nname = 'a'\nintegrand = 'x + * y'\n",
     {"integral[1].integrand: at character 5"}},
    {"IntegrandThatEnds",
     circle + "[[integral]]\nname = 'a'\nintegrand = 'x +'\n",
     {"integral[1].integrand: at the end"}},
    {"IntegrandWithANul",
     circle + "[[integral]]\nname = 'a'\nintegrand = \"x\\u0000y\"\n",
     {"integral[1].integrand: at character 2: found the control character 0x00"}},
    {"UnknownVariable",
     circle + "[[integral]]\nname = 'a'\nintegrand = '2*radius'\n",
     {"at character 3: found the unknown name \"radius\"; expected x, y, pi, e or a function"}},
    {"SpaceVariableInThePlane",
     circle + "[[integral]]\nname = 'a'\nintegrand = 'x*z'\n",
     {"at character 3: found \"z\" in the plane"}},
    {"NormalInADomain",
     sphere + "[[integral]]\nname = 'a'\nintegrand = 'nx'\n",
     {"at character 1: found \"nx\", the normal, which only a boundary has"}},
    {"IntegralNameTwice",
     circle + "[[integral]]\nname = 'a'\nintegrand = 'x'\n[[integral]]\nname = 'a'\nintegrand = 'y'\n",
     {"integral[2]: the name \"a\" is taken by another integral"}},
    {"IntegralNamedLikeAProperty",
     circle + "[[integral]]\nname = 'area'\nintegrand = 'x'\n",
     {"integral[1]: the name \"area\" is taken by a property"}},
    {"IntegralNameWithASlash",
     circle + "[[integral]]\nname = 'a/b'\nintegrand = 'x'\n",
     {"integral[1].name: found \"a/b\"; expected letters, digits, _ and -"}},
    {"PoleOfABoundaryIntegral",
     circle + "[[integral]]\nname = 'a'\nover = 'boundary'\nintegrand = 'x'\npole = [0, 0]\n",
     {"integral[1].pole: an integral over a boundary has no pole"}},
    {"DomainIntegralOfAnOpenBoundary",
     "[geometry]\ntype = 'ellipse_arc'\nradii = [2, 1]\nangles = [0, 90]\n[[integral]]\nname = 'a'\nintegrand = 'x'\n",
     {"integral[1]: the integral \"a\" is over a domain, but the boundary is open", "2 free ends"}},
    {"VolumeInThePlane",
     circle + "[expect]\nvolume = { value = 1, rtol = 1 }\n",
     {"expect.volume: found the quantity \"volume\"; expected one of perimeter, area"}},
    {"UnknownQuantity", circle + "[expect]\nperimetre = { value = 1, rtol = 1 }\n", {"(did you mean \"perimeter\"?)"}},
    {"MassWithoutDensity", circle + "[expect]\nmass = { value = 1, rtol = 1 }\n", {"[properties] has no density"}},
    {"ExpectationWithoutTolerance",
     circle + "[expect]\narea = { value = 1 }\n",
     {"expect.area: found no tolerance; expected at least one of \"rtol\" and \"atol\""}},
    {"NegativeExpectationTolerance",
     circle + "[expect]\narea = { value = 1, rtol = -1 }\n",
     {"expect.area.rtol: found -1; expected a number >= 0"}},
    {"ExpectationOfTheWrongShape",
     circle + "[expect]\ncentroid = { value = 1, rtol = 1 }\n",
     {"expect.centroid.value: found a real; expected a list of 2 reals"}},
    {"ConvergenceToNothing",
     circle + "[convergence]\npoints = [1, 2]\n",
     {"convergence: found no expected values to compare with"}},
    {"ConvergenceOfWhatIsNotExpected",
     circle + "[expect]\narea = { value = 1, rtol = 1 }\n[convergence]\npoints = [1]\nquantities = ['perimeter']\n",
     {"the quantity \"perimeter\" has no expected value"}},
    {"ConvergenceByAnEndlessStride",
     circle + "[expect]\narea = { value = 1, rtol = 1 }\n[convergence]\npoints = { to = 3, step = 2147483647 }\n",
     {"convergence.points.step: found 2147483647; expected a number from 1 to 128"}},
    {"ConvergenceBackwards",
     circle + "[expect]\narea = { value = 1, rtol = 1 }\n[convergence]\npoints = { from = 3, to = 1 }\n",
     {"convergence.points: found from = 3 above to = 1"}},
};

std::string propeller(const std::string& more) {
  return "[geometry]\ntype = 'propeller'\nseries = 'kaplan'\ndiameter = 500\narea_ratio = 0.6\n" + more + "\n";
}

const std::vector<BadCase> propellers{
    {"UnknownSeries",
     "[geometry]\ntype = 'propeller'\nseries = 'kaplann'\n",
     {"geometry.series: found the text \"kaplann\"", "(did you mean \"kaplan\"?)"}},
    {"NoPitch", propeller("blades = 4"), {"the key \"pitch_ratio\"", "is missing"}},
    {"TooManyBlades", propeller("blades = 9\npitch_ratio = 1"), {"geometry.blades: found 9", "from 3 to 7"}},
    {"PitchAsAList",
     propeller("blades = 4\npitch_ratio = [0.8, 0.9]"),
     {"case.toml:7: geometry.pitch_ratio: found a list; expected one number, or a list of rows [r/R, value]"}},
    {"PitchAtFallingRadii",
     propeller("blades = 4\npitch_ratio = [[0.5, 0.8], [0.2, 0.9]]"),
     {"case.toml:7: geometry.pitch_ratio: pitch_ratio: r/R is 0.2 in row 2 after 0.5; the radii have to rise"}},
    {"HubTooShort",
     propeller("blades = 4\npitch_ratio = 0.9\nhub_ends = [-10, 70]"),
     {"case.toml:1: geometry: propeller hub: it runs from X = -10 to 70; the blades on it need -"}},
    {"HubTooSmall",
     propeller("blades = 4\npitch_ratio = 0.9\nhub_ratio = 0.05"),
     {"geometry: propeller: the blades start at a radius of", "too far outside the hub of radius 12.5"}},
    {"ReducedPitchOfAnotherSeries",
     propeller("blades = 4\npitch_ratio = 0.9\nreduced_root_pitch = true"),
     {"the reduced root pitch belongs to Wageningen B screws of four blades"}},
};

INSTANTIATE_TEST_SUITE_P(Propellers, BadInput, ::testing::ValuesIn(propellers), bad_case_name);
INSTANTIATE_TEST_SUITE_P(Syntax, BadInput, ::testing::ValuesIn(syntax), bad_case_name);
INSTANTIATE_TEST_SUITE_P(Hydrostatics, BadInput, ::testing::ValuesIn(hydrostatics), bad_case_name);
INSTANTIATE_TEST_SUITE_P(Keys, BadInput, ::testing::ValuesIn(keys), bad_case_name);
INSTANTIATE_TEST_SUITE_P(Types, BadInput, ::testing::ValuesIn(types), bad_case_name);
INSTANTIATE_TEST_SUITE_P(Ranges, BadInput, ::testing::ValuesIn(ranges), bad_case_name);
INSTANTIATE_TEST_SUITE_P(Shapes, BadInput, ::testing::ValuesIn(shapes), bad_case_name);
INSTANTIATE_TEST_SUITE_P(Cuts, BadInput, ::testing::ValuesIn(cuts), bad_case_name);
INSTANTIATE_TEST_SUITE_P(TSplines, BadInput, ::testing::ValuesIn(tsplines), bad_case_name);
INSTANTIATE_TEST_SUITE_P(Quantities, BadInput, ::testing::ValuesIn(quantities), bad_case_name);

class SeveralFaults : public ProgramTest {};

TEST_F(SeveralFaults, AreAllNamedInOneRunInTheOrderOfTheFile) {
  const ProgramResult result = run_case(
      "titel = 'a'\n[geometry]\ntype = 'circle'\nradius = -1\ncentre = [0]\n[properties]\ntolerance = 'x'\n"
      "[[integral]]\nname = 3\nintegrand = 'x'\n[expect]\narea = { value = 1 }\n");
  EXPECT_EQ(result.status, 2);
  std::size_t last = 0;
  for (const char* fragment :
       {"case.toml:1: titel: unknown key (did you mean \"title\"?)", "case.toml:4: geometry.radius: found -1",
        "case.toml:5: geometry.centre: found a list", "case.toml:7: properties.tolerance: found the text",
        "case.toml:9: integral[1].name: found", "case.toml:12: expect.area: found no tolerance"}) {
    const std::size_t found = result.err.find(fragment);
    ASSERT_NE(found, std::string::npos) << fragment << "\nin\n" << result.err;
    EXPECT_GE(found, last) << fragment << " out of order in\n" << result.err;
    last = found;
  }
}

TEST_F(SeveralFaults, OfGeometryAndSectionsComeTogether) {
  const ProgramResult result =
      run_case(region("{ type = 'polygon', points = [[0, 0], [1, 1], [1, 0], [0, 1]] }, { curves = [{ type = 'line', "
                      "from = [0, 0], to = [1, 0] }] }") +
               "[[integral]]\nname = 'a'\nintegrand = 'x+'\n");
  EXPECT_EQ(result.status, 2);
  for (const char* fragment : {"geometry.loops[1]", "geometry.loops[2]", "integral[1].integrand"}) {
    EXPECT_THAT(result.err, HasSubstr(fragment));
  }
}

/// The complaints of a case, one a line.
std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> result;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) result.push_back(line);
  return result;
}

TEST_F(SeveralFaults, WhatIsWrongIsSaidOnce) {
  for (const std::string& text :
       {"integral = [1]\n" + circle, circle + "[[integral]]\nname = 'a'\n",
        circle + "[[integral]]\nname = 'a'\nintegrand = ''\n",
        std::string("[geometry]\ntype = 'ruled'\ncurves = [{ type = 'circle', radius = 1 }]\n"),
        std::string("[geometry]\ntype = 'loft'\nsections = []\n"),
        std::string("[geometry]\ntype = 'extrude'\nvector = [0, 0, 0]\nregion = { type = 'circle', radius = 1 }\n"),
        region("{ curves = [] }")}) {
    const ProgramResult result = run_case(text);
    EXPECT_EQ(result.status, 2) << text;
    EXPECT_EQ(lines(result.err).size(), 1U) << text << result.err;
    EXPECT_THAT(result.err, HasSubstr("case.toml:")) << text;
  }
}

TEST_F(SeveralFaults, LongIntegrandsAreShortened) {
  std::string integrand = "x";
  for (int i = 0; i < 20000; ++i) integrand += "+x";
  const ProgramResult result = run_case(circle + "[[integral]]\nname = 'a'\nintegrand = '" + integrand + "'\n");
  EXPECT_EQ(result.status, 2);
  EXPECT_LT(result.err.size(), 300U);
  EXPECT_THAT(result.err, HasSubstr("x+...\""));
}

class BadFile : public ProgramTest {};

TEST_F(BadFile, MissingIsNamed) {
  const ProgramResult result = run({"run", path("nothing.toml"), "-o", path("out")});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("nothing.toml: no such file"));
  EXPECT_FALSE(std::filesystem::exists(folder() / "out"));
}

TEST_F(BadFile, FolderIsRefused) {
  const ProgramResult result = run({"run", folder().string()});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("is a folder"));
}

TEST_F(BadFile, BinaryContentOfTablesIsShownWithoutWhatTerminalsActOn) {
  write("points.csv", "\x1b[31mx\x01;" + std::string(1000, 'y') + "\n1;2\n");
  const ProgramResult result =
      run({"run", write("case.toml", "[geometry]\ntype = 'fit'\npoints = 'points.csv'\n"), "-o", path("out")});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("points.csv:1: found the columns \"\\x1b[31mx\\x01;yyy"));
  EXPECT_EQ(result.err.find('\x1b'), std::string::npos);
  EXPECT_LT(result.err.size(), 500U);
}

TEST_F(BadFile, OutputThatIsAFileIsRefused) {
  write("occupied", "");
  const ProgramResult result = run({"run", write("case.toml", circle), "-o", path("occupied")});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("occupied: cannot make the folder"));
}

}  // namespace
}  // namespace isorim::testing
