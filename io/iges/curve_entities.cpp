#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/nurbs/curve.h"
#include "io/iges/entity_reader.h"

/// The curve entities.
namespace isorim::io::iges {

using geometry::AffineMap;
using geometry::Interval;
using geometry::NurbsCurve;
using geometry::Point2;
using geometry::Point3;
using geometry::Points;
using geometry::Vector3;

namespace {

bool is_identity(const AffineMap<3>& map) {
  return map.linear.isIdentity(0.0) && map.translation.isZero(0.0);
}

Point2 read_point2(Parameters& p) {
  const double x = p.real();
  const double y = p.real();
  return {x, y};
}

Point3 read_point3(Parameters& p) {
  const double x = p.real();
  const double y = p.real();
  const double z = p.real();
  return {x, y, z};
}

Points<3> read_points(Parameters& p, int count) {
  Points<3> points(3, count);
  p.reals(std::span<double>(points.data(), static_cast<std::size_t>(points.size())));
  return points;
}

/// How far apart the ends of neighbours in a composite curve may be.
double largest_gap(std::span<const ParametrisedCurve> pieces) {
  double size = 0.0;
  for (const ParametrisedCurve& piece : pieces) size = std::max(size, extent(piece.curve.control_points()));
  return 1e-3 * size;
}

}  // namespace

ParametrisedCurve EntityReader::curve(const Entity& entity) {
  if (entity.type == 102) {
    const std::vector<ParametrisedCurve> pieces = curve_pieces(entity);
    if (pieces.empty()) refuse(entity, "the composite curve holds no curve");
    return named(entity, [&] { return composite(pieces, largest_gap(pieces)); });
  }
  const Visit visit(*this, entity);
  charge(entity, entity.tokens.size());
  ParametrisedCurve result = named(entity, [&] { return unplaced_curve(entity); });
  const AffineMap<3> map = placement(entity);
  return is_identity(map) ? result : transform(result, map);
}

std::vector<ParametrisedCurve> EntityReader::curve_pieces(const Entity& entity) {
  if (entity.type != 102) return {curve(entity)};
  const Visit visit(*this, entity);
  charge(entity, entity.tokens.size());
  Parameters p(file_, entity);
  const int count = p.count();
  const AffineMap<3> map = placement(entity);
  std::vector<ParametrisedCurve> result;
  for (int i = 0; i < count; ++i) {
    const Entity& child = p.target();
    // Points mark where curves meet, or stand for a pole; connection points are no geometry.
    if (child.type == 116 || child.type == 132) continue;
    for (ParametrisedCurve& piece : curve_pieces(child))
      result.push_back(is_identity(map) ? std::move(piece) : transform(piece, map));
  }
  return result;
}

ParametrisedCurve EntityReader::unplaced_curve(const Entity& entity) {
  switch (entity.type) {
    case 100:
      return read_arc(entity);
    case 104:
      return read_conic(entity);
    case 106:
      return linear_path(copious_points(entity));
    case 110:
      return read_line(entity);
    case 112:
      return read_parametric_spline(entity);
    case 126:
      return read_b_spline(entity);
    case 130:
      return read_offset_curve(entity);
    default:
      refuse(entity, "a curve (100, 102, 104, 106, 110, 112, 126, 130) is expected here");
  }
}

ParametrisedCurve EntityReader::read_arc(const Entity& entity) {
  Parameters p(file_, entity);
  const double z = p.real();
  const Point2 centre = read_point2(p);
  const Point2 start = read_point2(p);
  const Point2 end = read_point2(p);
  ParametrisedCurve result = arc(z, centre, start, end);
  const double radius = (start - centre).norm();
  if (std::abs((end - centre).norm() - radius) > 1e-4 * radius)
    remark("the ends of the arc are not equally far from its centre; the start's distance is taken", entity);
  return result;
}

ParametrisedCurve EntityReader::read_conic(const Entity& entity) {
  Parameters p(file_, entity);
  Conic conic;
  for (double* coefficient : {&conic.a, &conic.b, &conic.c, &conic.d, &conic.e, &conic.f}) *coefficient = p.real();
  const double z = p.real();
  const Point2 start = read_point2(p);
  const Point2 end = read_point2(p);
  return conic_arc(conic, z, start, end);
}

Points<3> EntityReader::copious_points(const Entity& entity) {
  const bool is_path = (entity.form >= 11 && entity.form <= 13) || entity.form == 63;
  if (!is_path && (entity.form < 1 || entity.form > 3))
    refuse(entity, fmt::format("form {} of copious data is a drawing, not a curve", entity.form));
  Parameters p(file_, entity);
  const int kind = p.integer();
  if (kind < 1 || kind > 3) p.refuse(fmt::format("is {}; expected 1 (pairs), 2 (triples) or 3 (sextuples)", kind));
  const int width = kind == 1 ? 2 : (kind == 2 ? 3 : 6);
  const int count = p.count(width);
  const double z = kind == 1 ? p.real() : 0.0;
  Points<3> points(3, count);
  for (int i = 0; i < count; ++i) {
    if (kind == 1) {
      points.col(i) << read_point2(p), z;
    } else {
      points.col(i) = read_point3(p);
      if (kind == 3) p.skip(3);
    }
  }
  if (entity.form == 63 && count > 1 && points.col(0) != points.col(count - 1)) {
    points.conservativeResize(3, count + 1);
    points.col(count) = points.col(0);
  }
  return points;
}

ParametrisedCurve EntityReader::read_line(const Entity& entity) {
  if (entity.form == 1 || entity.form == 2)
    refuse(entity, "a line without ends is construction geometry; a curve with two ends is expected here");
  Parameters p(file_, entity);
  const Point3 start = read_point3(p);
  const Point3 end = read_point3(p);
  return line(start, end);
}

ParametrisedCurve EntityReader::read_parametric_spline(const Entity& entity) {
  Parameters p(file_, entity);
  p.skip(2);
  const bool is_planar = p.integer(3) == 2;
  // A breakpoint and three cubics each.
  const int count = p.count(13);
  if (count == 0) p.refuse("is 0; a spline has at least one segment");
  const std::vector<double> breakpoints = p.reals(count + 1);
  std::vector<Eigen::Matrix<double, 3, 4>> coefficients(static_cast<std::size_t>(count));
  for (Eigen::Matrix<double, 3, 4>& piece : coefficients)
    for (int row = 0; row < 3; ++row)
      for (int k = 0; k < 4; ++k) {
        const double value = p.real();
        piece(row, k) = is_planar && row == 2 && k > 0 ? 0.0 : value;
      }
  return parametric_spline(breakpoints, coefficients);
}

ParametrisedCurve EntityReader::read_b_spline(const Entity& entity) {
  Parameters p(file_, entity);
  const int last = p.integer();
  BSplineCurveData data;
  data.degree = p.integer();
  p.skip(2);
  const bool says_polynomial = p.integer(0) == 1;
  p.skip();
  if (data.degree < 1 || last < data.degree || last > p.remaining() / 5)
    p.refuse(fmt::format("the degree is {} and the last control point has the number {}, with {} values to follow",
                         data.degree, last, p.remaining()),
             2);
  data.knots = p.reals(last + data.degree + 2);
  data.weights = p.reals(last + 1);
  data.points = read_points(p, last + 1);
  data.range.first = p.real(0.0);
  data.range.last = p.real(0.0);
  Remark remarked;
  ParametrisedCurve result = b_spline(data, remarked);
  if (remarked) remark(*remarked, entity);
  if (says_polynomial && !result.curve.is_polynomial())
    remark("is marked as polynomial (PROP3), but its weights differ; the weights are taken", entity);
  return result;
}

ParametrisedCurve EntityReader::read_offset_curve(const Entity& entity) {
  Parameters p(file_, entity);
  const ParametrisedCurve base = curve(p.target());
  const int kind = p.integer();
  const int function = p.pointer();
  const int coordinate = p.integer(0);
  const bool by_length = p.integer(0) == 1;
  const double first = p.real(0.0);
  const double from = p.real(0.0);
  const double second = p.real(0.0);
  const double to = p.real(0.0);
  OffsetCurveData data;
  data.normal = read_point3(p);
  data.range = {p.real(), 0.0};
  data.range.last = p.real();
  if (kind < 1 || kind > 3) p.refuse(fmt::format("is {}; expected 1, 2 or 3", kind), 2);
  if (kind == 2 && !(from != to)) p.refuse("the two places of a varying offset are one", 9);

  const auto place = [&](double t) {
    if (!by_length) return t;
    const Interval piece{base.parameters(data.range.first), base.parameters(t)};
    return piece.length() > 0.0 ? arc_length(base.curve, piece).value : 0.0;
  };
  if (kind == 1) data.distance = [&](double) { return first; };
  if (kind == 2) data.distance = [&](double t) { return first + (second - first) * (place(t) - from) / (to - from); };
  std::optional<ParametrisedCurve> profile;
  if (kind == 3) {
    const Entity* other = file_.find(function);
    if (other == nullptr || coordinate < 1 || coordinate > 3)
      p.refuse("an offset by a function needs a curve and the number of its coordinate (1, 2 or 3)", 3);
    profile = curve(*other);
    data.distance = [&](double t) { return evaluate_at(*profile, place(t))(coordinate - 1); };
  }
  const Points<3> points = base.curve.control_points();
  charge(entity, static_cast<std::size_t>(points.cols()) * 4096);
  const double tolerance = tolerance_for(extent(points) + std::abs(first));
  ParametrisedCurve result = offset_curve(base, data, tolerance);
  approximation(entity, "offset curve", result.tolerance, result.deviation);
  return result;
}

}  // namespace isorim::io::iges
