#include "io/cad/read_cad.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <fstream>
#include <string_view>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/iges/reader.h"
#include "io/occt/occt_reader.h"
#include "io/tspline/be.h"
#include "io/tspline/bext.h"
#include "io/tspline/iga.h"

namespace isorim::io {
namespace {

struct Extension {
  std::string_view text;
  CadFormat format;
};

constexpr std::array<Extension, 7> extensions{{{".igs", CadFormat::iges},
                                               {".iges", CadFormat::iges},
                                               {".stp", CadFormat::step},
                                               {".step", CadFormat::step},
                                               {".iga", CadFormat::iga},
                                               {".be", CadFormat::be},
                                               {".json", CadFormat::bext}}};

std::optional<CadFormat> format_of_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const Extension& known : extensions) {
    if (extension == known.text) return known.format;
  }
  return std::nullopt;
}

std::string beginning(const std::filesystem::path& path) {
  if (std::filesystem::is_directory(path)) throw InputError(fmt::format("{}: is a folder", path.string()));
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(fmt::format("{}: cannot be opened", path.string()));
  std::array<char, 1024> buffer{};
  file.read(buffer.data(), buffer.size());
  return {buffer.data(), static_cast<std::size_t>(file.gcount())};
}

/// A line of an IGES file: the letter of its section in column 73 and a number in the columns 74 to 80. The first
/// section is S, or the flag C of a compressed file.
bool is_first_iges_line(std::string_view line) {
  if (line.size() < 74 || (line[72] != 'S' && line[72] != 'C')) return false;
  const std::string_view number = line.substr(73, 7);
  return std::all_of(number.begin(), number.end(),
                     [](unsigned char c) { return std::isdigit(c) != 0 || std::isspace(c) != 0; });
}

std::optional<CadFormat> format_of_content(const std::string& text) {
  // Some programs put blank lines before the first section.
  std::string_view rest(text);
  for (int i = 0; i < 4 && !rest.empty(); ++i) {
    const std::size_t end = std::min(rest.find_first_of("\r\n"), rest.size());
    if (is_first_iges_line(rest.substr(0, end))) return CadFormat::iges;
    rest.remove_prefix(end);
    rest.remove_prefix(std::min(rest.find_first_not_of("\r\n"), rest.size()));
  }
  if (text.find("ISO-10303-21") != std::string::npos) return CadFormat::step;
  return std::nullopt;
}

/// With its article, for messages.
std::string_view name_of(CadFormat format) {
  constexpr std::array<std::string_view, 5> names{"an IGES file", "a STEP file", "an .iga file", "a .be file",
                                                  "a BEXT file"};
  return names[static_cast<std::size_t>(format)];
}

}  // namespace

std::optional<CadFormat> cad_format(const std::filesystem::path& path) {
  const std::optional<CadFormat> format = format_of_content(beginning(path));
  return format ? format : format_of_extension(path);
}

bool has_cad_extension(const std::filesystem::path& path) {
  return format_of_extension(path).has_value();
}

bool has_units(CadFormat format) {
  return format == CadFormat::iges || format == CadFormat::step;
}

std::string cad_formats() {
  return "IGES (.igs, .iges), STEP (.stp, .step), T-splines (.iga, .be, BEXT as .json)";
}

CadModel read_cad(const std::filesystem::path& path, const CadOptions& options) {
  const std::optional<CadFormat> format = cad_format(path);
  if (!format) {
    throw InputError(fmt::format("{}: found no format that is known; expected {}", path.string(), cad_formats()));
  }
  if (options.repair && *format != CadFormat::iges)
    throw InputError(fmt::format("{}: found {}; repair is for IGES files", path.string(), name_of(*format)));
  if (*format == CadFormat::step) return read_step(path);
  if (*format == CadFormat::iga) return tspline::read_iga(path);
  if (*format == CadFormat::be) return tspline::read_be(path);
  if (*format == CadFormat::bext) return tspline::read_bext(path);
  if (options.repair) return read_iges_repaired(path, *options.repair);
  IgesOptions iges;
  iges.include_blanked = options.blanked == BlankedEntities::include;
  iges.skip_bad_entities = options.bad_entities == BadEntities::skip;
  return read_iges(path, iges);
}

}  // namespace isorim::io
