#include <ostream>
#include <vector>

#include <fmt/format.h>

#include "geometry/hull/fairing.h"
#include "geometry/hull/fairness.h"
#include "geometry/hull/hull_surface.h"
#include "io/atomic_file.h"
#include "io/cli/commands.h"
#include "io/cli/replies.h"
#include "io/hull/hull_library.h"
#include "io/hull/offset_file.h"
#include "io/results/table.h"

namespace isorim::cli {
namespace {

std::string table_text(const std::vector<io::HullEntry>& hulls) {
  io::TextTable table({{"name"},
                       {"length", io::Align::right},
                       {"beam", io::Align::right},
                       {"draught", io::Align::right},
                       {"stations", io::Align::right},
                       {"waterlines", io::Align::right},
                       {"title"},
                       {"source"}});
  for (const io::HullEntry& hull : hulls) {
    table.add_row({hull.name, fmt::format("{:g}", hull.length), fmt::format("{:g}", hull.beam),
                   fmt::format("{:g}", hull.draught), fmt::format("{}", hull.stations),
                   fmt::format("{}", hull.waterlines), hull.title, hull.source});
  }
  return table.text(2);
}

}  // namespace

int list_hulls(const std::filesystem::path& library, OutputFormat format, std::ostream& out) {
  const std::vector<io::HullEntry> hulls = io::list_hulls(library);
  out << (format == OutputFormat::json ? hulls_json(library, hulls) : table_text(hulls));
  return 0;
}

int import_hull(const HullImportArguments& arguments, std::ostream& out) {
  const geometry::OffsetTable table = io::read_offsets(arguments.file);
  const std::string name = arguments.name.value_or(arguments.file.stem().string());
  io::store_hull(arguments.library, name, table,
                 arguments.replaces ? io::ExistingHull::replace : io::ExistingHull::refuse);
  if (arguments.format == OutputFormat::json) {
    out << hull_json("imported", arguments.library, name, arguments.file);
  } else {
    out << fmt::format("  {} \"{}\": {} stations, {} waterlines\n", name, table.name, table.stations.size(),
                       table.waterlines.size());
  }
  return 0;
}

namespace {

std::string fairness_text(const char* when, double roughness, const geometry::OffsetTable& table) {
  const auto fairness = geometry::measure_fairness(table, geometry::hull_surface(geometry::hull_sections(table)));
  return fmt::format(
      "  {}: roughness {:.6g}, bending energy {:.6g}, {} and {} changes of curvature's sign along "
      "stations and waterlines\n",
      when, roughness, fairness.bending_energy, fairness.station_sign_changes, fairness.waterline_sign_changes);
}

}  // namespace

int export_hull(const HullExportArguments& arguments, std::ostream& out) {
  geometry::OffsetTable table = io::read_hull(arguments.library, arguments.name);
  const bool is_text = arguments.format == OutputFormat::text;
  if (arguments.fair) {
    const geometry::FairedOffsets faired = geometry::fair_offsets(table, *arguments.fair);
    if (is_text)
      out << fairness_text("as given", faired.roughness_before, table)
          << fairness_text("faired", faired.roughness, faired.table)
          << fmt::format("  {} half-breadths moved, by {:.4g} at most\n", faired.moved, faired.largest_move);
    table = faired.table;
  }
  io::write_file(arguments.file, io::offsets_text(table));
  out << (is_text ? fmt::format("  {}\n", arguments.file.string())
                  : hull_json("exported", arguments.library, arguments.name, arguments.file));
  return 0;
}

int remove_hull(const std::filesystem::path& library, const std::string& name, OutputFormat format, std::ostream& out) {
  io::remove_hull(library, name);
  if (format == OutputFormat::json) out << hull_json("removed", library, name, {});
  return 0;
}

}  // namespace isorim::cli
