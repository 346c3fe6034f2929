#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

/// What an analysis found, free of dimension and of file formats.
namespace isorim::io {

/// An image of VTK: point (i, j, k) is origin + directions diag(spacing) (i, j, k).
struct ImageShape {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d spacing = Eigen::Vector3d::Ones();
  /// Columns: unit vectors.
  Eigen::Matrix3d directions = Eigen::Matrix3d::Identity();
  std::array<int, 3> counts{1, 1, 1};

  Eigen::Index point_count() const { return Eigen::Index{counts[0]} * counts[1] * counts[2]; }
};

/// The solution at the points of a probe or grid; NaN outside the domain.
struct FieldSamples {
  std::string name;
  /// dim x n.
  Eigen::MatrixXd points;
  /// 1 inside, 0 on the boundary, -1 outside.
  std::vector<signed char> location;
  /// Potential (1 x n) or displacement (dim x n).
  Eigen::MatrixXd value;
  /// (components dim) x n, row i dim + k the derivative of component i by coordinate k.
  Eigen::MatrixXd gradient;
  /// Elasticity: xx, yy, zz, xy[, yz, xz] x n; without rows otherwise.
  Eigen::MatrixXd stress;
  /// Elasticity: n entries, and 3 x n in decreasing order.
  Eigen::VectorXd von_mises;
  Eigen::MatrixXd principal;
  /// The points follow one another along a straight line.
  bool is_line = false;
  /// Of a grid.
  std::optional<ImageShape> image;

  bool is_elastic() const { return stress.rows() > 0; }
  std::size_t outside_count() const;
};

/// Where the program writes them, in the folder of the results.
inline std::string grid_file_name(const FieldSamples& samples) {
  return "grid_" + samples.name + ".vti";
}
inline std::string probe_file_name(const FieldSamples& samples, const char* extension) {
  return "probe_" + samples.name + extension;
}

/// Integrals of the solution over the part of the boundary where a condition holds.
struct ConditionResult {
  std::string name;
  /// "value", "traction", ...
  std::string kind;
  int elements = 0;
  double measure = 0.0;
  /// int q dS of a potential, int t dS (dim entries) in elasticity.
  Eigen::VectorXd flux;
  /// Elasticity: int x cross t dS about the origin, 1 entry in the plane, 3 in space.
  Eigen::VectorXd moment;
};

/// A solution on the way of adaptive refinement.
struct AdaptiveStepResult {
  std::size_t elements = 0;
  std::size_t functions = 0;
  std::size_t unknowns = 0;
  /// Of the relative error.
  double estimate = 0.0;
  /// Those against [exact], on the boundary and at the probes.
  std::vector<std::pair<std::string, double>> errors;
  double seconds = 0.0;
};

struct AdaptiveHistory {
  double tolerance = 0.0;
  /// At least one.
  std::vector<AdaptiveStepResult> steps;
  /// "tolerance_reached", "max_steps", "max_unknowns" or "max_levels".
  std::string end;
  /// Why the tolerance is not reached; empty if it is.
  std::string shortfall;

  bool is_reached() const { return shortfall.empty(); }
};

struct AnalysisReport {
  std::string equation;
  bool exterior = false;
  int components = 1;
  /// Elements of the boundary of the analysis, and functions on them.
  std::size_t elements = 0;
  std::size_t functions = 0;
  std::size_t unknowns = 0;
  std::string method;
  int iterations = 0;
  double residual = 0.0;
  /// Bytes.
  std::size_t matrix_memory = 0;
  /// Bytes: the largest that the program has taken so far.
  std::size_t peak_memory = 0;
  /// With [discretisation] adapt.
  std::optional<AdaptiveHistory> adaptive;
  /// Relative errors against [exact].
  std::vector<std::pair<std::string, double>> errors;
  std::vector<ConditionResult> conditions;
  /// What loads in the domain amount to: int b dOmega.
  Eigen::VectorXd load;
  /// |int q dS + int b dOmega| over int |q| dS: how far fluxes or forces are from balance; interior problems.
  std::optional<double> balance;
  /// Exterior problems in the plane: what the solution tends to.
  Eigen::VectorXd at_infinity;
  std::vector<FieldSamples> probes;
  std::vector<FieldSamples> grids;
  std::vector<std::string> messages;
  /// Seconds.
  double discretise_time = 0.0;
  double solve_time = 0.0;
  double evaluate_time = 0.0;
};

}  // namespace isorim::io
