#include "io/sweep/plan.h"

#include <cmath>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "tests/io/cli/program_test.h"

namespace isorim::io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class SweepPlans : public testing::ProgramTest {
 protected:
  SweepPlan plan(const std::string& text) const {
    write("base.toml", base);
    return read_sweep(write("sweep.toml", "base = 'base.toml'\n" + text));
  }
  std::vector<std::vector<std::string>> values(const std::string& text) const {
    std::vector<std::vector<std::string>> rows;
    for (const SweepCase& one : plan(text).cases) {
      std::vector<std::string>& row = rows.emplace_back();
      for (const Value& value : one.values) row.push_back(plain_text(value));
    }
    return rows;
  }
  void expect_refused(const std::string& text, const std::string& fragment) const {
    EXPECT_THAT([&] { plan(text); }, ThrowsMessage<InputError>(HasSubstr(fragment))) << text;
  }

  std::string base = "[geometry]\ntype = 'torus'\nmajor_radius = 3\nminor_radius = 1\n";
};

const std::string major = "[[parameter]]\nkey = 'geometry.major_radius'\n";
const std::string minor = "[[parameter]]\nkey = 'geometry.minor_radius'\n";

TEST_F(SweepPlans, CombineAxesAsAGridWithTheLastFastest) {
  EXPECT_THAT(values(major + "values = [3, 4]\n" + minor + "values = [1, 1.5, 2]\n"),
              ElementsAre(ElementsAre("3", "1"), ElementsAre("3", "1.5"), ElementsAre("3", "2"), ElementsAre("4", "1"),
                          ElementsAre("4", "1.5"), ElementsAre("4", "2")));
}

TEST_F(SweepPlans, CombineAxesEntryByEntry) {
  EXPECT_THAT(values("combine = 'zip'\n" + major + "values = [3, 4]\n" + minor + "from = 1\nto = 2\ncount = 2\n"),
              ElementsAre(ElementsAre("3", "1"), ElementsAre("4", "2")));
}

TEST_F(SweepPlans, DivideRanges) {
  EXPECT_THAT(values(minor + "from = 0.1\nto = 0.7\ncount = 4\n"),
              ElementsAre(ElementsAre("0.1"), ElementsAre("0.3"), ElementsAre("0.5"), ElementsAre("0.7")));
  EXPECT_THAT(values(minor + "from = 0.1\nto = 0.75\nstep = 0.2\n"),
              ElementsAre(ElementsAre("0.1"), ElementsAre("0.3"), ElementsAre("0.5"), ElementsAre("0.7")));
  EXPECT_THAT(values(minor + "from = 2\nto = 0.5\nstep = -0.5\n"),
              ElementsAre(ElementsAre("2"), ElementsAre("1.5"), ElementsAre("1"), ElementsAre("0.5")));
  EXPECT_THAT(values(minor + "from = 0.01\nto = 1\ncount = 3\nspacing = 'logarithmic'\n"),
              ElementsAre(ElementsAre("0.01"), ElementsAre("0.1"), ElementsAre("1")));
}

TEST_F(SweepPlans, KeepIntegersIntegers) {
  const SweepPlan integers = plan("[[parameter]]\nkey = 'properties.gauss_points'\nfrom = 2\nto = 8\nstep = 3\n");
  for (const SweepCase& one : integers.cases) EXPECT_TRUE(one.values[0].as<std::int64_t>());
  const SweepPlan reals = plan(minor + "from = 1\nto = 2\ncount = 3\n");
  for (const SweepCase& one : reals.cases) EXPECT_TRUE(one.values[0].as<double>());
}

TEST_F(SweepPlans, TakeRowsOfFiles) {
  write("rows.csv", "name; major; minor\nthin; 3; 0.1\nthick; 2.5; 2\n");
  EXPECT_THAT(values("[[parameter]]\nkey = 'geometry.centre'\nvalues = [[0, 0, 0], [1, 2, 3]]\n[[rows]]\ncsv = "
                     "'rows.csv'\ncolumns = { major = 'geometry.major_radius', minor = 'geometry.minor_radius', name = "
                     "'title' }\n"),
              ElementsAre(ElementsAre("[0, 0, 0]", "3", "0.1", "thin"), ElementsAre("[0, 0, 0]", "2.5", "2", "thick"),
                          ElementsAre("[1, 2, 3]", "3", "0.1", "thin"), ElementsAre("[1, 2, 3]", "2.5", "2", "thick")));
}

TEST_F(SweepPlans, DeriveValues) {
  const SweepPlan derived =
      plan(major +
           "values = [3, 4]\nname = 'R'\n[[derived]]\nname = 'third'\nexpression = 'R/3'\n[[derived]]\nkey = "
           "'geometry.minor_radius'\nexpression = 'third + 0.5'\n");
  ASSERT_EQ(derived.columns.size(), 3);
  EXPECT_EQ(derived.columns[2].name, "minor_radius");
  const Value tree = case_tree(derived, 1);
  EXPECT_DOUBLE_EQ(*as_number(*tree.find("geometry")->find("minor_radius")), 4.0 / 3.0 + 0.5);
  EXPECT_EQ(*tree.find("geometry")->find("major_radius")->as<std::int64_t>(), 4);
}

TEST_F(SweepPlans, SampleEachRangeInEveryStratum) {
  const SweepPlan sampled = plan("combine = 'latin_hypercube'\nsamples = 40\nseed = 9\n" + major +
                                 "from = 3\nto = 5\n" + minor + "from = 0.01\nto = 1\nspacing = 'logarithmic'\n" +
                                 "[[parameter]]\nkey = 'properties.gauss_points'\nvalues = [3, 5, 8, 13]\n");
  ASSERT_EQ(sampled.cases.size(), 40);
  std::set<int> linear;
  std::set<int> logarithmic;
  std::multiset<std::int64_t> points;
  for (const SweepCase& one : sampled.cases) {
    linear.insert(static_cast<int>((*as_number(one.values[0]) - 3) * 20));
    logarithmic.insert(static_cast<int>((std::log10(*as_number(one.values[1])) + 2) * 20));
    points.insert(*one.values[2].as<std::int64_t>());
  }
  EXPECT_EQ(linear.size(), 40);
  EXPECT_EQ(logarithmic.size(), 40);
  for (const std::int64_t n : {3, 5, 8, 13}) EXPECT_EQ(points.count(n), 10);
}

TEST_F(SweepPlans, GiveEachCaseToOneShard) {
  for (int count = 1; count < 8; ++count) {
    for (std::size_t index = 0; index < 20; ++index) {
      int owners = 0;
      for (int part = 1; part <= count; ++part) owners += Shard{part, count}.owns(index) ? 1 : 0;
      EXPECT_EQ(owners, 1);
    }
  }
  for (const std::string text : {"0/2", "3/2", "1", "1/", "/2", "1/2x", "-1/2", "a/b", ""}) {
    EXPECT_THAT([&] { parse_shard(text); }, ThrowsMessage<InputError>(HasSubstr("expected K/N"))) << text;
  }
}

TEST_F(SweepPlans, RefuseKeysThatCasesDoNotHave) {
  expect_refused("[[parameter]]\nkey = 'geometry.major_radios'\nvalues = [1]\n",
                 "sweep.toml:4: geometry.major_radios: unknown key (did you mean \"major_radius\"?)");
  expect_refused("[[parameter]]\nkey = 'geometri.major_radius'\nvalues = [1]\n",
                 "geometri: unknown key (did you mean \"geometry\"?)");
  expect_refused("[[parameter]]\nkey = 'geometry.major_radius.x'\nvalues = [1]\n", "so \"x\" has no place in it");
  expect_refused("[[parameter]]\nkey = 'integral.0.name'\nvalues = ['a']\n",
                 "integral: found a table; expected a list");
}

TEST_F(SweepPlans, RefuseValuesThatKeysDoNotTake) {
  expect_refused(minor + "values = [1, 'wide']\n",
                 "sweep.toml:4: geometry.minor_radius: found the text \"wide\"; expected a real");
  expect_refused(major + "values = [3, 4]\n" + minor + "values = [1, 0.5, -1]\n", "found -1; expected a number > 0");
  expect_refused("[[parameter]]\nkey = 'properties.gauss_points'\nfrom = 1.5\nto = 3\ncount = 4\n",
                 "properties.gauss_points: found the real 1.5; expected an integer");
}

TEST_F(SweepPlans, LeaveToACaseWhatIsItsOwn) {
  // Only two of the combinations are rings.
  EXPECT_EQ(plan(major + "values = [1, 3]\n" + minor + "values = [2, 0.5]\n").cases.size(), 4);
}

TEST_F(SweepPlans, RefuseABaseThatIsNoCase) {
  base = "[geometry]\ntype = 'torus'\nmajor_radius = 3\nminor_radius = 1\n[outptu]\nvtk = true\n";
  expect_refused(minor + "values = [1, 2]\n", "base.toml:5: outptu: unknown key (did you mean \"output\"?)");
  EXPECT_THAT([&] { read_sweep(write("s.toml", "base = 'none.toml'\n" + minor + "values = [1]\n")); },
              ThrowsMessage<InputError>(HasSubstr("none.toml: no such file")));
}

TEST_F(SweepPlans, RefuseContradictions) {
  expect_refused("", "found nothing that varies");
  expect_refused(minor, "found no values; expected \"values\" or a range");
  expect_refused(minor + "values = []\n", "expected a list of at least one value");
  expect_refused(minor + "values = [1]\nfrom = 2\n", "found both \"values\" and a range");
  expect_refused(minor + "from = 1\nto = 2\n", "\"count\" or \"step\" is missing");
  expect_refused(minor + "from = 1\nto = 2\ncount = 2\nstep = 1\n", "found both \"step\" and \"count\"");
  expect_refused(minor + "from = 1\nto = 2\nstep = -1\n", "does not lead from 1 to 2");
  expect_refused(minor + "from = 1\nto = 2\nstep = 1e-9\n", "expected at most 1000000");
  expect_refused(minor + "from = 0\nto = 2\ncount = 3\nspacing = 'logarithmic'\n", "expected both above 0");
  expect_refused(minor + "from = 1\nto = 1\ncount = 3\n", "found from = to = 1");
  expect_refused("combine = 'zip'\n" + major + "values = [3, 4]\n" + minor + "values = [1]\n",
                 "found 1 values of \"minor_radius\" and 2 of \"major_radius\"");
  expect_refused("combine = 'latin_hypercube'\n" + minor + "from = 1\nto = 2\n", "\"samples\" is missing");
  expect_refused("samples = 3\n" + minor + "values = [1]\n", "found \"samples\"");
  expect_refused("combine = 'latin_hypercube'\nsamples = 3\n" + minor + "from = 1\nto = 2\ncount = 3\n",
                 "in a range that is sampled");
  expect_refused(minor + "values = [1, 2, 1.0]\n", "the cases 1 and 3 are the same: minor_radius = 1");
  expect_refused(minor + "values = [1, 2]\nvalus = 3\n", "unknown key (did you mean \"values\"?)");
  expect_refused(minor + "values = [1]\n[runs]\n", "runs: unknown key");
}

TEST_F(SweepPlans, RefuseMoreCasesThanAnyoneWants) {
  std::string text;
  for (const char* key : {"major_radius", "minor_radius", "centre.0", "centre.1"}) {
    text += std::string("[[parameter]]\nkey = 'geometry.") + key + "'\nfrom = 1\nto = 2\ncount = 1000\n";
  }
  expect_refused(text, "found more than 1000000 combinations");
}

TEST_F(SweepPlans, RefuseNames) {
  expect_refused(minor + "values = [1]\n" + minor + "values = [1]\n", "the name \"minor_radius\" is taken");
  expect_refused(minor + "values = [1]\n" + minor + "values = [1]\nname = 'other'\n",
                 "the key \"geometry.minor_radius\" is set by \"minor_radius\" already");
  expect_refused(minor + "values = [1]\nname = 'a-b'\n", "expected letters, digits and _");
  expect_refused(minor + "values = [1]\nname = 'sin'\n", "\"sin\" is a function of expressions");
  expect_refused(minor + "values = [1]\nname = 'pi'\n", "\"pi\" is a constant of expressions");
  expect_refused(minor + "values = [1]\nname = 'status'\n", "is a column of every table");
}

TEST_F(SweepPlans, RefuseExpressions) {
  expect_refused(minor + "values = [0.5, 1]\nname = 'r'\n[[derived]]\nname = 'd'\nexpression = 's'\n",
                 "found the unknown name \"s\"");
  expect_refused(minor + "values = [0.5, 1]\nname = 'r'\n[[derived]]\nname = 'd'\nexpression = '1/(r-1)'\n",
                 "found inf for r = 1");
  expect_refused("[[parameter]]\nkey = 'title'\nvalues = ['a']\n[[derived]]\nname = 'd'\nexpression = 'title'\n",
                 "found the unknown name \"title\"");
  expect_refused(minor + "values = [1]\n[[derived]]\nexpression = '1'\n", "found neither \"name\" nor \"key\"");
}

TEST_F(SweepPlans, RefuseRows) {
  write("rows.csv", "major,minor\n3,1\n4,\n");
  const std::string rows = "[[rows]]\ncsv = 'rows.csv'\ncolumns = ";
  expect_refused(rows + "{ mayor = 'geometry.major_radius' }\n",
                 "found no column \"mayor\" in " + path("rows.csv") + " (did you mean \"major\"?)");
  expect_refused(rows + "{ minor = 'geometry.minor_radius' }\n", "rows.csv:3: minor: found an empty field");
  expect_refused(rows + "{ major = 3 }\n", "rows[1].columns.major: found the integer 3; expected a text");
  expect_refused(rows + "{}\n", "expected a table");
  expect_refused("[[rows]]\ncsv = 'none.csv'\ncolumns = { a = 'title' }\n", "none.csv");
}

TEST_F(SweepPlans, RefusePlotsOfNothing) {
  expect_refused(minor + "values = [1]\n[[plot]]\nx = 'minor_radius'\ny = 'volume'\nseries = 'minor'\n",
                 "found the series \"minor\"");
  expect_refused(minor + "values = [1]\n[[plot]]\nx = 'minor_radius'\ny = []\n", "found an empty list");
  expect_refused(minor + "values = [1]\n[[plot]]\nx = 'minor_radius'\ny = 'volume'\nfile = '../a'\n",
                 "expected a name without folders");
}

}  // namespace
}  // namespace isorim::io
