#pragma once

#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/io/cli/program_test.h"

namespace isorim::testing {

/// A minimal bad case and what the message must say.
struct BadCase {
  std::string name;
  std::string text;
  std::vector<std::string> fragments;

  friend std::ostream& operator<<(std::ostream& out, const BadCase& bad) { return out << bad.name; }
};

class BadCaseTest : public ProgramTest, public ::testing::WithParamInterface<BadCase> {
 protected:
  void expect_refusal() const {
    const ProgramResult result = run_case(GetParam().text);
    EXPECT_EQ(result.status, 2) << result.err;
    for (const std::string& fragment : GetParam().fragments) EXPECT_THAT(result.err, ::testing::HasSubstr(fragment));
    EXPECT_THAT(result.err, ::testing::HasSubstr("case.toml:"));
    EXPECT_EQ(result.out, "");
    EXPECT_FALSE(std::filesystem::exists(folder() / "out"));
  }
};

inline std::string bad_case_name(const ::testing::TestParamInfo<BadCase>& info) {
  return info.param.name;
}

}  // namespace isorim::testing
