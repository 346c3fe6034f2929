#include "geometry/tspline/tspline.h"

#include <algorithm>
#include <limits>
#include <set>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "tests/geometry/expect_error.h"
#include "tests/geometry/tspline/random_tmeshes.h"

namespace isorim::geometry {
namespace {

using testing::Ends;
using testing::Random;

/// Degrees 1 to 5, odd, even and mixed; inner knots up to `largest` times.
template <class Use>
void for_degrees(unsigned seed, Use&& use) {
  Random random(seed);
  for (int p = 1; p <= 5; ++p)
    for (int q = 1; q <= 5; ++q) use(random, p, q);
}

KnotVector knots_for(Random& random, int degree, Ends ends) {
  KnotVector knots = testing::random_knots(random, degree, ends, random.integer(1, degree + 1));
  while (knots.basis_count() < degree + 4) knots = testing::random_knots(random, degree, ends, 2);
  return knots;
}

/// Analysis-suitable by rejection or, half of them, by refinement.
TMesh suitable_mesh(Random& random, int p, int q, Ends ends) {
  const KnotVector u = knots_for(random, p, ends);
  const KnotVector v = knots_for(random, q, ends);
  TMesh mesh = testing::random_suitable_tmesh(random, u, v);
  if (random.integer(0, 1) == 0) return mesh;
  for (int level = 0; level < 3; ++level) mesh = refine(mesh, testing::random_cuts(random, mesh, 3));
  return mesh;
}

/// The value of an extracted surface at a place of an element's unit cell, by powers of Bernstein polynomials.
Point3 extracted_value(const ExtractedSurface& surface, int element, double s, double t) {
  const HomogeneousPoints<3> net = bezier_net(surface, element);
  const auto& degree = surface.elements()[static_cast<std::size_t>(element)].degree;
  const Eigen::VectorXd u = basis_derivatives(KnotVector::bezier(degree[0]), degree[0], s, 0).row(0);
  const Eigen::VectorXd v = basis_derivatives(KnotVector::bezier(degree[1]), degree[1], t, 0).row(0);
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  for (Eigen::Index j = 0; j < v.size(); ++j)
    for (Eigen::Index i = 0; i < u.size(); ++i) sum += u[i] * v[j] * net.col(i + j * u.size());
  return sum.head<3>() / sum[3];
}

/// The largest distance between direct and extracted values, at random places and corners of all elements.
double extraction_error(Random& random, const TSpline& surface) {
  const ExtractedSurface extracted = extract(surface);
  double error = 0.0;
  for (int e = 0; e < static_cast<int>(extracted.elements().size()); ++e) {
    const auto& domain = extracted.elements()[static_cast<std::size_t>(e)].domain;
    for (int k = 0; k < 5; ++k) {
      const double s = random.real(0.0, 1.0);
      const double t = k == 0 ? 0.0 : random.real(0.0, 1.0);
      const Point2 uv{domain[0].first + s * domain[0].length(), domain[1].first + t * domain[1].length()};
      error = std::max(error, (evaluate(surface, uv) - extracted_value(extracted, e, s, t)).norm());
    }
  }
  return error;
}

TEST(TSpline, WithoutTJunctionsIsTheNurbsSurface) {
  for_degrees(1, [](Random& random, int p, int q) {
    const auto surface =
        testing::random_surface<3>(random, testing::random_knots(random, p), testing::random_knots(random, q));
    const TSpline tspline(surface);
    ASSERT_EQ(tspline.mesh().function_count(), surface.count_u() * surface.count_v());
    for (int k = 0; k < 20; ++k) {
      const Point2 uv = testing::random_parameters(random, tspline.mesh());
      const SurfaceJet<3> expected = evaluate_jet(surface, uv);
      const SurfaceJet<3> jet = evaluate_jet(tspline, uv);
      const double scale = 1.0 + expected.duu.norm() + expected.duv.norm() + expected.dvv.norm();
      EXPECT_LE((jet.point - expected.point).norm(), 1e-13);
      EXPECT_LE((evaluate(tspline, uv) - expected.point).norm(), 1e-13);
      EXPECT_LE((jet.du - expected.du).norm() + (jet.dv - expected.dv).norm(), 1e-13 * scale);
      EXPECT_LE((jet.duu - expected.duu).norm() + (jet.duv - expected.duv).norm() + (jet.dvv - expected.dvv).norm(),
                1e-12 * scale);
    }
  });
}

TEST(TSpline, TakesNurbsLimitsAtKnotsAndBeyondTheDomain) {
  Random random(2);
  const KnotVector knots(2, {0, 0, 0, 1, 1, 1, 2, 2, 2});
  const auto surface = testing::random_surface<3>(random, knots, knots);
  const TSpline tspline(surface);
  for (const double u : {-0.25, 0.0, 1.0, 2.0, 2.5})
    for (const double v : {-0.25, 0.0, 1.0, 2.0, 2.5})
      EXPECT_LE((evaluate(tspline, {u, v}) - evaluate(surface, Point2{u, v})).norm(), 1e-12);
}

TEST(TSpline, ExtractsTheElementsOfANurbsSurfaceInTheirOrder) {
  for_degrees(3, [](Random& random, int p, int q) {
    const auto surface =
        testing::random_surface<3>(random, testing::random_knots(random, p), testing::random_knots(random, q));
    const ExtractedSurface extracted = extract(TSpline(surface));
    const std::vector<ExtractionOperator> u = extraction_operators(surface.knots_u());
    const std::vector<ExtractionOperator> v = extraction_operators(surface.knots_v());
    ASSERT_EQ(extracted.elements().size(), u.size() * v.size());
    for (std::size_t e = 0; e < extracted.elements().size(); ++e) {
      const ExtractionElement& element = extracted.elements()[e];
      const ExtractionOperator& first = u[e % u.size()];
      const ExtractionOperator& second = v[e / u.size()];
      EXPECT_EQ(element.domain[0].first, first.domain.first);
      EXPECT_EQ(element.domain[1].last, second.domain.last);
      ASSERT_EQ(element.functions.size(), static_cast<std::size_t>((p + 1) * (q + 1)));
      for (int row = 0; row < (p + 1) * (q + 1); ++row) {
        const int i = row % (p + 1);
        const int j = row / (p + 1);
        EXPECT_EQ(element.functions[static_cast<std::size_t>(row)],
                  first.first_function + i + (second.first_function + j) * surface.count_u());
        const Eigen::MatrixXd expected = first.matrix.row(i).transpose() * second.matrix.row(j);
        EXPECT_LE((element.rows.row(row).transpose() - expected.reshaped()).cwiseAbs().maxCoeff(), 1e-14);
      }
    }
  });
}

TEST(TSpline, ExtractionEqualsDirectEvaluationOnAnyMesh) {
  for_degrees(4, [](Random& random, int p, int q) {
    for (int trial = 0; trial < 4; ++trial) {
      const Ends ends = trial % 2 == 0 ? Ends::clamped : Ends::unclamped;
      const KnotVector u = knots_for(random, p, ends);
      const TMesh mesh = testing::random_tmesh(random, u, knots_for(random, q, ends));
      EXPECT_LE(extraction_error(random, testing::random_tspline(random, mesh)), 1e-13) << p << ' ' << q;
    }
  });
}

TEST(TSpline, SuitableFunctionsSumToOneAndExtractExactly) {
  int with_junctions = 0;
  for_degrees(5, [&](Random& random, int p, int q) {
    for (int trial = 0; trial < 4; ++trial) {
      const TMesh mesh = suitable_mesh(random, p, q, trial % 2 == 0 ? Ends::clamped : Ends::unclamped);
      with_junctions += mesh.index_mesh().t_junctions().empty() ? 0 : 1;
      const TSpline surface = testing::random_tspline(random, mesh);
      for (int k = 0; k < 20; ++k)
        EXPECT_NEAR(function_values(mesh, testing::random_parameters(random, mesh)).sum(), 1.0, 1e-13) << p << q;
      for (const double defect : partition_defects(extract(surface))) EXPECT_LE(defect, 1e-13) << p << q;
      EXPECT_LE(extraction_error(random, surface), 1e-13) << p << q;
    }
  });
  EXPECT_GE(with_junctions, 60);
}

/// Rows of all elements under each other: full column rank is linear independence.
Eigen::MatrixXd stacked_rows(const TMesh& mesh) {
  const std::vector<ExtractionElement> elements = extraction_elements(mesh);
  const Eigen::Index length = elements.front().rows.cols();
  Eigen::MatrixXd stack =
      Eigen::MatrixXd::Zero(length * static_cast<Eigen::Index>(elements.size()), mesh.function_count());
  for (std::size_t e = 0; e < elements.size(); ++e)
    for (std::size_t k = 0; k < elements[e].functions.size(); ++k)
      stack.col(elements[e].functions[k]).segment(static_cast<Eigen::Index>(e) * length, length) =
          elements[e].rows.row(static_cast<Eigen::Index>(k));
  return stack;
}

TEST(TSpline, SuitableFunctionsAreLinearlyIndependent) {
  for_degrees(6, [](Random& random, int p, int q) {
    if (p > 4 || q > 4) return;
    const TMesh mesh = suitable_mesh(random, p, q, Ends::clamped);
    Eigen::MatrixXd stack = stacked_rows(mesh);
    stack.colwise().normalize();
    const Eigen::MatrixXd gram = stack.transpose() * stack;
    const Eigen::VectorXd squared =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(gram, Eigen::EigenvaluesOnly).eigenvalues();
    EXPECT_GT(squared.minCoeff(), 1e-12 * squared.maxCoeff()) << p << ' ' << q;
  });
}

TEST(TSpline, DerivativesMatchFiniteDifferencesBesideTJunctions) {
  Random random(7);
  const KnotVector knots = KnotVector::clamped_uniform(3, 6);
  const TMesh mesh = testing::random_suitable_tmesh(random, knots, knots);
  const TSpline surface = testing::random_tspline(random, mesh);
  const double h = 1e-5;
  for (int k = 0; k < 50; ++k) {
    const Point2 uv{random.real(0.01, 0.99), random.real(0.01, 0.99)};
    const SurfaceJet<3> jet = evaluate_jet(surface, uv);
    const SurfaceJet<3> right = evaluate_jet(surface, {uv[0] + h, uv[1]});
    const SurfaceJet<3> left = evaluate_jet(surface, {uv[0] - h, uv[1]});
    const SurfaceJet<3> above = evaluate_jet(surface, {uv[0], uv[1] + h});
    const SurfaceJet<3> below = evaluate_jet(surface, {uv[0], uv[1] - h});
    const double scale = 1.0 + jet.duu.norm() + jet.duv.norm() + jet.dvv.norm();
    EXPECT_LE(((right.point - left.point) / (2 * h) - jet.du).norm(), 1e-5 * scale);
    EXPECT_LE(((above.point - below.point) / (2 * h) - jet.dv).norm(), 1e-5 * scale);
    EXPECT_LE(((right.du - left.du) / (2 * h) - jet.duu).norm(), 1e-2 * scale);
    EXPECT_LE(((above.du - below.du) / (2 * h) - jet.duv).norm(), 1e-2 * scale);
    EXPECT_LE(((above.dv - below.dv) / (2 * h) - jet.dvv).norm(), 1e-2 * scale);
  }
}

TEST(TSpline, IsAffinelyInvariant) {
  Random random(8);
  const TMesh mesh = suitable_mesh(random, 3, 2, Ends::clamped);
  const TSpline surface = testing::random_tspline(random, mesh);
  AffineMap<3> map;
  map.linear << 1, 2, 0, -1, 0.5, 3, 0, 1, -2;
  map.translation << 3, -4, 5;
  const TSpline moved = transform(surface, map);
  for (int k = 0; k < 30; ++k) {
    const Point2 uv = testing::random_parameters(random, mesh);
    EXPECT_LE((evaluate(moved, uv) - map(evaluate(surface, uv))).norm(), 1e-13);
  }
}

/// The rectangles of the mesh with its face extensions, found by joining cells that no edge divides.
using Rectangle = std::array<double, 4>;
std::vector<Rectangle> extended_rectangles(const TMesh& mesh) {
  const IndexMesh& lines = mesh.index_mesh();
  std::set<std::array<int, 3>> extended;
  for (const TJunction& junction : lines.t_junctions()) {
    const Extension extension = lines.extension(junction);
    const auto [first, last] = std::minmax(junction.at[index(junction.along)], extension.ahead);
    const Direction d = other(junction.along);
    for (int cell = first; cell < last; ++cell)
      extended.insert({static_cast<int>(index(d)), junction.at[index(d)], cell});
  }
  const auto divided = [&](Direction d, int line, int cell) {
    return lines.has_edge(d, line, cell) || extended.contains({static_cast<int>(index(d)), line, cell});
  };
  const IndexBox domain = lines.domain();
  std::vector<Rectangle> result;
  for (int j = domain.first[1]; j < domain.last[1]; ++j) {
    for (int i = domain.first[0]; i < domain.last[0]; ++i) {
      if (!divided(Direction::u, i, j) || !divided(Direction::v, j, i)) continue;
      int right = i + 1;
      int top = j + 1;
      while (!divided(Direction::u, right, j)) ++right;
      while (!divided(Direction::v, top, i)) ++top;
      const Rectangle r{mesh.knots(Direction::v)[j], mesh.knots(Direction::u)[i], mesh.knots(Direction::v)[top],
                        mesh.knots(Direction::u)[right]};
      if (r[0] < r[2] && r[1] < r[3]) result.push_back(r);
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

TEST(TSpline, BezierMeshOfASuitableMeshIsTheMeshWithItsFaceExtensions) {
  for_degrees(9, [](Random& random, int p, int q) {
    for (int trial = 0; trial < 3; ++trial) {
      const TMesh mesh = suitable_mesh(random, p, q, Ends::clamped);
      std::vector<Rectangle> cells;
      for (const BezierCell& cell : bezier_mesh(mesh))
        cells.push_back({cell.domain[1].first, cell.domain[0].first, cell.domain[1].last, cell.domain[0].last});
      std::sort(cells.begin(), cells.end());
      EXPECT_EQ(cells, extended_rectangles(mesh)) << p << ' ' << q;
    }
  });
}

TEST(TSpline, RefusesWhatIsNoSurface) {
  const KnotVector knots = KnotVector::bezier(1);
  Points<3> points(3, 4);
  points << 0, 1, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0;
  const TMesh mesh(knots, knots);
  EXPECT_GEOMETRY_ERROR(TSpline::from_points(mesh, points.leftCols(3)), "3 control points given; the T-mesh has 4");
  const std::vector<double> weights{1, 1, -1, 1};
  EXPECT_GEOMETRY_ERROR(TSpline::from_points(mesh, points, weights), "weight 2 (anchor at u = 0, v = 1) is -1");
  points(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_GEOMETRY_ERROR(TSpline::from_points(mesh, points), "coordinate y of control point 1 (anchor at u = 1, v = 0)");
}

}  // namespace
}  // namespace isorim::geometry
