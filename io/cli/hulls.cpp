#include <ostream>
#include <vector>

#include <fmt/format.h>

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

int export_hull(const HullExportArguments& arguments, std::ostream& out) {
  io::write_file(arguments.file, io::offsets_text(io::read_hull(arguments.library, arguments.name)));
  out << (arguments.format == OutputFormat::json
              ? hull_json("exported", arguments.library, arguments.name, arguments.file)
              : fmt::format("  {}\n", arguments.file.string()));
  return 0;
}

int remove_hull(const std::filesystem::path& library, const std::string& name, OutputFormat format, std::ostream& out) {
  io::remove_hull(library, name);
  if (format == OutputFormat::json) out << hull_json("removed", library, name, {});
  return 0;
}

}  // namespace isorim::cli
