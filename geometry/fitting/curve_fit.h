#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "geometry/nurbs/curve.h"
#include "geometry/vocabulary.h"

/// B-spline curves through ordered points, as near as their number of control points allows: open and closed, in the
/// plane and in space.
namespace isorim::geometry {

enum class FitMethod {
  /// Parameters and knots are improved together with the control points: the nearest curve. Default.
  free,
  /// Knots by a rule, linear least squares for the control points.
  fixed_knots,
  /// L. R. Pereira's method (dissertation, Universidade Federal de Uberlândia, 2014, chapter 5): closed plane cubics
  /// only, see pereira_fit.h.
  pereira,
};

/// How a parameter in [0, 1] is given to each point (Piegl & Tiller, The NURBS Book, 2nd ed., eqs. 9.3 to 9.6).
enum class FitParameters { chord_length, centripetal, uniform };

/// How the inner knots are chosen. Method free moves them only if they are automatic; else parameters alone.
enum class FitKnots {
  /// Averaging for interpolation; else uniform, or Piegl and Tiller's rule where uniform knots would leave a control
  /// point without data. Method free: where the error is.
  automatic,
  /// Equal spans.
  uniform,
  /// Means of p parameters (Piegl & Tiller, eq. 9.8), for interpolation; with fewer control points than data, means
  /// about evenly chosen parameters.
  averaging,
  /// As many data in every span (Piegl & Tiller, eqs. 9.68 and 9.69; for closed curves its periodic form).
  piegl_tiller,
  /// CurveFitOptions::breakpoints.
  given,
};

enum class FitWeights {
  /// By curvature radius for method pereira, else uniform.
  automatic,
  uniform,
  /// Pereira's rule: the tighter the circle through a point and its neighbours, the larger the weight; see
  /// section_rules.h. Points of straight parts get the largest weight.
  curvature_radius,
  /// CurveFitOptions::point_weights.
  given,
};

/// What an end of an open curve must meet besides being near its point.
enum class FitEnd {
  /// Nothing: the end is fitted like the rest.
  free,
  /// The curve starts (ends) in the first (last) point.
  interpolated,
  /// And its second derivative vanishes there.
  natural,
  /// And its tangent has the direction of start_tangent (end_tangent); over the parameter interval [0, 1] its length
  /// is that of the polygon of the data.
  tangent,
};

template <int Dim>
struct CurveFitOptions {
  FitMethod method = FitMethod::free;
  /// The points run round a closed curve, the last one followed by the first; a last point equal to the first is
  /// dropped. The curve is C^(p-1) at the closing point too, unless a corner lies there.
  bool closed = true;
  int degree = 3;

  /// Distinct control points (a closed curve repeats p of them). 0: chosen to meet `tolerance` if that is given, else
  /// by Pereira's rule: as many as changes of curvature sign, but at least half as many as points.
  int control_points = 0;
  /// The largest distance of a point from the curve that is allowed; used if control_points is 0. The number of
  /// control points is then the smallest one that was found to do.
  double tolerance = 0.0;

  FitParameters parameters = FitParameters::chord_length;
  FitKnots knots = FitKnots::automatic;
  /// For FitKnots::given: increasing from 0 to 1, inner ones with the multiplicity given by repetition; corners p
  /// times.
  std::vector<double> breakpoints;
  FitWeights weights = FitWeights::automatic;
  /// For FitWeights::given: positive, one a point; their scale does not matter.
  std::vector<double> point_weights;

  /// Method fixed_knots: how often every parameter is moved to the nearest point of the curve and the fit repeated
  /// (Hoschek, Intrinsic parametrization for approximation, CAGD 5, 1988).
  int parameter_corrections = 0;

  /// Method free: steps in which knots, parameters and control points are improved together (Levenberg and Marquardt).
  /// 0 leaves the knots where the errors had them put; each step lowers the distances, the first ones most, and costs
  /// about as much as three linear fits. Up to two more are taken while the largest distance stands out of the others.
  int knot_steps = 2;
  /// Method free: rounds in which the largest distance is lowered at little cost of the others, see peak_steps.h; each
  /// costs somewhat more than a knot step. 8 of both take four to six times as long as the default.
  int peak_steps = 0;

  /// The factor mu >= 0 of the fairness term mu * integral of |C^(fairness_derivative)|^2 over [0, 1], which is added
  /// to the mean weighted squared distance. If it is absent, method free chooses mu by fairness_share, and the other
  /// methods take 0.
  std::optional<double> fairness;
  /// Method free: mu is such that the fairness term is this share of the mean squared distance before the steps. On the
  /// same knots the root mean square distance then grows by no more than the factor sqrt(1 + share). 0 or more.
  double fairness_share = 0.2;
  /// 2 or 3.
  int fairness_derivative = 3;

  /// Points at which the polygon of the data turns by more than this angle, in degrees, become corners: knots of
  /// multiplicity p, at which the curve is only continuous, and which it meets; of such points less than p steps from
  /// one another the sharpest. 0: none. Range 0 to 180.
  double corner_angle = 0.0;

  /// Open curves.
  FitEnd start = FitEnd::interpolated;
  FitEnd end = FitEnd::interpolated;
  Vector<Dim> start_tangent = Vector<Dim>::Zero();
  Vector<Dim> end_tangent = Vector<Dim>::Zero();
};

/// How well a curve meets points: true distances, from each point to the nearest point of the whole curve.
template <int Dim>
struct FitQuality {
  double max_distance = 0.0;
  /// The square root of the mean squared distance (not weighted).
  double rms_distance = 0.0;
  /// The point with the largest distance.
  int worst_point = 0;
  /// Length times the integral of the squared curvature over the length: dimensionless, 4 pi^2 on a circle. Relative
  /// accuracy 1e-6.
  double bending_energy = 0.0;
  /// Plane curves: how often the curvature changes its sign, round the whole curve if it is closed. 0 in space.
  int curvature_sign_changes = 0;
};

template <int Dim>
struct CurveFit {
  /// Polynomial, over [0, 1]. Closed: on a periodic knot vector, the last p control points repeating the first p; if
  /// there are corners, clamped at the first of them.
  NurbsCurve<Dim> curve;
  /// Of the nearest point to each of the given points.
  std::vector<double> parameters{};
  std::vector<double> distances{};
  FitQuality<Dim> quality{};
  /// Distinct control points.
  int control_points = 0;
  /// Linear least-squares problems solved.
  int iterations = 0;
  /// Whether `tolerance` is met; true if none was asked for.
  bool tolerance_met = true;
  /// Indices of the points that became corners.
  std::vector<int> corners{};
};

/// Fits a curve to ordered points, Dim x m. Consecutive equal points count once (with their weights added). Throws
/// GeometryError, naming the point or option, for coordinates that are not finite, points that all coincide, fewer
/// distinct points than control points, fewer than p + 1 control points, weights that are not positive, knots that
/// leave a control point without data, and options that contradict each other.
///
/// Time and memory are O(m) for a given number of control points.
template <int Dim>
CurveFit<Dim> fit_points(const Points<Dim>& points, const CurveFitOptions<Dim>& options);

/// The quality of any curve, whatever it comes from; rational ones too. `closed` joins its ends when sign changes are
/// counted.
template <int Dim>
FitQuality<Dim> fit_quality(const NurbsCurve<Dim>& curve, const Points<Dim>& points, bool closed);

}  // namespace isorim::geometry
