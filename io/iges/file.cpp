#include "io/iges/file.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/file_bytes.h"
#include "io/iges/lines.h"
#include "io/iges/records.h"

namespace isorim::io::iges {

std::string entity_text(const Entity& entity) {
  return fmt::format("{} at D{}", entity.type, entity.sequence);
}

const Entity* File::find(int sequence) const {
  if (sequence <= 0 || sequence % 2 == 0) return nullptr;
  const auto guess = static_cast<std::size_t>(sequence / 2);
  if (guess < entities.size() && entities[guess].sequence == sequence) return &entities[guess];
  const auto found = std::lower_bound(entities.begin(), entities.end(), sequence,
                                      [](const Entity& entity, int value) { return entity.sequence < value; });
  return found != entities.end() && found->sequence == sequence ? &*found : nullptr;
}

namespace {

/// "G      4" in the fields of 8 columns of a T line.
int count_in_terminate(std::string_view line, char section) {
  for (std::size_t i = 0; i + 8 <= line.size() && i < 32; i += 8) {
    if (line[i] == section) return parse_integer(trim(line.substr(i + 1, 7))).value_or(0);
  }
  return 0;
}

void check_counts(const Sections& sections, Warnings& warnings) {
  if (!sections.terminate) return;
  const std::pair<char, std::size_t> counts[] = {{'S', static_cast<std::size_t>(sections.start_lines)},
                                                 {'G', static_cast<std::size_t>(sections.global_lines)},
                                                 {'D', sections.directory.size()},
                                                 {'P', sections.parameters.lines.size()}};
  for (const auto& [section, found] : counts) {
    const int told = count_in_terminate(*sections.terminate, section);
    if (told >= 0 && static_cast<std::size_t>(told) == found) continue;
    warnings.add(fmt::format("it counts {} lines in section {}, but there are {}", told, section, found), "T line");
  }
}

File read_sections(Sections sections, Warnings& warnings) {
  File file;
  check_counts(sections, warnings);
  file.start = std::move(sections.start);
  file.global = read_global_section(sections.global, warnings);
  Directory directory = read_directory(sections.directory, warnings);
  auto parameters = std::make_shared<ParameterText>(std::move(sections.parameters));
  assign_parameters(directory, *parameters, file.global.delimiters, warnings);
  file.entities = std::move(directory.entities);
  file.parameters = std::move(parameters);
  file.warnings = warnings.sentences();
  return file;
}

}  // namespace

File parse(std::string_view bytes, std::string name) {
  try {
    Warnings warnings;
    File file = read_sections(split_sections(bytes, warnings), warnings);
    file.name = std::move(name);
    return file;
  } catch (Error& error) {
    error.add_context(name);
    throw;
  }
}

File read_file(const std::filesystem::path& path) {
  return parse(read_bytes(path), path.string());
}

}  // namespace isorim::io::iges
