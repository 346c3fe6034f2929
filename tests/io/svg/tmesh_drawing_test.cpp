#include "io/svg/tmesh_drawing.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/tspline/partial_lines.h"
#include "tests/io/svg/xml_check.h"

namespace isorim::io::svg {
namespace {

using geometry::KnotVector;
using geometry::PartialLine;
using geometry::TMesh;

TMesh mesh(int degree) {
  const KnotVector knots = KnotVector::clamped(degree, std::vector<double>{0, 1, 2, 3, 4, 5, 6});
  const std::vector<PartialLine> lines{{3, {0, 2}}};
  return geometry::mesh_of_lines(knots, knots, {}, lines);
}

/// Of circles, by the class of the group that they stand in.
std::size_t circles(const std::string& text, const std::string& group) {
  const std::size_t begin = text.find("<g class=\"" + group + "\"");
  if (begin == std::string::npos) return 0;
  const std::string part = text.substr(begin, text.find("</g>", begin) - begin);
  std::size_t count = 0;
  for (std::size_t at = part.find("<circle"); at != std::string::npos; at = part.find("<circle", at + 1)) ++count;
  return count;
}

TEST(TMeshDrawing, ShowsEachAnchorAndTJunctionOnce) {
  for (const int degree : {2, 3}) {
    const TMesh drawn = mesh(degree);
    const std::string text = to_svg(drawn, "a & b");
    const auto elements = parse_xml(text);
    EXPECT_EQ(circles(text, "anchors"), static_cast<std::size_t>(drawn.function_count()));
    EXPECT_EQ(circles(text, "T-junctions"), 1U);
    EXPECT_EQ(with_class(elements, "face extensions").size(), 1U);
    EXPECT_THAT(text, ::testing::HasSubstr("a &amp; b"));
    EXPECT_THAT(text, ::testing::HasSubstr(std::to_string(drawn.function_count()) + " anchors"));
    EXPECT_EQ(text, to_svg(mesh(degree), "a & b"));
  }
}

TEST(TMeshDrawing, LeavesOutWhatATensorProductHasNot) {
  const KnotVector knots = KnotVector::clamped_uniform(3, 2);
  const std::string text = to_svg(TMesh(knots, knots), "");
  EXPECT_TRUE(with_class(parse_xml(text), "face extensions").empty());
  EXPECT_EQ(circles(text, "T-junctions"), 0U);
  EXPECT_EQ(circles(text, "anchors"), 25U);
}

TEST(TMeshDrawing, EndsTheLineWhereItEnds) {
  // v = 3 runs over a third of the domain; the others over all of it.
  const std::string text = to_svg(mesh(3), "");
  const auto edges = with_class(parse_xml(text), "edges");
  ASSERT_EQ(edges.size(), 1U);
  const std::string path = edges.front().attribute("d");
  std::vector<double> lengths;
  double x = 0.0;
  for (std::size_t at = 0; at < path.size(); ++at) {
    if (path[at] == 'M') x = std::stod(path.substr(at + 1));
    if (path[at] == 'H') lengths.push_back(std::stod(path.substr(at + 1)) - x);
  }
  ASSERT_EQ(lengths.size(), 7U);
  for (std::size_t k = 0; k < lengths.size(); ++k) EXPECT_NEAR(lengths[k], k == 3 ? 640.0 / 3 : 640.0, 0.02);
}

}  // namespace
}  // namespace isorim::io::svg
