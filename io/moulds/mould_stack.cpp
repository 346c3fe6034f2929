#include "io/moulds/mould_stack.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/nurbs/surface.h"
#include "io/svg/markup.h"

namespace isorim::io {
namespace {

using geometry::Interval;
using geometry::Point3;
using geometry::Vector3;

constexpr double most_planes = 5000.0;
/// Of the size of the body.
constexpr double height_tolerance = 1e-9;
/// In mm, far below what a saw can do: a plane this near to the lowest or highest point only touches the body, and by
/// so little a body may stand out of a stack.
constexpr double touch = 0.02;
/// Of a step: what rounding may add to a whole number of them.
constexpr double whole_step = 1e-9;

geometry::PlaneFrame plane_at(double height) {
  return geometry::plane_frame(Point3(0.0, 0.0, height), Vector3::UnitZ());
}

bool meets(const geometry::PlaneCutter& cutter, double height) {
  try {
    return !cutter.section(plane_at(height)).is_empty();
  } catch (const GeometryError&) {
    // Only where there is something can it be hard to cut.
    return true;
  }
}

/// Where planes cease to meet the body between a height that does and one that does not.
double last_height(const geometry::PlaneCutter& cutter, double inside, double outside) {
  while (std::abs(outside - inside) > height_tolerance * cutter.size()) {
    const double middle = 0.5 * (inside + outside);
    (meets(cutter, middle) ? inside : outside) = middle;
  }
  return inside;
}

/// A point of the boundary.
double some_height(const geometry::Boundary<3>& boundary) {
  const auto loops = geometry::trim_loops(boundary.patches.front().shape);
  const auto& curve = loops.front().curves.front();
  return evaluate(geometry::surface_of(boundary.patches.front().shape), evaluate(curve, curve.domain().middle())).z();
}

/// Whether a plane goes through the body, and not just by it or along its top.
bool cuts(double height, Interval body) {
  return body.first + touch < height && height < body.last - touch;
}

std::string remark_on(const MouldSection& section, Interval body) {
  const solver::MeasuredSection& measured = section.measured;
  const std::string place = svg::number(section.height, 4);
  if (section.height <= body.first - touch || section.height >= body.last + touch)
    return fmt::format("the plane z = {} mm does not meet the body", place);
  if (!cuts(section.height, body))
    return fmt::format("the plane z = {} mm only touches the body: nothing to cut", place);
  if (!measured.section) return fmt::format("the section at z = {} mm failed: {}", place, measured.failure);
  if (!section.has_area) return fmt::format("the plane z = {} mm only touches the body: nothing to cut", place);
  return "";
}

std::optional<Interval> root_of(const MouldBody& body) {
  if (body.root) return body.root;
  if (!body.blade || !body.hub_radius) return std::nullopt;
  return geometry::root_extent(body.boundary.patches[static_cast<std::size_t>(*body.blade)].shape, *body.hub_radius);
}

void add_lines(const MouldBody& body, const std::optional<Interval>& root, MouldSection& section) {
  if (body.blade && section.has_area)
    section.parting = geometry::parting_line(*section.measured.section, body.boundary, *body.blade, body.sag);
  if (!body.hub_radius || !root) return;
  if (const auto half_width = geometry::hub_half_width(*body.hub_radius, section.height))
    section.hub = HubRectangle{*root, *half_width};
}

}  // namespace

Interval height_range(const geometry::PlaneCutter& cutter, const geometry::Boundary<3>& boundary) {
  const double inside = some_height(boundary);
  const double far = 1.01 * cutter.size();
  return {last_height(cutter, inside, inside - far), last_height(cutter, inside, inside + far)};
}

std::vector<double> mould_heights(const MouldKeys& keys, double millimetres, Interval body) {
  std::vector<double> heights;
  for (const double height : keys.heights) heights.push_back(height * millimetres);
  if (!heights.empty()) return heights;
  const double step = keys.step.value_or(keys.board_thickness.value_or(1.0)) * millimetres;
  const bool has_boards = keys.board_thickness.has_value();
  const double first = keys.from ? *keys.from * millimetres : step * std::floor((body.first + touch) / step);
  const double last = keys.to ? *keys.to * millimetres : step * std::ceil((body.last - touch) / step);
  const double steps = (last - first) / step;
  if (!(steps <= most_planes))
    throw InputError(fmt::format("moulds: {:.6g} sections, at most {} are made", steps, most_planes));
  // The last board reaches `to`, if need be beyond; the last section does not.
  const double count = has_boards ? std::ceil(steps - whole_step) : std::floor(steps + whole_step);
  for (int k = 0; k <= static_cast<int>(count); ++k) heights.push_back(first + k * step);
  return heights;
}

MouldStack cut_moulds(const MouldBody& body, const MouldKeys& keys, double millimetres, int threads,
                      const std::function<void(double)>& progress) {
  const geometry::PlaneCutter cutter(body.boundary);
  MouldStack stack;
  if (keys.board_thickness) stack.board_thickness = *keys.board_thickness * millimetres;
  stack.body_heights = height_range(cutter, body.boundary);
  const std::vector<double> heights = mould_heights(keys, millimetres, stack.body_heights);
  std::vector<geometry::PlaneFrame> planes;
  for (const double height : heights)
    if (cuts(height, stack.body_heights)) planes.push_back(plane_at(height));
  const solver::PlaneSectionOptions options{
      .tolerance = 1e-9, .fit_tolerance = 1e-7, .threads = threads, .progress = progress};
  std::vector<solver::MeasuredSection> measured = measure_sections(cutter, planes, options);
  const std::optional<Interval> root = root_of(body);
  std::size_t next = 0;
  for (const double height : heights) {
    MouldSection section;
    section.height = height;
    if (cuts(height, stack.body_heights)) section.measured = std::move(measured[next++]);
    const auto& cut = section.measured.section;
    section.has_area = cut && !(cut->loops.empty() && cut->chains.empty());
    add_lines(body, root, section);
    section.remark = remark_on(section, stack.body_heights);
    stack.sections.push_back(std::move(section));
  }
  return stack;
}

std::string section_layer(double height) {
  std::string text = svg::number(height, 4);
  const std::size_t point = text.find('.');
  if (point == std::string::npos) return "CORTE" + text + "_";
  text[point] = '_';
  return "CORTE" + text;
}

}  // namespace isorim::io
