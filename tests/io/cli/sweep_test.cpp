#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <map>
#include <random>
#include <sstream>
#include <thread>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLDataParser.h>
#include <vtkXMLUnstructuredGridReader.h>

#include "io/sweep/csv_rows.h"
#include "io/sweep/journal.h"
#include "tests/io/cli/program_test.h"

namespace isorim::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// The program itself: cases run in copies of it, and tests end it by signals.
class SweepTest : public ProgramTest {
 protected:
  struct Started {
    pid_t process = -1;
    std::string log;
  };

  /// Starts the program with its output in files.
  Started start(std::vector<std::string> args) const {
    static int counter = 0;
    Started started;
    started.log = path("log" + std::to_string(counter++));
    args.insert(args.begin(), ISORIM_PROGRAM);
    std::vector<char*> pointers;
    for (std::string& arg : args) pointers.push_back(arg.data());
    pointers.push_back(nullptr);
    started.process = fork();
    if (started.process == 0) {
      dup2(open((started.log + ".out").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666), STDOUT_FILENO);
      dup2(open((started.log + ".err").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666), STDERR_FILENO);
      execv(ISORIM_PROGRAM, pointers.data());
      _exit(126);
    }
    return started;
  }
  /// The exit status, or minus the signal that ended it.
  static int wait(const Started& started) {
    int status = 0;
    waitpid(started.process, &status, 0);
    return WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
  }
  static bool is_running(const Started& started) {
    siginfo_t info{};
    waitid(P_PID, static_cast<id_t>(started.process), &info, WEXITED | WNOHANG | WNOWAIT);
    return info.si_pid == 0;
  }
  ProgramResult program(const std::vector<std::string>& args) const {
    const Started started = start(args);
    const int status = wait(started);
    return {status, read_file(started.log + ".out"), read_file(started.log + ".err")};
  }
  ProgramResult sweep(const std::string& text, std::vector<std::string> more = {}) const {
    write("base.toml", base);
    std::vector<std::string> args{"sweep", write("sweep.toml", "base = 'base.toml'\n" + text), "-o", path("out")};
    if (std::find(more.begin(), more.end(), "-j") == more.end()) args.insert(args.end(), {"-j", "2"});
    args.insert(args.end(), more.begin(), more.end());
    return program(args);
  }
  io::CsvRows table(const std::string& name = "out/sweep.csv") const {
    return io::parse_csv(read_file(path(name)), name);
  }
  std::vector<std::string> column(const std::string& heading, const std::string& name = "out/sweep.csv") const {
    const io::CsvRows rows = table(name);
    const auto at = std::find(rows.headings.begin(), rows.headings.end(), heading);
    std::vector<std::string> fields;
    if (at == rows.headings.end()) return fields;
    for (const auto& row : rows.rows) fields.push_back(row[static_cast<std::size_t>(at - rows.headings.begin())]);
    return fields;
  }

  std::string base = "[geometry]\ntype = 'sphere'\nradius = 1\n";
};

const std::string radii = "[[parameter]]\nkey = 'geometry.radius'\nvalues = [0.5, 1, 2, 4]\n";
void nap(unsigned milliseconds) {
  std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
}

/// A case of it takes some tenths of a second.
const std::string slow_base =
    "[geometry]\ntype = 'sphere'\nradius = 1\n[[integral]]\nname = 'i'\nover = 'domain'\n"
    "integrand = 'sqrt((x-0.1)^2 + y^2 + z^2)'\ntolerance = 1e-6\n";
const std::string slow_radii = "[[parameter]]\nkey = 'geometry.radius'\nfrom = 1\nto = 2\ncount = 24\n";

TEST_F(SweepTest, ComputesEveryCaseAsRunDoes) {
  const ProgramResult result = sweep(radii);
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("4 cases: 4 finished, 0 of them failed"));
  EXPECT_THAT(column("case"), ElementsAre("1", "2", "3", "4"));
  EXPECT_THAT(column("radius"), ElementsAre("0.5", "1", "2", "4"));
  EXPECT_THAT(column("status"), ElementsAre("ok", "ok", "ok", "ok"));
  for (int i = 0; i < 4; ++i) {
    const std::string radius = column("radius")[std::size_t(i)];
    ASSERT_EQ(run({"run", path("base.toml"), "--set", "geometry.radius=" + radius, "-o", path("one")}).status, 0);
    const auto one = nlohmann::json::parse(read_file(path("one/results.json")));
    EXPECT_EQ(std::stod(column("volume")[std::size_t(i)]), one["properties"]["volume"]["value"].get<double>());
    EXPECT_EQ(std::stod(column("centroid.1")[std::size_t(i)]), one["properties"]["centroid"]["value"][1].get<double>());
    const auto in_sweep =
        nlohmann::json::parse(read_file(path("out/cases/" + std::to_string(i + 1) + "/results.json")));
    EXPECT_EQ(in_sweep["properties"], one["properties"]);
  }
}

TEST_F(SweepTest, IsTheSameForAnyNumberOfProcesses) {
  ASSERT_EQ(sweep(radii).status, 0);
  const std::string two = read_file(path("out/sweep.csv"));
  ASSERT_EQ(sweep(radii, {"--restart", "-j", "1"}).status, 0);
  EXPECT_EQ(read_file(path("out/sweep.csv")), two);
  ASSERT_EQ(sweep(radii, {"--restart", "-j", "8"}).status, 0);
  EXPECT_EQ(read_file(path("out/sweep.csv")), two);
}

TEST_F(SweepTest, CountsExpectationsAndExitsAsTheWorstCase) {
  base += "[expect]\nvolume = { value = 4.18879020478639, rtol = 1e-12 }\n";
  const ProgramResult missed = sweep(radii);
  EXPECT_EQ(missed.status, 1);
  EXPECT_THAT(missed.out, HasSubstr("1 expectations of 4 met"));
  EXPECT_THAT(missed.err, HasSubstr("case 1 (radius = 0.5): expectation_missed: the expectation of volume is missed"));
  const ProgramResult met = sweep(
      radii + "[[derived]]\nname = 'v'\nkey = 'expect.volume.value'\nexpression = '4/3*pi*radius^3'\n", {"--restart"});
  EXPECT_EQ(met.status, 0) << met.err;
  EXPECT_THAT(column("expectations_met"), ElementsAre("1", "1", "1", "1"));
}

TEST_F(SweepTest, RecordsFailuresAndGoesOn) {
  base = "[geometry]\ntype = 'torus'\nmajor_radius = 3\nminor_radius = 1\n";
  const std::string rings = "[[parameter]]\nkey = 'geometry.major_radius'\nvalues = [3, 1, 4]\n";
  const ProgramResult result = sweep(rings + "[[parameter]]\nkey = 'geometry.minor_radius'\nvalues = [2]\n");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(column("status"), ElementsAre("ok", "failed", "ok"));
  EXPECT_THAT(column("exit_status"), ElementsAre("0", "2", "0"));
  EXPECT_THAT(column("volume")[1], "");
  EXPECT_THAT(column("message")[1], HasSubstr("geometry"));
  const auto json = nlohmann::json::parse(read_file(path("out/sweep.json")));
  EXPECT_EQ(json["failed"], 1);
  EXPECT_EQ(json["not_ok"][0]["case"], 2);
  EXPECT_EQ(json["not_ok"][0]["parameters"], "major_radius = 1, minor_radius = 2");
}

TEST_F(SweepTest, StopsOnAFailureIfAsked) {
  base = "[geometry]\ntype = 'torus'\nmajor_radius = 3\nminor_radius = 2\n";
  const std::string rings =
      "[[parameter]]\nkey = 'geometry.major_radius'\nvalues = [3, 1, 4, 5]\n[run]\nstop_on_failure = true\n";
  const ProgramResult result = sweep(rings, {"-j", "1"});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(column("status"), ElementsAre("ok", "failed", "missing", "missing"));
  EXPECT_THAT(result.err, HasSubstr("2 cases of 4 are missing: 3-4; --resume runs them"));
  EXPECT_EQ(sweep(rings, {"-j", "1", "--resume"}).status, 2);
  EXPECT_THAT(column("status"), ElementsAre("ok", "failed", "ok", "ok"));
}

TEST_F(SweepTest, EndsCasesThatTakeTooLong) {
  base +=
      "[analysis]\nequation = 'laplace'\n[[boundary_condition]]\nkind = 'value'\nvalue = 'x'\n"
      "[discretisation]\nrefine = 0\n";
  const ProgramResult late = sweep(
      "[[parameter]]\nkey = 'discretisation.refine'\nvalues = [0, 6]\n[run]\ntimeout = 5\n[output]\n"
      "case_files = false\n");
  EXPECT_EQ(late.status, 3) << late.err;
  EXPECT_EQ(column("status")[1], "timed_out");
  EXPECT_EQ(column("message")[1], "not finished after 5 s");
}

/// Killed at random moments, from the start of the program to the writing of the tables.
TEST_F(SweepTest, LosesNothingWhenKilledAtAnyMoment) {
  base = slow_base;
  ASSERT_EQ(sweep(slow_radii).status, 0);
  const std::string undisturbed = read_file(path("out/sweep.csv"));
  std::filesystem::remove_all(path("out"));
  std::mt19937 random(20);
  std::string journal;
  int kills = 0;
  while (true) {
    const Started started = start({"sweep", path("sweep.toml"), "-o", path("out"), "-j", "2", "--resume"});
    // Every other time, at the earliest when something new is recorded: so that there is an end to it.
    const auto is_new = [&] { return read_file(path("out/journal")).size() > journal.size() + 200; };
    while (kills % 2 == 1 && !is_new() && is_running(started)) nap(1);
    nap(static_cast<unsigned>(random() % 300));
    kill(started.process, SIGKILL);
    const int status = wait(started);
    const std::string now = read_file(path("out/journal"));
    // What was recorded stays as it is: no case is run again.
    const std::size_t whole = journal.rfind('\n') == std::string::npos ? 0 : journal.rfind('\n') + 1;
    EXPECT_EQ(now.substr(0, whole), journal.substr(0, whole));
    journal = now;
    if (status == 0) break;
    ASSERT_EQ(status, -SIGKILL) << read_file(started.log + ".err");
    ++kills;
    ASSERT_LT(kills, 100);
  }
  EXPECT_GE(kills, 3);
  const io::JournalContent content = io::read_journal(path("out/journal"));
  EXPECT_EQ(content.records.size(), 24);
  EXPECT_EQ(std::count(journal.begin(), journal.end(), '\n'), 25);
  EXPECT_EQ(read_file(path("out/sweep.csv")), undisturbed);
  RecordProperty("kills", kills);
}

TEST_F(SweepTest, LosesTheCasesInFlightAtMost) {
  base = slow_base;
  write("base.toml", base);
  write("sweep.toml", "base = 'base.toml'\n" + slow_radii);
  const Started started = start({"sweep", path("sweep.toml"), "-o", path("out"), "-j", "2"});
  // Until some cases are there.
  while (read_file(path("out/journal")).size() < 10000) nap(5);
  kill(started.process, SIGKILL);
  wait(started);
  const auto recorded = io::read_journal(path("out/journal")).records.size();
  std::size_t begun = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(path("out/cases"))) ++begun;
  EXPECT_GT(recorded, 0);
  EXPECT_LE(begun, recorded + 2);
}

TEST_F(SweepTest, StopsCleanlyWhenInterrupted) {
  base = slow_base;
  write("base.toml", base);
  write("sweep.toml", "base = 'base.toml'\n" + slow_radii);
  for (const int signal : {SIGINT, SIGTERM}) {
    std::filesystem::remove_all(path("out"));
    const Started started = start({"sweep", path("sweep.toml"), "-o", path("out"), "-j", "2"});
    while (read_file(path("out/journal")).size() < 10000) nap(5);
    kill(started.process, signal);
    EXPECT_EQ(wait(started), -signal);
    EXPECT_THAT(read_file(started.log + ".err"), HasSubstr("; --resume runs them"));
    const auto recorded = io::read_journal(path("out/journal")).records.size();
    const std::vector<std::string> status = column("status");
    EXPECT_EQ(status.size(), 24);
    EXPECT_EQ(std::count(status.begin(), status.end(), "ok"), recorded);
    EXPECT_LT(recorded, 24);
    EXPECT_EQ(nlohmann::json::parse(read_file(path("out/sweep.json")))["status"], "incomplete");
  }
  EXPECT_EQ(sweep(slow_radii, {"--resume"}).status, 0);
  EXPECT_THAT(column("status"), ::testing::Each("ok"));
}

TEST_F(SweepTest, RefusesToMixSweeps) {
  ASSERT_EQ(sweep(radii).status, 0);
  const std::string before = read_file(path("out/journal"));
  EXPECT_THAT(sweep(radii).err, HasSubstr("holds a sweep already; expected --resume"));
  base += "[properties]\ntolerance = 1e-9\n";
  const ProgramResult changed = sweep(radii, {"--resume"});
  EXPECT_EQ(changed.status, 2);
  EXPECT_THAT(changed.err, HasSubstr("the base case: properties was absent, is { tolerance = 1e-09 }"));
  base = "[geometry]\ntype = 'sphere'\nradius = 1\n";
  EXPECT_THAT(sweep("[[parameter]]\nkey = 'geometry.radius'\nvalues = [1, 2]\n", {"--resume"}).err,
              HasSubstr("the sweep file: parameter.0.values was [0.5, 1, 2, 4], is [1, 2]"));
  EXPECT_EQ(read_file(path("out/journal")), before);
  // What is written of the results may change.
  EXPECT_EQ(sweep(radii + "[output]\nresults = ['area']\n", {"--resume"}).status, 0);
  EXPECT_EQ(read_file(path("out/journal")), before);
  EXPECT_THAT(column("volume"), IsEmpty());
  EXPECT_EQ(column("area").size(), 4);
}

/// One case of two takes longer than it may, until it may take longer.
TEST_F(SweepTest, RetriesFailedCasesAlone) {
  base +=
      "[analysis]\nequation = 'laplace'\n[[boundary_condition]]\nkind = 'value'\nvalue = 'x'\n"
      "[discretisation]\nrefine = 0\n";
  const std::string levels = "[[parameter]]\nkey = 'discretisation.refine'\nvalues = [0, 4]\n";
  EXPECT_EQ(sweep(levels + "[run]\ntimeout = 0.5\n").status, 3);
  EXPECT_THAT(column("status"), ElementsAre("ok", "timed_out"));
  const auto written = std::filesystem::last_write_time(path("out/cases/1/results.json"));
  // What has ended has ended, unless it is asked for.
  EXPECT_EQ(sweep(levels, {"--resume"}).status, 3);
  EXPECT_THAT(column("status"), ElementsAre("ok", "timed_out"));
  EXPECT_EQ(sweep(levels, {"--resume", "--retry"}).status, 0);
  EXPECT_THAT(column("status"), ElementsAre("ok", "ok"));
  EXPECT_EQ(std::filesystem::last_write_time(path("out/cases/1/results.json")), written);
  EXPECT_EQ(sweep(levels, {"--retry"}).status, 2);
}

TEST_F(SweepTest, DiscardsItsOwnCasesAlone) {
  write("out/cases/mine.toml", "");
  write("out/cases/9/mine.txt", "");
  ASSERT_EQ(sweep(radii).status, 0);
  EXPECT_TRUE(std::filesystem::exists(path("out/cases/9/mine.txt")));
  ASSERT_EQ(sweep("[[parameter]]\nkey = 'geometry.radius'\nvalues = [1, 2]\n", {"--restart"}).status, 0);
  EXPECT_TRUE(std::filesystem::exists(path("out/cases/mine.toml")));
  EXPECT_FALSE(std::filesystem::exists(path("out/cases/3")));
  EXPECT_EQ(column("volume").size(), 2);
}

TEST_F(SweepTest, WritesNothingForBadInput) {
  const ProgramResult result = sweep("[[parameter]]\nkey = 'geometry.radios'\nvalues = [1]\n");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("unknown key (did you mean \"radius\"?)"));
  EXPECT_FALSE(std::filesystem::exists(path("out")));
  EXPECT_EQ(sweep(radii, {"--shard", "3/2"}).status, 2);
  EXPECT_EQ(sweep(radii, {"--resume", "--restart"}).status, 2);
  EXPECT_EQ(sweep(radii, {"--merge"}).status, 2);
  EXPECT_FALSE(std::filesystem::exists(path("out")));
}

TEST_F(SweepTest, TellsOfResultsThatNoCaseHas) {
  const ProgramResult result = sweep(radii + "[output]\nresults = ['volum']\n[[plot]]\nx = 'radius'\ny = 'aera'\n");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("no case has the result \"volum\" (did you mean \"volume\"?)"));
  EXPECT_THAT(result.err, HasSubstr("no case has the result \"aera\" (did you mean \"area\"?)"));
}

TEST_F(SweepTest, ListsItsCases) {
  const ProgramResult text = sweep(radii, {"--dry-run", "--shard", "2/2"});
  EXPECT_EQ(text.status, 0);
  EXPECT_THAT(text.out, HasSubstr("2 of 4 cases"));
  const auto json = nlohmann::json::parse(sweep(radii, {"--dry-run", "--json"}).out);
  EXPECT_EQ(json["cases"].size(), 4);
  EXPECT_EQ(json["cases"][2]["values"]["radius"], 2);
  EXPECT_FALSE(std::filesystem::exists(path("out")));
}

TEST_F(SweepTest, PrintsItsSummaryAsJson) {
  const ProgramResult result = sweep(radii, {"--json"});
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["status"], "ok");
  EXPECT_EQ(json["cases"], 4);
  EXPECT_EQ(result.out, read_file(path("out/sweep.json")));
}

// --- Shards ---------------------------------------------------------------------------------------------------

TEST_F(SweepTest, JoinsItsShards) {
  ASSERT_EQ(sweep(radii).status, 0);
  const std::string whole = read_file(path("out/sweep.csv"));
  std::filesystem::remove_all(path("out"));
  ASSERT_EQ(sweep(radii, {"--shard", "1/3"}).status, 0);
  EXPECT_THAT(column("case", "out/shard_1_of_3/sweep.csv"), ElementsAre("1", "4"));
  ASSERT_EQ(sweep(radii, {"--shard", "3/3"}).status, 0);
  const ProgramResult incomplete = sweep(radii, {"--merge"});
  EXPECT_EQ(incomplete.status, 2);
  EXPECT_THAT(incomplete.err, HasSubstr("1 cases of 4 are missing: 2; --resume runs them"));
  EXPECT_THAT(column("status"), ElementsAre("ok", "missing", "ok", "ok"));
  ASSERT_EQ(sweep(radii, {"--shard", "2/3"}).status, 0);
  EXPECT_EQ(sweep(radii, {"--merge"}).status, 0);
  EXPECT_EQ(read_file(path("out/sweep.csv")), whole);
  EXPECT_THAT(read_file(path("out/boundary.pvd")), HasSubstr("file=\"shard_2_of_3/cases/2/boundary.vtu\""));
}

TEST_F(SweepTest, GoesOnFromAnIncompleteMerge) {
  ASSERT_EQ(sweep(radii).status, 0);
  const std::string whole = read_file(path("out/sweep.csv"));
  std::filesystem::remove_all(path("out"));
  ASSERT_EQ(sweep(radii, {"--shard", "2/2"}).status, 0);
  ASSERT_EQ(sweep(radii, {"--merge"}).status, 2);
  EXPECT_EQ(sweep(radii, {"--resume"}).status, 0);
  EXPECT_EQ(read_file(path("out/sweep.csv")), whole);
  EXPECT_FALSE(std::filesystem::exists(path("out/cases/2")));
  EXPECT_TRUE(std::filesystem::exists(path("out/cases/3/results.json")));
  EXPECT_EQ(sweep(radii, {"--merge"}).status, 0);
  EXPECT_EQ(read_file(path("out/sweep.csv")), whole);
}

TEST_F(SweepTest, RefusesShardsOfAnotherSweep) {
  ASSERT_EQ(sweep(radii, {"--shard", "1/2"}).status, 0);
  const ProgramResult result = sweep("[[parameter]]\nkey = 'geometry.radius'\nvalues = [1, 2]\n", {"--merge"});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("shard_1_of_2/journal: the sweep file: parameter.0.values was"));
  EXPECT_FALSE(std::filesystem::exists(path("out/journal")));
}

// --- Files ----------------------------------------------------------------------------------------------------

TEST_F(SweepTest, WritesACollectionThatParaViewCanFollow) {
  ASSERT_EQ(sweep(radii).status, 0);
  vtkNew<vtkXMLDataParser> parser;
  parser->SetFileName(path("out/boundary.pvd").c_str());
  ASSERT_EQ(parser->Parse(), 1);
  vtkXMLDataElement* root = parser->GetRootElement();
  EXPECT_STREQ(root->GetName(), "VTKFile");
  EXPECT_STREQ(root->GetAttribute("type"), "Collection");
  vtkXMLDataElement* list = root->FindNestedElementWithName("Collection");
  ASSERT_NE(list, nullptr);
  ASSERT_EQ(list->GetNumberOfNestedElements(), 4);
  for (int i = 0; i < 4; ++i) {
    vtkXMLDataElement* set = list->GetNestedElement(i);
    double time = 0.0;
    ASSERT_TRUE(set->GetScalarAttribute("timestep", time));
    EXPECT_EQ(time, 0.5 * std::pow(2.0, i));
    vtkNew<vtkXMLUnstructuredGridReader> reader;
    reader->SetFileName((std::filesystem::path(path("out")) / set->GetAttribute("file")).c_str());
    reader->Update();
    double box[6];
    reader->GetOutput()->GetBounds(box);
    ASSERT_GT(reader->GetOutput()->GetNumberOfCells(), 0);
    EXPECT_NEAR(box[1], time, 1e-12);
  }
}

std::vector<double> read_reals(hid_t file, const std::string& name) {
  const hid_t set = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
  const hid_t space = H5Dget_space(set);
  std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  EXPECT_GE(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0) << name;
  H5Sclose(space);
  H5Dclose(set);
  return values;
}

TEST_F(SweepTest, GathersTablesAndFieldsInOneFile) {
  base = "[geometry]\ntype = 'torus'\nmajor_radius = 3\nminor_radius = 2\n";
  const ProgramResult result = sweep("[[parameter]]\nkey = 'geometry.major_radius'\nvalues = [3, 1, 4]\n");
  EXPECT_EQ(result.status, 2);
  const hid_t file = H5Fopen(path("out/sweep.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  EXPECT_THAT(read_reals(file, "table/case"), ElementsAre(1, 2, 3));
  EXPECT_THAT(read_reals(file, "table/major_radius"), ElementsAre(3, 1, 4));
  const std::vector<double> volume = read_reals(file, "table/volume");
  const double pi = std::acos(-1.0);
  EXPECT_NEAR(volume[0], 2 * pi * pi * 3 * 4, 1e-9);
  EXPECT_TRUE(std::isnan(volume[1]));
  EXPECT_NEAR(volume[2], 2 * pi * pi * 4 * 4, 1e-9);
  EXPECT_EQ(read_reals(file, "cases/3/properties/volume/value"), std::vector<double>{volume[2]});
  EXPECT_GT(read_reals(file, "cases/1/geometry/elements/nets").size(), 36);
  EXPECT_EQ(H5Lexists(file, "cases/2", H5P_DEFAULT), 0);
  H5Fclose(file);
}

TEST_F(SweepTest, PlotsResultsAgainstParameters) {
  ASSERT_EQ(sweep(radii + "[[plot]]\nx = 'radius'\ny = ['area', 'volume']\nx_scale = 'logarithmic'\ny_scale = "
                          "'logarithmic'\n[[plot]]\nfile = 'b'\nx = 'volume'\ny = 'area'\nseries = 'radius'\n")
                .status,
            0);
  EXPECT_THAT(read_file(path("out/plot_1.svg")), HasSubstr(">volume</text>"));
  EXPECT_THAT(read_file(path("out/b.svg")), HasSubstr(">radius = 0.5</text>"));
}

TEST_F(SweepTest, WritesNoCaseFilesIfTold) {
  ASSERT_EQ(sweep(radii + "[output]\ncase_files = false\n").status, 0);
  EXPECT_FALSE(std::filesystem::exists(path("out/cases")));
  EXPECT_FALSE(std::filesystem::exists(path("out/boundary.pvd")));
  EXPECT_EQ(column("volume").size(), 4);
}

TEST_F(SweepTest, RunsItsExamples) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(ISORIM_SOURCE_DIR "/cases/sweeps")) {
    const std::string file = entry.path().string();
    if (entry.path().extension() != ".toml" || read_file(file).find("\nbase = ") == std::string::npos) continue;
    ++count;
    const ProgramResult result = program({"sweep", file, "-o", path("out"), "--restart"});
    EXPECT_EQ(result.status, 0) << file << result.err;
    EXPECT_THAT(result.out, HasSubstr(" 0 of them failed")) << file;
  }
  EXPECT_EQ(count, 5);
}

}  // namespace
}  // namespace isorim::testing
