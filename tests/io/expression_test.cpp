#include "io/expression.h"

#include <cmath>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"

namespace isorim::io {
namespace {

using ::testing::HasSubstr;

geometry::Points<3> some_points(int count) {
  geometry::Points<3> points(3, count);
  for (int i = 0; i < count; ++i) points.col(i) << 0.1 * i, 1.0 - 0.2 * i, 0.5 + 0.01 * i * i;
  return points;
}

std::string message(const std::string& text, ExpressionScope scope = ExpressionScope::domain) {
  try {
    compile_integrand<3>(text, scope);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Expression, EvaluatesEveryPoint) {
  const auto f = compile_integrand<3>("x^2 + y*sin(pi*z) - e", ExpressionScope::domain)();
  const geometry::Points<3> points = some_points(50);
  std::vector<double> values(50);
  f(points, geometry::Points<3>(3, 0), values);
  for (int i = 0; i < 50; ++i) {
    const geometry::Point3 p = points.col(i);
    EXPECT_NEAR(values[i], p.x() * p.x() + p.y() * std::sin(M_PI * p.z()) - M_E, 1e-14);
  }
}

TEST(Expression, KnowsTheNormalOnABoundary) {
  const auto f = compile_integrand<2>("x*nx + y*ny", ExpressionScope::boundary)();
  geometry::Points<2> points(2, 2);
  geometry::Points<2> normals(2, 2);
  points << 1, 2, 3, 4;
  normals << 5, 6, 7, 8;
  std::vector<double> values(2);
  f(points, normals, values);
  EXPECT_EQ(values[0], 1.0 * 5 + 3 * 7);
  EXPECT_EQ(values[1], 2.0 * 6 + 4 * 8);
}

TEST(Expression, FactoryServesThreadsIndependently) {
  const auto factory = compile_integrand<3>("exp(x) / (1 + y^2) + z", ExpressionScope::domain);
  const geometry::Points<3> points = some_points(2000);
  std::vector<double> expected(2000);
  factory()(points, geometry::Points<3>(3, 0), expected);
  std::vector<std::vector<double>> found(4, std::vector<double>(2000));
  std::vector<std::thread> threads;
  for (auto& values : found) {
    threads.emplace_back([&] { factory()(points, geometry::Points<3>(3, 0), values); });
  }
  for (std::thread& thread : threads) thread.join();
  for (const auto& values : found) EXPECT_EQ(values, expected);
}

TEST(Expression, ComparisonsAreNoAssignments) {
  EXPECT_EQ(message("x == 1 ? 2 : 3"), "");
  EXPECT_EQ(message("x <= y && y != z || x >= 1"), "");
  EXPECT_THAT(message("x = 1"), HasSubstr("at character 3: found an assignment"));
}

TEST(Expression, FaultsAreLocated) {
  EXPECT_THAT(message("1 + foo(3)"), HasSubstr("at character 5: found the unknown name \"foo\""));
  EXPECT_THAT(message("x * (y"), HasSubstr("Missing parenthesis"));
  EXPECT_THAT(message("x y"), HasSubstr("at character 3"));
  EXPECT_THAT(message("x, y"), HasSubstr("found 2 expressions"));
  EXPECT_THAT(message(" "), HasSubstr("found an empty expression"));
  EXPECT_THAT(message("x +"), HasSubstr("at the end of \"x +\""));
  EXPECT_THAT(message("x + nx"), HasSubstr("at character 5: found \"nx\", the normal, which only a boundary has"));
  EXPECT_EQ(message("x + nx", ExpressionScope::boundary), "");
}

TEST(Definitions, StandForTheirExpressionsEverywhere) {
  const Definitions definitions{{"a", "2"}, {"b", "3*a"}, {"r", "sqrt(x^2 + y^2)"}, {"s", "b*r"}};
  const auto f = compile_integrand<2>("s + r/a + nx", ExpressionScope::boundary, definitions)();
  geometry::Points<2> points(2, 2);
  geometry::Points<2> normals(2, 2);
  points << 3, 0, 4, 2;
  normals << 7, 8, 0, 0;
  std::vector<double> values(2);
  f(points, normals, values);
  EXPECT_EQ(values[0], 30.0 + 2.5 + 7.0);
  EXPECT_EQ(values[1], 12.0 + 1.0 + 8.0);
}

TEST(Definitions, AreConstantIfNoCoordinatePlaysAPart) {
  const Definitions definitions{{"a", "2"}, {"b", "3*a"}, {"r", "a*x"}};
  EXPECT_EQ(constant_value("b + 1", 2, definitions), 7.0);
  EXPECT_EQ(constant_value("b + y", 2, definitions), std::nullopt);
  EXPECT_EQ(constant_value("r", 2, definitions), std::nullopt);
}

TEST(NamedFunction, TakesItsVariablesInOrder) {
  const auto f = compile_function("u*nx + c*q", {"x", "y", "nx", "ny", "u", "q"}, 2, {{"c", "x + 10"}})();
  EXPECT_EQ(f(std::vector<double>{1, 2, 3, 4, 5, 6}), 15.0 + 66.0);
}

}  // namespace
}  // namespace isorim::io
