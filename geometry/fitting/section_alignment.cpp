#include "geometry/fitting/section_alignment.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "geometry/errors.h"

namespace isorim::geometry {
namespace {

constexpr int sample_count = 256;

bool is_point(const NurbsCurve<3>& curve) {
  const Points<3> points = curve.control_points();
  return (points.colwise() - points.col(0)).isZero(0.0);
}

/// The control points repeat as those of KnotVector::periodic() do, and so do the steps of the knots.
bool is_periodic(const NurbsCurve<3>& curve) {
  const KnotVector& knots = curve.knots();
  const int p = knots.degree();
  const int n = knots.basis_count();
  if (n < 2 * p || knots.is_clamped()) return false;
  const double period = knots.domain().length();
  const double rounding = 1e-12 * (std::abs(knots.domain().first) + std::abs(knots.domain().last));
  for (int i = 0; i <= p; ++i) {
    if (std::abs(knots[i + n - p] - knots[i] - period) > rounding) return false;
    if (std::abs(knots[p + i] + period - knots[n + i]) > rounding) return false;
  }
  return curve.homogeneous().leftCols(p) == curve.homogeneous().rightCols(p);
}

Vector3 polygon_vector_area(const Points<3>& points) {
  Vector3 twice = Vector3::Zero();
  for (Eigen::Index i = 1; i + 1 < points.cols(); ++i) {
    twice += Vector3(points.col(i) - points.col(0)).cross(Vector3(points.col(i + 1) - points.col(0)));
  }
  return 0.5 * twice;
}

/// Points at the parameters k / count of the period.
Points<3> samples(const NurbsCurve<3>& curve, int count = sample_count) {
  const Interval domain = curve.domain();
  Points<3> points(3, count);
  for (int k = 0; k < count; ++k) points.col(k) = evaluate(curve, domain.first + k * domain.length() / count);
  return points;
}

// --- Shifts ---------------------------------------------------------------------------------------------------

/// Sum of the squares of the distances between reference(k) and moved(k + shift).
double twist(const Points<3>& reference, const Points<3>& moved, int shift) {
  const Eigen::Index count = reference.cols();
  const Eigen::Index head = count - shift;
  return (reference.leftCols(head) - moved.rightCols(head)).squaredNorm() +
         (reference.rightCols(shift) - moved.leftCols(shift)).squaredNorm();
}

/// The place of the least of three values at -1, 0, 1 of which the middle one is the least.
double parabola_minimum(double before, double here, double after) {
  const double curvature = before - 2.0 * here + after;
  return curvature > 0.0 ? std::clamp(0.5 * (before - after) / curvature, -0.5, 0.5) : 0.0;
}

/// The part of the period, in [0, 1), by which `moved` is ahead. Columns are points at equal steps.
double least_twist_shift(Points<3> reference, Points<3> moved) {
  reference.colwise() -= reference.rowwise().mean().eval();
  moved.colwise() -= moved.rowwise().mean().eval();
  const int count = static_cast<int>(reference.cols());
  std::vector<double> values;
  for (int shift = 0; shift < count; ++shift) values.push_back(twist(reference, moved, shift));
  const int best = static_cast<int>(std::ranges::min_element(values) - values.begin());
  const auto at = [&](int shift) { return values[static_cast<std::size_t>((shift + count) % count)]; };
  const double fine = best + parabola_minimum(at(best - 1), at(best), at(best + 1));
  const double part = fine / count;
  return part - std::floor(part);
}

/// Newton's method for a stationary sum of squares would need derivatives; the sums of shifted curves are smooth in the
/// shift, so three parabolas through ever nearer values do.
double refined_shift(const NurbsCurve<3>& reference, const NurbsCurve<3>& moved, double shift) {
  Points<3> fixed = samples(reference);
  fixed.colwise() -= fixed.rowwise().mean().eval();
  const Interval domain = moved.domain();
  const auto sum = [&](double s) {
    Points<3> points(3, sample_count);
    for (int k = 0; k < sample_count; ++k) {
      const double t = s + static_cast<double>(k) / sample_count;
      points.col(k) = evaluate(moved, domain.first + (t - std::floor(t)) * domain.length());
    }
    points.colwise() -= points.rowwise().mean().eval();
    return (points - fixed).squaredNorm();
  };
  for (const double step : {1e-3, 1e-4, 1e-4}) {
    shift += step * parabola_minimum(sum(shift - step), sum(shift), sum(shift + step));
  }
  return shift - std::floor(shift);
}

/// Where, as a part of the period, the section should start.
double start_of(const NurbsCurve<3>& reference, const NurbsCurve<3>& section, StartRule rule) {
  if (rule == StartRule::closest) {
    const Interval domain = section.domain();
    const Point3 start = evaluate(reference, reference.domain().first);
    return (closest_point(section, start).u - domain.first) / domain.length();
  }
  return refined_shift(reference, section, least_twist_shift(samples(reference), samples(section)));
}

/// The parameter at that part of the period; a knot that is as good as there itself, so that no span becomes a sliver.
double snapped_parameter(const NurbsCurve<3>& section, double part) {
  const Interval domain = section.domain();
  const double u = std::clamp(domain.first + part * domain.length(), domain.first, domain.last);
  for (const double knot : section.knots().breakpoints()) {
    if (std::abs(knot - u) <= 1e-6 * domain.length()) return knot;
  }
  return u;
}

// --- Polygons -------------------------------------------------------------------------------------------------

/// Points at equal parts of the closed polygon's length.
Points<3> even_samples(const Points<3>& polygon) {
  const Eigen::Index count = polygon.cols();
  std::vector<double> lengths{0.0};
  for (Eigen::Index i = 0; i < count; ++i) {
    lengths.push_back(lengths.back() + (polygon.col((i + 1) % count) - polygon.col(i)).norm());
  }
  Points<3> points(3, sample_count);
  std::size_t side = 0;
  for (int k = 0; k < sample_count; ++k) {
    const double length = lengths.back() * k / sample_count;
    while (side + 2 < lengths.size() && lengths[side + 1] <= length) ++side;
    const double step = lengths[side + 1] - lengths[side];
    const double part = step > 0.0 ? (length - lengths[side]) / step : 0.0;
    const auto i = static_cast<Eigen::Index>(side);
    points.col(k) = (1.0 - part) * polygon.col(i) + part * polygon.col((i + 1) % count);
  }
  return points;
}

Eigen::Index nearest_column(const Points<3>& points, const Point3& place) {
  Eigen::Index nearest = 0;
  (points.colwise() - place).colwise().squaredNorm().minCoeff(&nearest);
  return nearest;
}

void rotate_columns(Points<3>& points, Eigen::Index first) {
  const Points<3> given = points;
  points << given.rightCols(given.cols() - first), given.leftCols(first);
}

}  // namespace

bool is_closed(const NurbsCurve<3>& curve) {
  const Points<3> points = curve.control_points();
  const double size = (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).norm();
  return (evaluate(curve, curve.domain().first) - evaluate(curve, curve.domain().last)).norm() <= 1e-9 * size;
}

Vector3 vector_area(const NurbsCurve<3>& curve) {
  return polygon_vector_area(samples(curve));
}

NurbsCurve<3> start_at(const NurbsCurve<3>& curve, double u) {
  const Interval domain = curve.domain();
  if (!is_closed(curve)) throw GeometryError("start of a section: the curve is not closed");
  if (!domain.contains(u)) {
    throw GeometryError(
        fmt::format("start of a section: {} lies outside the domain [{}, {}]", u, domain.first, domain.last));
  }
  const Interval unit{0.0, 1.0};
  if (u == domain.first || u == domain.last) return reparametrise(clamp(curve), unit);
  if (!is_periodic(curve)) {
    const auto [before, after] = split(curve, u);
    const std::vector<NurbsCurve<3>> halves{after, before};
    return reparametrise(join<3>(halves, 1e-8 * (1.0 + curve.control_points().cwiseAbs().maxCoeff())), unit);
  }
  // Two periods, of which one is cut out.
  const int p = curve.degree();
  const std::span<const double> knots = curve.knots().knots();
  const int period = curve.knots().basis_count() - p;
  std::vector<double> breakpoints(knots.begin() + p, knots.begin() + p + period + 1);
  for (int i = 1; i <= period; ++i) breakpoints.push_back(breakpoints[static_cast<std::size_t>(i)] + domain.length());
  HomogeneousPoints<3> net(4, 2 * period + p);
  for (int i = 0; i < net.cols(); ++i) net.col(i) = curve.homogeneous().col(i % period);
  const NurbsCurve<3> twice(KnotVector::periodic(p, breakpoints), std::move(net));
  return reparametrise(restrict_to(twice, Interval{u, u + domain.length()}), unit);
}

std::vector<NurbsCurve<3>> align_sections(std::span<const NurbsCurve<3>> sections, StartRule rule) {
  std::vector<NurbsCurve<3>> aligned;
  std::optional<std::size_t> before;
  for (std::size_t k = 0; k < sections.size(); ++k) {
    NurbsCurve<3> section = sections[k];
    if (!is_point(section)) {
      if (!is_closed(section)) throw GeometryError(fmt::format("section {} is not closed", k + 1));
      if (before) {
        if (vector_area(section).dot(vector_area(aligned[*before])) < 0.0) section = reverse(section);
        if (rule != StartRule::as_given) {
          section = start_at(section, snapped_parameter(section, start_of(aligned[*before], section, rule)));
        }
      }
      before = k;
    }
    aligned.push_back(reparametrise(clamp(section), Interval{0.0, 1.0}));
  }
  return aligned;
}

std::vector<PolygonAlignment> align_polygons(std::span<Points<3>> polygons, StartRule rule) {
  std::vector<PolygonAlignment> done(polygons.size());
  for (std::size_t k = 1; k < polygons.size(); ++k) {
    const Points<3>& reference = polygons[k - 1];
    Points<3>& polygon = polygons[k];
    if (reference.cols() < 3 || polygon.cols() < 3) continue;
    done[k].reversed = polygon_vector_area(polygon).dot(polygon_vector_area(reference)) < 0.0;
    if (done[k].reversed) polygon = polygon.rowwise().reverse().eval();
    if (rule == StartRule::closest) {
      done[k].first = nearest_column(polygon, reference.col(0));
    } else if (rule == StartRule::least_twist) {
      const Points<3> even = even_samples(polygon);
      const double shift = least_twist_shift(even_samples(reference), even) * sample_count;
      const auto lower = static_cast<Eigen::Index>(shift);
      const double part = shift - std::floor(shift);
      const Point3 start = (1.0 - part) * even.col(lower % sample_count) + part * even.col((lower + 1) % sample_count);
      done[k].first = nearest_column(polygon, start);
    }
    rotate_columns(polygon, done[k].first);
  }
  return done;
}

}  // namespace isorim::geometry
