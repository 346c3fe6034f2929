#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "geometry/nurbs/curve.h"
#include "geometry/topology/orientation.h"
#include "io/svg/bezier_path.h"
#include "io/svg/frame.h"

/// Drawings of plane boundaries, true to scale.
namespace isorim::io::svg {

/// A curvature comb: teeth from the curve outwards, as long as its curvature says.
struct Comb {
  /// 2 x n each: tooth i goes from foot i to tip i.
  geometry::Points<2> feet;
  geometry::Points<2> tips;
};

struct Drawing {
  std::string title;
  /// The area inside the closed chains is filled by the even-odd rule, so holes stay empty; open ones are lines.
  std::vector<Chain> chains;
  /// false: closed chains are lines as well.
  bool fill = true;
  /// Points under the curves, such as those that they were fitted to.
  std::vector<geometry::Points<2>> marks = {};
  /// Teeth, and a line through their tips.
  std::vector<Comb> combs = {};
  bool show_control_net = false;
  bool show_axes = true;
  /// Axis labels, with the unit of length where there is one.
  std::string x_label;
  std::string y_label;
  /// The picture is as large as fits into this, in pixels; one unit is equally long in x and y.
  int largest_width = 720;
  int largest_height = 720;
};

/// The loops of an oriented boundary, each run through with the region on its left.
std::vector<Chain> chains(const geometry::OrientedBoundary<2>& oriented);

/// The drawing as an SVG document; the same text for the same drawing on every machine.
///
/// Polynomial Bézier segments of degree 3 at most are drawn exactly, up to coordinates rounded to 0.001 pixels; others
/// by cubic segments that stay within 0.01 pixels of the curve (measured at 16 parameters of each). Throws InputError
/// if there is nothing to draw or the picture is smaller than 200 x 150.
std::string to_svg(const Drawing& drawing);

/// Writes `to_svg(drawing)` atomically; errors as write_file and to_svg.
void write_svg(const std::filesystem::path& path, const Drawing& drawing);

}  // namespace isorim::io::svg
