#include "geometry/tspline/extracted_surface.h"

#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/bezier/element_table.h"
#include "geometry/shapes/solids.h"
#include "geometry/topology/orientation.h"
#include "geometry/tspline/extraction.h"
#include "tests/geometry/expect_error.h"
#include "tests/geometry/random_splines.h"

namespace isorim::geometry {
namespace {

using testing::Random;

/// A bilinear unit square over four functions.
ExtractionElement bilinear_element() {
  return {{1, 1}, {0, 1, 2, 3}, Eigen::MatrixXd::Identity(4, 4), {}};
}

HomogeneousPoints<3> unit_square() {
  HomogeneousPoints<3> net(4, 4);
  net << 0, 1, 0, 1,  //
      0, 0, 1, 1,     //
      0, 0, 0, 0,     //
      1, 1, 1, 1;
  return net;
}

TEST(ExtractedSurface, HasTheBezierElementsOfTheNurbsSurfaceThatItWas) {
  Random random(11);
  for (int trial = 0; trial < 50; ++trial) {
    const NurbsSurface<3> surface =
        testing::random_surface<3>(random, testing::random_knots(random, random.integer(1, 5)),
                                   testing::random_knots(random, random.integer(1, 5)));
    const ExtractedSurface extraction = extracted_surface(surface);
    const ElementTable<3> table = bezier_elements(Boundary<3>{{{"surface", surface, 1}}});
    ASSERT_EQ(extraction.elements().size(), table.elements.size());
    for (std::size_t e = 0; e < table.elements.size(); ++e) {
      const HomogeneousPoints<3> net = bezier_net(extraction, static_cast<int>(e));
      const double size = net.cwiseAbs().maxCoeff();
      EXPECT_LE((net - table.net_matrix(table.elements[e])).cwiseAbs().maxCoeff(), 1e-12 * size) << "trial " << trial;
    }
  }
}

TEST(ExtractedSurface, FunctionsOfNurbsSurfacesSumToOne) {
  Random random(12);
  for (int trial = 0; trial < 20; ++trial) {
    const NurbsSurface<3> surface =
        testing::random_surface<3>(random, testing::random_knots(random, 3), testing::random_knots(random, 4));
    EXPECT_THAT(partition_defects(extracted_surface(surface)), ::testing::Each(::testing::Lt(1e-13)));
  }
}

TEST(ExtractedSurface, TellsTheDefectOfItsRowsElementByElement) {
  ExtractionElement second = bilinear_element();
  second.rows(1, 1) = 0.98;
  second.rows(2, 1) = -0.01;
  const ExtractedSurface surface(unit_square(), {bilinear_element(), second});
  const std::vector<double> defects = partition_defects(surface);
  ASSERT_EQ(defects.size(), 2u);
  EXPECT_EQ(defects[0], 0.0);
  EXPECT_NEAR(defects[1], 0.03, 1e-15);
}

TEST(ExtractedSurface, EqualWeightsStayEqualInBezierFormIfTheFunctionsSumToOne) {
  Random random(13);
  const KnotVector u = testing::random_knots(random, 3, testing::Ends::clamped, 2);
  const KnotVector v = testing::random_knots(random, 2, testing::Ends::clamped, 2);
  HomogeneousPoints<3> net = testing::random_net<3>(random, u.basis_count() * v.basis_count());
  net.row(3).setConstant(0.7);
  const ExtractedSurface surface = extracted_surface(NurbsSurface<3>(u, v, net));
  for (std::size_t e = 0; e < surface.elements().size(); ++e)
    EXPECT_TRUE((bezier_net(surface, static_cast<int>(e)).row(3).array() == 0.7).all());
}

TEST(ExtractedSurface, RowsThatDoNotSumToOneMakeItRational) {
  ExtractionElement element = bilinear_element();
  element.rows(1, 1) = 0.98;
  const HomogeneousPoints<3> net = bezier_net(ExtractedSurface(unit_square(), {element}), 0);
  EXPECT_EQ(net(3, 1), 0.98);
  EXPECT_EQ(net(0, 1) / net(3, 1), 1.0) << "the corner is the only point of its only function";
}

TEST(ExtractedSurface, TransformsAsItsPointsDo) {
  Random random(14);
  const NurbsSurface<3> nurbs =
      testing::random_surface<3>(random, testing::random_knots(random, 2), testing::random_knots(random, 3));
  AffineMap<3> map;
  map.linear << 1, 2, 0, -1, 0.5, 0, 0, 0.25, -3;
  map.translation << 4, -5, 6;
  const ExtractedSurface mapped = transform(extracted_surface(nurbs), map);
  EXPECT_EQ(mapped.homogeneous(), transform(nurbs, map).homogeneous());
  EXPECT_EQ(mapped.elements().size(), extracted_surface(nurbs).elements().size());
}

TEST(ExtractedSurface, ReversedLooksTheOtherWay) {
  Random random(15);
  const ExtractedSurface surface = extracted_surface(
      testing::random_surface<3>(random, testing::random_knots(random, 2), testing::random_knots(random, 3)));
  const ExtractedSurface turned = reversed(surface);
  for (int e = 0; e < static_cast<int>(surface.elements().size()); ++e) {
    const Point2 place(random.real(0.0, 1.0), random.real(0.0, 1.0));
    const SurfaceJet<3> jet = evaluate_jet(bezier_surface(surface, e), place);
    const SurfaceJet<3> other = evaluate_jet(bezier_surface(turned, e), Point2(1.0 - place.x(), place.y()));
    EXPECT_LE((jet.point - other.point).norm(), 1e-14);
    EXPECT_LE((jet.du + other.du).norm(), 1e-13 * jet.du.norm());
    EXPECT_LE((jet.dv - other.dv).norm(), 1e-13 * jet.dv.norm());
  }
  EXPECT_EQ(reversed(turned).elements()[0].rows, surface.elements()[0].rows);
  EXPECT_EQ(turned.elements()[0].domain[0].first, -surface.elements()[0].domain[0].last);
}

TEST(ExtractedSurface, PatchesBecomeOneSurfaceThatLooksOutward) {
  Boundary<3> solid = box(Vector3(1, 2, 3));
  solid.patches[2].shape = reverse(std::get<NurbsSurface<3>>(solid.patches[2].shape), Direction::u);
  const OrientedBoundary<3> oriented = orient(solid);
  ASSERT_EQ(oriented.boundary.patches[2].orientation, -1);
  const Boundary<3> one{{{"box", extracted_surface(oriented.boundary), 1}}};
  const OrientedBoundary<3> again = orient(one);
  EXPECT_TRUE(again.topology.closed);
  EXPECT_EQ(again.boundary.patches[0].orientation, 1);
  Boundary<3> trimmed = solid;
  const auto& whole = std::get<NurbsSurface<3>>(solid.patches[0].shape);
  trimmed.patches[0].shape = TrimmedSurface(whole, {domain_loop(whole)});
  EXPECT_GEOMETRY_ERROR(extracted_surface(trimmed),
                        fmt::format("patch \"{}\": it is trimmed", trimmed.patches[0].name));
}

struct Refusal {
  const char* name;
  void (*spoil)(HomogeneousPoints<3>& net, std::vector<ExtractionElement>& elements);
  const char* fragment;
};

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

class RefusedExtraction : public ::testing::TestWithParam<Refusal> {};

TEST_P(RefusedExtraction, NamesWhatIsWrong) {
  HomogeneousPoints<3> net = unit_square();
  std::vector<ExtractionElement> elements{bilinear_element(), bilinear_element()};
  GetParam().spoil(net, elements);
  EXPECT_GEOMETRY_ERROR(ExtractedSurface(net, elements), GetParam().fragment);
}

using Net = HomogeneousPoints<3>;
using Elements = std::vector<ExtractionElement>;
INSTANTIATE_TEST_SUITE_P(
    ExtractedSurface, RefusedExtraction,
    ::testing::Values(
        Refusal{"NoElements", [](Net&, Elements& e) { e.clear(); }, "it has no elements"},
        Refusal{"NegativeWeight", [](Net& n, Elements&) { n(3, 2) = -1.0; }, "weight 2 is -1"},
        Refusal{"Infinite", [](Net& n, Elements&) { n(1, 3) = nan; }, "coordinate y of control point 3"},
        Refusal{"DegreeZero", [](Net&, Elements& e) { e[1].degree[0] = 0; }, "element 1: degree 0 is out of range"},
        Refusal{"HighDegree", [](Net&, Elements& e) { e[1].degree[1] = 31; }, "degree 31 is out of range"},
        Refusal{"NoFunctions",
                [](Net&, Elements& e) {
                  e[1].functions.clear();
                  e[1].rows.resize(0, 4);
                },
                "element 1: no function lives on it"},
        Refusal{"UnknownFunction", [](Net&, Elements& e) { e[0].functions[2] = 4; },
                "element 0: function 4 does not exist; expected 0 to 3"},
        Refusal{"NegativeFunction", [](Net&, Elements& e) { e[0].functions[2] = -1; }, "function -1 does not exist"},
        Refusal{"TwiceTheSame", [](Net&, Elements& e) { e[1].functions[3] = 1; },
                "element 1: function 1 is listed twice"},
        Refusal{"ShortRows", [](Net&, Elements& e) { e[1].rows.conservativeResize(4, 3); },
                "element 1: 4 rows of 3 coefficients given; 4 functions of degree (1, 1) need 4 x 4"},
        Refusal{"FewRows", [](Net&, Elements& e) { e[1].rows.conservativeResize(3, 4); }, "3 rows of 4"},
        Refusal{"InfiniteRow", [](Net&, Elements& e) { e[1].rows(2, 3) = nan; },
                "element 1: coefficient 3 of function 2 is nan"},
        Refusal{"NoWeight", [](Net&, Elements& e) { e[1].rows(1, 1) = 0.0; },
                "element 1 in Bézier form: weight (1, 0) is 0; weights must be positive"},
        Refusal{"WeightsApart", [](Net&, Elements& e) { e[1].rows(1, 1) = 1e-11; }, "expected a ratio of at most"},
        Refusal{"EmptyDomain",
                [](Net&, Elements& e) {
                  e[1].domain[1] = {2.0, 2.0};
                },
                "element 1: its domain from 2 to 2"}),
    [](const auto& refusal) { return refusal.param.name; });

}  // namespace
}  // namespace isorim::geometry
