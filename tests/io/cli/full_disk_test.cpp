#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "tests/io/cli/program_test.h"

namespace isorim::testing {
namespace {

namespace fs = std::filesystem;

/// Runs the program as `main` does, to the end of the process, where no file can have more than `most` bytes: for those
/// who write, a disk that is full. Every run is a process of its own, of one thread: others do not
/// survive a fork.
[[noreturn]] void run_with_full_disk(const std::vector<std::string>& args, rlim_t most) {
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{most, most};
  setrlimit(RLIMIT_FSIZE, &limit);
  std::exit(cli::run_program(args, std::cout, std::cerr));
}

class FullDisk : public ProgramTest {
 protected:
  FullDisk() { ::testing::FLAGS_gtest_death_test_style = "fast"; }

  std::string sphere(const std::string& output) const {
    return write("case.toml", "[geometry]\ntype = 'sphere'\nradius = 1\n[output]\n" + output);
  }
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder() / "out")) {
      names.push_back(entry.path().filename().string());
    }
    return names;
  }
};

TEST_F(FullDisk, ResultsInHdf5AreRefusedAndTheProcessEndsWell) {
  const std::string file = sphere("vtk = false\n");
  EXPECT_EXIT(run_with_full_disk({"run", file, "-q", "-j", "1", "-o", path("out")}, 8192), ::testing::ExitedWithCode(2),
              "cannot write '.*results.h5': File too large");
  EXPECT_THAT(files(), ::testing::IsEmpty());
}

TEST_F(FullDisk, VtkFilesAreRefusedAndLeaveNothing) {
  const std::string file = sphere("hdf5 = false\n");
  EXPECT_EXIT(run_with_full_disk({"run", file, "-q", "-j", "1", "-o", path("out")}, 1024), ::testing::ExitedWithCode(2),
              "cannot write '.*boundary.vtu'");
  EXPECT_THAT(files(), ::testing::IsEmpty());
}

TEST_F(FullDisk, NoResultsOfAnEarlierRunStayBesideTheFilesOfALaterOne) {
  const std::string file = sphere("vtk = false\n");
  EXPECT_EXIT(run_with_full_disk({"run", file, "-q", "-j", "1", "-o", path("out")}, RLIM_INFINITY),
              ::testing::ExitedWithCode(0), "");
  EXPECT_THAT(files(), ::testing::UnorderedElementsAre("results.h5", "results.json"));
  const std::string before = read_file(folder() / "out/results.h5");
  EXPECT_EXIT(run_with_full_disk({"run", file, "-q", "-j", "1", "-o", path("out"), "--set", "geometry.radius=2"}, 8192),
              ::testing::ExitedWithCode(2), "results.h5");
  EXPECT_THAT(files(), ::testing::ElementsAre("results.h5"));
  EXPECT_EQ(read_file(folder() / "out/results.h5"), before);
}

TEST_F(FullDisk, LibrariesOfHullsStayAsTheyWere) {
  const std::string library = path("hulls.h5");
  const std::string table = std::string(ISORIM_SOURCE_DIR) + "/cases/hull/wigley.csv";
  EXPECT_EXIT(run_with_full_disk({"hulls", "import", library, table, "--name", "a"}, RLIM_INFINITY),
              ::testing::ExitedWithCode(0), "");
  const std::string before = read_file(library);
  EXPECT_EXIT(run_with_full_disk({"hulls", "import", library, table, "--name", "b"}, 8192),
              ::testing::ExitedWithCode(2), "cannot write '.*hulls.h5'");
  EXPECT_EQ(read_file(library), before);
}

}  // namespace
}  // namespace isorim::testing
