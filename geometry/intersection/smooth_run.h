#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "geometry/vocabulary.h"

namespace isorim::geometry {

/// Position, unit tangent and curvature vector at a point of a curve.
struct ArcJet {
  Point2 point;
  Vector2 tangent;
  Vector2 bend;
};

/// A Bézier segment of degree 5 over an interval of the arc length.
struct ArcSegment {
  Interval s;
  Points<2> points;
};

/// What is known of a smooth stretch of a curve: points by arc length, and how far quintic Hermite segments are off.
struct RunSamples {
  struct Sample {
    double s = 0.0;
    Point2 point;
  };
  struct Span {
    Interval s;
    double error = 0.0;
  };
  /// Both in increasing order, the samples without the end of the run, a few in every span.
  std::vector<Sample> samples;
  std::vector<Span> spans;
  /// At both ends; not used if the run closes upon itself.
  ArcJet start;
  ArcJet end;
  bool is_periodic = false;
};

struct RunSpline {
  std::vector<ArcSegment> segments;
  /// The largest distance found.
  double error = 0.0;
};

/// A quintic spline with simple knots, so C4, within `allowed` of the run; with the position, tangent and curvature
/// given at its ends, or periodic. Least squares; knots such that every span has the same share of the error, as the
/// Hermite segments have it (the sixth root of the error over the length is the density; C. de Boor, A Practical Guide
/// to Splines, 2001, chapter XII). It takes about a third of the control points of C2 Hermite segments. `at` gives the
/// point at an arc length, for checks between the samples. Nothing if this is not found in a few trials with fewer
/// control points than those have.
std::optional<RunSpline> smooth_run_spline(const RunSamples& run, double allowed,
                                           const std::function<Point2(double)>& at);

}  // namespace isorim::geometry
