#include "io/results/report.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "io/results/json.h"
#include "io/results/table.h"

namespace isorim::io {
namespace {

using ::testing::HasSubstr;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Quantity scalar(double value) {
  return {"volume", {{value}}, {1e-9}, 10, quadrature::Status::converged, ""};
}

Quantity vector(std::vector<double> values) {
  const int rows = static_cast<int>(values.size());
  return {"centroid", {std::move(values), rows, 1}, {1e-9, 2e-9}, 10, quadrature::Status::converged, ""};
}

TEST(Expectation, TolerancesAddUp) {
  EXPECT_TRUE(compare(scalar(2.2), {{2.0}}, 0.05, 0.11).met);
  EXPECT_FALSE(compare(scalar(2.2), {{2.0}}, 0.05, 0.09).met);
  EXPECT_TRUE(compare(scalar(-2.2), {{-2.0}}, 0.11, 0.0).met);
  EXPECT_TRUE(compare(scalar(2.0), {{2.0}}, 0.0, 0.0).met);
}

TEST(Expectation, RelativeToTheLargestEntryAndEveryEntryCounts) {
  EXPECT_TRUE(compare(vector({10.0, 0.09}), {{10.0, 0.0}, 2, 1}, 0.01, 0.0).met);
  EXPECT_FALSE(compare(vector({10.0, 0.11}), {{10.0, 0.0}, 2, 1}, 0.01, 0.0).met);
  const ExpectationResult result = compare(vector({10.5, 0.1}), {{10.0, 0.0}, 2, 1}, 0.01, 0.0);
  EXPECT_NEAR(*result.difference, 0.5, 1e-15);
  EXPECT_NEAR(*result.relative_difference, 0.05, 1e-15);
  EXPECT_EQ(*result.error, 2e-9);
}

TEST(Expectation, ZeroHasNoRelativeDifference) {
  const ExpectationResult result = compare(scalar(1e-3), {{0.0}}, 1.0, 0.0);
  EXPECT_FALSE(result.met);
  EXPECT_FALSE(result.relative_difference.has_value());
}

TEST(Expectation, WhatIsNotThereOrNotANumberMisses) {
  EXPECT_FALSE(compare({"volume", {}, {}, {}, {}, "open"}, {{2.0}}, 1e9, 1e9).met);
  EXPECT_FALSE(compare(scalar(nan), {{2.0}}, 1e9, 1e9).met);
  EXPECT_FALSE(compare(vector({nan, 1.0}), {{1.0, 1.0}, 2, 1}, 1e9, 1e9).met);
  EXPECT_FALSE(compare(vector({1.0, nan}), {{1.0, 1.0}, 2, 1}, 1e9, 1e9).met);
}

TEST(ExitStatus, IsThatOfTheContract) {
  EXPECT_EQ(exit_status(RunStatus::ok), 0);
  EXPECT_EQ(exit_status(RunStatus::expectation_missed), 1);
  EXPECT_EQ(exit_status(RunStatus::tolerance_not_reached), 3);
}

TEST(Json, KeepsBitsAndShowsWhatIsNotFiniteAsNull) {
  Report report;
  report.title = "Ünïcode \"quoted\"";
  report.properties.push_back(scalar(0.1 + 0.2));
  report.properties.push_back(vector({nan, 1.0 / 3.0}));
  Quantity inertia = scalar(0.0);
  inertia.name = "inertia";
  inertia.value = {{1, 2, 3, 4}, 2, 2};
  inertia.error = {1e-300};
  report.properties.push_back(inertia);
  const nlohmann::json json = nlohmann::json::parse(to_json(report));
  EXPECT_EQ(json["case"], report.title);
  EXPECT_EQ(json["properties"]["volume"]["value"].get<double>(), 0.1 + 0.2);
  EXPECT_TRUE(json["properties"]["centroid"]["value"][0].is_null());
  EXPECT_EQ(json["properties"]["centroid"]["value"][1].get<double>(), 1.0 / 3.0);
  EXPECT_EQ(json["properties"]["inertia"]["value"], (nlohmann::json{{1.0, 2.0}, {3.0, 4.0}}));
  EXPECT_EQ(json["properties"]["inertia"]["error"].get<double>(), 1e-300);
}

TEST(Table, ColumnsAlignByCharactersNotBytes) {
  TextTable table({{"name"}, {"x", Align::right}});
  table.add_row({"é", "1"});
  table.add_row({"abcdef", "23"});
  EXPECT_EQ(table.text(1), " name     x\n é        1\n abcdef  23\n");
}

TEST(Table, ResultsShowValueErrorAndVerdict) {
  Report report;
  report.title = "Title";
  report.properties = {scalar(2.5), vector({1.0, 2.0})};
  report.properties.push_back({"mass", {}, {}, {}, {}, "open"});
  report.expectations = {compare(report.properties[0], {{2.0}}, 0.1, 0.0)};
  const std::string text = results_text(report);
  EXPECT_THAT(text, HasSubstr("volume"));
  EXPECT_THAT(text, HasSubstr("MISSED"));
  EXPECT_THAT(text, HasSubstr("centroid y"));
  EXPECT_THAT(text, HasSubstr("refused"));
  EXPECT_THAT(text, HasSubstr("0 expectations of 1 met"));
}

}  // namespace
}  // namespace isorim::io
