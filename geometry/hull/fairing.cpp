#include "geometry/hull/fairing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include "geometry/errors.h"

namespace isorim::geometry {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Offsets that differ by less, over half the beam, are equal.
constexpr double same = 1e-12;
/// Of the measure's largest curvature: what keeps offsets where they are if the measure does not care.
constexpr double holding = 1e-9;
constexpr int most_steps = 200;

/// A term of the roughness: weight times the square of the sum of four offsets by their factors.
struct Difference {
  std::array<Index, 4> offsets;
  std::array<double, 4> factors;
};

/// Factors of the third derivative of the cubic through four points, times the root of a third of their length: so that
/// the squares sum up to its integral.
std::array<double, 4> third_difference(const std::array<double, 4>& at) {
  std::array<double, 4> factors{};
  for (std::size_t i = 0; i < 4; ++i) {
    double product = 1.0;
    for (std::size_t j = 0; j < 4; ++j)
      if (j != i) product *= at[i] - at[j];
    factors[i] = 6.0 / product * std::sqrt((at[3] - at[0]) / 3.0);
  }
  return factors;
}

/// The share of a line at i among lines at increasing places: half the distance of its neighbours.
double spacing(const std::vector<double>& places, std::size_t i) {
  const std::size_t before = i > 0 ? i - 1 : 0;
  const std::size_t after = std::min(i + 1, places.size() - 1);
  return after > before ? 0.5 * (places[after] - places[before]) : 1.0;
}

std::vector<double> scaled_places(std::vector<double> places, double unit) {
  for (double& place : places) place /= unit;
  return places;
}

class Fairer {
 public:
  Fairer(const OffsetTable& table, double tolerance)
      : table_(table),
        unit_(0.5 * table.beam),
        tolerance_(tolerance / unit_),
        x_(scaled_places(table.stations, table.length)),
        z_(scaled_places(table.waterlines, table.draught)),
        fixed_(static_cast<std::size_t>(table.half_breadths.size()), char{0}) {
    given_ = table.half_breadths.reshaped() / unit_;
    collect_along_waterlines();
    collect_along_sections();
    fix_what_stays();
    set_bounds();
  }

  FairedOffsets fair() {
    const MatrixXd hessian = curvature();
    const double hold = holding * hessian.diagonal().maxCoeff();
    VectorXd y = start_;
    for (int step = 0; step < most_steps; ++step)
      if (!improve(hessian, hold, y)) break;
    FairedOffsets result{table_, 0, 0.0, roughness(start_), roughness(y)};
    for (Index k = 0; k < y.size(); ++k) {
      const double move = std::abs(y[k] - start_[k]);
      if (fixed_[static_cast<std::size_t>(k)] != 0 || !(move > same)) continue;
      result.table.half_breadths.reshaped()[k] = unit_ * y[k];
      ++result.moved;
      result.largest_move = std::max(result.largest_move, unit_ * move);
    }
    return result;
  }

 private:
  Index rows() const { return table_.half_breadths.rows(); }
  Index index(Index waterline, Index station) const { return waterline + rows() * station; }
  bool is_given(Index k) const { return std::isfinite(given_[k]); }

  /// One after the other, those that are not given passed over.
  void collect(const std::vector<Index>& line, const std::vector<double>& places, double share) {
    for (std::size_t i = 0; i + 3 < line.size(); ++i) {
      Difference difference{{line[i], line[i + 1], line[i + 2], line[i + 3]},
                            third_difference({places[i], places[i + 1], places[i + 2], places[i + 3]})};
      for (double& factor : difference.factors) factor *= std::sqrt(share);
      differences_.push_back(difference);
    }
    for (std::size_t i = 0; i + 2 < line.size(); ++i) {
      const double a = given_[line[i]];
      if (std::abs(given_[line[i + 1]] - a) > same || std::abs(given_[line[i + 2]] - a) > same) continue;
      for (std::size_t k = i; k < i + 3; ++k) fixed_[static_cast<std::size_t>(line[k])] = 1;
    }
  }

  void collect_along_waterlines() {
    for (Index j = 0; j < rows(); ++j) {
      std::vector<Index> line;
      std::vector<double> places;
      for (std::size_t i = 0; i < x_.size(); ++i) {
        const Index k = index(j, static_cast<Index>(i));
        if (!is_given(k)) continue;
        line.push_back(k);
        places.push_back(x_[i]);
      }
      collect(line, places, spacing(z_, static_cast<std::size_t>(j)));
    }
  }

  /// From knuckle to knuckle.
  void collect_along_sections() {
    for (std::size_t i = 0; i < x_.size(); ++i) {
      std::vector<Index> line;
      std::vector<double> places;
      for (std::size_t j = 0; j < z_.size(); ++j) {
        const Index k = index(static_cast<Index>(j), static_cast<Index>(i));
        if (!line.empty() && has_knuckle_between(static_cast<Index>(i), places.back(), z_[j])) {
          collect(line, places, spacing(x_, i));
          line.clear();
          places.clear();
        }
        if (!is_given(k)) continue;
        line.push_back(k);
        places.push_back(z_[j]);
      }
      collect(line, places, spacing(x_, i));
    }
  }

  bool has_knuckle_between(Index station, double low, double high) const {
    return std::ranges::any_of(table_.knuckles, [&](const KnuckleLine& knuckle) {
      const double z = knuckle.places(1, station) / table_.draught;
      return z > low - same && z < high + same;
    });
  }

  void fix_what_stays() {
    start_ = given_;
    for (Index k = 0; k < given_.size(); ++k) {
      auto& fixed = fixed_[static_cast<std::size_t>(k)];
      if (!is_given(k)) {
        fixed = 1;
        start_[k] = 0.0;
      } else if (given_[k] == 0.0 || std::abs(given_[k] - 1.0) <= same) {
        fixed = 1;
      }
    }
  }

  void set_bounds() {
    lower_ = (start_.array() - tolerance_).max(0.0);
    upper_ = start_.array() + tolerance_;
    for (Index k = 0; k < start_.size(); ++k) {
      if (start_[k] <= 1.0) upper_[k] = std::min(upper_[k], 1.0);
      if (fixed_[static_cast<std::size_t>(k)] != 0) lower_[k] = upper_[k] = start_[k];
    }
  }

  double roughness(const VectorXd& y) const {
    double sum = 0.0;
    for (const Difference& difference : differences_) {
      double value = 0.0;
      for (std::size_t i = 0; i < 4; ++i) value += difference.factors[i] * y[difference.offsets[i]];
      sum += value * value;
    }
    return sum;
  }

  MatrixXd curvature() const {
    MatrixXd hessian = MatrixXd::Zero(start_.size(), start_.size());
    for (const Difference& difference : differences_)
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j)
          hessian(difference.offsets[i], difference.offsets[j]) += 2.0 * difference.factors[i] * difference.factors[j];
    return hessian;
  }

  double objective(const VectorXd& y, double hold) const {
    return roughness(y) + 0.5 * hold * (y - start_).squaredNorm();
  }

  /// Offsets that are not held at a bound by the gradient.
  std::vector<Index> free_offsets(const VectorXd& y, const VectorXd& gradient) const {
    std::vector<Index> free;
    for (Index k = 0; k < y.size(); ++k) {
      const bool is_held = (y[k] <= lower_[k] && gradient[k] >= 0.0) || (y[k] >= upper_[k] && gradient[k] <= 0.0);
      if (!is_held) free.push_back(k);
    }
    return free;
  }

  /// One step of Newton's method among the free offsets, projected; false if there is nothing to gain.
  bool improve(const MatrixXd& hessian, double hold, VectorXd& y) const {
    const VectorXd gradient = hessian * y + hold * (y - start_);
    const std::vector<Index> free = free_offsets(y, gradient);
    if (free.empty()) return false;
    MatrixXd reduced = hessian(free, free);
    reduced.diagonal().array() += hold;
    VectorXd step = VectorXd::Zero(y.size());
    step(free) = -reduced.ldlt().solve(gradient(free));
    const double before = objective(y, hold);
    for (double length = 1.0; length > 1e-6; length *= 0.5) {
      const VectorXd next = (y + length * step).cwiseMax(lower_).cwiseMin(upper_);
      const double gain = before - objective(next, hold);
      if (!(gain > 1e-14 * before)) continue;
      y = next;
      return true;
    }
    return false;
  }

  const OffsetTable& table_;
  /// Half-breadths are in this unit, half the beam.
  double unit_;
  double tolerance_;
  std::vector<double> x_;
  std::vector<double> z_;
  std::vector<char> fixed_;
  VectorXd given_;
  /// What is not given is zero; no difference touches it.
  VectorXd start_;
  VectorXd lower_;
  VectorXd upper_;
  std::vector<Difference> differences_;
};

}  // namespace

FairedOffsets fair_offsets(const OffsetTable& table, double tolerance) {
  check(table);
  if (!(tolerance > 0.0) || !std::isfinite(tolerance))
    throw GeometryError(fmt::format("found the tolerance {} for fairing; expected a positive length", tolerance));
  return Fairer(table, tolerance).fair();
}

}  // namespace isorim::geometry
