#include <filesystem>
#include <optional>
#include <ostream>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/cad/read_cad.h"
#include "io/cli/commands.h"
#include "io/cli/replies.h"
#include "io/results/compute.h"
#include "io/results/conversion.h"

namespace isorim::cli {
namespace {

void require_different_files(const ConvertArguments& arguments) {
  std::error_code missing;
  if (!std::filesystem::equivalent(arguments.input, arguments.output, missing) || missing) return;
  throw InputError(fmt::format("'{}' and '{}' are the same file", arguments.input.string(), arguments.output.string()));
}

bool tells_unit(const std::filesystem::path& path) {
  if (!io::has_cad_extension(path)) return false;
  const std::optional<io::CadFormat> format = io::cad_format(path);
  return format && io::has_units(*format);
}

/// The case or CAD file; if the latter tells its unit, its lengths are converted into the one that is asked for.
io::CaseFile read_input(const ConvertArguments& arguments) {
  std::vector<std::string> overrides = arguments.overrides;
  if (arguments.unit && tells_unit(arguments.input)) overrides.push_back("geometry.units=" + *arguments.unit);
  io::CaseFile file = io::read_case_or_cad(arguments.input, overrides);
  if (file.cad && arguments.unit && !file.cad->unit.empty() && *arguments.unit != file.cad->unit) {
    throw InputError(
        fmt::format("{}: its lengths are in {}, and --unit asks for {}; expected [geometry] units = \"{}\"",
                    arguments.input.string(), file.cad->unit, *arguments.unit, *arguments.unit));
  }
  return file;
}

}  // namespace

int convert(const ConvertArguments& arguments, std::ostream& out, std::ostream& err) {
  io::boundary_format(arguments.output);
  require_different_files(arguments);
  const io::CaseFile file = read_input(arguments);
  const io::Conversion conversion =
      io::write_boundary(arguments.output, file, io::build_model(file), {arguments.faces, arguments.unit});
  const std::vector<std::string> warnings = file.cad ? file.cad->warnings : std::vector<std::string>();
  for (const std::string& warning : warnings) {
    print_message(err, fmt::format("{}: {}", arguments.input.string(), warning));
  }
  if (arguments.format == OutputFormat::json) {
    out << conversion_json(arguments, conversion, warnings);
  } else {
    out << fmt::format("{}: {}\n", arguments.output.string(), io::conversion_text(conversion));
  }
  return 0;
}

}  // namespace isorim::cli
