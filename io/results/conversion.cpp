#include "io/results/conversion.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/tspline/extraction.h"
#include "io/iges/writer.h"
#include "io/results/pictures.h"
#include "io/tspline/iga.h"

namespace isorim::io {
namespace {

constexpr std::array<std::pair<const char*, BoundaryFormat>, 6> extensions{{{".igs", BoundaryFormat::iges},
                                                                            {".iges", BoundaryFormat::iges},
                                                                            {".iga", BoundaryFormat::iga},
                                                                            {".vtu", BoundaryFormat::vtu},
                                                                            {".svg", BoundaryFormat::svg},
                                                                            {".stl", BoundaryFormat::stl}}};

std::string counted(std::size_t count, const char* one, const char* several) {
  return fmt::format("{} {}", count, count == 1 ? one : several);
}

std::string counted(int count, const char* one, const char* several) {
  return counted(static_cast<std::size_t>(count), one, several);
}

/// None where the patches are no longer those of the file: clipped ones.
std::vector<iges::Look> looks_of(const std::vector<PatchOrigin>& origins, std::size_t patches) {
  std::vector<iges::Look> looks;
  if (origins.size() != patches) return looks;
  for (const PatchOrigin& origin : origins) looks.push_back({origin.origin.colour, origin.origin.level});
  return looks;
}

Conversion write_iges(const std::filesystem::path& path, const CaseFile& file, const AnyModel& model,
                      const ConversionOptions& asked) {
  iges::WriterOptions options;
  options.form = asked.faces == FaceForm::loose ? iges::Form::faces : iges::Form::solids;
  options.title = file.title();
  options.unit = file.cad && !file.cad->unit.empty() ? file.cad->unit : asked.unit.value_or("mm");
  const iges::WriterReport report = std::visit(
      [&](const auto& known) {
        options.looks = looks_of(known.origins, known.oriented.boundary.patches.size());
        return iges::write_iges(path, known.oriented, options);
      },
      model);
  Conversion conversion;
  conversion.solids = report.solids;
  conversion.solid_faces = report.solid_faces;
  conversion.loose_faces = report.loose_faces;
  conversion.curves = report.curves;
  conversion.unit = options.unit;
  return conversion;
}

/// All patches as one file; they keep no names there.
Conversion write_iga(const std::filesystem::path& path, const CaseFile& file, const AnyModel& model) {
  const auto* solid = std::get_if<Model<3>>(&model);
  if (!solid) {
    throw InputError(fmt::format("{}: an .iga file holds surfaces, and this is a shape of the plane", file.title()));
  }
  try {
    const geometry::ExtractedSurface surface = geometry::extracted_surface(solid->oriented.boundary);
    tspline::write_iga(path, surface, file.title() + ", written by isorim");
    Conversion conversion;
    conversion.elements = surface.elements().size();
    conversion.functions = static_cast<std::size_t>(surface.function_count());
    return conversion;
  } catch (GeometryError& error) {
    error.add_context(file.title());
    throw;
  }
}

Conversion write_svg(const std::filesystem::path& path, const CaseFile& file, const AnyModel& model) {
  if (std::holds_alternative<Model<3>>(model)) {
    throw InputError(
        fmt::format("{}: a drawing (.svg) shows regions of the plane, and this is a shape in space", file.title()));
  }
  write_boundary_svg(path, file.title(), model);
  return {};
}

Conversion write_vtu(const std::filesystem::path& path, const AnyModel& model) {
  write_boundary_vtu(path, model);
  Conversion conversion;
  conversion.elements = static_cast<std::size_t>(summarise(model).elements);
  return conversion;
}

Conversion write_stl(const std::filesystem::path& path, const CaseFile& file, const AnyModel& model) {
  Conversion conversion;
  conversion.triangles = write_boundary_stl(path, file, model);
  return conversion;
}

std::string iges_text(const Conversion& conversion) {
  if (conversion.curves > 0) return counted(conversion.curves, "curve", "curves");
  std::string text;
  if (conversion.solids > 0) {
    text = fmt::format("{} of {}", counted(conversion.solids, "solid", "solids"),
                       counted(conversion.solid_faces, "face", "faces"));
  }
  if (conversion.loose_faces > 0) {
    text += fmt::format("{}{}", text.empty() ? "" : ", ", counted(conversion.loose_faces, "loose face", "loose faces"));
  }
  return text;
}

}  // namespace

BoundaryFormat boundary_format(const std::filesystem::path& path) {
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

std::string format_name(BoundaryFormat format) {
  const auto known = std::ranges::find(extensions, format, [](const auto& entry) { return entry.second; });
  return format == BoundaryFormat::iges ? "iges" : known->first + 1;
}

Conversion write_boundary(const std::filesystem::path& path, const CaseFile& file, const AnyModel& model,
                          const ConversionOptions& options) {
  const BoundaryFormat format = boundary_format(path);
  Conversion conversion = format == BoundaryFormat::iges  ? write_iges(path, file, model, options)
                          : format == BoundaryFormat::iga ? write_iga(path, file, model)
                          : format == BoundaryFormat::svg ? write_svg(path, file, model)
                          : format == BoundaryFormat::stl ? write_stl(path, file, model)
                                                          : write_vtu(path, model);
  conversion.format = format;
  return conversion;
}

std::string conversion_text(const Conversion& conversion) {
  switch (conversion.format) {
    case BoundaryFormat::iges:
      return fmt::format("{}, unit {}", iges_text(conversion), conversion.unit);
    case BoundaryFormat::iga:
      return fmt::format("{} elements, {} functions", conversion.elements, conversion.functions);
    case BoundaryFormat::vtu:
      return fmt::format("{} elements", conversion.elements);
    case BoundaryFormat::stl:
      return fmt::format("{} triangles", conversion.triangles);
    case BoundaryFormat::svg:
      break;
  }
  return "a drawing";
}

}  // namespace isorim::io
