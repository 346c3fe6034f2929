#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include "geometry/intersection/clip.h"
#include "io/case/schema.h"

/// What every shape of a case file may say: its name, how it is moved, and how a solid is cut.
namespace isorim::io {

struct RotationKeys {
  std::optional<Eigen::Vector3d> axis;
  double angle = 0.0;
  Coordinates point;
  KeyPlace where;
};

struct MirrorKeys {
  Coordinates point;
  Coordinates normal;
  KeyPlace where;
};

/// Applied in the order scale, mirror, rotate, translate.
struct TransformKeys {
  std::optional<NumberArray> scale;
  std::optional<MirrorKeys> mirror;
  std::optional<RotationKeys> rotate;
  std::optional<Coordinates> translate;
  KeyPlace where;
};

/// What every shape may have.
struct ShapeKeys {
  std::string name;
  OneOrMany<TransformKeys> transform;
  KeyPlace where;
};

// --- Cutting solids -------------------------------------------------------------------------------------------

struct PlaneClipKeys {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  KeyPlace where;
};

struct SphereClipKeys {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = 0.0;
  geometry::KeptSide keep = geometry::KeptSide::inside;
  KeyPlace where;
};

struct CylinderClipKeys {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  double radius = 0.0;
  geometry::KeptSide keep = geometry::KeptSide::inside;
  KeyPlace where;
};

struct ConeClipKeys {
  Eigen::Vector3d apex = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  double half_angle = 0.0;
  geometry::KeptSide keep = geometry::KeptSide::inside;
  KeyPlace where;
};

using ClipKeys = std::variant<PlaneClipKeys, SphereClipKeys, CylinderClipKeys, ConeClipKeys>;

/// What every shape of space may have.
struct SolidKeys : ShapeKeys {
  /// After the transform, one after the other.
  OneOrMany<ClipKeys> clip;
};

}  // namespace isorim::io
