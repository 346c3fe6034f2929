#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "io/cli/program.h"

namespace isorim::testing {

struct ProgramResult {
  int status = 0;
  std::string out;
  std::string err;
};

inline ProgramResult run(const std::vector<std::string>& args) {
  std::ostringstream out;
  std::ostringstream err;
  const int status = cli::run_program(args, out, err);
  return {status, out.str(), err.str()};
}

inline std::string read_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// Each test has an empty folder of its own.
class ProgramTest : public ::testing::Test {
 protected:
  ProgramTest() {
    std::string pattern = (std::filesystem::temp_directory_path() / "isorim_test_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~ProgramTest() override { std::filesystem::remove_all(folder_); }

  const std::filesystem::path& folder() const { return folder_; }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return path(name);
  }
  ProgramResult run_case(const std::string& text, std::vector<std::string> more = {}) const {
    std::vector<std::string> args{"run", write("case.toml", text), "-o", path("out")};
    args.insert(args.end(), more.begin(), more.end());
    return run(args);
  }

 private:
  std::filesystem::path folder_;
};

}  // namespace isorim::testing
