#include "quadrature/element_sums.h"

#include <array>

#include <gtest/gtest.h>

#include "quadrature/element_piece.h"
#include "quadrature/piece_samples.h"
#include "tests/quadrature/random_elements.h"

namespace isorim::quadrature {
namespace {

using testing::random_elements;

/// The sums written down from their definition.
template <int Dim>
ElementSums<Dim> plain_sums(const geometry::ElementTable<Dim>& table, std::size_t e, const geometry::Point<Dim>& pole,
                            const Orders<Dim - 1>& orders) {
  using Layout = SumLayout<Dim>;
  geometry::BezierElement<Dim> element = table.elements[e];
  element.orientation = 1;
  PieceSamples<Dim> samples;
  sample_piece(whole_element(table, element), orders, samples);
  ElementSums<Dim> sums = ElementSums<Dim>::Zero();
  for (Eigen::Index i = 0; i < samples.points.cols(); ++i) {
    const geometry::Vector<Dim> d = samples.points.col(i) - pole;
    const geometry::Vector<Dim> n = samples.weights[static_cast<std::size_t>(i)] * samples.normals.col(i);
    sums[Layout::measure] += n.norm();
    sums[Layout::content] += d.dot(n);
    for (int k = 0; k < Dim; ++k) {
      sums[Layout::normal + k] += n[k];
      sums[Layout::first + k] += d.dot(n) * d[k];
      for (int l = k; l < Dim; ++l) sums[Layout::second_index(k, l)] += d.dot(n) * d[k] * d[l];
    }
  }
  return sums;
}

template <int Dim>
ElementBatch<Dim> batch_of(const geometry::ElementTable<Dim>& table, int size) {
  ElementBatch<Dim> batch;
  batch.size = size;
  for (std::size_t d = 0; d < Dim - 1; ++d) batch.degree[d] = table.elements[0].degree[d];
  batch.polynomial = table.elements[0].polynomial;
  for (int i = 0; i < size; ++i) {
    const auto slot = static_cast<std::size_t>(i);
    batch.nets[slot] = table.net(table.elements[slot]).data();
  }
  return batch;
}

template <int Dim>
void expect_definition(std::array<int, Dim - 1> degree, double largest_weight, const Orders<Dim - 1>& orders) {
  const auto table = random_elements<Dim>(kernel_lanes, degree, largest_weight, 7);
  geometry::Point<Dim> pole = geometry::Point<Dim>::Constant(0.3);
  for (int size = 1; size <= kernel_lanes; ++size) {
    std::array<ElementSums<Dim>, kernel_lanes> sums;
    sum_over_elements<Dim>(batch_of(table, size), pole, orders, sums);
    for (int lane = 0; lane < size; ++lane) {
      const auto e = static_cast<std::size_t>(lane);
      const ElementSums<Dim> expected = plain_sums<Dim>(table, e, pole, orders);
      EXPECT_LT((sums[e] - expected).abs().maxCoeff(), 5e-15) << "degree " << degree[0] << " lane " << lane;
    }
  }
}

TEST(ElementSums, SurfacesFollowTheDefinition) {
  for (const int p : {1, 2, 3, 5}) {
    for (const int q : {1, 2, 4}) {
      expect_definition<3>({p, q}, 1.0, {6, 5});
      expect_definition<3>({p, q}, 5.0, {4, 7});
    }
  }
}

TEST(ElementSums, CurvesFollowTheDefinition) {
  for (const int p : {1, 2, 3, 8}) {
    expect_definition<2>({p}, 1.0, {6});
    expect_definition<2>({p}, 5.0, {9});
  }
}

TEST(ElementSums, DoNotDependOnTheLane) {
  const auto table = random_elements<3>(kernel_lanes, {2, 3}, 3.0, 11);
  std::array<ElementSums<3>, kernel_lanes> together;
  sum_over_elements<3>(batch_of(table, kernel_lanes), geometry::Point3::Zero(), {6, 6}, together);
  for (std::size_t e = 0; e < kernel_lanes; ++e) {
    ElementBatch<3> alone = batch_of(table, 1);
    alone.nets[0] = table.net(table.elements[e]).data();
    std::array<ElementSums<3>, 1> sums;
    sum_over_elements<3>(alone, geometry::Point3::Zero(), {6, 6}, sums);
    EXPECT_TRUE((sums[0] == together[e]).all());
  }
}

TEST(ElementSums, PolynomialAndRationalKernelsAgreeForUnitWeights) {
  const auto table = random_elements<3>(kernel_lanes, {3, 2}, 1.0, 3);
  ElementBatch<3> batch = batch_of(table, kernel_lanes);
  std::array<ElementSums<3>, kernel_lanes> polynomial;
  std::array<ElementSums<3>, kernel_lanes> rational;
  sum_over_elements<3>(batch, geometry::Point3::Zero(), {8, 6}, polynomial);
  batch.polynomial = false;
  sum_over_elements<3>(batch, geometry::Point3::Zero(), {8, 6}, rational);
  for (std::size_t e = 0; e < kernel_lanes; ++e) EXPECT_LT((polynomial[e] - rational[e]).abs().maxCoeff(), 1e-14);
}

/// The exact order is exact, and one point less is not.
template <int Dim>
void expect_exact_order_is_sharp(int degree) {
  std::array<int, Dim - 1> degrees;
  degrees.fill(degree);
  const auto table = random_elements<Dim>(1, degrees, 1.0, 5);
  const auto sums_with = [&](int order) {
    Orders<Dim - 1> orders;
    orders.fill(order);
    std::array<ElementSums<Dim>, 1> sums;
    sum_over_elements<Dim>(batch_of(table, 1), geometry::Point<Dim>::Constant(0.1), orders, sums);
    return sums[0];
  };
  const int order = exact_order<Dim>(degree);
  const ElementSums<Dim> reference = sums_with(order + 12);
  constexpr int tail = SumLayout<Dim>::count - 1;
  EXPECT_LT((sums_with(order) - reference).template tail<tail>().abs().maxCoeff(), 1e-14) << degree;
  EXPECT_GT((sums_with(order - 1) - reference).template tail<tail>().abs().maxCoeff(), 1e-13) << degree;
}

TEST(ElementSums, ExactOrderIsExactAndSharp) {
  for (const int degree : {1, 2, 3, 4}) {
    expect_exact_order_is_sharp<2>(degree);
    expect_exact_order_is_sharp<3>(degree);
  }
}

}  // namespace
}  // namespace isorim::quadrature
