#include "solver/bem/added_mass.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "geometry/bezier/element_table.h"
#include "geometry/errors.h"
#include "geometry/intersection/clip.h"
#include "geometry/shapes/transforms.h"
#include "geometry/topology/outer_shells.h"
#include "solver/bem/boundary_integrals.h"
#include "solver/bem/problem.h"
#include "solver/properties.h"

namespace isorim::solver {
namespace {

using geometry::Boundary;
using geometry::OrientedBoundary;
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

/// Of one discretisation; not symmetric.
struct RawAddedMass {
  AddedMass::Matrix matrix;
  std::size_t unknowns = 0;
  std::string method;
};

/// - int phi v_j dS for all motions j.
Eigen::Matrix<double, 1, 6> impulse(const Problem<3>& problem, const FieldSpace<3>& space, const Solution<3>& solution,
                                    const Point3& centre, const EvaluationOptions& evaluation) {
  const auto make = [&]() -> FieldFunction<3> {
    return [centre](const quadrature::NodeView<3>& nodes, const Densities& fields, std::span<double> values) {
      const std::size_t count = nodes.size();
      for (std::size_t q = 0; q < count; ++q) {
        const Point3 x(nodes.position[0][q], nodes.position[1][q], nodes.position[2][q]);
        const Vector3 n(nodes.normal[0][q], nodes.normal[1][q], nodes.normal[2][q]);
        for (std::size_t j = 0; j < 6; ++j)
          values[j * count + q] =
              -fields.potential(static_cast<Eigen::Index>(q), 0) * normal_velocity(static_cast<int>(j), x - centre, n);
      }
    };
  };
  return integrate_fields<3>(problem, space, solution, 6, make, evaluation).transpose();
}

RawAddedMass solve_motions(const OrientedBoundary<3>& boundary, const AddedMassOptions& options) {
  DiscretisationOptions<3> discretisation;
  discretisation.degree = options.degree;
  discretisation.refine = options.refine;
  const FieldSpace<3> space = field_space(graded_to_edges(boundary, options.edges), discretisation);
  std::vector<Problem<3>> problems;
  for (int k = 0; k < 6; ++k) problems.push_back(problem_of(k, space, options.centre));
  const std::vector<Solution<3>> solutions = solve_all<3>(problems, space, options.solve);
  EvaluationOptions evaluation;
  evaluation.tolerance = options.solve.tolerance;
  evaluation.threads = options.solve.threads;
  RawAddedMass result;
  result.unknowns = solutions.front().unknowns;
  result.method = solutions.front().method;
  for (int k = 0; k < 6; ++k) {
    const auto index = static_cast<std::size_t>(k);
    result.matrix.row(k) = impulse(problems[index], space, solutions[index], options.centre, evaluation);
  }
  return result;
}

/// Steiner: from the inertia about the centroid to that about the centre.
void set_displaced(const OrientedBoundary<3>& boundary, const AddedMassOptions& options, AddedMass& result) {
  PropertyOptions<3> property_options;
  property_options.integration.threads = options.solve.threads;
  const auto properties = geometric_properties<3>(geometry::bezier_elements(boundary.boundary), property_options);
  const DomainProperties<3>& displaced = *properties.domain;
  const Vector3 arm = displaced.centroid - options.centre;
  result.volume = displaced.measure.value;
  result.inertia =
      displaced.inertia + result.volume * (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());
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

Eigen::Matrix<double, 6, 1> AddedMass::coefficients() const {
  Eigen::Matrix<double, 6, 1> result;
  for (int i = 0; i < 6; ++i) {
    const double displaced = i < 3 ? volume : inertia(i - 3, i - 3);
    result[i] = displaced > 0.0 ? matrix(i, i) / displaced : 0.0;
  }
  return result;
}

AddedMass added_mass(const OrientedBoundary<3>& solid, const AddedMassOptions& options) {
  if (options.refine < 1)
    throw InputError(fmt::format("found {} bisections for added masses; expected 1 or more", options.refine));
  const OrientedBoundary<3> boundary = geometry::outer_shells(solid);
  const RawAddedMass fine = solve_motions(boundary, options);
  AddedMassOptions less = options;
  --less.refine;
  const RawAddedMass coarse = solve_motions(boundary, less);

  AddedMass result;
  result.matrix = 0.5 * (fine.matrix + fine.matrix.transpose());
  const AddedMass::Matrix from_coarse = result.matrix - 0.5 * (coarse.matrix + coarse.matrix.transpose());
  result.error = from_coarse.cwiseAbs() + 0.5 * (fine.matrix - fine.matrix.transpose()).cwiseAbs();
  result.unknowns = fine.unknowns;
  result.method = fine.method;
  set_displaced(boundary, options, result);
  return result;
}

}  // namespace isorim::solver
