#include "io/results/plane_sections.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/results/table.h"

namespace isorim::io {
namespace {

using solver::MeasuredSection;

/// Of an [expect] quantity.
double value_of(const MeasuredSection& measured, const std::string& quantity) {
  if (quantity == "area") return measured.area.value;
  if (quantity == "perimeter") return measured.perimeter.value;
  const geometry::PlaneSection& section = *measured.section;
  if (quantity == "loops") return static_cast<double>(section.loops.size());
  if (quantity == "chains") return static_cast<double>(section.chains.size());
  if (quantity == "touching") return static_cast<double>(section.touching.size());
  if (quantity == "isolated") return static_cast<double>(section.isolated.size());
  return static_cast<double>(section.double_points.size());
}

Quantity quantity_of(const SectionFamily& family, const std::string& name) {
  Quantity quantity{family.name + "." + name, {{}, static_cast<int>(family.sections.size()), 1}, {}, {}, {}, ""};
  quantity.is_sequence = true;
  for (const MeasuredSection& measured : family.sections) {
    if (!measured.section) {
      quantity.value.values.clear();
      quantity.error.clear();
      quantity.reason = measured.failure;
      return quantity;
    }
    quantity.value.values.push_back(value_of(measured, name));
    if (name == "area") quantity.error.push_back(measured.area.error);
    if (name == "perimeter") quantity.error.push_back(measured.perimeter.error);
  }
  return quantity;
}

/// "1 loop", "2 open curves", ...
void add_count(std::vector<std::string>& parts, std::size_t count, const char* one, const char* many) {
  if (count > 0) parts.push_back(fmt::format("{} {}", count, count == 1 ? one : many));
}

std::string contents_of(const geometry::PlaneSection& section) {
  std::vector<std::string> parts;
  add_count(parts, section.loops.size(), "loop", "loops");
  add_count(parts, section.chains.size(), "open curve", "open curves");
  add_count(parts, section.touching.size(), "curve of contact", "curves of contact");
  add_count(parts, section.isolated.size(), "point of contact", "points of contact");
  add_count(parts, section.double_points.size(), "double point", "double points");
  add_count(parts, section.coplanar.size(), "face in the plane", "faces in the plane");
  return parts.empty() ? "nothing" : fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace

std::vector<SectionFamily> cut_sections(const CaseFile& file, const geometry::Boundary<3>& boundary, double largest_gap,
                                        const std::function<void(double)>& progress, int threads) {
  std::vector<SectionFamily> families;
  if (file.keys.section.empty()) return families;
  solver::PlaneSectionOptions options;
  options.tolerance = file.keys.properties.tolerance;
  options.threads = threads;
  options.progress = progress;
  const double size = geometry::PlaneCutter(boundary).size();
  options.cutting.gap_tolerance = std::max(options.cutting.gap_tolerance, 2.0 * largest_gap / size);
  const geometry::PlaneCutter cutter(boundary, options.cutting);
  for (const PlaneSectionKeys& keys : file.keys.section) {
    SectionFamily family;
    family.name = keys.name;
    family.offsets = section_offsets(keys);
    family.planes = section_planes(keys);
    family.size = size;
    for (const geometry::Patch<3>& patch : boundary.patches) family.patch_names.push_back(patch.name);
    if (file.cad) family.unit = file.cad->unit;
    options.fit_tolerance = keys.fit_tolerance;
    family.sections = solver::measure_sections(cutter, family.planes, options);
    families.push_back(std::move(family));
  }
  return families;
}

std::vector<Quantity> section_quantities(const std::vector<SectionFamily>& families) {
  std::vector<Quantity> quantities;
  for (const SectionFamily& family : families)
    for (const std::string& name : section_quantity_names()) quantities.push_back(quantity_of(family, name));
  return quantities;
}

std::vector<std::string> section_warnings(const std::vector<SectionFamily>& families) {
  std::vector<std::string> warnings;
  for (const SectionFamily& family : families)
    for (std::size_t i = 0; i < family.sections.size(); ++i) {
      const MeasuredSection& measured = family.sections[i];
      const std::string where = fmt::format("section \"{}\" at {:.9g}", family.name, family.offsets[i]);
      if (!measured.section) {
        warnings.push_back(fmt::format("{}: {}", where, measured.failure));
        continue;
      }
      for (const std::string& message : measured.section->messages)
        warnings.push_back(fmt::format("{}: {}", where, message));
    }
  return warnings;
}

std::string sections_text(const std::vector<SectionFamily>& families) {
  std::string text;
  for (const SectionFamily& family : families) {
    TextTable table(
        {{"offset", Align::right}, {"area", Align::right}, {"perimeter", Align::right}, {"contents", Align::left}});
    for (std::size_t i = 0; i < family.sections.size(); ++i) {
      const MeasuredSection& measured = family.sections[i];
      if (!measured.section) {
        table.add_row({fmt::format("{:.9g}", family.offsets[i]), measured.touches_within ? "" : "failed", "",
                       measured.touches_within ? "degenerate: the plane only touches" : ""});
        continue;
      }
      table.add_row({fmt::format("{:.9g}", family.offsets[i]), fmt::format("{:.12g}", measured.area.value),
                     fmt::format("{:.12g}", measured.perimeter.value), contents_of(*measured.section)});
    }
    text += fmt::format("  section \"{}\"\n{}\n", family.name, table.text(2));
  }
  return text;
}

}  // namespace isorim::io
