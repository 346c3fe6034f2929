#include "solver/bem/ray_moments.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "solver/bem/ray_rule.h"

namespace isorim::solver {

namespace {

/// The node less the target.
template <int Dim>
geometry::Vector<Dim> ray(const geometry::Point<Dim>& target, const quadrature::NodeView<Dim>& nodes,
                          std::size_t node) {
  geometry::Vector<Dim> d;
  for (std::size_t i = 0; i < Dim; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    d[row] = nodes.offset[i].empty() ? nodes.position[i][node] - target[row] : nodes.offset[i][node];
  }
  return d;
}

bool needs_value_at_target(std::span<const RayMoment> kinds) {
  return std::any_of(kinds.begin(), kinds.end(),
                     [](RayMoment kind) { return kind == RayMoment::difference || kind == RayMoment::quotient; });
}

/// The moments of 1, t and t^2.
std::array<double, 3> moments_of_powers(RayMoment kind) {
  switch (kind) {
    case RayMoment::plain:
      return {1.0, 1.0 / 2.0, 1.0 / 3.0};
    case RayMoment::linear:
      return {1.0 / 2.0, 1.0 / 3.0, 1.0 / 4.0};
    case RayMoment::logarithmic:
      return {1.0 / 4.0, 1.0 / 9.0, 1.0 / 16.0};
    case RayMoment::difference:
      return {0.0, 1.0 / 2.0, 1.0 / 3.0};
    case RayMoment::quotient:
      return {0.0, 1.0, 1.0 / 2.0};
  }
  return {};
}

template <int Dim>
class QuadraticRays : public RayFunctions<Dim> {
 public:
  explicit QuadraticRays(std::vector<Quadratic<Dim>> functions) : functions_(std::move(functions)) {}

  int components() const override { return static_cast<int>(functions_.size()); }

  Eigen::VectorXd at(const geometry::Point<Dim>& point) override {
    Eigen::VectorXd values(components());
    for (Eigen::Index c = 0; c < values.size(); ++c) values[c] = functions_[static_cast<std::size_t>(c)](point);
    return values;
  }

  void moments(const geometry::Point<Dim>& target, const quadrature::NodeView<Dim>& nodes,
               std::span<const RayMoment> kinds, std::span<Eigen::MatrixXd> moments) override {
    const auto count = static_cast<Eigen::Index>(nodes.size());
    for (Eigen::MatrixXd& values : moments) values.resize(components(), count);
    for (Eigen::Index c = 0; c < components(); ++c) {
      const Quadratic<Dim>& f = functions_[static_cast<std::size_t>(c)];
      const double at_target = f(target);
      const geometry::Vector<Dim> slope = f.linear + (f.quadratic + f.quadratic.transpose()) * target;
      for (Eigen::Index q = 0; q < count; ++q) {
        const geometry::Vector<Dim> d = ray(target, nodes, static_cast<std::size_t>(q));
        const double first = slope.dot(d);
        const double second = d.dot((f.quadratic * d).eval());
        for (std::size_t m = 0; m < kinds.size(); ++m) {
          const std::array<double, 3> power = moments_of_powers(kinds[m]);
          moments[m](c, q) = power[0] * at_target + power[1] * first + power[2] * second;
        }
      }
    }
  }

 private:
  std::vector<Quadratic<Dim>> functions_;
};

/// A part of a ray, or all of it.
struct RayPanel {
  Eigen::Index node = 0;
  double first = 0.0;
  double length = 1.0;
  int bisections = 0;
};

template <int Dim>
class SampledRays : public RayFunctions<Dim> {
 public:
  SampledRays(std::span<const quadrature::IntegrandFactory<Dim>> components, const std::string& name,
              const RayResolution<Dim>& resolution, double tolerance)
      : name_(name), resolution_(resolution), tolerance_(tolerance), allowed_(tolerance * resolution.scale) {
    for (const auto& make : components) functions_.push_back(make());
  }

  int components() const override { return static_cast<int>(functions_.size()); }

  Eigen::VectorXd at(const geometry::Point<Dim>& point) override {
    points_ = point;
    sample();
    return samples_.col(0);
  }

  void moments(const geometry::Point<Dim>& target, const quadrature::NodeView<Dim>& nodes,
               std::span<const RayMoment> kinds, std::span<Eigen::MatrixXd> moments) override {
    const auto count = static_cast<Eigen::Index>(nodes.size());
    for (Eigen::MatrixXd& values : moments) values.setZero(components(), count);
    at_target_ = needs_value_at_target(kinds) ? at(target) : Eigen::VectorXd::Zero(components());
    rays_.resize(Dim, count);
    for (Eigen::Index q = 0; q < count; ++q) rays_.col(q) = ray(target, nodes, static_cast<std::size_t>(q));
    std::vector<RayPanel> panels = resolution_.peaks.empty() ? equal_panels() : graded_panels(target);
    const RayRule* rule = &ray_rule(resolution_.order);
    while (!panels.empty()) {
      unresolved_.clear();
      const std::size_t chunk = std::max<std::size_t>(1, points_at_once / static_cast<std::size_t>(rule->size()));
      for (std::size_t begin = 0; begin < panels.size(); begin += chunk) {
        const std::size_t size = std::min(chunk, panels.size() - begin);
        integrate(target, {panels.data() + begin, size}, *rule, kinds, moments);
      }
      // A lower rule than the best is given another chance with that one, all further panels are halves.
      panels = rule->size() < best_order ? unresolved_ : halves(unresolved_);
      rule = &ray_rule(best_order);
    }
  }

 private:
  static constexpr int best_order = 16;
  static constexpr int most_bisections = 50;
  static constexpr double most_first_panels = 256.0;
  static constexpr std::size_t points_at_once = 4096;

  std::vector<RayPanel> graded_panels(const geometry::Point<Dim>& target) const {
    std::vector<RayPanel> panels;
    std::vector<double> cuts;
    for (Eigen::Index q = 0; q < rays_.cols(); ++q) {
      cuts.assign(1, 1.0);
      for (const RayPeak<Dim>& peak : resolution_.peaks) append_cuts<Dim>(target, rays_.col(q), peak, cuts);
      std::sort(cuts.begin(), cuts.end());
      double first = 0.0;
      for (const double cut : cuts) {
        // Beside ln t panels must not be longer than they are far from 0.
        for (; first > 0.0 && cut > 2.0 * first; first *= 2.0) panels.push_back({q, first, first, 0});
        if (cut > first) panels.push_back({q, first, cut - first, 0});
        first = cut;
      }
    }
    return panels;
  }

  std::vector<RayPanel> equal_panels() const {
    std::vector<RayPanel> panels;
    for (Eigen::Index q = 0; q < rays_.cols(); ++q) {
      const double wanted = std::ceil(rays_.col(q).norm() / resolution_.panel_length);
      const double count = std::clamp(wanted, 1.0, most_first_panels);
      for (double i = 0.0; i < count; i += 1.0) panels.push_back({q, i / count, 1.0 / count, 0});
    }
    return panels;
  }

  static std::vector<RayPanel> halves(const std::vector<RayPanel>& panels) {
    std::vector<RayPanel> halves;
    for (const RayPanel& panel : panels) {
      const double length = 0.5 * panel.length;
      halves.push_back({panel.node, panel.first, length, panel.bisections + 1});
      halves.push_back({panel.node, panel.first + length, length, panel.bisections + 1});
    }
    return halves;
  }

  /// Fills samples_ (components x points) with the functions at points_.
  void sample() {
    static const geometry::Points<Dim> no_normals(Dim, 0);
    samples_.resize(components(), points_.cols());
    row_.resize(static_cast<std::size_t>(points_.cols()));
    for (Eigen::Index c = 0; c < components(); ++c) {
      functions_[static_cast<std::size_t>(c)](points_, no_normals, row_);
      for (Eigen::Index i = 0; i < points_.cols(); ++i) {
        samples_(c, i) = row_[static_cast<std::size_t>(i)];
        if (!std::isfinite(samples_(c, i))) refuse(samples_(c, i), points_.col(i));
      }
    }
  }

  [[noreturn]] void refuse(double value, const geometry::Point<Dim>& point) const {
    std::string place = fmt::format("({:.6g}, {:.6g}", point[0], point[1]);
    if constexpr (Dim == 3) place += fmt::format(", {:.6g}", point[2]);
    throw InputError(fmt::format(
        "{} is {} at {}); expected a finite value: loads are integrated along rays from points of the domain and of "
        "its "
        "boundary to all of the boundary, which leave a domain that is not convex; give an expression that is finite "
        "there too",
        name_, std::isnan(value) ? "nan" : fmt::format("{}", value), place));
  }

  void integrate(const geometry::Point<Dim>& target, std::span<const RayPanel> panels, const RayRule& rule,
                 std::span<const RayMoment> kinds, std::span<Eigen::MatrixXd> moments) {
    const Eigen::Index n = rule.size();
    points_.resize(Dim, n * static_cast<Eigen::Index>(panels.size()));
    Eigen::Index column = 0;
    for (const RayPanel& panel : panels) {
      for (const double s : rule.nodes)
        points_.col(column++) = target + (panel.first + s * panel.length) * rays_.col(panel.node);
    }
    sample();
    for (std::size_t p = 0; p < panels.size(); ++p) {
      const auto values = samples_.middleCols(static_cast<Eigen::Index>(p) * n, n);
      if (panels[p].bisections < most_bisections && !is_resolved(values, rule, panels[p].length)) {
        unresolved_.push_back(panels[p]);
        continue;
      }
      for (std::size_t m = 0; m < kinds.size(); ++m) {
        set_weights(panels[p], rule, kinds[m]);
        auto sum = moments[m].col(panels[p].node);
        sum += values * weights_;
        if (kinds[m] == RayMoment::difference || kinds[m] == RayMoment::quotient) sum -= at_target_ * weights_.sum();
      }
    }
  }

  template <class Values>
  bool is_resolved(const Values& values, const RayRule& rule, double length) const {
    const Eigen::Map<const Eigen::MatrixXd> tail(rule.tail.data(), rule.size(), 2);
    const double left = (values * tail).cwiseAbs().maxCoeff();
    return left * length <= allowed_ || left <= tolerance_ * values.cwiseAbs().maxCoeff();
  }

  void set_weights(const RayPanel& panel, const RayRule& rule, RayMoment kind) {
    weights_.resize(rule.size());
    const double h = panel.length;
    for (Eigen::Index k = 0; k < weights_.size(); ++k) {
      const auto node = static_cast<std::size_t>(k);
      const double t = panel.first + rule.nodes[node] * h;
      const double weight = rule.weights[node] * h;
      switch (kind) {
        case RayMoment::plain:
        case RayMoment::difference:
          weights_[k] = weight;
          break;
        case RayMoment::linear:
          weights_[k] = weight * t;
          break;
        case RayMoment::quotient:
          weights_[k] = weight / t;
          break;
        case RayMoment::logarithmic:
          weights_[k] =
              panel.first > 0.0 ? -weight * t * std::log(t) : h * h * rule.log_weights[node] - weight * t * std::log(h);
          break;
      }
    }
  }

  std::string name_;
  std::vector<quadrature::Integrand<Dim>> functions_;
  RayResolution<Dim> resolution_;
  double tolerance_;
  double allowed_;
  /// Reused storage.
  Eigen::VectorXd at_target_;
  geometry::Points<Dim> rays_;
  geometry::Points<Dim> points_;
  Eigen::MatrixXd samples_;
  std::vector<double> row_;
  Eigen::VectorXd weights_;
  std::vector<RayPanel> unresolved_;
};

}  // namespace

template <int Dim>
std::unique_ptr<RayFunctions<Dim>> quadratic_rays(std::vector<Quadratic<Dim>> components) {
  return std::make_unique<QuadraticRays<Dim>>(std::move(components));
}

template <int Dim>
void append_cuts(const geometry::Point<Dim>& from, const geometry::Vector<Dim>& d, const RayPeak<Dim>& peak,
                 std::vector<double>& cuts) {
  constexpr double least_step = 1e-12;
  const double length = d.norm();
  if (!(length > 0.0)) return;
  const double nearest = std::clamp(d.dot(peak.place - from) / (length * length), 0.0, 1.0);
  const double away = (from + nearest * d - peak.place).norm();
  const double step = std::max(std::max(away, peak.width) / length, least_step);
  if (step >= 1.0) return;
  if (nearest > 0.0 && nearest < 1.0) cuts.push_back(nearest);
  double beside = step;
  for (double next = step; beside < 1.0; next *= 2.0, beside += next) {
    if (nearest + beside < 1.0) cuts.push_back(nearest + beside);
    if (nearest - beside > 0.0) cuts.push_back(nearest - beside);
  }
}

template <int Dim>
std::unique_ptr<RayFunctions<Dim>> sampled_rays(std::span<const quadrature::IntegrandFactory<Dim>> components,
                                                const std::string& name, const RayResolution<Dim>& resolution,
                                                double tolerance) {
  return std::make_unique<SampledRays<Dim>>(components, name, resolution, tolerance);
}

template std::unique_ptr<RayFunctions<2>> quadratic_rays(std::vector<Quadratic<2>>);
template std::unique_ptr<RayFunctions<3>> quadratic_rays(std::vector<Quadratic<3>>);
template void append_cuts(const geometry::Point2&, const geometry::Vector2&, const RayPeak<2>&, std::vector<double>&);
template void append_cuts(const geometry::Point3&, const geometry::Vector3&, const RayPeak<3>&, std::vector<double>&);
template std::unique_ptr<RayFunctions<2>> sampled_rays(std::span<const quadrature::IntegrandFactory<2>>,
                                                       const std::string&, const RayResolution<2>&, double);
template std::unique_ptr<RayFunctions<3>> sampled_rays(std::span<const quadrature::IntegrandFactory<3>>,
                                                       const std::string&, const RayResolution<3>&, double);

}  // namespace isorim::solver
