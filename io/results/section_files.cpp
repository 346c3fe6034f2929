#include <algorithm>
#include <cstddef>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "io/atomic_file.h"
#include "io/iges/units.h"
#include "io/iges/writer.h"
#include "io/results/plane_sections.h"
#include "io/svg/drawing.h"
#include "io/vtk/bezier_writer.h"

/// write_sections() of plane_sections.h.
namespace isorim::io {
namespace {

using geometry::PlaneSection;
using geometry::SectionCurve;
using geometry::SectionSpline;

/// Of the points in CSV files, relative to the size of the shape.
constexpr double sag = 1e-4;
/// Families of more planes are drawn in one picture alone.
constexpr std::size_t most_pictures = 40;
/// Of the crosses that mark points of contact, relative to the size of the shape.
constexpr double cross_size = 0.01;

enum class CurveKind { outer = 0, hole = 1, open = 2, touching = 3 };

const char* name_of(CurveKind kind) {
  switch (kind) {
    case CurveKind::outer:
      return "outer";
    case CurveKind::hole:
      return "hole";
    case CurveKind::open:
      return "open";
    default:
      return "touching";
  }
}

/// Calls visit(plane index, kind, curve, spline) for every curve of the family.
template <class Visit>
void for_each_curve(const SectionFamily& family, const Visit& visit) {
  for (std::size_t k = 0; k < family.sections.size(); ++k) {
    const solver::MeasuredSection& measured = family.sections[k];
    if (!measured.section) continue;
    const PlaneSection& section = *measured.section;
    for (std::size_t i = 0; i < section.loops.size(); ++i)
      visit(k, section.loops[i].is_hole ? CurveKind::hole : CurveKind::outer, section.loops[i].curve,
            measured.loops[i]);
    for (std::size_t i = 0; i < section.chains.size(); ++i)
      visit(k, CurveKind::open, section.chains[i], measured.chains[i]);
    for (std::size_t i = 0; i < section.touching.size(); ++i)
      visit(k, CurveKind::touching, section.touching[i], measured.touching[i]);
  }
}

// --- Points -------------------------------------------------------------------------------------------------------

/// In a CSV field.
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + "\"";
}

class CsvText {
 public:
  explicit CsvText(const SectionFamily& family) : family_(family) {
    text_ = "offset,kind,curve,x,y,z,plane_x,plane_y,tangent_x,tangent_y,tangent_z,patch,element,u,v\n";
    int number = 0;
    for_each_curve(family, [&](std::size_t k, CurveKind kind, const SectionCurve& curve, const auto&) {
      ++number;
      const geometry::PlaneFrame& frame = family_.sections[k].section->frame;
      for (const geometry::SectionSample& sample : sample_section(curve, frame, sag * family_.size))
        add(k, name_of(kind), number, sample);
    });
    for (std::size_t k = 0; k < family.sections.size(); ++k) {
      const auto& section = family.sections[k].section;
      if (!section) continue;
      for (const geometry::SectionPoint& point : section->isolated) add_point(k, "isolated", point);
      for (const geometry::SectionPoint& point : section->double_points) add_point(k, "double", point);
    }
  }

  const std::string& text() const { return text_; }

 private:
  void add(std::size_t plane, const char* kind, int curve, const geometry::SectionSample& sample) {
    const geometry::Point3& x = sample.place.point;
    const geometry::Vector3& t = sample.tangent;
    fmt::format_to(std::back_inserter(text_), "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", family_.offsets[plane],
                   kind, curve, x.x(), x.y(), x.z(), sample.plane.x(), sample.plane.y(), t.x(), t.y(), t.z(),
                   quoted(family_.patch_names[static_cast<std::size_t>(sample.place.patch)]), sample.place.element,
                   sample.place.uv.x(), sample.place.uv.y());
  }
  void add_point(std::size_t plane, const char* kind, const geometry::SectionPoint& point) {
    const geometry::PlaneFrame& frame = family_.sections[plane].section->frame;
    add(plane, kind, 0, {point, frame.to_plane(point.point), geometry::Vector3::Zero()});
  }

  const SectionFamily& family_;
  std::string text_;
};

// --- Curves -------------------------------------------------------------------------------------------------------

/// The fitted curves in space and what is said of each.
struct SpaceCurves {
  std::vector<geometry::NurbsCurve<3>> curves;
  std::vector<std::string> names;
  std::vector<double> offsets;
  std::vector<double> kinds;

  explicit SpaceCurves(const SectionFamily& family) {
    for_each_curve(family,
                   [&](std::size_t k, CurveKind kind, const SectionCurve&, const std::optional<SectionSpline>& spline) {
                     if (!spline) return;
                     curves.push_back(to_space(spline->curve, family.sections[k].section->frame));
                     names.push_back(fmt::format("{} {:.9g} {}", family.name, family.offsets[k], name_of(kind)));
                     offsets.push_back(family.offsets[k]);
                     kinds.push_back(static_cast<double>(kind));
                   });
  }
};

void write_curves(const std::filesystem::path& folder, const SectionFamily& family, const OutputKeys& output) {
  const SpaceCurves curves(family);
  if (curves.curves.empty()) return;
  const std::filesystem::path stem = folder / ("section_" + family.name);
  if (output.vtk) {
    const std::vector<VtuField> fields{{"offset", 1, curves.offsets}, {"kind", 1, curves.kinds}};
    write_curves_vtu<3>(stem.string() + ".vtu", curves.curves, curves.names, fields);
  }
  iges::WriterOptions options;
  options.title = "section " + family.name;
  if (iges::unit_of_name(family.unit) != nullptr) options.unit = family.unit;
  iges::write_iges_curves(stem.string() + ".igs", curves.curves, curves.names, options);
}

// --- Pictures -----------------------------------------------------------------------------------------------------

geometry::NurbsCurve<2> segment(const geometry::Point2& from, const geometry::Point2& to) {
  geometry::Points<2> ends(2, 2);
  ends << from, to;
  return geometry::NurbsCurve<2>::from_points(geometry::KnotVector::bezier(1), ends);
}

void add_cross(const geometry::Point2& place, double size, std::vector<svg::Chain>& chains) {
  const geometry::Vector2 up(0.5 * size, 0.5 * size);
  const geometry::Vector2 down(0.5 * size, -0.5 * size);
  chains.push_back({segment(place - up, place + up)});
  chains.push_back({segment(place - down, place + down)});
}

void add_chains(const SectionFamily& family, const PlaneSection& section, std::vector<svg::Chain>& chains) {
  for (const geometry::SectionLoop& loop : section.loops) chains.push_back(loop.curve.plane_curves.curves);
  for (const SectionCurve& chain : section.chains) chains.push_back(chain.plane_curves.curves);
  for (const SectionCurve& curve : section.touching) chains.push_back(curve.plane_curves.curves);
  for (const geometry::SectionPoint& point : section.isolated)
    add_cross(section.frame.to_plane(point.point), cross_size * family.size, chains);
}

/// "x", "-y" if the axis is one of space, else what is given.
std::string axis_label(const geometry::Vector3& axis, const std::string& otherwise, const std::string& unit) {
  std::string name = otherwise;
  for (Eigen::Index i = 0; i < 3; ++i)
    if (std::abs(axis(i)) == 1.0) name = fmt::format("{}{}", axis(i) < 0.0 ? "-" : "", "xyz"[i]);
  return unit.empty() || unit == "?" ? name : fmt::format("{} [{}]", name, unit);
}

void write_picture(const std::filesystem::path& path, const SectionFamily& family, const std::string& title,
                   std::vector<svg::Chain> chains, bool fill) {
  if (chains.empty()) return;
  svg::Drawing drawing{.title = title, .chains = std::move(chains), .x_label = "", .y_label = ""};
  drawing.fill = fill;
  drawing.x_label = axis_label(family.planes.front().axis_x, "plane x", family.unit);
  drawing.y_label = axis_label(family.planes.front().axis_y, "plane y", family.unit);
  svg::write_svg(path, drawing);
}

/// What the pictures cannot show: planes that only touch.
std::string remarks_of(const SectionFamily& family) {
  std::vector<std::string> offsets;
  for (std::size_t k = 0; k < family.sections.size(); ++k)
    if (family.sections[k].touches_within) offsets.push_back(fmt::format("{:.9g}", family.offsets[k]));
  return offsets.empty() ? "" : fmt::format(" (the plane at {} only touches)", fmt::join(offsets, ", "));
}

void write_pictures(const std::filesystem::path& folder, const SectionFamily& family) {
  std::vector<svg::Chain> all;
  const bool is_single = family.sections.size() == 1;
  for (std::size_t k = 0; k < family.sections.size(); ++k) {
    const auto& section = family.sections[k].section;
    if (!section) continue;
    std::vector<svg::Chain> own;
    add_chains(family, *section, own);
    all.insert(all.end(), own.begin(), own.end());
    if (is_single || family.sections.size() > most_pictures) continue;
    write_picture(folder / fmt::format("section_{}_{}.svg", family.name, k + 1), family,
                  fmt::format("{} at {:.9g}", family.name, family.offsets[k]), std::move(own), true);
  }
  write_picture(folder / fmt::format("section_{}.svg", family.name), family, family.name + remarks_of(family),
                std::move(all), is_single);
}

}  // namespace

void write_sections(const std::filesystem::path& folder, const std::vector<SectionFamily>& families,
                    const OutputKeys& output) {
  for (const SectionFamily& family : families) {
    write_file(folder / ("section_" + family.name + ".csv"), CsvText(family).text());
    write_curves(folder, family, output);
    if (output.svg) write_pictures(folder, family);
  }
}

}  // namespace isorim::io
