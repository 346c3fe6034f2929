#include "solver/bem/added_mass.h"

#include <cmath>
#include <span>
#include <utility>

#include <Eigen/Geometry>

#include "geometry/bezier/element_table.h"
#include "geometry/intersection/clip.h"
#include "geometry/shapes/transforms.h"
#include "solver/bem/boundary_integrals.h"
#include "solver/bem/problem.h"

namespace isorim::solver {
namespace {

using geometry::Boundary;
using geometry::Patch;
using geometry::Point3;
using geometry::Vector3;

/// Faces nearer to the plane than this, relative to the size, lie in it.
constexpr double coincidence = 1e-12;

/// The normal velocity of a unit motion: three translations, three turns about the centre.
double normal_velocity(int motion, const Vector3& arm, const Vector3& normal) {
  return motion < 3 ? normal[motion] : arm.cross(normal)[motion - 3];
}

quadrature::IntegrandFactory<3> velocity_of(int motion, const Point3& centre) {
  return [motion, centre]() -> quadrature::Integrand<3> {
    return [motion, centre](const Eigen::Ref<const geometry::Points<3>>& points,
                            const Eigen::Ref<const geometry::Points<3>>& normals, std::span<double> values) {
      for (Eigen::Index q = 0; q < points.cols(); ++q)
        values[static_cast<std::size_t>(q)] = normal_velocity(motion, points.col(q) - centre, normals.col(q));
    };
  };
}

Problem<3> problem_of(int motion, const FieldSpace<3>& space, const Point3& centre) {
  Problem<3> problem;
  problem.equation = Laplace<3>{};
  problem.exterior = true;
  Condition<3> condition;
  condition.name = "moving body";
  condition.components.push_back({ConditionKind::flux, velocity_of(motion, centre), {}});
  problem.conditions.push_back(std::move(condition));
  problem.condition_of.assign(space.table.elements.size(), 0);
  return problem;
}

}  // namespace

Boundary<3> double_body(const Boundary<3>& solid, double height) {
  const geometry::PlaneTool plane{Point3(0.0, 0.0, height), Vector3::UnitZ()};
  const Boundary<3> under = geometry::clip(solid, plane);
  const double size = geometry::bounding_box(geometry::bezier_elements(under)).diagonal();
  const geometry::AffineMap<3> mirror = geometry::mirroring<3>(plane.point, plane.normal);
  Boundary<3> half;
  for (const Patch<3>& patch : under.patches) {
    const geometry::BoundingBox<3> box = geometry::bounding_box(geometry::bezier_elements(Boundary<3>{{patch}}));
    const bool is_in_plane = std::abs(box.lower.z() - height) <= coincidence * size &&
                             std::abs(box.upper.z() - height) <= coincidence * size;
    if (!is_in_plane) half.patches.push_back(patch);
  }
  Boundary<3> both = half;
  for (Patch<3> image : geometry::transform(half, mirror).patches) {
    image.name += "_image";
    both.patches.push_back(std::move(image));
  }
  return both;
}

AddedMass added_mass(const geometry::OrientedBoundary<3>& boundary, const AddedMassOptions& options) {
  const FieldSpace<3> space = field_space(boundary, options.discretisation);
  EvaluationOptions evaluation;
  evaluation.tolerance = options.solve.tolerance;
  evaluation.threads = options.solve.threads;
  AddedMass result;
  Eigen::Matrix<double, 6, 6> matrix;
  for (int k = 0; k < 6; ++k) {
    const Problem<3> problem = problem_of(k, space, options.centre);
    const Solution<3> solution = solve(problem, space, options.solve);
    result.unknowns = solution.unknowns;
    if (k == 0) result.messages = solution.messages;
    for (int j = 0; j < 6; ++j) {
      const auto make = [&]() -> FieldFunction<3> {
        return [j, centre = options.centre](const quadrature::NodeView<3>& nodes, const Densities& fields,
                                            std::span<double> values) {
          for (std::size_t q = 0; q < values.size(); ++q) {
            const Point3 x(nodes.position[0][q], nodes.position[1][q], nodes.position[2][q]);
            const Vector3 n(nodes.normal[0][q], nodes.normal[1][q], nodes.normal[2][q]);
            values[q] = -fields.potential(static_cast<Eigen::Index>(q), 0) * normal_velocity(j, x - centre, n);
          }
        };
      };
      matrix(k, j) = integrate_fields<3>(problem, space, solution, make, evaluation);
    }
  }
  result.matrix = 0.5 * (matrix + matrix.transpose());
  result.asymmetry = 0.5 * (matrix - matrix.transpose()).cwiseAbs().maxCoeff();
  return result;
}

}  // namespace isorim::solver
