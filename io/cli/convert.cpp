#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <optional>
#include <ostream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/tspline/extraction.h"
#include "io/cad/read_cad.h"
#include "io/cli/commands.h"
#include "io/iges/writer.h"
#include "io/results/compute.h"
#include "io/results/pictures.h"
#include "io/tspline/iga.h"

namespace isorim::cli {
namespace {

enum class Format { iges, iga, vtu, svg, stl };

constexpr std::array<std::pair<const char*, Format>, 6> extensions{{{".igs", Format::iges},
                                                                    {".iges", Format::iges},
                                                                    {".iga", Format::iga},
                                                                    {".vtu", Format::vtu},
                                                                    {".svg", Format::svg},
                                                                    {".stl", Format::stl}}};

Format format_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const auto& [known, format] : extensions) {
    if (extension == known) return format;
  }
  throw InputError(
      fmt::format("cannot write '{}': found the extension \"{}\", expected one of .igs, .iges, .iga, .vtu, .svg, .stl",
                  path.string(), path.extension().string()));
}

void require_different_files(const ConvertArguments& arguments) {
  std::error_code missing;
  if (!std::filesystem::equivalent(arguments.input, arguments.output, missing) || missing) return;
  throw InputError(fmt::format("'{}' and '{}' are the same file", arguments.input.string(), arguments.output.string()));
}

std::string counted(int count, const char* one, const char* several) {
  return fmt::format("{} {}", count, count == 1 ? one : several);
}

std::string report_text(const io::iges::WriterReport& report) {
  if (report.curves > 0) return counted(report.curves, "curve", "curves");
  std::string text;
  if (report.solids > 0) {
    text = fmt::format("{} of {}", counted(report.solids, "solid", "solids"),
                       counted(report.solid_faces, "face", "faces"));
  }
  if (report.loose_faces > 0) {
    text += fmt::format("{}{}", text.empty() ? "" : ", ", counted(report.loose_faces, "loose face", "loose faces"));
  }
  return text;
}

/// None where the patches are no longer those of the file: clipped ones.
std::vector<io::iges::Look> looks_of(const std::vector<io::PatchOrigin>& origins, std::size_t patches) {
  std::vector<io::iges::Look> looks;
  if (origins.size() != patches) return looks;
  for (const io::PatchOrigin& origin : origins) looks.push_back({origin.origin.colour, origin.origin.level});
  return looks;
}

std::string write_iges(const ConvertArguments& arguments, const io::CaseFile& file, const io::AnyModel& model) {
  io::iges::WriterOptions options;
  options.form = arguments.faces == FaceForm::loose ? io::iges::Form::faces : io::iges::Form::solids;
  options.title = file.title();
  options.unit = file.cad && !file.cad->unit.empty() ? file.cad->unit : arguments.unit.value_or("mm");
  const io::iges::WriterReport report = std::visit(
      [&](const auto& known) {
        options.looks = looks_of(known.origins, known.oriented.boundary.patches.size());
        return io::iges::write_iges(arguments.output, known.oriented, options);
      },
      model);
  return fmt::format("{}, unit {}", report_text(report), options.unit);
}

/// All patches as one file; they keep no names there.
std::string write_iga(const ConvertArguments& arguments, const io::CaseFile& file, const io::AnyModel& model) {
  const auto* solid = std::get_if<io::Model<3>>(&model);
  if (!solid)
    throw InputError(
        fmt::format("{}: an .iga file holds surfaces, and this is a shape of the plane", arguments.input.string()));
  try {
    const geometry::ExtractedSurface surface = geometry::extracted_surface(solid->oriented.boundary);
    io::tspline::write_iga(arguments.output, surface, file.title() + ", written by isorim");
    return fmt::format("{} elements, {} functions", surface.elements().size(), surface.function_count());
  } catch (GeometryError& error) {
    error.add_context(arguments.input.string());
    throw;
  }
}

std::string write_svg(const ConvertArguments& arguments, const io::CaseFile& file, const io::AnyModel& model) {
  if (std::holds_alternative<io::Model<3>>(model)) {
    throw InputError(fmt::format("{}: a drawing (.svg) shows regions of the plane, and this is a shape in space",
                                 arguments.input.string()));
  }
  io::write_boundary_svg(arguments.output, file.title(), model);
  return "a drawing";
}

std::string write_vtu(const ConvertArguments& arguments, const io::AnyModel& model) {
  io::write_boundary_vtu(arguments.output, model);
  return fmt::format("{} elements", io::summarise(model).elements);
}

std::string write_stl(const ConvertArguments& arguments, const io::CaseFile& file, const io::AnyModel& model) {
  return fmt::format("{} triangles", io::write_boundary_stl(arguments.output, file, model));
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
  const Format format = format_of(arguments.output);
  require_different_files(arguments);
  const io::CaseFile file = read_input(arguments);
  const io::AnyModel model = io::build_model(file);
  const std::string content = format == Format::iges  ? write_iges(arguments, file, model)
                              : format == Format::iga ? write_iga(arguments, file, model)
                              : format == Format::svg ? write_svg(arguments, file, model)
                              : format == Format::stl ? write_stl(arguments, file, model)
                                                      : write_vtu(arguments, model);
  if (file.cad) {
    for (const std::string& warning : file.cad->warnings) {
      print_message(err, fmt::format("{}: {}", arguments.input.string(), warning));
    }
  }
  out << fmt::format("{}: {}\n", arguments.output.string(), content);
  return 0;
}

}  // namespace isorim::cli
