#include "io/analysis/solution_errors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include <Eigen/Core>
#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/analysis/boundary_field.h"
#include "io/case/analysis_checks.h"
#include "solver/bem/bodies.h"
#include "solver/bem/rigid_motion.h"

namespace isorim::io {
namespace {

/// Several expressions as the rows of a matrix; a missing one is zero.
template <int Dim>
class ExactField {
 public:
  ExactField(const std::vector<std::optional<ExpressionText>>& texts, ExpressionScope scope, const CaseFile& file) {
    for (const std::optional<ExpressionText>& text : texts) {
      rows_.push_back(text ? compile_integrand<Dim>(text->text, scope, file.definitions)()
                           : quadrature::Integrand<Dim>());
      texts_.push_back(text.value_or(ExpressionText{}));
    }
  }

  /// rows x points.
  Eigen::MatrixXd operator()(const geometry::Points<Dim>& points, const geometry::Points<Dim>& normals) const {
    Eigen::MatrixXd values = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows_.size()), points.cols());
    std::vector<double> row(static_cast<std::size_t>(points.cols()));
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (!rows_[i]) continue;
      rows_[i](points, normals, row);
      require_finite(i, row, points);
      values.row(static_cast<Eigen::Index>(i)) = Eigen::Map<const Eigen::RowVectorXd>(row.data(), points.cols());
    }
    return values;
  }

 private:
  void require_finite(std::size_t i, const std::vector<double>& values, const geometry::Points<Dim>& points) const {
    const auto bad = std::ranges::find_if_not(values, [](double x) { return std::isfinite(x); });
    if (bad == values.end()) return;
    const geometry::Point<Dim> place = points.col(bad - values.begin());
    throw InputError(fmt::format("{}: {}: {} is {} at ({}); expected a finite number", texts_[i].where.place.describe(),
                                 texts_[i].where.path, texts_[i].text, *bad,
                                 fmt::join(place.begin(), place.end(), ", ")));
  }

  std::vector<quadrature::Integrand<Dim>> rows_;
  std::vector<ExpressionText> texts_;
};

template <int Dim>
std::vector<std::optional<ExpressionText>> axes_of(const ComponentTexts& texts) {
  return {texts.axes.begin(), texts.axes.begin() + Dim};
}

/// xx, yy[, zz], xy[, yz, xz].
template <int Dim>
std::vector<std::optional<ExpressionText>> tensor_of(const TensorTexts& texts) {
  if constexpr (Dim == 2) return {texts.xx, texts.yy, texts.xy};
  return {texts.xx, texts.yy, texts.zz, texts.xy, texts.yz, texts.xz};
}

/// stress n, column by column; the rows of `stress` in the order of tensor_of().
template <int Dim>
Eigen::MatrixXd tractions(const Eigen::MatrixXd& stress, const geometry::Points<Dim>& normals) {
  Eigen::MatrixXd traction(Dim, stress.cols());
  for (Eigen::Index i = 0; i < stress.cols(); ++i) {
    const auto s = stress.col(i);
    Eigen::Matrix<double, Dim, Dim> tensor;
    if constexpr (Dim == 2) {
      tensor << s[0], s[2], s[2], s[1];
    } else {
      tensor << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
    }
    traction.col(i) = tensor * normals.col(i);
  }
  return traction;
}

template <int Dim>
using Exact = std::function<Eigen::MatrixXd(const geometry::Points<Dim>&, const geometry::Points<Dim>&)>;

/// The exact potential or displacement; empty if the case does not tell.
template <int Dim>
Exact<Dim> exact_value(const CaseFile& file) {
  const ExactKeys& keys = *file.keys.exact;
  if (keys.value) return ExactField<Dim>({keys.value}, ExpressionScope::domain, file);
  if (keys.displacement) return ExactField<Dim>(axes_of<Dim>(*keys.displacement), ExpressionScope::domain, file);
  return {};
}

/// The exact flux or traction on the boundary, by itself or from gradient or stress.
template <int Dim>
Exact<Dim> exact_flux(const CaseFile& file) {
  const ExactKeys& keys = *file.keys.exact;
  if (keys.flux) return ExactField<Dim>({keys.flux}, ExpressionScope::boundary, file);
  if (keys.traction) return ExactField<Dim>(axes_of<Dim>(*keys.traction), ExpressionScope::boundary, file);
  if (keys.stress) {
    return [stress = ExactField<Dim>(tensor_of<Dim>(*keys.stress), ExpressionScope::domain, file)](
               const geometry::Points<Dim>& points, const geometry::Points<Dim>& normals) {
      return tractions<Dim>(stress(points, normals), normals);
    };
  }
  if (!keys.gradient) return {};
  const double conductivity = file.keys.material ? file.keys.material->conductivity.value_or(1.0) : 1.0;
  return [conductivity, gradient = ExactField<Dim>(axes_of<Dim>(*keys.gradient), ExpressionScope::domain, file)](
             const geometry::Points<Dim>& points, const geometry::Points<Dim>& normals) -> Eigen::MatrixXd {
    return conductivity * gradient(points, normals).cwiseProduct(normals).colwise().sum();
  };
}

/// Largest magnitude and square integral of an error and of the exact field.
struct Norms {
  double error = 0.0;
  double exact = 0.0;
  double squared_error = 0.0;
  double squared_exact = 0.0;

  /// A NaN must show.
  static double larger(double a, double b) { return b <= a ? a : b; }
  void add(double error_size, double exact_size, double weight) {
    error = larger(error, error_size);
    exact = larger(exact, exact_size);
    squared_error += weight * error_size * error_size;
    squared_exact += weight * exact_size * exact_size;
  }
  double relative_max() const { return exact > 0.0 ? error / exact : error; }
  double relative_l2() const { return std::sqrt(squared_exact > 0.0 ? squared_error / squared_exact : squared_error); }
};

/// What is the same at all nodes: positions and normals as matrices.
template <int Dim>
struct NodeMatrices {
  geometry::Points<Dim> points;
  geometry::Points<Dim> normals;

  explicit NodeMatrices(const quadrature::NodeView<Dim>& nodes) {
    const auto count = static_cast<Eigen::Index>(nodes.size());
    points.resize(Dim, count);
    normals.resize(Dim, count);
    for (int d = 0; d < Dim; ++d) {
      points.row(d) = Eigen::Map<const Eigen::RowVectorXd>(nodes.position[std::size_t(d)].data(), count);
      normals.row(d) = Eigen::Map<const Eigen::RowVectorXd>(nodes.normal[std::size_t(d)].data(), count);
    }
  }
};

/// Motions of the body with the coefficients that fit an error best.
template <int Dim>
struct FreePart {
  std::vector<solver::RigidMotion<Dim>> motions;
  Eigen::VectorXd coefficients;

  /// At a point of a body.
  Eigen::VectorXd operator()(const geometry::Point<Dim>& point, std::int32_t body, Eigen::Index components) const {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(components);
    for (std::size_t m = 0; m < motions.size(); ++m) {
      if (!motions[m].moves(body)) continue;
      sum += coefficients[static_cast<Eigen::Index>(m)] * motions[m](point).head(components);
    }
    return sum;
  }
};

template <int Dim>
class ErrorMeter {
 public:
  ErrorMeter(const CaseFile& file, const BoundaryValueProblem<Dim>& setting, const solver::Solution<Dim>& solution)
      : file_(file),
        setting_(setting),
        rules_(sampling_rules(setting.space)),
        sampler_(setting.space, solution, rules_),
        value_(exact_value<Dim>(file)),
        flux_(exact_flux<Dim>(file)),
        body_at_(setting.space) {
    if (value_) fit_free_part();
  }

  void add_boundary(std::vector<std::pair<std::string, double>>& errors) {
    Norms value;
    Norms flux;
    for (int e = 0; e < element_count(); ++e) {
      const BoundarySample<Dim>& sample = sampler_.sample(e);
      const NodeMatrices<Dim> at(sample.nodes);
      if (value_) add_sample(e, sample, at, sample.value - value_(at.points, at.normals), true, value);
      if (flux_) add_sample(e, sample, at, sample.flux - flux_(at.points, at.normals), false, flux);
    }
    if (value_) {
      errors.emplace_back("boundary_l2", value.relative_l2());
      errors.emplace_back("boundary_max", value.relative_max());
    }
    if (flux_) {
      errors.emplace_back("flux_l2", flux.relative_l2());
      errors.emplace_back("flux_max", flux.relative_max());
    }
  }

  void add_points(const std::vector<FieldSamples>& sets, const std::string& prefix,
                  std::vector<std::pair<std::string, double>>& errors) const {
    if (sets.empty()) return;
    const ExactKeys& keys = *file_.keys.exact;
    if (value_) {
      errors.emplace_back(prefix + "_max", largest(sets, value_, [&](const FieldSamples& set) {
                            Eigen::MatrixXd value = set.value;
                            for (Eigen::Index i = 0; i < value.cols(); ++i) {
                              value.col(i) -= free_(set.points.col(i), body_at_(set.points.col(i)), value.rows());
                            }
                            return value;
                          }));
    }
    if (prefix != "probe") return;
    if (keys.gradient) {
      const ExactField<Dim> gradient(axes_of<Dim>(*keys.gradient), ExpressionScope::domain, file_);
      errors.emplace_back("probe_gradient_max",
                          largest(sets, gradient, [](const FieldSamples& set) { return set.gradient; }));
    }
    if (keys.stress) {
      const ExactField<Dim> stress(tensor_of<Dim>(*keys.stress), ExpressionScope::domain, file_);
      errors.emplace_back("probe_stress_max", largest(sets, stress, [](const FieldSamples& set) -> Eigen::MatrixXd {
                            if constexpr (Dim == 3) return set.stress;
                            Eigen::MatrixXd rows(3, set.stress.cols());
                            rows << set.stress.topRows(2), set.stress.row(3);
                            return rows;
                          }));
    }
  }

 private:
  int element_count() const { return static_cast<int>(setting_.space.table.elements.size()); }

  void add_sample(int e, const BoundarySample<Dim>& sample, const NodeMatrices<Dim>& at, const Eigen::MatrixXd& error,
                  bool of_value, Norms& norms) const {
    const Eigen::MatrixXd& found = of_value ? sample.value : sample.flux;
    for (Eigen::Index i = 0; i < error.cols(); ++i) {
      Eigen::VectorXd rest = error.col(i);
      if (of_value) rest -= free_(at.points.col(i), setting_.space.body_of(e), rest.size());
      norms.add(rest.norm(), (found.col(i) - error.col(i)).norm(), sample.nodes.weight[std::size_t(i)]);
    }
  }

  /// Least squares on the boundary.
  void fit_free_part() {
    free_.motions = solver::free_motions(setting_.problem, setting_.space);
    const auto count = static_cast<Eigen::Index>(free_.motions.size());
    if (count == 0) return;
    Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(count, count);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(count);
    for (int e = 0; e < element_count(); ++e) {
      const BoundarySample<Dim>& sample = sampler_.sample(e);
      const NodeMatrices<Dim> at(sample.nodes);
      const Eigen::MatrixXd error = sample.value - value_(at.points, at.normals);
      for (Eigen::Index i = 0; i < error.cols(); ++i) {
        Eigen::MatrixXd motions = Eigen::MatrixXd::Zero(error.rows(), count);
        for (Eigen::Index m = 0; m < count; ++m) {
          const solver::RigidMotion<Dim>& motion = free_.motions[std::size_t(m)];
          if (motion.moves(setting_.space.body_of(e))) motions.col(m) = motion(at.points.col(i)).head(error.rows());
        }
        const double weight = sample.nodes.weight[std::size_t(i)];
        gram += weight * motions.transpose() * motions;
        right += weight * motions.transpose() * error.col(i);
      }
    }
    free_.coefficients = solve_positive_definite(gram, right);
  }

  /// The largest error over the points of all sets that are not outside, over the largest exact magnitude.
  static double largest(const std::vector<FieldSamples>& sets, const Exact<Dim>& exact,
                        const std::function<Eigen::MatrixXd(const FieldSamples&)>& found) {
    Norms norms;
    for (const FieldSamples& set : sets) {
      const geometry::Points<Dim> points = set.points;
      const Eigen::MatrixXd expected = exact(points, geometry::Points<Dim>::Zero(Dim, points.cols()));
      const Eigen::MatrixXd error = found(set) - expected;
      for (Eigen::Index i = 0; i < points.cols(); ++i) {
        if (set.location[std::size_t(i)] >= 0) norms.add(error.col(i).norm(), expected.col(i).norm(), 0.0);
      }
    }
    return norms.relative_max();
  }

  /// Cholesky's method; the few unknowns need no pivots.
  static Eigen::VectorXd solve_positive_definite(Eigen::MatrixXd a, Eigen::VectorXd b) {
    const Eigen::Index n = a.rows();
    for (Eigen::Index j = 0; j < n; ++j) {
      a(j, j) = std::sqrt(a(j, j) - a.row(j).head(j).squaredNorm());
      for (Eigen::Index i = j + 1; i < n; ++i) a(i, j) = (a(i, j) - a.row(i).head(j).dot(a.row(j).head(j))) / a(j, j);
      b[j] = (b[j] - a.row(j).head(j).dot(b.head(j))) / a(j, j);
    }
    for (Eigen::Index j = n - 1; j >= 0; --j) {
      b[j] = (b[j] - a.col(j).tail(n - j - 1).dot(b.tail(n - j - 1))) / a(j, j);
    }
    return b;
  }

  const CaseFile& file_;
  const BoundaryValueProblem<Dim>& setting_;
  quadrature::TargetRules<Dim> rules_;
  BoundarySampler<Dim> sampler_;
  Exact<Dim> value_;
  Exact<Dim> flux_;
  FreePart<Dim> free_;
  solver::BodyLocator<Dim> body_at_;
};

}  // namespace

template <int Dim>
void check_exact(const CaseFile& file, const solver::FieldSpace<Dim>& space) {
  if (!file.keys.exact) return;
  geometry::Points<Dim> points(Dim, space.function_count());
  geometry::Points<Dim> normals(Dim, space.function_count());
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    points.col(i) = space.points[static_cast<std::size_t>(i)].position;
    normals.col(i) = space.points[static_cast<std::size_t>(i)].normal;
  }
  for (const Exact<Dim>& field : {exact_value<Dim>(file), exact_flux<Dim>(file)}) {
    if (field) field(points, normals);
  }
}

template <int Dim>
std::vector<std::pair<std::string, double>> solution_errors(const CaseFile& file,
                                                            const BoundaryValueProblem<Dim>& setting,
                                                            const solver::Solution<Dim>& solution,
                                                            const AnalysisReport& report) {
  std::vector<std::pair<std::string, double>> errors;
  if (!file.keys.exact) return errors;
  ErrorMeter<Dim> meter(file, setting, solution);
  meter.add_boundary(errors);
  meter.add_points(report.probes, "probe", errors);
  meter.add_points(report.grids, "grid", errors);
  return errors;
}

template void check_exact(const CaseFile&, const solver::FieldSpace<2>&);
template void check_exact(const CaseFile&, const solver::FieldSpace<3>&);
template std::vector<std::pair<std::string, double>> solution_errors(const CaseFile&, const BoundaryValueProblem<2>&,
                                                                     const solver::Solution<2>&, const AnalysisReport&);
template std::vector<std::pair<std::string, double>> solution_errors(const CaseFile&, const BoundaryValueProblem<3>&,
                                                                     const solver::Solution<3>&, const AnalysisReport&);

}  // namespace isorim::io
