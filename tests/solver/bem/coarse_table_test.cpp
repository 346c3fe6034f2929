#include "solver/bem/coarse_table.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/bezier/element_jet.h"
#include "geometry/intersection/clip.h"
#include "geometry/shapes/regions.h"
#include "geometry/shapes/solids.h"
#include "geometry/topology/orientation.h"
#include "solver/bem/domain_load.h"
#include "solver/bem/field_space.h"
#include "tests/solver/bem/exact_fields.h"

namespace isorim::solver {
namespace {

using geometry::Boundary;
using geometry::Point;
using geometry::Point3;
using geometry::Vector3;
using quadrature::Target;

template <int Dim>
FieldSpace<Dim> refined_space(const Boundary<Dim>& boundary, int refine) {
  DiscretisationOptions<Dim> options;
  options.degree = 2;
  options.refine = refine;
  return field_space(geometry::orient(boundary), options);
}

/// The largest distance between places on fine elements and the same places on coarse ones.
template <int Dim>
double largest_shift(const FieldSpace<Dim>& space) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  double largest = 0.0;
  for (std::size_t e = 0; e < space.table.elements.size(); ++e) {
    Target<Dim> fine;
    fine.element = static_cast<int>(e);
    for (Eigen::Index d = 0; d < Dim - 1; ++d) fine.place[d] = unit(generator);
    const auto here = geometry::evaluate_jet<Dim>(space.table, space.table.elements[e], fine.place);
    fine.position = here.position;
    const Target<Dim> coarse = space.coarse->target(fine);
    const auto& table = space.coarse->table();
    const auto there =
        geometry::evaluate_jet<Dim>(table, table.elements[static_cast<std::size_t>(coarse.element)], coarse.place);
    largest = std::max(largest, (here.position - there.position).norm());
  }
  return largest;
}

TEST(CoarseTable, TargetsStayWhereTheyAre) {
  const FieldSpace<2> disc = refined_space(geometry::disc(2.0), 3);
  EXPECT_EQ(disc.coarse->table().elements.size(), 4U);
  EXPECT_LT(largest_shift(disc), 1e-14);
  const FieldSpace<3> torus = refined_space(geometry::torus(2.0, 0.5), 2);
  EXPECT_EQ(torus.coarse->table().elements.size() * 16U, torus.table.elements.size());
  EXPECT_LT(largest_shift(torus), 1e-14);
}

TEST(CoarseTable, KeepsCutElementsAsTheyAre) {
  const geometry::CylinderTool tool{{1.0, 0.9, 0.0}, {0.0, 0.0, 1.0}, 0.4, geometry::KeptSide::outside};
  const FieldSpace<3> block = refined_space(geometry::clip(geometry::box({2.0, 2.0, 1.0}), tool), 2);
  ASSERT_NE(block.coarse, nullptr);
  EXPECT_LT(block.coarse->table().elements.size(), block.table.elements.size());
  EXPECT_LT(largest_shift(block), 1e-14);
  std::size_t cut = 0;
  for (const auto& element : block.table.elements) cut += element.is_cut() ? 1U : 0U;
  for (const auto& element : block.coarse->table().elements) cut -= element.is_cut() ? 1U : 0U;
  EXPECT_EQ(cut, 0U);
}

TEST(CoarseTable, IsNotThereWithoutRefinement) {
  EXPECT_EQ(refined_space(geometry::disc(1.0), 0).coarse, nullptr);
}

/// Potentials of a source with and without the coarse table; relative to the largest.
double difference(const Boundary<3>& boundary) {
  const FieldSpace<3> space = refined_space(boundary, 2);
  const Laplace<3> kernel{1.0};
  const auto source = [](const Point3& z, const Vector3&) {
    return std::exp(z[0] - 0.5 * z[1]) * std::cos(2.0 * z[2]);
  };
  const Loads<3> loads{expression_load(kernel, {testing::integrand<3>(source)}, space.table)};
  std::vector<Target<3>> targets;
  for (std::size_t i = 0; i < space.points.size(); i += 7)
    targets.push_back({space.points[i].position, space.points[i].element, space.points[i].place});
  const quadrature::TargetRules<3> rules(space.table, {1e-11, 2});
  const Eigen::MatrixXd fine = domain_potentials<3>(loads, space.table, rules, targets);
  const Eigen::MatrixXd coarse = domain_potentials<3>(loads, space.table, rules, targets, {}, space.coarse.get());
  return (fine - coarse).cwiseAbs().maxCoeff() / fine.cwiseAbs().maxCoeff();
}

TEST(CoarseTable, GivesTheSamePotentials) {
  EXPECT_LT(difference(geometry::sphere(1.0)), 1e-10);
  const geometry::CylinderTool tool{{0.5, 0.5, 0.0}, {0.0, 0.0, 1.0}, 0.2, geometry::KeptSide::outside};
  EXPECT_LT(difference(geometry::clip(geometry::box({1.0, 1.0, 1.0}), tool)), 1e-10);
}

}  // namespace
}  // namespace isorim::solver
