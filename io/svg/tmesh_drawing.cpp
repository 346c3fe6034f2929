#include "io/svg/tmesh_drawing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <fmt/format.h>

#include "io/atomic_file.h"
#include "io/svg/frame.h"
#include "io/svg/markup.h"

namespace isorim::io::svg {

namespace {

using geometry::Direction;
using geometry::index;
using geometry::IndexBox;
using geometry::IndexMesh;
using geometry::other;
using geometry::TMesh;

constexpr double largest_side = 640.0;
/// Between lines of equal knots, in pixels.
constexpr double zero_interval = 16.0;
/// A direction is drawn at most this many times as long as the other one.
constexpr double largest_ratio = 2.5;
constexpr double margin = 16.0;
constexpr double small_font_size = 8.0;
constexpr double title_height = 36.0;
constexpr double legend_height = 30.0;
constexpr std::array<Direction, 2> directions{Direction::u, Direction::v};

/// Where the lines of one direction are drawn, in pixels from the first line shown; lines outside the active region,
/// where no anchors are, are not shown.
struct Lines {
  int first = 0;
  int last = 0;
  std::vector<double> at;

  double operator[](int line) const { return at[static_cast<std::size_t>(line)]; }
  double length() const { return (*this)[last]; }
};

Lines lines_of(const TMesh& mesh, Direction d, double length) {
  const auto& knots = mesh.knots(d);
  Lines lines;
  lines.first = (mesh.degree(d) + 1) / 2;
  lines.last = static_cast<int>(knots.knots().size()) - 1 - lines.first;
  lines.at.assign(knots.knots().size(), 0.0);
  const double range = knots[lines.last] - knots[lines.first];
  for (int line = lines.first + 1; line < static_cast<int>(lines.at.size()); ++line) {
    const double interval = knots[std::min(line, lines.last)] - knots[std::min(line, lines.last) - 1];
    lines.at[static_cast<std::size_t>(line)] = lines[line - 1] + (line > lines.last ? 0.0
                                                                  : interval > 0.0  ? length * interval / range
                                                                                    : zero_interval);
  }
  return lines;
}

/// Where everything is.
struct Layout {
  std::array<Lines, 2> lines;
  double left = 0.0;
  double bottom = 0.0;

  double x(int line) const { return left + lines[0][line]; }
  double y(int line) const { return bottom - lines[1][line]; }
  double right() const { return left + lines[0].length(); }
  double top() const { return bottom - lines[1].length(); }
};

double widest_label(const TMesh& mesh) {
  double width = 0.0;
  for (const double knot : mesh.knots(Direction::v).breakpoints())
    width = std::max(width, text_width(fmt::format("{:.4g}", knot), font_size));
  return width;
}

Layout lay_out(const TMesh& mesh) {
  const auto domain = mesh.domain();
  const double ratio = std::clamp(domain[1].length() / domain[0].length(), 1.0 / largest_ratio, largest_ratio);
  Layout layout;
  layout.lines[0] = lines_of(mesh, Direction::u, largest_side / std::max(1.0, ratio));
  layout.lines[1] = lines_of(mesh, Direction::v, largest_side * std::min(1.0, ratio));
  layout.left = margin + widest_label(mesh) + 34.0;
  layout.bottom = title_height + margin + layout.lines[1].length();
  return layout;
}

/// The unit edges of one kind as one path, runs of them drawn in one go.
template <class Belongs>
std::string edge_path(const Layout& layout, Belongs&& belongs) {
  std::string path;
  for (const Direction d : directions) {
    const Lines& own = layout.lines[index(d)];
    const Lines& crossing = layout.lines[index(other(d))];
    for (int line = own.first; line <= own.last; ++line) {
      for (int cell = crossing.first; cell < crossing.last; ++cell) {
        const int first = cell;
        while (cell < crossing.last && belongs(d, line, cell)) ++cell;
        if (cell == first) continue;
        path += d == Direction::u
                    ? fmt::format("M{} {}V{}", number(layout.x(line)), number(layout.y(first)), number(layout.y(cell)))
                    : fmt::format("M{} {}H{}", number(layout.x(first)), number(layout.y(line)), number(layout.x(cell)));
      }
    }
  }
  return path;
}

bool in_domain(const IndexMesh& mesh, Direction d, int line, int cell) {
  const IndexBox domain = mesh.domain();
  const std::size_t own = index(d);
  const std::size_t crossing = index(other(d));
  return domain.first[own] <= line && line <= domain.last[own] && domain.first[crossing] <= cell &&
         cell < domain.last[crossing];
}

std::string draw_edges(const IndexMesh& mesh, const Layout& layout) {
  const auto path = [&](std::string_view name, std::string_view style, bool inside) {
    const std::string d = edge_path(layout, [&](Direction direction, int line, int cell) {
      return mesh.has_edge(direction, line, cell) && in_domain(mesh, direction, line, cell) == inside;
    });
    return d.empty() ? "" : fmt::format("<path class=\"{}\" d=\"{}\" fill=\"none\" {}/>\n", name, d, style);
  };
  return path("frame edges", "stroke=\"#c4ccd4\" stroke-width=\"1\"", false) +
         path("edges", "stroke=\"#333\" stroke-width=\"1.4\"", true);
}

std::string draw_extensions(const IndexMesh& mesh, const Layout& layout) {
  std::string path;
  for (const geometry::TJunction& junction : mesh.t_junctions()) {
    const int ahead = mesh.extension(junction).ahead;
    path += fmt::format("M{} {}", number(layout.x(junction.at[0])), number(layout.y(junction.at[1])));
    path += junction.along == Direction::u ? fmt::format("H{}", number(layout.x(ahead)))
                                           : fmt::format("V{}", number(layout.y(ahead)));
  }
  if (path.empty()) return "";
  return fmt::format(
      "<path class=\"face extensions\" d=\"{}\" fill=\"none\" stroke=\"#d55e00\" stroke-width=\"1.3\" "
      "stroke-dasharray=\"5 3\"/>\n",
      path);
}

/// Centres of what lies between lines, such as anchors.
std::array<double, 2> centre(const Layout& layout, const IndexBox& box) {
  return {0.5 * (layout.x(box.first[0]) + layout.x(box.last[0])),
          0.5 * (layout.y(box.first[1]) + layout.y(box.last[1]))};
}

/// The number beside an anchor, if it ends before the next anchor of the row.
std::string draw_number(const TMesh& mesh, const Layout& layout, int k) {
  const auto [x, y] = centre(layout, mesh.anchors()[static_cast<std::size_t>(k)]);
  const std::string text = fmt::format("{}", k);
  if (k + 1 < mesh.function_count()) {
    const auto [next_x, next_y] = centre(layout, mesh.anchors()[static_cast<std::size_t>(k) + 1]);
    if (next_y == y && next_x - x < text_width(text, small_font_size) + 4.0) return "";
  }
  return fmt::format("<text x=\"{}\" y=\"{}\">{}</text>\n", number(x + 3.0), number(y - 3.0), text);
}

std::string draw_anchors(const TMesh& mesh, const Layout& layout) {
  std::string circles;
  std::string numbers;
  for (int k = 0; k < mesh.function_count(); ++k) {
    const auto [x, y] = centre(layout, mesh.anchors()[static_cast<std::size_t>(k)]);
    circles += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"2.6\"/>\n", number(x), number(y));
    numbers += draw_number(mesh, layout, k);
  }
  return fmt::format(
      "<g class=\"anchors\" fill=\"#0072b2\">\n{}</g>\n<g class=\"numbers\" fill=\"#0072b2\" "
      "font-size=\"{}\">\n{}</g>\n",
      circles, number(small_font_size), numbers);
}

/// Hollow, so that the anchors of odd degrees show inside.
std::string draw_junctions(const IndexMesh& mesh, const Layout& layout) {
  std::string circles;
  for (const geometry::TJunction& junction : mesh.t_junctions())
    circles += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"5\"/>\n", number(layout.x(junction.at[0])),
                           number(layout.y(junction.at[1])));
  if (circles.empty()) return "";
  return fmt::format("<g class=\"T-junctions\" fill=\"none\" stroke=\"#d55e00\" stroke-width=\"1.6\">\n{}</g>\n",
                     circles);
}

/// The values of the knots, each at the first of its lines in the domain, as far as they do not run into each other.
std::string draw_knots(const TMesh& mesh, const Layout& layout, Direction d) {
  const auto& knots = mesh.knots(d);
  const IndexBox domain = mesh.index_mesh().domain();
  std::string texts;
  double free_from = -1e9;
  for (int line = domain.first[index(d)]; line <= domain.last[index(d)]; ++line) {
    if (line > domain.first[index(d)] && knots[line] == knots[line - 1]) continue;
    const std::string label = fmt::format("{:.4g}", knots[line]);
    const double extent = d == Direction::u ? text_width(label, font_size) + 6.0 : font_size + 2.0;
    const double at = layout.lines[index(d)][line];
    if (at - 0.5 * extent < free_from) continue;
    free_from = at + 0.5 * extent;
    const double x = d == Direction::u ? layout.x(line) : layout.left - 8.0;
    const double y = d == Direction::u ? layout.bottom + 8.0 + font_size : layout.y(line) + 0.35 * font_size;
    texts += fmt::format("<text x=\"{}\" y=\"{}\">{}</text>\n", number(x), number(y), label);
  }
  return fmt::format("<g class=\"{} knots\" text-anchor=\"{}\">\n{}</g>\n", "uv"[index(d)],
                     d == Direction::u ? "middle" : "end", texts);
}

std::string draw_axis_names(const Layout& layout) {
  return fmt::format(
      "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\" font-size=\"13\" font-style=\"italic\">u</text>\n"
      "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\" font-size=\"13\" font-style=\"italic\">v</text>\n",
      number(0.5 * (layout.left + layout.right())), number(layout.bottom + 36.0), number(margin + 4.0),
      number(0.5 * (layout.bottom + layout.top())));
}

std::string draw_legend(const TMesh& mesh, const Layout& layout) {
  const double y = layout.bottom + 36.0 + legend_height;
  double x = layout.left;
  std::string result = "<g class=\"legend\">\n";
  const auto entry = [&](const std::string& symbol, const std::string& text) {
    result += fmt::format("<g transform=\"translate({} {})\">{}<text x=\"24\" y=\"4\">{}</text></g>\n", number(x),
                          number(y), symbol, text);
    x += 24.0 + text_width(text, font_size) + 18.0;
  };
  entry("<circle cx=\"9\" cy=\"0\" r=\"2.6\" fill=\"#0072b2\"/>", fmt::format("{} anchors", mesh.function_count()));
  if (!mesh.index_mesh().t_junctions().empty()) {
    entry("<circle cx=\"9\" cy=\"0\" r=\"5\" fill=\"none\" stroke=\"#d55e00\" stroke-width=\"1.6\"/>", "T-junction");
    entry("<path d=\"M0 0H18\" stroke=\"#d55e00\" stroke-width=\"1.3\" stroke-dasharray=\"5 3\"/>", "face extension");
  }
  entry("<path d=\"M0 0H18\" stroke=\"#c4ccd4\"/>", "frame");
  return result + "</g>\n";
}

}  // namespace

std::string to_svg(const TMesh& mesh, const std::string& title) {
  const Layout layout = lay_out(mesh);
  const double least_width = layout.left + 400.0;
  const double title_width = layout.left + text_width(title, title_font_size) * 1.1;
  const int width = static_cast<int>(std::ceil(std::max({layout.right() + 12.0, least_width, title_width}) + margin));
  const int height = static_cast<int>(std::ceil(layout.bottom + 36.0 + legend_height + margin));
  return open_document(width, height, title) +
         fmt::format("<text class=\"title\" x=\"{}\" y=\"{}\" font-size=\"{}\" font-weight=\"bold\">{}</text>\n",
                     number(layout.left), number(margin + 10.0), number(title_font_size), escape(title)) +
         draw_edges(mesh.index_mesh(), layout) + draw_extensions(mesh.index_mesh(), layout) +
         draw_anchors(mesh, layout) + draw_junctions(mesh.index_mesh(), layout) +
         draw_knots(mesh, layout, Direction::u) + draw_knots(mesh, layout, Direction::v) + draw_axis_names(layout) +
         draw_legend(mesh, layout) + "</svg>\n";
}

void write_svg(const std::filesystem::path& path, const TMesh& mesh, const std::string& title) {
  write_file(path, to_svg(mesh, title));
}

}  // namespace isorim::io::svg
