#pragma once

#include <memory>
#include <vector>

#include "geometry/bezier/element_table.h"
#include "geometry/boundary.h"
#include "geometry/vocabulary.h"
#include "solver/hydrostatics/wetted_sums.h"

/// A body that is cut by many water planes.
namespace isorim::solver {

/// Water lies where up . x < offset, in the coordinates of the body.
struct WaterPlane {
  /// Of unit length.
  geometry::Vector3 up = geometry::Vector3::UnitZ();
  double offset = 0.0;
};

/// A stretch of the waterline: t -> S(c(t)), t in [0, 1], S an element over its unit cell.
struct WaterlinePiece {
  int element = 0;
  /// 3 x (p + 1) homogeneous points in the unit cell, the immersed part on the left.
  geometry::HomogeneousPoints<2> parameters;
};

/// Integrals over the wetted part of a boundary.
struct WettedPart {
  /// About FloatingBody::reference(). The area is to the tolerance only if it was asked for.
  WettedSums sums;
  /// Elements that were cut, and elements wholly under water.
  int cut_elements = 0;
  int immersed_elements = 0;
  /// The edges of the wetted part in the water plane; if asked for.
  std::vector<WaterlinePiece> waterline;
  /// The plane was moved by this along `up`, since it meets the boundary in a singular point: at most 4e-11 of the
  /// size. 0 nearly always.
  double shift = 0.0;
};

struct FloatingBodyOptions {
  /// Relative, of integrals over rational elements and of areas; see WettedScales.
  double tolerance = 1e-11;
  /// 0: all that OpenMP offers; for the construction alone.
  int threads = 0;
};

/// What does not depend on the water plane is computed once: the integrals over each element. A plane takes those of
/// the elements below it as they are and cuts the elements that it meets, one by one (geometry/intersection/
/// clipped_cell.h); no caps, loops or faces are made. Its functions may be called from several threads at a time.
class FloatingBody {
 public:
  /// `boundary` is closed and oriented (see orient()). Throws GeometryError if it encloses nothing.
  explicit FloatingBody(const geometry::Boundary<3>& boundary, const FloatingBodyOptions& options = {});
  ~FloatingBody();
  FloatingBody(FloatingBody&&) noexcept;
  FloatingBody& operator=(FloatingBody&&) noexcept;

  /// The point about which sums are taken: the middle of the box.
  const geometry::Point3& reference() const;
  /// Of the control points.
  const geometry::BoundingBox<3>& box() const;
  const geometry::ElementTable<3>& table() const;
  /// Over the whole boundary.
  const WettedSums& whole() const;
  /// Of the whole body.
  double volume() const;
  double tolerance() const;

  enum class Waterline { skip, collect };
  /// The part of the boundary under water: faces in the plane do not belong to it, nor what touches it from above.
  /// Throws GeometryError if an element cannot be cut, nor a plane nearby.
  WettedPart wetted(const WaterPlane& plane, WettedScope scope = WettedScope::moments,
                    Waterline waterline = Waterline::skip) const;

  /// min direction . x over the boundary, to rounding. Where it is reached along a curve that follows no parameter
  /// line, to about 1e-9 of the size.
  double lowest(const geometry::Vector3& direction) const;

 private:
  struct Elements;
  std::unique_ptr<const Elements> elements_;
};

/// A point of the waterline, in the coordinates of the body.
geometry::Point3 point_on(const FloatingBody& body, const WaterlinePiece& piece, double t);

/// max direction . x over pieces of the waterline; nothing without pieces. To rounding.
double farthest(const FloatingBody& body, const std::vector<WaterlinePiece>& waterline,
                const geometry::Vector3& direction);

}  // namespace isorim::solver
