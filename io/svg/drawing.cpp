#include "io/svg/drawing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/atomic_file.h"
#include "io/svg/bezier_path.h"

namespace isorim::io::svg {

namespace {

using geometry::Points;

constexpr double tolerance_pixels = 0.01;
constexpr double width_of_margin = 0.05;
constexpr int least_width = 200;
constexpr int least_height = 150;

/// All control points: holds the curves, but loosely.
Bounds control_bounds(const Drawing& drawing) {
  Bounds bounds;
  for (const Chain& chain : drawing.chains) {
    for (const auto& curve : chain) bounds.add(curve.control_points());
  }
  if (bounds.is_empty() || bounds.diagonal() == 0.0)
    throw InputError("the drawing is empty: no curves, or all of them in one point");
  return bounds;
}

/// The chains as segments that can be drawn, in units of the shape.
using DrawableChain = std::vector<PathSegment>;

std::vector<DrawableChain> drawable_chains(const Drawing& drawing, double tolerance) {
  std::vector<DrawableChain> result;
  for (const Chain& chain : drawing.chains) result.push_back(path_segments(chain, tolerance));
  return result;
}

/// The extent of what is drawn.
Bounds drawn_bounds(const Drawing& drawing, const std::vector<DrawableChain>& drawable) {
  Bounds bounds;
  if (drawing.show_control_net) bounds = control_bounds(drawing);
  for (const Points<2>& marks : drawing.marks) bounds.add(marks);
  for (const Comb& comb : drawing.combs) bounds.add(comb.tips);
  for (const DrawableChain& chain : drawable) {
    for (const PathSegment& segment : chain) add_extent(segment, bounds);
  }
  return bounds;
}

/// What is drawn where.
struct Layout {
  Frame frame;
  FrameTicks ticks;
  int width = 0;
  int height = 0;

  PathSegment to_pixels(const Points<2>& points) const {
    PathSegment pixels(2, points.cols());
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      pixels.col(i) << frame.pixel_x(points(0, i)), frame.pixel_y(points(1, i));
    }
    return pixels;
  }
};

Axis axis_of(const std::string& label) {
  return {label, Scale::linear};
}

Box margins_of(const Drawing& drawing, const FrameTicks& ticks) {
  if (drawing.show_axes) return frame_margins(ticks, drawing.title, axis_of(drawing.x_label), axis_of(drawing.y_label));
  return {8.0, drawing.title.empty() ? 8.0 : 40.0, 8.0, 8.0};
}

Layout lay_out(const Drawing& drawing, const Bounds& bounds) {
  Layout layout;
  const double margin = width_of_margin * (bounds.upper - bounds.lower).maxCoeff();
  layout.frame.x = {Scale::linear, bounds.lower.x() - margin, bounds.upper.x() + margin};
  layout.frame.y = {Scale::linear, bounds.lower.y() - margin, bounds.upper.y() + margin};
  const double width = layout.frame.x.last - layout.frame.x.first;
  const double height = layout.frame.y.last - layout.frame.y.first;
  // The same step in both directions.
  const double step = tick_step(std::max(width, height), 9);
  layout.ticks = {ticks(layout.frame.x, static_cast<int>(std::ceil(width / step))),
                  ticks(layout.frame.y, static_cast<int>(std::ceil(height / step)))};
  const Box margins = margins_of(drawing, layout.ticks);
  const double scale = std::min((drawing.largest_width - margins.left - margins.right) / width,
                                (drawing.largest_height - margins.top - margins.bottom) / height);
  layout.frame.box = {margins.left, margins.top, margins.left + scale * width, margins.top + scale * height};
  layout.width = static_cast<int>(std::ceil(layout.frame.box.right + margins.right));
  layout.height = static_cast<int>(std::ceil(layout.frame.box.bottom + margins.bottom));
  return layout;
}

bool is_closed(const DrawableChain& chain, double tolerance) {
  return (chain.front().leftCols(1) - chain.back().rightCols(1)).norm() <= tolerance;
}

std::string chain_path(const DrawableChain& chain, const Layout& layout, double tolerance) {
  const PathSegment first = layout.to_pixels(chain.front().leftCols(1));
  std::string path = fmt::format("M{} {}", number(first(0, 0), 3), number(first(1, 0), 3));
  for (const PathSegment& segment : chain) path += path_command(layout.to_pixels(segment));
  return path + (is_closed(chain, tolerance) ? "Z" : "");
}

std::string draw_marks(const Drawing& drawing, const Layout& layout) {
  std::string circles;
  for (const Points<2>& marks : drawing.marks) {
    const PathSegment pixels = layout.to_pixels(marks);
    for (Eigen::Index i = 0; i < pixels.cols(); ++i) {
      circles += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"2\"/>\n", number(pixels(0, i)), number(pixels(1, i)));
    }
  }
  return circles.empty() ? "" : "<g class=\"data\" fill=\"#222\">\n" + circles + "</g>\n";
}

std::string draw_combs(const Drawing& drawing, const Layout& layout) {
  std::string teeth;
  std::string envelopes;
  for (const Comb& comb : drawing.combs) {
    const PathSegment feet = layout.to_pixels(comb.feet);
    const PathSegment tips = layout.to_pixels(comb.tips);
    for (Eigen::Index i = 0; i < feet.cols(); ++i) {
      teeth +=
          fmt::format("M{} {}L{} {}", number(feet(0, i)), number(feet(1, i)), number(tips(0, i)), number(tips(1, i)));
      envelopes += fmt::format("{}{} {}", i == 0 ? 'M' : 'L', number(tips(0, i)), number(tips(1, i)));
    }
  }
  if (teeth.empty()) return "";
  return fmt::format(
      "<path class=\"comb\" d=\"{}\" fill=\"none\" stroke=\"#009e73\" stroke-width=\"0.5\"/>\n"
      "<path class=\"comb envelope\" d=\"{}\" fill=\"none\" stroke=\"#009e73\" stroke-width=\"0.9\"/>\n",
      teeth, envelopes);
}

std::string draw_chains(const std::vector<DrawableChain>& chains, const Layout& layout, double tolerance, bool fill) {
  std::string closed;
  std::string open;
  for (const DrawableChain& chain : chains) {
    if (chain.empty()) continue;
    (is_closed(chain, tolerance) ? closed : open) += chain_path(chain, layout, tolerance);
  }
  std::string result;
  const auto draw = [&](const std::string& path, std::string_view name, std::string_view paint) {
    if (path.empty()) return;
    result += fmt::format(
        "<path class=\"{}\" d=\"{}\" fill=\"{}\" fill-rule=\"evenodd\" stroke=\"#0072b2\" stroke-width=\"1.6\" "
        "stroke-linejoin=\"round\"/>\n",
        name, path, paint);
  };
  draw(closed, fill ? "region" : "curves", fill ? "#d6e8f4" : "none");
  draw(open, "curves", "none");
  return result;
}

/// How many of the last control points are the first ones again, if they are several: p on a periodic knot vector.
Eigen::Index repeated_points(const geometry::NurbsCurve<2>& curve) {
  const geometry::Points<2> points = curve.control_points();
  for (Eigen::Index count = std::min<Eigen::Index>(curve.degree(), points.cols() - 1); count > 1; --count)
    if (points.rightCols(count) == points.leftCols(count)) return count;
  return 0;
}

std::string draw_control_net(const Drawing& drawing, const Layout& layout) {
  std::string polygons;
  std::string points;
  for (const Chain& chain : drawing.chains) {
    for (const auto& curve : chain) {
      // Edges drawn twice would fill the gaps of their dashes.
      const Eigen::Index repeated = repeated_points(curve);
      const PathSegment net = layout.to_pixels(curve.control_points());
      for (Eigen::Index i = 0; i + repeated < net.cols(); ++i) {
        const std::string x = number(net(0, i));
        const std::string y = number(net(1, i));
        polygons += fmt::format("{}{} {}", i == 0 ? 'M' : 'L', x, y);
        points += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"3\"/>\n", x, y);
      }
      if (repeated > 0) polygons += 'Z';
    }
  }
  return fmt::format(
      "<path class=\"control polygon\" d=\"{}\" fill=\"none\" stroke=\"#d55e00\" stroke-width=\"0.9\" "
      "stroke-dasharray=\"4 3\"/>\n"
      "<g class=\"control points\" fill=\"#fff\" stroke=\"#d55e00\" stroke-width=\"1.2\">\n{}</g>\n",
      polygons, points);
}

std::string draw_title(const Drawing& drawing, const Layout& layout) {
  if (drawing.show_axes) {
    return draw_frame(layout.frame, layout.ticks, drawing.title, axis_of(drawing.x_label), axis_of(drawing.y_label));
  }
  if (drawing.title.empty()) return "";
  return fmt::format("<text class=\"title\" x=\"{}\" y=\"{}\" font-size=\"{}\" font-weight=\"bold\">{}</text>\n",
                     number(layout.frame.box.left), number(layout.frame.box.top - 16.0), number(title_font_size),
                     escape(drawing.title));
}

}  // namespace

std::vector<Chain> chains(const geometry::OrientedBoundary<2>& oriented) {
  std::vector<Chain> result;
  for (const auto& shell : oriented.topology.shells) {
    Chain& chain = result.emplace_back();
    for (const int index : shell.patches) {
      const auto& patch = oriented.boundary.patches[static_cast<std::size_t>(index)];
      chain.push_back(patch.orientation > 0 ? patch.shape : geometry::reverse(patch.shape));
    }
  }
  return result;
}

std::string to_svg(const Drawing& drawing) {
  if (drawing.largest_width < least_width || drawing.largest_height < least_height) {
    throw InputError(fmt::format("the drawing's size is {} x {}, expected at least {} x {}", drawing.largest_width,
                                 drawing.largest_height, least_width, least_height));
  }
  // The scale that comes out of the layout is at most the largest diagonal over the shape's.
  const double rough = 0.01 * control_bounds(drawing).diagonal();
  const double size = drawn_bounds(drawing, drawable_chains(drawing, rough)).diagonal();
  const double tolerance = tolerance_pixels * size / std::hypot(drawing.largest_width, drawing.largest_height);
  const std::vector<DrawableChain> drawable = drawable_chains(drawing, tolerance);
  const Layout layout = lay_out(drawing, drawn_bounds(drawing, drawable));
  return open_document(layout.width, layout.height, drawing.title) + draw_title(drawing, layout) +
         draw_combs(drawing, layout) + draw_chains(drawable, layout, 1e-6 * size, drawing.fill) +
         draw_marks(drawing, layout) + (drawing.show_control_net ? draw_control_net(drawing, layout) : "") + "</svg>\n";
}

void write_svg(const std::filesystem::path& path, const Drawing& drawing) {
  write_file(path, to_svg(drawing));
}

}  // namespace isorim::io::svg
