#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include "geometry/propeller/series.h"
#include "geometry/tspline/refinement.h"
#include "io/cad/read_cad.h"
#include "io/case/fit_keys.h"
#include "io/case/hull_keys.h"
#include "io/case/schema.h"
#include "io/case/shape_base_keys.h"
#include "io/propeller/blade_table.h"

/// What a case file says of shapes, as it stands there: angles in degrees, lengths in the unit of the shape. The
/// declarations (types, ranges, texts) are in shape_declarations.cpp, the construction in shape_builder.h.
namespace isorim::io {

// --- Curves ---------------------------------------------------------------------------------------------------

struct LineKeys : ShapeKeys {
  Coordinates from;
  Coordinates to;
};

struct PolylineKeys : ShapeKeys {
  std::vector<Coordinates> points;
};

struct ArcKeys : ShapeKeys {
  double radius = 0.0;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Eigen::Vector2d angles = {0.0, 360.0};
};

struct EllipseArcKeys : ShapeKeys {
  Eigen::Vector2d radii = Eigen::Vector2d::Zero();
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double rotation = 0.0;
  Eigen::Vector2d angles = {0.0, 360.0};
};

struct NurbsCurveKeys : ShapeKeys {
  int degree = 0;
  std::vector<double> knots;
  std::vector<Coordinates> points;
  std::vector<double> weights;
  std::vector<Coordinates> homogeneous;
  bool periodic = false;
};

struct CircleKeys : ShapeKeys {
  double radius = 0.0;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
};

struct EllipseKeys : ShapeKeys {
  Eigen::Vector2d radii = Eigen::Vector2d::Zero();
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double rotation = 0.0;
};

struct RectangleKeys : ShapeKeys {
  Eigen::Vector2d size = Eigen::Vector2d::Zero();
  Eigen::Vector2d corner = Eigen::Vector2d::Zero();
};

struct PolygonKeys : ShapeKeys {
  std::vector<Coordinates> points;
};

using CurveKeys = std::variant<LineKeys, PolylineKeys, ArcKeys, EllipseArcKeys, NurbsCurveKeys, CircleKeys, EllipseKeys,
                               RectangleKeys, PolygonKeys>;

/// Curves that follow one another and close.
struct PathKeys : ShapeKeys {
  std::vector<CurveKeys> curves;
};

// --- Regions of the plane -------------------------------------------------------------------------------------

/// What the author says a loop is; checked against the nesting that is found.
enum class LoopRole { any, outer, hole };

template <class Keys>
struct LoopOf : Keys {
  LoopRole role = LoopRole::any;
};

using LoopKeys = std::variant<LoopOf<PathKeys>, LoopOf<CircleKeys>, LoopOf<EllipseKeys>, LoopOf<RectangleKeys>,
                              LoopOf<PolygonKeys>, LoopOf<NurbsCurveKeys>>;

struct RegionKeys : ShapeKeys {
  std::vector<LoopKeys> loops;
};

using PlaneRegionKeys = std::variant<RegionKeys, CircleKeys, EllipseKeys, RectangleKeys, PolygonKeys, PathKeys>;

// --- Surfaces and solids --------------------------------------------------------------------------------------

struct SphereKeys : SolidKeys {
  double radius = 0.0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  int patches = 1;
};

struct EllipsoidKeys : SolidKeys {
  Eigen::Vector3d radii = Eigen::Vector3d::Zero();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
};

struct TorusKeys : SolidKeys {
  double major_radius = 0.0;
  double minor_radius = 0.0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  int patches = 1;
};

struct CylinderKeys : SolidKeys {
  double radius = 0.0;
  double height = 0.0;
  Eigen::Vector3d base = Eigen::Vector3d::Zero();
};

struct ConeKeys : SolidKeys {
  std::optional<double> radius;
  std::optional<Eigen::Vector2d> radii;
  double height = 0.0;
  Eigen::Vector3d base = Eigen::Vector3d::Zero();
};

struct BoxKeys : SolidKeys {
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
  Eigen::Vector3d corner = Eigen::Vector3d::Zero();
};

struct AxisKeys {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
  KeyPlace where;
};

/// What becomes of the first and last place of a swept profile.
enum class SweepEnds { open, caps };

/// Exactly one of `profile` and `region`.
struct RevolveKeys : SolidKeys {
  std::vector<CurveKeys> profile;
  std::optional<PlaneRegionKeys> region;
  AxisKeys axis;
  double angle = 360.0;
  SweepEnds ends = SweepEnds::open;
};

/// Exactly one of `profile` and `region`.
struct ExtrudeKeys : SolidKeys {
  std::vector<CurveKeys> profile;
  std::optional<PlaneRegionKeys> region;
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
};

/// A single surface of which a part may be kept.
struct FaceKeys : ShapeKeys {
  /// In the parameters of the surface; without loops all of it is kept.
  std::vector<LoopKeys> trims;
};

struct RuledKeys : FaceKeys {
  std::vector<CurveKeys> curves;
};

struct LoftKeys : SolidKeys {
  std::vector<CurveKeys> sections;
  int degree = 3;
  SweepEnds ends = SweepEnds::open;
};

struct DiscKeys : FaceKeys {
  double radius = 0.0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
};

struct QuadrilateralKeys : FaceKeys {
  std::vector<Coordinates> corners;
};

struct NurbsPatchKeys : FaceKeys {
  Eigen::Vector2i degrees = Eigen::Vector2i::Zero();
  std::vector<double> knots_u;
  std::vector<double> knots_v;
  PointGrid points;
  NumberArray weights;
  PointGrid homogeneous;
};

/// What consists of NURBS patches.
using NurbsSurfaceKeys = std::variant<NurbsPatchKeys, QuadrilateralKeys, DiscKeys, RevolveKeys, ExtrudeKeys, RuledKeys,
                                      LoftKeys, SphereKeys, EllipsoidKeys, TorusKeys, CylinderKeys, ConeKeys, BoxKeys>;

// --- T-splines ------------------------------------------------------------------------------------------------

/// A part of a knot line.
struct PartialLineKeys {
  double at = 0.0;
  double from = 0.0;
  double to = 0.0;
  KeyPlace where;
};

/// Which faces are bisected; all conditions that are given must hold.
struct RefineKeys {
  /// An expression in x, y, z.
  std::string condition;
  std::vector<Coordinates> box;
  std::optional<Eigen::Vector2d> u;
  std::optional<Eigen::Vector2d> v;
  int levels = 1;
  geometry::Bisection direction = geometry::Bisection::both;
  KeyPlace where;
};

/// A T-mesh by knots and lines, or NURBS (`from`).
struct TSplineKeys : SolidKeys {
  OneOrMany<NurbsSurfaceKeys> from;
  std::optional<Eigen::Vector2i> degrees;
  std::vector<double> knots_u;
  std::vector<double> knots_v;
  std::vector<PartialLineKeys> lines_u;
  std::vector<PartialLineKeys> lines_v;
  std::vector<Coordinates> points;
  std::vector<double> weights;
  std::vector<Coordinates> homogeneous;
  OneOrMany<RefineKeys> refine;
};

/// How the sections of a blade come to the same knots.
enum class BladeUniformisation { averaged, merge, insert_and_remove };

/// What a blade's sections come from; `own`: the case's own table or points.
enum class BladeSource { own, kaplan, b_troost };

/// The points of a section.
struct BladeSectionKeys {
  double radius_ratio = 0.0;
  std::string file;
  KeyPlace where;
};

/// Exactly one of move_x, move_y and smooth.
struct BladeEditKeys {
  double radius_ratio = 0.0;
  int point = 0;
  std::optional<double> move_x;
  std::optional<double> move_y;
  bool smooth = false;
  KeyPlace where;
};

/// A screw: of a systematic series, by a table, or by the points of its sections.
struct PropellerKeys : SolidKeys {
  BladeSource series = BladeSource::own;
  std::optional<BladeTableKeys> table;
  std::string table_file;
  std::vector<BladeSectionKeys> sections;
  geometry::ThicknessForm thickness_form = geometry::ThicknessForm::naca_66_mod;
  geometry::MeanLine mean_line = geometry::MeanLine::naca_a08;
  int points_a_side = 25;
  double diameter = 0.0;
  int blades = 0;
  std::optional<double> area_ratio;
  /// One number, or rows of r / R and the value.
  NumberArray pitch_ratio;
  /// Degrees, or rows of r / R and a length.
  NumberArray rake;
  /// Degrees at the tip, or rows of r / R and degrees.
  NumberArray skew;
  bool has_reduced_root_pitch = false;
  /// 0: no hub.
  double hub_ratio = 0.2;
  std::optional<Eigen::Vector2d> hub_ends;
  /// In (X, distance from the shaft); takes the place of hub_ratio and hub_ends.
  std::vector<CurveKeys> hub_profile;
  geometry::Hand hand = geometry::Hand::right;
  BladeUniformisation uniformisation = BladeUniformisation::averaged;
  int inserted_knots = 25;
  /// Absent: 1e-4 of the diameter.
  std::optional<double> removal_tolerance;
  std::vector<BladeEditKeys> edits;
  /// Where relative paths begin, the folder of the case file; set by its reader.
  std::filesystem::path folder;
};

using SurfaceKeys =
    std::variant<NurbsPatchKeys, QuadrilateralKeys, DiscKeys, RevolveKeys, ExtrudeKeys, RuledKeys, LoftKeys, SphereKeys,
                 EllipsoidKeys, TorusKeys, CylinderKeys, ConeKeys, BoxKeys, TSplineKeys>;

struct PatchesKeys : SolidKeys {
  std::vector<SurfaceKeys> patches;
};

/// Exactly one of `curves` (a region of the plane) and `patches` (surfaces in space).
struct NurbsKeys : SolidKeys {
  std::vector<LoopOf<NurbsCurveKeys>> curves;
  std::vector<NurbsPatchKeys> patches;
};

/// The boundary that a CAD file holds.
struct FileKeys : SolidKeys {
  std::string path;
  /// Empty: the file's own.
  std::string units;
  std::optional<int> dimension;
  BlankedEntities blanked = BlankedEntities::skip;
  /// Millimetres.
  std::optional<double> repair;
  std::vector<std::string> names;
  std::vector<int> levels;
  /// Where a relative path begins, the folder of the case file; set by its reader.
  std::filesystem::path folder;
};

using GeometryKeys =
    std::variant<CircleKeys, EllipseKeys, EllipseArcKeys, RectangleKeys, PolygonKeys, RegionKeys, NurbsKeys, SphereKeys,
                 EllipsoidKeys, TorusKeys, CylinderKeys, ConeKeys, BoxKeys, RevolveKeys, ExtrudeKeys, RuledKeys,
                 LoftKeys, PatchesKeys, TSplineKeys, PropellerKeys, FileKeys, FitKeys, HullKeys>;

}  // namespace isorim::io
