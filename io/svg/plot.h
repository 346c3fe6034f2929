#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "geometry/vocabulary.h"
#include "io/svg/frame.h"

/// Charts of one quantity against another, such as error against the number of points.
namespace isorim::io::svg {

enum class Line { none, solid, dashed };
enum class Marker { none, circle, square, triangle, diamond, cross };

/// A row of points in the order in which the line runs through them. `x` and `y` have the same size.
struct Series {
  /// What the legend says; an empty name is left out of the legend.
  std::string name;
  std::vector<double> x;
  std::vector<double> y;
  Line line = Line::solid;
  /// By default one after the other of circle, square, triangle, diamond, cross.
  std::optional<Marker> marker = std::nullopt;
};

struct PlotAxis : Axis {
  /// What to show; by default everything, up to round numbers. Points outside are cut off.
  std::optional<geometry::Interval> range = std::nullopt;
};

struct Plot {
  std::string title;
  PlotAxis x;
  PlotAxis y;
  std::vector<Series> series;
  /// Pixels.
  int width = 720;
  int height = 480;
};

/// The chart as an SVG document; the same text for the same plot on every machine.
///
/// A point that a logarithmic axis cannot show because a coordinate is zero or less is drawn at the axis's low end
/// with a hollow marker, and the legend says so; the line is interrupted there. Points with a coordinate that is not
/// finite are left out, and the legend says how many. The legend stands in the corner where it hides no data, else
/// beside the chart. Throws InputError if the sizes of a series differ, if a range is empty, not finite or (on a
/// logarithmic axis) not positive, or if the picture is smaller than 200 x 150.
std::string to_svg(const Plot& plot);

/// Writes `to_svg(plot)` atomically; errors as write_file and to_svg.
void write_svg(const std::filesystem::path& path, const Plot& plot);

}  // namespace isorim::io::svg
