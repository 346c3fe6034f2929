#include "geometry/propeller/radial_law.h"

#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "tests/geometry/refusals.h"

namespace isorim::geometry {
namespace {

using ::testing::HasSubstr;
using testing::refusal;

TEST(RadialLaw, PassesThroughItsRowsAndReproducesStraightLines) {
  const std::vector<double> radii{0.2, 0.3, 0.55, 0.7, 1.0};
  const RadialLaw law("pitch", radii, {0.8, 0.95, 1.0, 0.9, 0.4});
  EXPECT_EQ(law(0.55), 1.0);
  EXPECT_EQ(law(1.0), 0.4);
  const RadialLaw line("pitch", radii, {2.4, 2.6, 3.1, 3.4, 4.0});
  for (double r = 0.0; r <= 1.2; r += 0.05) EXPECT_NEAR(line(r), 2.0 + 2.0 * r, 1e-15 * 8.0);
  EXPECT_EQ(RadialLaw(0.7)(0.33), 0.7);
}

TEST(RadialLaw, GoesBeyondNoRow) {
  const RadialLaw law("chord", {0.2, 0.4, 0.5, 0.9, 1.0}, {1.0, 1.0, 3.0, 3.1, 0.0});
  double before = law(0.2);
  for (double r = 0.2; r <= 1.0; r += 0.001) {
    EXPECT_LE(law(r), 3.1);
    EXPECT_GE(law(r), 0.0);
    if (r < 0.9) {
      EXPECT_GE(law(r), before - 1e-15);
    }
    before = law(r);
  }
}

TEST(RadialLaw, RefusesWhatIsNoTable) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal([] { RadialLaw("skew", {}, {}); }), HasSubstr("skew: the table has no rows"));
  EXPECT_THAT(refusal([] { RadialLaw("skew", {0.2, 0.3}, {1.0}); }), HasSubstr("1 values for 2 radii"));
  EXPECT_THAT(refusal([] { RadialLaw("skew", {0.2, 0.2}, {1.0, 2.0}); }), HasSubstr("r/R is 0.2 in row 2 after 0.2"));
  EXPECT_THAT(refusal([&] { RadialLaw("skew", {0.2, 0.3}, {1.0, nan}); }), HasSubstr("row 2 is (0.3, nan)"));
}

}  // namespace
}  // namespace isorim::geometry
