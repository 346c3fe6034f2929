#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "geometry/fitting/contour_ordering.h"
#include "geometry/fitting/curve_fit.h"
#include "geometry/fitting/section_solid.h"
#include "io/case/shape_base_keys.h"

/// What a case file says of shapes that are fitted to measured points. The declarations are in fit_declarations.cpp,
/// the construction in io/fit/.
namespace isorim::io {

enum class PointOrder {
  as_given,
  /// geometry::order_contours().
  contours,
  /// geometry::order_by_density().
  density,
};

/// How a cloud is cut into sections.
struct SliceKeys {
  /// 0, 1, 2 for x, y, z.
  int axis = 2;
  double thickness = 0.0;
  KeyPlace where;
};

struct FitKeys : SolidKeys {
  /// Exactly one of the two; a body if there are sections or slices, else a region of the plane.
  std::string points;
  std::vector<std::string> sections;
  std::optional<SliceKeys> slices;
  std::vector<double> heights;

  // The points.
  PointOrder order = PointOrder::as_given;
  std::optional<Eigen::Vector2d> cell;
  double largest_gap = 0.15;
  int least_points = 6;
  int reach = 1;

  // The curves.
  bool closed = true;
  int degree = 3;
  std::optional<int> control_points;
  std::optional<double> tolerance;
  /// "uniform", "curvature", "counts" or a file; empty: the file's column of weights, else uniform.
  std::string weights;
  std::optional<geometry::FitMethod> method;
  geometry::FitParameters parameters = geometry::FitParameters::chord_length;
  geometry::FitKnots knots = geometry::FitKnots::uniform;
  int corrections = 0;
  int knot_steps = 2;
  int peak_steps = 0;
  double fairness = 0.0;
  double corner_angle = 0.0;

  // The body.
  geometry::BodyEnds ends = geometry::BodyEnds::caps;
  std::optional<Eigen::Vector3d> start_tip;
  std::optional<Eigen::Vector3d> end_tip;
  int degree_across = 3;
  geometry::StartRule start = geometry::StartRule::least_twist;
  geometry::Uniformisation uniformisation = geometry::Uniformisation::merge;
  int inserted_knots = 25;
  double removal_tolerance = 0.0;

  /// Where relative paths begin, the folder of the case file; set by its reader.
  std::filesystem::path folder;

  bool is_body() const { return !sections.empty() || slices.has_value(); }
};

}  // namespace isorim::io
