#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>

#include "quadrature/element_piece.h"
#include "quadrature/piece_samples.h"
#include "solver/bem/ray_moments.h"
#include "solver/bem/ray_rule.h"

namespace isorim::solver {

namespace {

constexpr std::array<int, 3> ray_orders{6, 10, 16};
constexpr int random_chords = 1024;
constexpr int points_on_chord = 64;
/// Chords on which rules are tried: random ones, and as many that end where the functions are largest.
constexpr int tried_chords = 128;
/// Panels shorter than this part of the domain's size are left to the refinement of each ray.
constexpr double shortest_panel = 1.0 / 64.0;

/// Values that exceed the means along chords by more than this are those of a singularity, and no measure of errors.
constexpr double most_above_mean = 30.0;

/// Peaks of more than this part of the domain's size are as well integrated by panels of one length.
constexpr double sharp = 1.0 / 24.0;

/// A peak that panels of some length resolve has points of panels that are so many times as long on it.
constexpr double visible = 4.0;

/// Points spread over the boundary, some hundred.
template <int Dim>
geometry::Points<Dim> boundary_points(const geometry::ElementTable<Dim>& table) {
  constexpr std::size_t elements_used = 256;
  const std::size_t count = table.elements.size();
  const std::size_t used = std::min(count, elements_used);
  quadrature::Orders<Dim - 1> orders;
  orders.fill(used < 32 ? 6 : 2);
  geometry::Points<Dim> points(Dim, 0);
  quadrature::PieceSamples<Dim> samples;
  for (std::size_t i = 0; i < used; ++i) {
    const auto piece = quadrature::whole_element(table, table.elements[i * count / used]);
    if (piece.empty()) continue;
    quadrature::sample_piece<Dim>(piece, orders, samples);
    points.conservativeResize(Dim, points.cols() + samples.points.cols());
    points.rightCols(samples.points.cols()) = samples.points;
  }
  return points;
}

template <int Dim>
struct Chord {
  geometry::Point<Dim> from;
  geometry::Point<Dim> to;
};

template <int Dim>
class Sampler {
 public:
  Sampler(std::span<const quadrature::IntegrandFactory<Dim>> components, const geometry::ElementTable<Dim>& table,
          double tolerance)
      : on_boundary_(boundary_points(table)), size_(geometry::bounding_box(table).diagonal()), tolerance_(tolerance) {
    for (const auto& make : components) functions_.push_back(make());
  }

  RayResolution<Dim> resolution() {
    RayResolution<Dim> resolution;
    std::vector<Chord<Dim>> chords;
    for (int i = 0; i < random_chords; ++i) chords.push_back({random_point(), random_point()});
    find_largest(chords);
    climb();
    chords.resize(tried_chords);
    for (int i = 0; i < tried_chords; ++i) chords.push_back({random_point(), place_});
    find_largest({chords.begin() + tried_chords, chords.end()});
    scale_ = std::min(largest_, most_above_mean * scale_);
    resolution.scale = scale_;
    if (!(scale_ > 0.0)) return resolution;
    for (const int order : ray_orders) {
      resolution.order = order;
      const bool resolved = std::all_of(chords.begin(), chords.end(),
                                        [&](const Chord<Dim>& chord) { return is_resolved(chord, order, 1.0); });
      if (resolved) return resolution;
    }
    const RayPeak<Dim> peak = peak_at_largest(chords);
    if (peak.width < sharp * size_ && is_alone(peak, chords)) {
      resolution.peaks = {peak};
      return resolution;
    }
    double shortest = size_;
    for (const Chord<Dim>& chord : chords)
      shortest = std::min(shortest, shortest_resolved(chord, shortest_panel * size_));
    resolution.panel_length = std::max(visible * shortest, shortest_panel * size_);
    return resolution;
  }

 private:
  geometry::Point<Dim> random_point() {
    std::uniform_int_distribution<Eigen::Index> column(0, on_boundary_.cols() - 1);
    return on_boundary_.col(column(random_));
  }

  /// components x points; entries that are not finite set to zero.
  const Eigen::MatrixXd& sample(const geometry::Points<Dim>& points) {
    static const geometry::Points<Dim> no_normals(Dim, 0);
    values_.resize(static_cast<Eigen::Index>(functions_.size()), points.cols());
    row_.resize(static_cast<std::size_t>(points.cols()));
    for (std::size_t c = 0; c < functions_.size(); ++c) {
      functions_[c](points, no_normals, row_);
      for (std::size_t i = 0; i < row_.size(); ++i)
        values_(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(i)) = std::isfinite(row_[i]) ? row_[i] : 0.0;
    }
    return values_;
  }

  /// Whether a larger value was found among the points.
  bool take_largest(const geometry::Points<Dim>& points) {
    Eigen::Index component = 0;
    Eigen::Index best = 0;
    const double value = sample(points).cwiseAbs().maxCoeff(&component, &best);
    if (!(value > largest_)) return false;
    largest_ = value;
    place_ = points.col(best);
    return true;
  }

  void find_largest(const std::vector<Chord<Dim>>& chords) {
    std::uniform_real_distribution<double> shift(0.0, 1.0);
    geometry::Points<Dim> points(Dim, points_on_chord);
    for (const Chord<Dim>& chord : chords) {
      for (int k = 0; k < points_on_chord; ++k)
        points.col(k) = chord.from + (k + shift(random_)) / points_on_chord * (chord.to - chord.from);
      take_largest(points);
      scale_ = std::max(scale_, values_.cwiseAbs().rowwise().mean().maxCoeff());
    }
  }

  /// Moves to larger values, on lines to points of the boundary, with steps that shrink where nothing is gained.
  void climb() {
    constexpr int tries = 24;
    geometry::Points<Dim> points(Dim, tries);
    for (double step = size_ / 16.0; step > 1e-13 * size_;) {
      for (int k = 0; k < tries; ++k) {
        const geometry::Vector<Dim> way = random_point() - place_;
        const double length = way.norm();
        points.col(k) = place_ + (length > step ? step / length : 1.0) * way;
      }
      if (!take_largest(points)) step *= 0.6;
    }
  }

  geometry::Points<Dim> panel_points(const Chord<Dim>& chord, int order) const {
    const RayRule& rule = ray_rule(order);
    geometry::Points<Dim> points(Dim, order);
    for (Eigen::Index k = 0; k < order; ++k)
      points.col(k) = chord.from + rule.nodes[static_cast<std::size_t>(k)] * (chord.to - chord.from);
    return points;
  }

  bool is_resolved(const Chord<Dim>& chord, int order, double part) {
    const Eigen::Map<const Eigen::MatrixXd> tail(ray_rule(order).tail.data(), order, 2);
    const Eigen::MatrixXd& values = sample(panel_points(chord, order));
    const double left = (values * tail).cwiseAbs().maxCoeff();
    return left * part <= tolerance_ * scale_ || left <= tolerance_ * values.cwiseAbs().maxCoeff();
  }

  /// The place where the functions are largest, and how near to it panels have to become short.
  RayPeak<Dim> peak_at_largest(const std::vector<Chord<Dim>>& chords) {
    constexpr double no_width = 1e-8;
    double shortest = size_;
    for (std::size_t i = tried_chords; i < chords.size(); ++i)
      shortest = std::min(shortest, shortest_resolved(chords[i], no_width * size_));
    return {place_, shortest > 2.0 * no_width * size_ ? 0.5 * shortest : 0.0};
  }

  /// On panels that grow with the distance from the peak, bisected at most twice, the best rule resolves the functions.
  bool is_alone(const RayPeak<Dim>& peak, const std::vector<Chord<Dim>>& chords) {
    return std::all_of(chords.begin(), chords.end(), [&](const Chord<Dim>& chord) {
      const geometry::Vector<Dim> d = chord.to - chord.from;
      std::vector<double> cuts{0.0, 1.0};
      append_cuts<Dim>(chord.from, d, peak, cuts);
      std::sort(cuts.begin(), cuts.end());
      for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
        if (!is_resolved_by_quarters(chord, peak, cuts[i], cuts[i + 1])) return false;
      }
      return true;
    });
  }

  bool is_resolved_by_quarters(const Chord<Dim>& chord, const RayPeak<Dim>& peak, double first, double last) {
    constexpr int parts = 4;
    constexpr double vicinity = 1e-5;
    const geometry::Vector<Dim> d = chord.to - chord.from;
    for (int part = 0; part < parts; ++part) {
      const Chord<Dim> panel{chord.from + (first + part * (last - first) / parts) * d,
                             chord.from + (first + (part + 1) * (last - first) / parts) * d};
      if (std::min((panel.from - peak.place).norm(), (panel.to - peak.place).norm()) < vicinity * size_) continue;
      if (!is_resolved(panel, ray_orders.back(), (last - first) / parts)) return false;
    }
    return true;
  }

  /// Length of the shortest panel that bisection by the best rule ends with.
  double shortest_resolved(const Chord<Dim>& chord, double least) {
    double shortest = size_;
    const double whole = (chord.to - chord.from).norm();
    std::vector<Chord<Dim>> work{chord};
    while (!work.empty()) {
      const Chord<Dim> panel = work.back();
      work.pop_back();
      const double length = (panel.to - panel.from).norm();
      if (length <= least || is_resolved(panel, ray_orders.back(), length / whole)) {
        if (length < whole) shortest = std::min(shortest, length);
        continue;
      }
      const geometry::Point<Dim> middle = 0.5 * (panel.from + panel.to);
      work.push_back({panel.from, middle});
      work.push_back({middle, panel.to});
    }
    return shortest;
  }

  std::vector<quadrature::Integrand<Dim>> functions_;
  geometry::Points<Dim> on_boundary_;
  double size_;
  double tolerance_;
  std::mt19937 random_{20020905};
  double largest_ = 0.0;
  double scale_ = 0.0;
  geometry::Point<Dim> place_ = geometry::Point<Dim>::Zero();
  Eigen::MatrixXd values_;
  std::vector<double> row_;
};

}  // namespace

template <int Dim>
RayResolution<Dim> resolve_along_chords(std::span<const quadrature::IntegrandFactory<Dim>> components,
                                        const geometry::ElementTable<Dim>& table, double tolerance) {
  return Sampler<Dim>(components, table, tolerance).resolution();
}

template RayResolution<2> resolve_along_chords(std::span<const quadrature::IntegrandFactory<2>>,
                                               const geometry::ElementTable<2>&, double);
template RayResolution<3> resolve_along_chords(std::span<const quadrature::IntegrandFactory<3>>,
                                               const geometry::ElementTable<3>&, double);

}  // namespace isorim::solver
