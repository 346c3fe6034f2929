#include "io/tspline/bext.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"

namespace isorim::io::tspline {
namespace {

using ::testing::HasSubstr;

/// The quarter of a unit circle as one rational element.
const char* const quarter_circle = R"({
  "patch_id": 0, "dim": 2, "num_nodes": 3, "num_elems": 1, "is_rational": true,
  "nodes": [[1, 0, 0, 1], [1, 1, 0, 0.70710678118654757], [0, 1, 0, 1]],
  "elements": {
    "num_elem_blocks": 1,
    "element_block_info": [{"element_type": "Cube", "num_elems": 1, "num_nodes": 3, "num_coefficient_vectors": 3,
                            "deg_s": 2, "deg_t": -1, "deg_u": -1}],
    "element_blocks": [{"node_ids": [0, 1, 2], "coeff_vector_ids": [2, 1, 0]}]
  },
  "coefficients": {
    "dense_coefficient_vectors": [{"components": [0, 0, 1]}, {"components": [0, 1, 0]}, {"components": [1, 0, 0]}],
    "sparse_coefficient_vectors": []
  },
  "num_coeff_vecs": 3
})";

/// Two bilinear squares.
const char* const two_squares = R"({
  "num_nodes": 6,
  "nodes": [[0, 0, 0, 1], [1, 0, 0, 1], [2, 0, 0, 1], [0, 1, 0, 1], [1, 1, 0, 1], [2, 1, 0, 1]],
  "elements": {
    "element_block_info": [{"num_elems": 2, "deg_s": 1, "deg_t": 1, "deg_u": -1}],
    "element_blocks": [{"node_ids": [0, 1, 3, 4], "coeff_vector_ids": [0, 1, 2, 3], "us_cid": 0},
                       {"node_ids": [1, 2, 4, 5], "coeff_vector_ids": [0, 1, 2, 3], "us_cid": 1}]
  },
  "coefficients": {"dense_coefficient_vectors": [{"components": [1, 0, 0, 0]}, {"components": [0, 1, 0, 0]},
                                                 {"components": [0, 0, 1, 0]}, {"components": [0, 0, 0, 1]}]}
})";

std::string replaced(std::string text, const std::string& old, const std::string& by) {
  const std::size_t at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return text.replace(at, old.size(), by);
}

std::string refusal(const std::string& text) {
  try {
    parse_bext(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "(nothing was refused)";
}

TEST(Bext, CurveElementsBecomeCurves) {
  const CadModel model = parse_bext(quarter_circle);
  EXPECT_TRUE(model.t_splines.empty());
  ASSERT_EQ(model.curves.size(), 1u);
  for (int i = 0; i <= 10; ++i) EXPECT_NEAR(evaluate(model.curves[0].curve, i / 10.0).norm(), 1.0, 1e-15);
}

TEST(Bext, SurfacesAreExperimental) {
  const CadModel model = parse_bext(two_squares);
  ASSERT_EQ(model.t_splines.size(), 1u);
  const geometry::ExtractedSurface& surface = model.t_splines[0].surface;
  ASSERT_EQ(surface.elements().size(), 2u);
  EXPECT_EQ(bezier_net(surface, 1).col(1), Eigen::Vector4d(2, 0, 0, 1));
  EXPECT_THAT(model.warnings, ::testing::Contains(HasSubstr("experimental")));
}

TEST(Bext, RefusalsNameThePlace) {
  EXPECT_THAT(refusal("{"), HasSubstr("is no JSON"));
  EXPECT_THAT(refusal(replaced(two_squares, "[2, 1, 0, 1]", "[2, 1e999, 0, 1]")), HasSubstr("1e999"));
  EXPECT_THAT(refusal("[]"), HasSubstr("expected an object"));
  EXPECT_THAT(refusal("{}"), HasSubstr("nodes: is missing"));
  EXPECT_THAT(refusal(replaced(two_squares, "\"num_nodes\": 6", "\"num_nodes\": 7")),
              HasSubstr("num_nodes: found 7, but there are 6 nodes"));
  EXPECT_THAT(refusal(replaced(two_squares, "[2, 1, 0, 1]", "[2, 1, 0]")),
              HasSubstr("nodes[5]: found 3 entries; expected 4"));
  EXPECT_THAT(refusal(replaced(two_squares, "[2, 1, 0, 1]", "[2, 1, \"a\", 1]")),
              HasSubstr("nodes[5][2]: expected a number"));
  EXPECT_THAT(refusal(replaced(two_squares, "[2, 1, 0, 1]", "[2, 1, 0, 0]")),
              HasSubstr("nodes[5][3]: the weight is 0"));
  EXPECT_THAT(refusal(replaced(two_squares, "[1, 2, 4, 5]", "[1, 2, 4, 6]")),
              HasSubstr("elements.element_blocks[1].node_ids[3]: found 6; expected 0 to 5"));
  EXPECT_THAT(refusal(replaced(two_squares, "[1, 2, 4, 5]", "[1, 2, 4, 99999999999999999999]")),
              HasSubstr("node_ids[3]: expected an integer"));
  EXPECT_THAT(refusal(replaced(two_squares, "[0, 1, 2, 3]", "[0, 1, 2]")),
              HasSubstr("coeff_vector_ids: found 3 entries; expected 4"));
  EXPECT_THAT(refusal(replaced(two_squares, "\"num_elems\": 2", "\"num_elems\": 3")),
              HasSubstr("element_blocks: found 2 entries; expected 3"));
  EXPECT_THAT(refusal(replaced(two_squares, "\"deg_u\": -1", "\"deg_u\": 1")),
              HasSubstr("deg_u: the elements have a volume"));
  EXPECT_THAT(refusal(replaced(two_squares, "\"deg_s\": 1", "\"deg_s\": 2")),
              HasSubstr("vector 0 has 4 components; the element's degrees need 6"));
  EXPECT_THAT(
      refusal(replaced(quarter_circle, "\"sparse_coefficient_vectors\": []", "\"sparse_coefficient_vectors\": [1]")),
      HasSubstr("sparse coefficient vectors are not supported"));
}

}  // namespace
}  // namespace isorim::io::tspline
