#include "solver/bem/rigid_motion.h"

#include <cstddef>

#include <Eigen/SVD>
#include <fmt/format.h>

#include "geometry/bezier/element_table.h"

namespace isorim::solver {

namespace {

/// All motions that a field may make without strain, lengths measured by `size`.
template <int Dim>
std::vector<RigidMotion<Dim>> all_motions(int components, bool with_rotations, const geometry::Point<Dim>& centre,
                                          double size) {
  std::vector<RigidMotion<Dim>> motions;
  for (int c = 0; c < components; ++c) {
    RigidMotion<Dim>& motion = motions.emplace_back();
    motion.translation[c] = 1.0;
    motion.centre = centre;
  }
  if (components == 1 || !with_rotations) return motions;
  for (int i = 0; i < Dim; ++i) {
    for (int j = i + 1; j < Dim; ++j) {
      RigidMotion<Dim>& motion = motions.emplace_back();
      motion.spin(i, j) = -2.0 / size;
      motion.spin(j, i) = 2.0 / size;
      motion.centre = centre;
    }
  }
  return motions;
}

template <int Dim>
RigidMotion<Dim> combine(const std::vector<RigidMotion<Dim>>& motions, const Eigen::VectorXd& factors) {
  RigidMotion<Dim> sum;
  sum.centre = motions.front().centre;
  for (std::size_t m = 0; m < motions.size(); ++m) {
    sum.translation += factors[static_cast<Eigen::Index>(m)] * motions[m].translation;
    sum.spin += factors[static_cast<Eigen::Index>(m)] * motions[m].spin;
  }
  return sum;
}

/// Orthonormal columns that span what all rows annihilate.
Eigen::MatrixXd null_space(const std::vector<Eigen::VectorXd>& rows, Eigen::Index columns) {
  if (rows.empty()) return Eigen::MatrixXd::Identity(columns, columns);
  Eigen::MatrixXd stacked(static_cast<Eigen::Index>(rows.size()), columns);
  for (std::size_t i = 0; i < rows.size(); ++i) stacked.row(static_cast<Eigen::Index>(i)) = rows[i].transpose();
  const Eigen::JacobiSVD<Eigen::MatrixXd, Eigen::FullPivHouseholderQRPreconditioner> svd(stacked, Eigen::ComputeFullV);
  const Eigen::VectorXd& values = svd.singularValues();
  Eigen::Index rank = 0;
  while (rank < values.size() && values[rank] > 1e-8 * values[0]) ++rank;
  return svd.matrixV().rightCols(columns - rank);
}

template <int Dim>
std::string place_text(const geometry::Vector<Dim>& v) {
  std::string text;
  for (int d = 0; d < Dim; ++d) text += fmt::format("{}{:.6g}", d == 0 ? "" : ", ", v[d] + 0.0);
  return "(" + text + ")";
}

}  // namespace

namespace {

template <int Dim>
geometry::BoundingBox<Dim> box_of(const FieldSpace<Dim>& space, std::int32_t body) {
  geometry::ElementTable<Dim> part{{}, space.table.nets, space.table.regions};
  for (int e = 0; e < static_cast<int>(space.table.elements.size()); ++e)
    if (body < 0 || space.body_of(e) == body)
      part.elements.push_back(space.table.elements[static_cast<std::size_t>(e)]);
  return geometry::bounding_box(part);
}

/// Of one body, or of all as one.
template <int Dim>
void append_free_motions(const Problem<Dim>& problem, const FieldSpace<Dim>& space, std::int32_t body,
                         std::vector<RigidMotion<Dim>>& result) {
  const int components = component_count(problem.equation);
  const geometry::BoundingBox<Dim> box = box_of(space, body);
  const auto motions = all_motions<Dim>(components, !problem.exterior, box.middle(), box.diagonal());
  std::vector<Eigen::VectorXd> rows;
  for (const CollocationPoint<Dim>& point : space.points) {
    if (body >= 0 && space.body_of(point.element) != body) continue;
    const auto index = static_cast<std::size_t>(problem.condition_of[static_cast<std::size_t>(point.element)]);
    const Condition<Dim>& condition = problem.conditions[index];
    for (int c = 0; c < components; ++c) {
      if (condition.components[static_cast<std::size_t>(c)].kind == ConditionKind::flux) continue;
      const geometry::Vector<Dim> axis = component_axis(condition, c);
      Eigen::VectorXd& row = rows.emplace_back(static_cast<Eigen::Index>(motions.size()));
      for (std::size_t m = 0; m < motions.size(); ++m)
        row[static_cast<Eigen::Index>(m)] = axis.dot(motions[m](point.position));
    }
  }
  const Eigen::MatrixXd free = null_space(rows, static_cast<Eigen::Index>(motions.size()));
  for (Eigen::Index k = 0; k < free.cols(); ++k) {
    result.push_back(combine<Dim>(motions, free.col(k)));
    result.back().body = body;
  }
}

}  // namespace

template <int Dim>
std::vector<RigidMotion<Dim>> free_motions(const Problem<Dim>& problem, const FieldSpace<Dim>& space) {
  std::vector<RigidMotion<Dim>> result;
  if (problem.exterior || space.body_count() == 1) {
    append_free_motions<Dim>(problem, space, -1, result);
    return result;
  }
  for (std::int32_t body = 0; body < space.body_count(); ++body) append_free_motions<Dim>(problem, space, body, result);
  return result;
}

template <int Dim>
std::string describe(const RigidMotion<Dim>& motion, int components) {
  if (components == 1) return "the constant";
  if (motion.spin.norm() == 0.0) return "translation along " + place_text<Dim>(motion.translation.normalized());
  if constexpr (Dim == 3) {
    const geometry::Vector<3> turn(motion.spin(2, 1), motion.spin(0, 2), motion.spin(1, 0));
    if (motion.translation.norm() == 0.0) return "rotation about " + place_text<3>(turn.normalized());
  } else if (motion.translation.norm() == 0.0) {
    return "rotation about " + place_text<2>(motion.centre);
  }
  return "a rigid motion";
}

template std::vector<RigidMotion<2>> free_motions<2>(const Problem<2>&, const FieldSpace<2>&);
template std::vector<RigidMotion<3>> free_motions<3>(const Problem<3>&, const FieldSpace<3>&);
template std::string describe<2>(const RigidMotion<2>&, int);
template std::string describe<3>(const RigidMotion<3>&, int);

}  // namespace isorim::solver
