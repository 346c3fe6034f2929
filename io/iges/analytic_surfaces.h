#pragma once

#include <optional>

#include "geometry/vocabulary.h"
#include "io/iges/surfaces.h"

namespace isorim::io::iges {

/// Where a surface of the series 190 to 198 sits: a right-handed orthonormal frame.
struct Frame {
  geometry::Point3 origin = geometry::Point3::Zero();
  geometry::Vector3 x = geometry::Vector3::UnitX();
  geometry::Vector3 y = geometry::Vector3::UnitY();
  geometry::Vector3 z = geometry::Vector3::UnitZ();

  /// Coordinates of a point in the frame.
  geometry::Point3 inward(const geometry::Point3& point) const;
};

/// z along `axis`, x as near to `reference` as it can be; without a reference in some direction across. Throws
/// GeometryError if a direction is zero or both are parallel.
Frame frame_of(const geometry::Point3& origin, const geometry::Vector3& axis,
               const std::optional<geometry::Vector3>& reference);

enum class AnalyticKind { plane, cylinder, cone, sphere, torus };

/// 108, 190, 192, 194, 196, 198: surfaces without ends, or whose seam is nowhere in particular. Angles are in degrees.
///
/// plane: origin + u x + v y. cylinder, cone: origin + (radius + v slope) (cos u x + sin u y) + v z. sphere: origin +
/// radius (cos v (cos u x + sin u y) + sin v z). torus: origin + (radius + minor cos u)(cos v x - sin v y) + minor sin
/// u z.
struct AnalyticSurface {
  AnalyticKind kind = AnalyticKind::plane;
  Frame frame;
  /// The major one of a torus; unused by a plane.
  double radius = 0.0;
  double minor_radius = 0.0;
  /// Tangent of a cone's half angle.
  double slope = 0.0;
  /// Whether the file says where u = 0 is: form 1 of the series.
  bool parametrised = true;
};

/// A map whose linear part is not orthogonal up to a factor makes something else of these surfaces: GeometryError.
AnalyticSurface transform(const AnalyticSurface& surface, const geometry::AffineMap<3>& map);

/// The surface at the given distance along its normal. Throws GeometryError if a radius would not be positive.
AnalyticSurface offset(const AnalyticSurface& surface, double distance);

/// The rectangle of parameters that is needed.
struct ParameterBox {
  geometry::Interval u;
  geometry::Interval v;
};

/// What a point's parameters are. Angles in [0, 360), latitudes in [-90, 90].
geometry::Point2 parameters_of(const AnalyticSurface& surface, const geometry::Point3& point);

/// A NURBS that covers `needed`: exactly that in lengths, whole turns in angles, beginning at a multiple of a quarter
/// turn, and from pole to pole. A cone ends at its apex. Throws GeometryError if nothing is left.
ParametrisedSurface finite_part(const AnalyticSurface& surface, const ParameterBox& needed);

}  // namespace isorim::io::iges
