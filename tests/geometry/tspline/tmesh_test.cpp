#include "geometry/tspline/tmesh.h"

#include <gtest/gtest.h>

#include "geometry/tspline/partial_lines.h"
#include "geometry/tspline/tspline.h"
#include "tests/geometry/expect_error.h"
#include "tests/geometry/tspline/random_tmeshes.h"

namespace isorim::geometry {
namespace {

using testing::Random;

using Parts = std::vector<PartialLine>;

std::vector<double> list(std::span<const double> values) {
  return {values.begin(), values.end()};
}

/// The local knot vectors of the function whose anchor has these lower lines.
std::array<std::vector<double>, 2> local_knots_at(const TMesh& mesh, std::array<int, 2> first) {
  for (int k = 0; k < mesh.function_count(); ++k)
    if (mesh.anchors()[static_cast<std::size_t>(k)].first == first)
      return {list(mesh.local_knots(k, Direction::u)), list(mesh.local_knots(k, Direction::v))};
  return {};
}

/// Six by six spans, 0 to 6, with these lines of u and v by their parts.
TMesh six_by_six(int p, int q, const Parts& lines_u, const Parts& lines_v) {
  const std::vector<double> breakpoints{0, 1, 2, 3, 4, 5, 6};
  return mesh_of_lines(KnotVector::clamped(p, breakpoints), KnotVector::clamped(q, breakpoints), lines_u, lines_v);
}

TEST(TMesh, OfWholeLinesHasTheKnotVectorsOfATensorProduct) {
  Random random(1);
  for (int p = 1; p <= 5; ++p) {
    for (int q = 1; q <= 5; ++q) {
      const KnotVector u = testing::random_knots(random, p);
      const KnotVector v = testing::random_knots(random, q);
      const TMesh mesh(u, v);
      ASSERT_EQ(mesh.function_count(), u.basis_count() * v.basis_count());
      for (int k = 0; k < mesh.function_count(); ++k) {
        const auto first_u = static_cast<std::size_t>(k % u.basis_count());
        const auto first_v = static_cast<std::size_t>(k / u.basis_count());
        EXPECT_EQ(list(mesh.local_knots(k, Direction::u)),
                  list(u.knots().subspan(first_u, mesh.degree(Direction::u) + 2)));
        EXPECT_EQ(list(mesh.local_knots(k, Direction::v)),
                  list(v.knots().subspan(first_v, mesh.degree(Direction::v) + 2)));
      }
    }
  }
}

TEST(TMesh, CubicRaysPassTheLinesThatAreMissing) {
  // The line v = 3 ends at u = 2. Lines have index value + 3.
  const TMesh mesh = six_by_six(3, 3, {}, {{3, {0, 2}}});
  EXPECT_EQ(mesh.index_mesh().faces().size(), 36U - 4U);
  EXPECT_EQ(mesh.function_count(), 81 - 5);
  EXPECT_TRUE(mesh.index_mesh().is_vertex(5, 6));
  EXPECT_FALSE(mesh.index_mesh().is_vertex(6, 6));
  // From (3, 2): up over the missing vertex (3, 3).
  const auto below = local_knots_at(mesh, {6, 5});
  EXPECT_EQ(below[0], (std::vector<double>{1, 2, 3, 4, 5}));
  EXPECT_EQ(below[1], (std::vector<double>{0, 1, 2, 4, 5}));
  // From the T-junction (2, 3) the ray along v = 3 crosses u = 3, though no vertex is there.
  const auto junction = local_knots_at(mesh, {5, 6});
  EXPECT_EQ(junction[0], (std::vector<double>{0, 1, 2, 3, 4}));
  EXPECT_EQ(junction[1], (std::vector<double>{1, 2, 3, 4, 5}));
}

TEST(TMesh, QuadraticBeamsAreAsWideAsTheirFace) {
  // The faces right of u = 2 are 2 high between v = 2 and 4. Lines have index value + 2.
  const TMesh mesh = six_by_six(2, 2, {}, {{3, {0, 2}}});
  EXPECT_EQ(mesh.function_count(), 64 - 5);
  const auto high = local_knots_at(mesh, {4, 4});
  EXPECT_EQ(high[0], (std::vector<double>{1, 2, 3, 4}));
  EXPECT_EQ(high[1], (std::vector<double>{1, 2, 4, 5}));
  const auto low = local_knots_at(mesh, {4, 3});
  EXPECT_EQ(low[1], (std::vector<double>{0, 1, 2, 4}));
  const auto beside = local_knots_at(mesh, {3, 4});
  EXPECT_EQ(beside[1], (std::vector<double>{1, 2, 3, 4}));
}

TEST(TMesh, MixedDegreesHaveEdgesAsAnchors) {
  // Quadratic in u, cubic in v: edges that run in u; v = 3 has 2 + 1 of them, one over the frame's cell of no width.
  const TMesh mesh = six_by_six(2, 3, {}, {{3, {0, 2}}});
  EXPECT_EQ(mesh.function_count(), 8 * 9 - 5);
  for (const IndexBox& anchor : mesh.anchors()) {
    EXPECT_EQ(anchor.first[0] + 1, anchor.last[0]);
    EXPECT_EQ(anchor.first[1], anchor.last[1]);
  }
  // Cubic in u, quadratic in v: the edges that cross v = 3 right of u = 2 are two bays long.
  const TMesh turned = six_by_six(3, 2, {}, {{3, {0, 2}}});
  EXPECT_EQ(turned.function_count(), 9 * 8 - 5);
  EXPECT_EQ(local_knots_at(turned, {6, 4})[1], (std::vector<double>{1, 2, 4, 5}));
}

TEST(TMesh, FrameFollowsTheBorder) {
  // The line u = 3 does not reach the side v = 0: the frame below has no line there either, nor functions.
  const TMesh mesh = six_by_six(3, 3, {{3, {2, 6}}}, {});
  EXPECT_EQ(mesh.function_count(), 81 - 3);
  EXPECT_EQ(local_knots_at(mesh, {5, 2})[0], (std::vector<double>{0, 1, 2, 4, 5}));
}

TEST(TMesh, RepeatedKnotsHaveEqualPartsAndStopWhatEndsThereAtTheNearest) {
  const KnotVector u(2, {0, 0, 0, 1, 1, 2, 3, 3, 3});
  const KnotVector v(2, {0, 0, 0, 1, 2, 2, 3, 3, 3});
  const Parts lines_v{{1, {1, 3}}, {2, {0, 2}}};
  const TMesh mesh = mesh_of_lines(u, v, {}, lines_v);
  EXPECT_FALSE(mesh.index_mesh().has_edge(Direction::v, 3, 3));
  EXPECT_TRUE(mesh.index_mesh().has_edge(Direction::v, 3, 4));
  for (const int line : {4, 5}) {
    EXPECT_TRUE(mesh.index_mesh().has_edge(Direction::v, line, 4));
    EXPECT_FALSE(mesh.index_mesh().has_edge(Direction::v, line, 5));
  }
}

TEST(TMesh, ExtensionsReachOverHalfTheDegree) {
  for (const int p : {1, 2, 3, 4, 5}) {
    const TMesh mesh = six_by_six(p, 3, {}, {{3, {0, 2}}});
    const std::vector<TJunction> junctions = mesh.index_mesh().t_junctions();
    ASSERT_EQ(junctions.size(), 1U);
    EXPECT_EQ(junctions[0], (TJunction{{2 + p, 6}, Direction::u, 1}));
    const Extension extension = mesh.index_mesh().extension(junctions[0]);
    EXPECT_EQ(extension.ahead, 2 + p + (p + 1) / 2);
    EXPECT_EQ(extension.first, 2 + p - p / 2);
    EXPECT_EQ(extension.last, extension.ahead);
  }
}

TEST(TMesh, ExtensionsThatTouchAtAnEndAreNotSuitable) {
  // The extension of v = 3 from (2, 3) ends at (4, 3); that of u = 4 from (4, y) reaches down to y - 2.
  const auto conflicts = [](double y) {
    return extension_conflicts(six_by_six(3, 3, {{4, {y, 6}}}, {{3, {0, 2}}}).index_mesh());
  };
  const std::vector<ExtensionConflict> touching = conflicts(5);
  ASSERT_EQ(touching.size(), 1U);
  EXPECT_EQ(touching[0].in_u.at, (std::array<int, 2>{5, 6}));
  EXPECT_EQ(touching[0].in_v.at, (std::array<int, 2>{7, 8}));
  EXPECT_TRUE(is_analysis_suitable(six_by_six(3, 3, {{5, {5, 6}}}, {{3, {0, 2}}})));
  EXPECT_FALSE(is_analysis_suitable(six_by_six(3, 3, {{3, {4, 6}}}, {{3, {0, 2}}})));
}

TEST(TMesh, UnsuitableFunctionsNeedNotSumToOne) {
  const TMesh mesh = six_by_six(3, 3, {{3, {4, 6}}}, {{3, {0, 2}}});
  double defect = 0.0;
  for (double u = 0.25; u < 6.0; u += 0.5)
    for (double v = 0.25; v < 6.0; v += 0.5)
      defect = std::max(defect, std::abs(function_values(mesh, {u, v}).sum() - 1.0));
  EXPECT_GT(defect, 1e-3);
}

TEST(TMesh, RefusesWhatIsNoTMesh) {
  EXPECT_GEOMETRY_ERROR(six_by_six(3, 3, {{2.5, {0, 1}}}, {}),
                        "a line u is drawn at 2.5, which is no knot between 0 and 6");
  EXPECT_GEOMETRY_ERROR(six_by_six(3, 3, {{6, {0, 1}}}, {}), "the line u = 6 cannot be given by parts");
  EXPECT_GEOMETRY_ERROR(six_by_six(3, 3, {}, {{2, {0, 1.5}}}),
                        "the line v = 2 has an end at 1.5, which is no knot between 0 and 6");
  EXPECT_GEOMETRY_ERROR(six_by_six(3, 3, {}, {{2, {4, 4}}}), "the line v = 2 runs from u = 4 to 4");
  EXPECT_GEOMETRY_ERROR(six_by_six(3, 3, {{2, {0, 3}}}, {{4, {0, 2}}}),
                        "the line v = 4 ends at (u, v) = (2, 4), where no line crosses it");
  EXPECT_GEOMETRY_ERROR(six_by_six(3, 3, {{2, {0, 4}}}, {{4, {0, 2}}}),
                        "two lines end in a corner at (u, v) = (2, 4); one must run on");
  const std::vector<IndexBox> frame{{{2, 3}, {4, 4}}};
  EXPECT_GEOMETRY_ERROR(IndexMesh({3, 3}, {13, 13}, frame), "leaves the domain, which has lines 3 to 9 of u");
  const std::vector<IndexBox> overlapping{{{3, 3}, {5, 5}}, {{4, 4}, {6, 6}}};
  EXPECT_GEOMETRY_ERROR(IndexMesh({3, 3}, {13, 13}, overlapping),
                        "faces 0 and 1 overlap: lines 3 to 5 of u and 3 to 5 of v; lines 4 to 6 of u");
  const std::vector<IndexBox> empty{{{3, 3}, {3, 5}}};
  EXPECT_GEOMETRY_ERROR(IndexMesh({3, 3}, {13, 13}, empty), "face 0 holds no cell");
  EXPECT_GEOMETRY_ERROR(IndexMesh({3, 3}, {7, 13}), "7 lines of direction u for degree 3; expected at least 8");
  EXPECT_GEOMETRY_ERROR(
      TMesh(KnotVector::clamped_uniform(3, 2), KnotVector::clamped_uniform(3, 2), IndexMesh({3, 3}, {9, 10})),
      "10 lines for degree 3 and 9 knots for degree 3 in direction v");
}

TEST(TMesh, TJunctionsThatFaceEachOtherMustBeJoined) {
  EXPECT_GEOMETRY_ERROR(six_by_six(3, 3, {}, {{1, {0, 1}}, {1, {2, 6}}}),
                        "the face u = 1 to 2, v = 0 to 2 has T-junctions at v = 1 on both of its sides");
}

}  // namespace
}  // namespace isorim::geometry
