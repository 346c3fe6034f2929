#include "io/analysis/sampling.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <variant>

#include "io/analysis/analysis.h"
#include "io/analysis/points.h"
#include "solver/bem/evaluation.h"
#include "solver/bem/stress.h"

namespace isorim::io {
namespace {

/// xx, yy, zz, xy[, yz, xz]: in the plane the last two vanish.
template <int Dim>
Eigen::VectorXd stress_entries(const Eigen::Matrix3d& s) {
  if constexpr (Dim == 2) return Eigen::Vector4d(s(0, 0), s(1, 1), s(2, 2), s(0, 1));
  Eigen::VectorXd entries(6);
  entries << s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2);
  return entries;
}

template <int Dim>
void store(const solver::PointEvaluation<Dim>& found, Eigen::Index i, FieldSamples& samples) {
  samples.location[static_cast<std::size_t>(i)] = found.location == solver::Location::inside        ? 1
                                                  : found.location == solver::Location::on_boundary ? 0
                                                                                                    : -1;
  if (found.location == solver::Location::outside) return;
  samples.value.col(i) = found.field.value;
  const Eigen::Index components = found.field.gradient.rows();
  for (Eigen::Index c = 0; c < components; ++c) {
    samples.gradient.col(i).segment(c * Dim, Dim) = found.field.gradient.row(c).transpose();
  }
  if (!samples.is_elastic()) return;
  const Eigen::Matrix3d stress = full_stress(found.field);
  samples.stress.col(i) = stress_entries<Dim>(stress);
  samples.von_mises[i] = solver::von_mises(stress);
  samples.principal.col(i) = solver::principal_stresses(stress).reverse();
}

template <int Dim>
FieldSamples sample_points(const BoundaryValueProblem<Dim>& setting, const solver::Solution<Dim>& solution,
                           std::string name, const Eigen::MatrixXd& points, int threads) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const Eigen::Index count = points.cols();
  const bool is_elastic = std::holds_alternative<solver::Elasticity<Dim>>(setting.problem.equation);
  const int components = is_elastic ? Dim : 1;
  const Eigen::Index stress_rows = is_elastic ? (Dim == 2 ? 4 : 6) : 0;
  FieldSamples samples;
  samples.name = std::move(name);
  samples.points = points;
  samples.location.resize(static_cast<std::size_t>(count));
  samples.value = Eigen::MatrixXd::Constant(components, count, none);
  samples.gradient = Eigen::MatrixXd::Constant(Eigen::Index{components} * Dim, count, none);
  samples.stress = Eigen::MatrixXd::Constant(stress_rows, count, none);
  if (stress_rows > 0) {
    samples.von_mises = Eigen::VectorXd::Constant(count, none);
    samples.principal = Eigen::MatrixXd::Constant(3, count, none);
  }
  const geometry::Points<Dim> places = points;
  const std::vector<solver::PointEvaluation<Dim>> found =
      solver::evaluate_at<Dim>(setting.problem, setting.space, solution, places, {.threads = threads});
  for (Eigen::Index i = 0; i < count; ++i) store(found[static_cast<std::size_t>(i)], i, samples);
  return samples;
}

}  // namespace

std::size_t FieldSamples::outside_count() const {
  return static_cast<std::size_t>(std::count(location.begin(), location.end(), static_cast<signed char>(-1)));
}

template <int Dim>
std::vector<FieldSamples> sample_probes(const CaseFile& file, const BoundaryValueProblem<Dim>& setting,
                                        const solver::Solution<Dim>& solution, int threads) {
  std::vector<FieldSamples> list;
  for (const ProbeKeys& keys : file.keys.probe) {
    const Eigen::MatrixXd points = probe_points(keys, Dim, file.path.parent_path());
    list.push_back(sample_points<Dim>(setting, solution, keys.name, points, threads));
    list.back().is_line = keys.from.has_value();
  }
  return list;
}

template <int Dim>
std::vector<FieldSamples> sample_grids(const CaseFile& file, const BoundaryValueProblem<Dim>& setting,
                                       const solver::Solution<Dim>& solution, int threads) {
  std::vector<FieldSamples> list;
  for (const GridKeys& keys : file.keys.grid) {
    const ImageShape shape = grid_shape(keys, Dim);
    list.push_back(sample_points<Dim>(setting, solution, keys.name, grid_points(shape, Dim), threads));
    list.back().image = shape;
  }
  return list;
}

template std::vector<FieldSamples> sample_probes(const CaseFile&, const BoundaryValueProblem<2>&,
                                                 const solver::Solution<2>&, int);
template std::vector<FieldSamples> sample_probes(const CaseFile&, const BoundaryValueProblem<3>&,
                                                 const solver::Solution<3>&, int);
template std::vector<FieldSamples> sample_grids(const CaseFile&, const BoundaryValueProblem<2>&,
                                                const solver::Solution<2>&, int);
template std::vector<FieldSamples> sample_grids(const CaseFile&, const BoundaryValueProblem<3>&,
                                                const solver::Solution<3>&, int);

}  // namespace isorim::io
