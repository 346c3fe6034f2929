#include <ostream>

#include <fmt/format.h>

#include "io/atomic_file.h"
#include "io/cli/commands.h"
#include "io/hull/hull_library.h"
#include "io/hull/offset_file.h"
#include "io/results/table.h"

namespace isorim::cli {

int list_hulls(const std::filesystem::path& library, std::ostream& out) {
  io::TextTable table({{"name"},
                       {"length", io::Align::right},
                       {"beam", io::Align::right},
                       {"draught", io::Align::right},
                       {"stations", io::Align::right},
                       {"waterlines", io::Align::right},
                       {"title"},
                       {"source"}});
  for (const io::HullEntry& hull : io::list_hulls(library)) {
    table.add_row({hull.name, fmt::format("{:g}", hull.length), fmt::format("{:g}", hull.beam),
                   fmt::format("{:g}", hull.draught), fmt::format("{}", hull.stations),
                   fmt::format("{}", hull.waterlines), hull.title, hull.source});
  }
  out << table.text(2);
  return 0;
}

int import_hull(const HullImportArguments& arguments, std::ostream& out) {
  const geometry::OffsetTable table = io::read_offsets(arguments.file);
  const std::string name = arguments.name.value_or(arguments.file.stem().string());
  io::store_hull(arguments.library, name, table,
                 arguments.replaces ? io::ExistingHull::replace : io::ExistingHull::refuse);
  out << fmt::format("  {} \"{}\": {} stations, {} waterlines\n", name, table.name, table.stations.size(),
                     table.waterlines.size());
  return 0;
}

int export_hull(const HullExportArguments& arguments, std::ostream& out) {
  io::write_file(arguments.file, io::offsets_text(io::read_hull(arguments.library, arguments.name)));
  out << fmt::format("  {}\n", arguments.file.string());
  return 0;
}

int remove_hull(const std::filesystem::path& library, const std::string& name) {
  io::remove_hull(library, name);
  return 0;
}

}  // namespace isorim::cli
