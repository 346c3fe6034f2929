#include "io/tspline/be.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"

namespace isorim::io::tspline {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// Two bilinear squares; the nodes have numbers of their own. %1 is where face nodes stand.
std::string two_squares(bool faces) {
  const std::string first = faces ? "10 20 40 50\n" : "";
  const std::string second = faces ? "20 30 50 60\n" : "";
  return "6\n10 0 0 0 1\n60 2.0 1 0 1\n30 4 0 0 2\n40 0 1 0 1\n50 1 1 0 1\n20 1 0 0 1\n2\n0 4 1\n" + first +
         "10 20 40 50\n1 1 1 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n\n7 4 1\n" + second +
         "20 30 50 60\n1 2 2 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"
         "10 1\n0 -1.0 -1.0\n20 2\n0 1 -1\n7 -1 -1\n";
}

std::string replaced(std::string text, const std::string& old, const std::string& by) {
  const std::size_t at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return text.replace(at, old.size(), by);
}

std::string refusal(const std::string& text) {
  try {
    parse_be(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "(nothing was refused)";
}

TEST(Be, ReadsElementsWithAndWithoutFaceNodes) {
  for (const bool faces : {false, true}) {
    const ExtractionData data = parse_be(two_squares(faces));
    ASSERT_EQ(data.points.cols(), 6);
    EXPECT_EQ(data.points.col(2), Eigen::Vector4d(8, 0, 0, 2));
    ASSERT_EQ(data.elements.size(), 2u);
    EXPECT_THAT(data.elements[1].functions, ::testing::ElementsAre(5, 2, 4, 1));
    EXPECT_EQ(data.elements[0].rows, Eigen::MatrixXd::Identity(4, 4));
    EXPECT_EQ(data.elements[0].degree, (std::array<std::int8_t, 2>{1, 1}));
    ASSERT_EQ(data.entities.size(), 3u);
    EXPECT_EQ(data.entities[2].count, 2);
  }
}

TEST(Be, ReadsFilesWithoutCollocationPoints) {
  const std::string text = two_squares(true);
  EXPECT_EQ(parse_be(text.substr(0, text.rfind("10 1\n"))).elements.size(), 2u);
}

TEST(Be, TellsWhatIsNotUsed) {
  EXPECT_THAT(parse_be(two_squares(true)).warnings,
              ::testing::ElementsAre("the regions of nodes are not used; found 2 different ones",
                                     "2 collocation points are not used: analyses place their own"));
  const std::string plain = replaced(two_squares(false), "1 2 2 1\n", "1 1 1 1\n");
  EXPECT_THAT(parse_be(plain.substr(0, plain.rfind("10 1\n"))).warnings, ::testing::IsEmpty());
}

TEST(Be, RefusalsNameTheLine) {
  for (const bool faces : {false, true}) {
    const std::string text = two_squares(faces);
    EXPECT_THAT(refusal(replaced(text, "\n60 ", "\n10 ")), HasSubstr("line 3: node 10 is there twice"));
    EXPECT_THAT(refusal(replaced(text, "4 0 0 2", "4 0 0 0")), HasSubstr("line 4: the weight of node 30 is 0"));
    EXPECT_THAT(refusal(replaced(text, "\n7 4 1", "\n0 4 1")), HasSubstr("element 0 is there twice"));
    EXPECT_THAT(refusal(replaced(text, "\n7 4 1", "\n7 4 31")),
                HasSubstr("expected the degree of element 7 from 1 to 30"));
    EXPECT_THAT(refusal(replaced(text, "0 0 0 1\n\n7", "0 0 x 1\n\n7")),
                HasSubstr("found \"x\"; expected a coefficient"));
    EXPECT_THAT(refusal(replaced(text, "7 -1 -1", "8 -1 -1")), HasSubstr("element 8 does not exist"));
    EXPECT_THAT(refusal(replaced(text, "7 -1 -1", "7 -1 -2")), HasSubstr("a collocation point lies at -2"));
    EXPECT_THAT(refusal(text.substr(0, text.size() - 3)), HasSubstr("found the end of the file"));
  }
  EXPECT_THAT(refusal("99999999999\n"), HasSubstr("line 1"));
  EXPECT_THAT(refusal("1000000\n1 2 3 4 5"), HasSubstr("the rest of the file has room for no more than"));
  EXPECT_THAT(refusal(""), AllOf(HasSubstr("line 1"), HasSubstr("the end of the file")));
}

}  // namespace
}  // namespace isorim::io::tspline
