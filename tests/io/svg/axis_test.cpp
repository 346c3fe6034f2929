#include "io/svg/axis.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace isorim::io::svg {
namespace {

using testing::ElementsAre;

std::vector<std::string> labels(const Ticks& ticks) {
  std::vector<std::string> result;
  for (const Tick& tick : ticks.major) {
    result.push_back(tick.label.base + (tick.label.superscript.empty() ? "" : "^" + tick.label.superscript));
  }
  return result;
}

std::vector<double> values(const Ticks& ticks) {
  std::vector<double> result;
  for (const Tick& tick : ticks.major) result.push_back(tick.value);
  return result;
}

TEST(SvgAxis, FractionRunsFromZeroToOne) {
  const AxisRange linear{Scale::linear, -2.0, 6.0};
  EXPECT_EQ(linear.fraction(-2.0), 0.0);
  EXPECT_EQ(linear.fraction(0.0), 0.25);
  EXPECT_EQ(linear.fraction(6.0), 1.0);
  const AxisRange logarithmic{Scale::logarithmic, 1e-3, 1e5};
  EXPECT_NEAR(logarithmic.fraction(1e-3), 0.0, 1e-15);
  EXPECT_NEAR(logarithmic.fraction(0.1), 0.25, 1e-15);
  EXPECT_NEAR(logarithmic.fraction(1e5), 1.0, 1e-15);
}

TEST(SvgAxis, StepsAreOneTwoOrFiveTimesADecade) {
  EXPECT_DOUBLE_EQ(tick_step(8.0, 8), 1.0);
  EXPECT_DOUBLE_EQ(tick_step(8.1, 8), 2.0);
  EXPECT_DOUBLE_EQ(tick_step(0.17, 8), 0.05);
  EXPECT_DOUBLE_EQ(tick_step(0.61, 8), 0.1);
  EXPECT_DOUBLE_EQ(tick_step(7e12, 8), 1e12);
}

TEST(SvgAxis, LinearTicksAreExactDecimals) {
  const Ticks found = ticks({Scale::linear, 0.0, 0.6}, 8);
  EXPECT_THAT(values(found), ElementsAre(0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6));
  EXPECT_THAT(labels(found), ElementsAre("0", "0.1", "0.2", "0.3", "0.4", "0.5", "0.6"));
}

TEST(SvgAxis, LinearTicksStayInsideTheRange) {
  EXPECT_THAT(labels(ticks({Scale::linear, -1.3, 2.9}, 9)),
              ElementsAre("\u22121", "\u22120.5", "0", "0.5", "1", "1.5", "2", "2.5"));
  EXPECT_THAT(labels(ticks({Scale::linear, 0.0, 8e6}, 4)),
              ElementsAre("0", "2\u00d710^6", "4\u00d710^6", "6\u00d710^6", "8\u00d710^6"));
}

TEST(SvgAxis, LogarithmicTicksAreDecadesWithMinorOnesBetween) {
  const Ticks found = ticks({Scale::logarithmic, 1.0, 1e3}, 9);
  EXPECT_THAT(labels(found), ElementsAre("1", "10", "100", "1000"));
  ASSERT_EQ(found.minor.size(), 24U);
  EXPECT_DOUBLE_EQ(found.minor.front(), 2.0);
  EXPECT_DOUBLE_EQ(found.minor.back(), 900.0);
}

TEST(SvgAxis, ManyDecadesAreThinnedOut) {
  const Ticks found = ticks({Scale::logarithmic, 1e-16, 1.0}, 9);
  EXPECT_THAT(labels(found), ElementsAre("10^\u221216", "10^\u221214", "10^\u221212", "10^\u221210", "10^\u22128",
                                         "10^\u22126", "10^\u22124", "10^\u22122", "10^0"));
  EXPECT_EQ(found.minor.size(), 8U);
  EXPECT_LE(ticks({Scale::logarithmic, 1e-300, 1e300}, 9).major.size(), 9U);
}

TEST(SvgAxis, ShortLogarithmicRangesLabelOneTwoFive) {
  EXPECT_THAT(labels(ticks({Scale::logarithmic, 2.0, 50.0}, 9)), ElementsAre("2", "5", "10", "20", "50"));
  EXPECT_THAT(
      labels(ticks({Scale::logarithmic, 2e-9, 5e-8}, 9)),
      ElementsAre("2\u00d710^\u22129", "5\u00d710^\u22129", "10^\u22128", "2\u00d710^\u22128", "5\u00d710^\u22128"));
  EXPECT_THAT(labels(ticks({Scale::logarithmic, 1.0, 2.0}, 5)), ElementsAre("1", "1.2", "1.4", "1.6", "1.8", "2"));
}

TEST(SvgAxis, RoundRangeHoldsTheValues) {
  const AxisRange linear = round_range(Scale::linear, 0.13, 7.4);
  EXPECT_EQ(linear.first, 0.0);
  EXPECT_EQ(linear.last, 8.0);
  const AxisRange decades = round_range(Scale::logarithmic, 3e-15, 0.02);
  EXPECT_DOUBLE_EQ(decades.first, 1e-15);
  EXPECT_DOUBLE_EQ(decades.last, 0.1);
  const AxisRange factors = round_range(Scale::logarithmic, 3.0, 41.0);
  EXPECT_DOUBLE_EQ(factors.first, 2.0);
  EXPECT_DOUBLE_EQ(factors.last, 50.0);
}

TEST(SvgAxis, RoundEndsStayAndEqualEndsAreDrawnApart) {
  const AxisRange exact = round_range(Scale::logarithmic, 1e-12, 1e3);
  EXPECT_DOUBLE_EQ(exact.first, 1e-12);
  EXPECT_DOUBLE_EQ(exact.last, 1e3);
  for (const double value : {0.0, 5.0, -3.0}) {
    const AxisRange range = round_range(Scale::linear, value, value);
    EXPECT_LT(range.first, value);
    EXPECT_GT(range.last, value);
  }
  const AxisRange range = round_range(Scale::logarithmic, 7.0, 7.0);
  EXPECT_LT(range.first, 7.0);
  EXPECT_GT(range.last, 7.0);
}

}  // namespace
}  // namespace isorim::io::svg
