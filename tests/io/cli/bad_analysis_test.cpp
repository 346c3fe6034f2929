#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/io/cli/bad_case.h"

namespace isorim::testing {
namespace {

class BadAnalysis : public BadCaseTest {};
class SingleMistake : public ProgramTest {};

TEST_P(BadAnalysis, IsRefusedWithStatus2AndNothingWritten) {
  expect_refusal();
}

const std::string circle = "[geometry]\ntype = 'circle'\nradius = 1\n";
const std::string square = "[geometry]\ntype = 'rectangle'\nsize = [1, 1]\n";
const std::string box = "[geometry]\ntype = 'box'\nsize = [1, 1, 1]\n";
const std::string laplace = "[analysis]\nequation = 'laplace'\n";
const std::string elastic = "[analysis]\nequation = 'elasticity'\n[material]\nyoung = 1\npoisson = 0.3\n";
const std::string everywhere = "[[boundary_condition]]\nkind = 'value'\nvalue = 'x'\n";

std::string condition(const std::string& keys) {
  return "[[boundary_condition]]\n" + keys + "\n";
}

const std::vector<BadCase> sections{
    {"ConditionWithoutAnalysis", circle + everywhere, {"boundary_condition[1]: found no section [analysis]"}},
    {"ProbeWithoutAnalysis", circle + "[[probe]]\nname = 'a'\npoints = [[0, 0]]\n", {"found no section [analysis]"}},
    {"NoEquation", circle + "[analysis]\nexterior = true\n" + everywhere, {"the key \"equation\" (text) is missing"}},
    {"UnknownEquation",
     circle + "[analysis]\nequation = 'poison'\n" + everywhere,
     {"analysis.equation: found the text \"poison\"", "(did you mean \"poisson\"?)"}},
    {"NoCondition", circle + laplace, {"found no boundary condition; expected [[boundary_condition]]"}},
    {"StateOfAPotential",
     circle + laplace + "state = 'plane_stress'\n" + everywhere,
     {"found a \"state\", which only elasticity in the plane has"}},
    {"PoissonWithoutSource",
     circle + "[analysis]\nequation = 'poisson'\n" + everywhere,
     {"expected a section [source] with a \"value\""}},
    {"SourceOfLaplace",
     circle + laplace + everywhere + "[source]\nvalue = 1\n",
     {"source: found a source; expected equation = \"poisson\""}},
    {"SourceOutside",
     circle + "[analysis]\nequation = 'poisson'\nexterior = true\n" + everywhere + "[source]\nvalue = 1\n",
     {"loads are not available in a domain that reaches to infinity"}},
    {"ElasticityWithoutMaterial",
     circle + "[analysis]\nequation = 'elasticity'\n" + condition("kind = 'displacement'"),
     {"elasticity needs \"young\" and \"poisson\" in [material]"}},
    {"Incompressible",
     circle + "[analysis]\nequation = 'elasticity'\n[material]\nyoung = 1\npoisson = 0.5\n" +
         condition("kind = 'displacement'"),
     {"material.poisson: found 0.5; expected a number > -1 and < 0.5"}},
    {"GravityWithoutDensity",
     square + elastic + condition("kind = 'displacement'") + "[body_force]\ngravity = [0, -10]\n",
     {"gravity and centrifugal loads need a \"density\""}},
    {"TemperatureWithoutExpansion",
     square + elastic + condition("kind = 'displacement'") + "[body_force]\ntemperature = 'x'\n",
     {"a temperature needs \"expansion\""}},
    {"EmptyBodyForce",
     square + elastic + condition("kind = 'displacement'") + "[body_force]\n",
     {"expected at least one of gravity, centrifugal, force and temperature"}},
    {"GravityInTheWrongSpace",
     square + elastic + "density = 1\n" + condition("kind = 'displacement'") + "[body_force]\ngravity = [0, 0, 1]\n",
     {"body_force.gravity: found 3 coordinates; expected 2"}},
    {"TwoDensities",
     square + "[properties]\ndensity = 3\n" + elastic + "density = 2\n" + condition("kind = 'displacement'") +
         "[body_force]\ngravity = [0, -1]\n",
     {"body_force: found two densities, 2 in [material] and 3 in [properties]"}},
    {"RotationOffThePlane",
     square + elastic + "density = 1\n" + condition("kind = 'displacement'") +
         "[body_force]\ncentrifugal = { speed = 1, direction = [1, 0, 0] }\n",
     {"body_force.centrifugal: found a \"direction\" off z"}},
};

const std::vector<BadCase> conditions{
    {"EmptyListOfPatches",
     square + laplace + condition("on = []\nkind = 'value'"),
     {"boundary_condition[1]: \"on\" is an empty list; expected names of patches"}},
    {"SelectionThatIsNoNumber",
     square + laplace + condition("kind = 'value'\nwhere = 'log(-1 - x^2)'") + condition("kind = 'flux'"),
     {"case.toml:8: boundary_condition[1].where: log(-1 - x^2) is no number at (0.5, 0)"}},
    {"DisplacementOfNothing",
     square + elastic + condition("kind = 'displacement'\nvalue = ['', '']"),
     {"boundary_condition[1].value: found no component; expected at least one"}},
    {"TractionWhereTheDisplacementIsGiven",
     square + elastic + condition("kind = 'displacement'\nvalue = ['0', '']\ntraction = ['1', '2']"),
     {"boundary_condition[1].traction: found a traction along x, where the displacement is given"}},
    {"ReferenceWithoutCoefficient",
     square + elastic + condition("kind = 'foundation'\ncoefficient = [1, '']\nreference = ['', 'y']"),
     {"boundary_condition[1].reference: found a reference along y, which has no coefficient"}},
    {"NegativeCoefficient",
     square + laplace + condition("kind = 'robin'\ncoefficient = 'x - 2'"),
     {"boundary condition 'all': the coefficient is", "expected a positive number"}},
    {"ValueThatIsInfinite",
     square + laplace + condition("kind = 'value'\nvalue = '1/0'"),
     {"boundary condition 'all': the value is inf at"}},
    {"UnknownPatch",
     square + laplace + condition("on = 'bottm'\nkind = 'value'"),
     {"boundary_condition[1]: found the patch \"bottm\" (did you mean \"bottom\"?)"}},
    {"UnknownPatchInAList",
     square + laplace + condition("on = ['bottom', 'roof']\nkind = 'value'"),
     {"found the patch \"roof\""}},
    {"KindOfElasticity",
     circle + laplace + condition("kind = 'displacement'"),
     {"boundary_condition[1].kind: found \"displacement\"; a potential has value, flux, robin and symmetry"}},
    {"KindOfAPotential",
     circle + elastic + condition("kind = 'flux'"),
     {"elasticity has displacement, traction, foundation and symmetry"}},
    {"BadExpression",
     circle + laplace + condition("kind = 'value'\nvalue = 'x + zeta'"),
     {"case.toml:8: boundary_condition[1].value: at character 5: found the unknown name \"zeta\""}},
    {"BadSelection",
     circle + laplace + condition("kind = 'value'\nwhere = 'x > '"),
     {"boundary_condition[1].where: at the end of"}},
    {"ListForAPotential",
     circle + laplace + condition("kind = 'value'\nvalue = [1, 2]"),
     {"a potential is one number; expected a single expression as \"value\""}},
    {"SingleForAVector",
     circle + elastic + condition("kind = 'traction'\nvalue = 'x'"),
     {"found a single expression; expected a list of 2 or a table"}},
    {"TooManyComponents",
     circle + elastic + condition("kind = 'traction'\nvalue = [1, 2, 3]"),
     {"found a list of 3; expected 2 components"}},
    {"NormalBesideAxes",
     circle + elastic + condition("kind = 'traction'\nvalue = { x = 1, normal = 2 }"),
     {"found \"normal\" beside x, y or z"}},
    {"RobinWithoutCoefficient",
     circle + laplace + condition("kind = 'robin'\nreference = 1"),
     {"the key \"coefficient\" is missing"}},
    {"PressureOfADisplacement",
     circle + elastic + condition("kind = 'displacement'\npressure = 1"),
     {"found \"pressure\", which goes with traction"}},
    {"ValueOfSymmetry",
     circle + elastic + condition("kind = 'symmetry'\nvalue = [0, 0]"),
     {"found \"value\", which goes with"}},
};

const std::vector<BadCase> discretisations{
    {"MoreElementsThanMemory",
     box + laplace + everywhere + "[discretisation]\nrefine = 12\n",
     {"discretisation: the bisections make 100663296 elements; expected no more than 1000000"}},
    {"ADenseMatrixLargerThanTheMachine",
     box + laplace + everywhere + "[discretisation]\nrefine = 8\n[solve]\nmethod = 'dense'\n",
     {"case.toml:11: solve: a dense matrix of", "expected method = \"compressed\" or fewer unknowns"}},
    {"PatchWithoutChoice",
     square + laplace + everywhere + "[[discretisation.patch]]\non = 'top'\n",
     {"discretisation.patch[1]: expected \"degree\", \"refine\" or both"}},
    {"PatchWithTwoChoices",
     square + laplace + everywhere +
         "[[discretisation.patch]]\non = 'top'\ndegree = 2\n[[discretisation.patch]]\non = 'top'\ndegree = 3\n",
     {"discretisation.patch[2]: the patch \"top\" has choices above"}},
    {"AdaptOfANumber",
     circle + laplace + everywhere + "[discretisation]\nadapt = 1e-6\n",
     {"discretisation.adapt: found the real 1e-06; expected true, false or a table"}},
    {"UnknownKeyOfAdapt",
     circle + laplace + everywhere + "[discretisation]\nadapt = { tol = 1e-6 }\n",
     {"discretisation.adapt.tol: unknown key", "tolerance"}},
    {"AdaptBelowTheSolver",
     circle + laplace + everywhere + "[discretisation]\nadapt = { tolerance = 1e-12 }\n",
     {"discretisation.adapt: found the tolerance 1e-12, which is below that of [solve], 1e-10"}},
    {"FractionAboveOne",
     circle + laplace + everywhere + "[discretisation]\nadapt = { fraction = 1.5 }\n",
     {"discretisation.adapt.fraction: found 1.5; expected a number > 0 and <= 1"}},
};

const std::vector<BadCase> points{
    {"LineOfOnePoint",
     circle + laplace + everywhere + "[[probe]]\nname = 'a'\nfrom = [0, 0]\nto = [0, 0]\n",
     {"probe[1]: \"from\" and \"to\" are the same point"}},
    {"CountWithoutALine",
     circle + laplace + everywhere + "[[probe]]\nname = 'a'\npoints = [[0, 0]]\ncount = 5\n",
     {"probe[1]: found \"count\", which goes with \"from\" and \"to\""}},
    {"GridLargerThanMemory",
     circle + laplace + everywhere + "[[grid]]\nname = 'a'\nfrom = [0, 0]\nto = [1, 1]\ncounts = [100000, 1000]\n",
     {"grid[1]: found 1e+08 points; expected no more than 1e+07"}},
    {"GridInThePlaneWithACorner",
     circle + laplace + everywhere +
         "[[grid]]\nname = 'a'\ncorner = [0, 0]\nsides = [[1, 0], [0, 1]]\ncounts = [2, 2]\n",
     {"grid[1]: expected a corner and two sides, in space"}},
    {"MissingFileOfPoints",
     circle + laplace + everywhere + "[[probe]]\nname = 'a'\nfile = 'nowhere.csv'\n",
     {"nowhere.csv: cannot read the file of points"}},
    {"ProbeWithoutPoints",
     circle + laplace + everywhere + "[[probe]]\nname = 'a'\n",
     {"probe[1]: expected exactly one of \"points\", \"from\" with \"to\", and \"file\""}},
    {"HalfALine",
     circle + laplace + everywhere + "[[probe]]\nname = 'a'\nfrom = [0, 0]\n",
     {"a line needs both \"from\" and \"to\""}},
    {"ProbeInTheWrongSpace",
     circle + laplace + everywhere + "[[probe]]\nname = 'a'\npoints = [[0, 0, 0]]\n",
     {"probe[1].points[1]: found 3 coordinates; expected 2"}},
    {"NameTwice",
     circle + laplace + everywhere +
         "[[probe]]\nname = 'a'\npoints = [[0, 0]]\n[[grid]]\nname = 'a'\nfrom = [0, 0]\nto = [1, 1]\ncounts = [2, "
         "2]\n",
     {"grid[1]: the name \"a\" is taken"}},
    {"NameWithASlash",
     circle + laplace + everywhere + "[[probe]]\nname = 'a/b'\npoints = [[0, 0]]\n",
     {"found the name \"a/b\"; expected letters, digits, _ and -"}},
    {"GridWithThreeCounts",
     circle + laplace + everywhere + "[[grid]]\nname = 'a'\nfrom = [0, 0]\nto = [1, 1]\ncounts = [2, 2, 2]\n",
     {"found 3 counts; expected 2"}},
    {"GridInsideOut",
     circle + laplace + everywhere + "[[grid]]\nname = 'a'\nfrom = [0, 1]\nto = [1, 0]\ncounts = [2, 2]\n",
     {"\"from\" is not below \"to\" in y"}},
    {"SkewSides",
     box + laplace + everywhere +
         "[[grid]]\nname = 'a'\ncorner = [0, 0, 0]\nsides = [[1, 0, 0], [1, 1, 0]]\ncounts = [2, 2]\n",
     {"the sides are not at right angles"}},
};

const std::vector<BadCase> expected{
    {"EmptyExact", circle + laplace + everywhere + "[exact]\n", {"exact: the section is empty"}},
    {"ExactThatIsNoNumber",
     circle + laplace + everywhere + "[exact]\nvalue = 'log(x - 5)'\n",
     {"case.toml:10: exact.value: log(x - 5) is", "expected a finite number"}},
    {"IntegralNamedLikeAResult",
     circle + laplace + everywhere + "[[integral]]\nname = 'balance'\nover = 'boundary'\nintegrand = 'u'\n",
     {"integral[1]: the name \"balance\" is that of a result of the analysis"}},
    {"ErrorWithoutExact",
     circle + laplace + everywhere + "[expect]\nboundary_l2 = { value = 0, atol = 1 }\n",
     {"found the quantity \"boundary_l2\""}},
    {"ProbeThatIsNotThere",
     circle + laplace + everywhere + "[expect]\n'line.value' = { value = 0, atol = 1 }\n",
     {"found the quantity \"line.value\""}},
    {"WrongNumberOfProbeValues",
     circle + laplace + everywhere +
         "[[probe]]\nname = 'line'\npoints = [[0, 0], [0.1, 0]]\n[expect]\n'line.value' = { "
         "value = 0, atol = 1 }\n",
     {"found a real; expected a list of 2 reals"}},
    {"ExactStressOfAPotential",
     circle + laplace + everywhere + "[exact]\nstress = { xx = 1 }\n",
     {"a potential has an exact value, gradient and flux"}},
    {"ExactValueOfElasticity",
     circle + elastic + condition("kind = 'displacement'") + "[exact]\nvalue = 'x'\n",
     {"elasticity has an exact displacement, stress and traction"}},
    {"SolutionInADomain",
     circle + laplace + everywhere + "[[integral]]\nname = 'a'\nintegrand = 'u'\n",
     {"found the unknown name \"u\""}},
};

const std::vector<BadCase> definitions{
    {"UndefinedName",
     "[definitions]\na = 'b + 1'\n" + circle,
     {"case.toml:2: definitions.a: at character 1: found the unknown name \"b\""}},
    {"DefinedLater", "[definitions]\na = 'b'\nb = 1\n" + circle, {"definitions.a:", "found the unknown name \"b\""}},
    {"CoordinateDefined", "[definitions]\nx = 1\n" + circle, {"the name \"x\" is a coordinate"}},
    {"FunctionDefined", "[definitions]\nsin = 1\n" + circle, {"the name \"sin\" is a function"}},
    {"ResultDefined", "[definitions]\nu = 1\n" + circle, {"the name \"u\" is a result of analyses"}},
    {"NormalInADefinition",
     "[definitions]\na = 'nx'\n" + circle,
     {"found \"nx\", the normal, which only a boundary has"}},
};

/// What follows from another complaint is not said.
TEST_F(SingleMistake, OneMistakeIsOneLine) {
  for (const std::string& text :
       {square + "[analysis]\nequation = 'elasticity'\n[material]\nyoung = -1\npoisson = 0.3\n" +
            condition("kind = 'displacement'"),
        "analysis = 'laplace'\n" + square + everywhere, square + laplace + "[boundary_condition]\nkind = 'value'\n",
        square + laplace + "[[boundary_conditions]]\nkind = 'value'\n",
        square + laplace + everywhere + "[[probe]]\npoints = [[0.5, 0.5]]\n",
        square + laplace + condition("on = 3\nkind = 'value'"),
        "[definitions]\na = [1]\n" + square + laplace + everywhere}) {
    const ProgramResult result = run_case(text);
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  }
}

INSTANTIATE_TEST_SUITE_P(Sections, BadAnalysis, ::testing::ValuesIn(sections), bad_case_name);
INSTANTIATE_TEST_SUITE_P(Conditions, BadAnalysis, ::testing::ValuesIn(conditions), bad_case_name);
INSTANTIATE_TEST_SUITE_P(Discretisations, BadAnalysis, ::testing::ValuesIn(discretisations), bad_case_name);
INSTANTIATE_TEST_SUITE_P(Points, BadAnalysis, ::testing::ValuesIn(points), bad_case_name);
INSTANTIATE_TEST_SUITE_P(Expected, BadAnalysis, ::testing::ValuesIn(expected), bad_case_name);
INSTANTIATE_TEST_SUITE_P(Definitions, BadAnalysis, ::testing::ValuesIn(definitions), bad_case_name);

}  // namespace
}  // namespace isorim::testing
