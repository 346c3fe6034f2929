#include "io/picture/picture.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdlib>
#include <ostream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/analysis/analysis.h"
#include "io/analysis/solution_pictures.h"
#include "io/atomic_file.h"
#include "io/case/complaints.h"
#include "io/cli/commands.h"
#include "io/cli/interrupts.h"
#include "io/cli/replies.h"
#include "io/results/compute.h"
#include "io/results/pictures.h"

namespace isorim::cli {
namespace {

namespace picture = io::picture;
using std::filesystem::path;

/// For the files that are drawn; goes with all that is in it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "isorim_picture_XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) throw InputError(fmt::format("cannot make a folder like {}", pattern));
    folder_ = pattern;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  /// An empty folder in it.
  path make_inner() {
    path inner = folder_ / std::to_string(++count_);
    io::make_folder(inner);
    return inner;
  }

 private:
  path folder_;
  int count_ = 0;
};

/// A case or CAD file, computed as far as the picture needs.
struct Prepared {
  path file;
  std::optional<io::AnyModel> model;
  std::optional<io::AnyAnalysis> analysis;
};

bool is_data_file(const path& file) {
  const std::string extension = file.extension().string();
  return extension == ".vtu" || extension == ".vtp" || extension == ".vti";
}

/// Cell data of boundary.vtu.
bool is_of_the_boundary(const std::string& field) {
  constexpr std::array<const char*, 5> names{"patch", "element", "orientation", "colour", "level"};
  return std::any_of(names.begin(), names.end(), [&](const char* name) { return field == name; });
}

Prepared prepare(const path& file, const PictureArguments& arguments, const io::RunOptions& options) {
  if (is_data_file(file)) return {file, std::nullopt, std::nullopt};
  const io::CaseFile read = io::read_case_or_cad(file, arguments.overrides, {.threads = arguments.threads});
  Prepared prepared{file, io::build_model(read), std::nullopt};
  if (!read.keys.analysis || !arguments.field || is_of_the_boundary(*arguments.field)) return prepared;
  std::visit(
      [&](const auto& known) { prepared.analysis = io::AnyAnalysis{io::analyse(read, known.oriented, options)}; },
      *prepared.model);
  return prepared;
}

/// Of an analysis: exact cells if they have the field, else facets; grids in the plane, where they show the inside.
std::vector<path> write_solution(const Prepared& prepared, const PictureArguments& arguments, const path& folder) {
  io::write_solution_vtu(folder / "solution.vtu", *prepared.model, *prepared.analysis);
  std::vector<path> files{folder / "solution.vtu"};
  if (!picture::has_field(files.front(), *arguments.field)) {
    io::write_fields_vtu(folder / "fields.vtu", *prepared.analysis, arguments.threads);
    files.front() = folder / "fields.vtu";
  }
  if (std::holds_alternative<io::Model<3>>(*prepared.model)) return files;
  const io::AnalysisReport& report =
      std::visit([](const auto& known) -> const io::AnalysisReport& { return known.report; }, prepared.analysis->known);
  io::write_samples(folder, report);
  for (const io::FieldSamples& grid : report.grids) files.push_back(folder / io::grid_file_name(grid));
  return files;
}

/// The files that stand for an input.
std::vector<path> write_input(const Prepared& prepared, const PictureArguments& arguments, TemporaryFolder& folder) {
  if (!prepared.model) return {prepared.file};
  const path inner = folder.make_inner();
  if (prepared.analysis) return write_solution(prepared, arguments, inner);
  io::write_boundary_vtu(inner / "boundary.vtu", *prepared.model);
  return {inner / "boundary.vtu"};
}

template <class Value, std::size_t N>
Value chosen(const char* option, const std::string& word, const std::array<std::pair<const char*, Value>, N>& known) {
  std::vector<std::string> names;
  for (const auto& [name, value] : known) {
    if (word == name) return value;
    names.emplace_back(name);
  }
  throw InputError(fmt::format("{}: found \"{}\"{}; expected one of {}", option, word, io::did_you_mean(word, names),
                               fmt::join(names, ", ")));
}

std::array<int, 2> size_from(const std::string& text) {
  std::array<int, 2> size{};
  const char* end = text.data() + text.size();
  const auto [middle, error] = std::from_chars(text.data(), end, size[0]);
  const bool has_height = error == std::errc() && middle != end && *middle == 'x';
  if (!has_height || std::from_chars(middle + 1, end, size[1]).ptr != end) {
    throw InputError(fmt::format("--size: found \"{}\"; expected WIDTHxHEIGHT in pixels, such as 1200x900", text));
  }
  return size;
}

picture::PictureOptions options_of(const PictureArguments& arguments) {
  using picture::ColourMap;
  using picture::FaceColours;
  using picture::Lines;
  constexpr std::array<std::pair<const char*, ColourMap>, 3> maps{
      {{"viridis", ColourMap::viridis}, {"coolwarm", ColourMap::coolwarm}, {"grey", ColourMap::grey}}};
  constexpr std::array<std::pair<const char*, FaceColours>, 3> colours{
      {{"automatic", FaceColours::automatic}, {"patch", FaceColours::patch}, {"plain", FaceColours::plain}}};
  constexpr std::array<std::pair<const char*, Lines>, 2> lines{{{"elements", Lines::elements}, {"none", Lines::none}}};
  picture::PictureOptions options;
  const auto [width, height] = size_from(arguments.size);
  options.width = width;
  options.height = height;
  for (const std::string& text : arguments.views) {
    for (picture::View& view : picture::views_from(text)) options.views.push_back(std::move(view));
  }
  const picture::ColourMap map = chosen("--map", arguments.map, maps);
  if (arguments.field) {
    options.field = {.name = *arguments.field, .component = arguments.component, .range = {}, .map = map};
    if (!arguments.range.empty()) options.field->range = {arguments.range[0], arguments.range[1]};
  } else if (!arguments.component.empty() || !arguments.range.empty()) {
    throw InputError("--component and --range belong to --field, which is absent");
  }
  options.colours = chosen("--colours", arguments.colours, colours);
  options.lines = chosen("--lines", arguments.lines, lines);
  options.transparent = arguments.background == "transparent";
  if (!options.transparent) options.background = picture::colour_from(arguments.background);
  return options;
}

}  // namespace

int draw_picture(const PictureArguments& arguments, std::ostream& out, std::ostream& err) {
  const picture::PictureOptions options = options_of(arguments);
  picture::check_options(options, arguments.output);
  io::require_writable_file(arguments.output);
  std::vector<Prepared> prepared;
  {
    ProgressLine progress(err);
    for (const path& file : arguments.inputs) {
      prepared.push_back(prepare(file, arguments, {arguments.threads, progress.reporter()}));
    }
  }
  const HeldInterrupts held;
  TemporaryFolder folder;
  std::vector<picture::PictureInput> inputs;
  for (const Prepared& input : prepared) {
    for (path& file : write_input(input, arguments, folder)) inputs.push_back({std::move(file), input.file.string()});
  }
  picture::draw_picture(inputs, options, arguments.output);
  out << (arguments.format == OutputFormat::json ? picture_json(arguments, options)
                                                 : fmt::format("{}\n", arguments.output.string()));
  return 0;
}

}  // namespace isorim::cli
