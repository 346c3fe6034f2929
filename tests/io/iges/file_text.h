#pragma once

#include <string>
#include <vector>

#include <fmt/format.h>

/// Small IGES files, written by hand.
namespace isorim::io::iges {

inline std::string section_line(std::string_view text, char section, int number) {
  return fmt::format("{:<72}{}{:>7}\n", text, section, number);
}

/// One entity as a test wants it: its P lines follow the type number.
struct EntityText {
  int type = 0;
  /// All parameters with the type number and the record delimiter, cut into lines of at most 64 columns.
  std::vector<std::string> parameters = {};
  int form = 0;
  int transformation = 0;
  std::string status = "00000000";
  int colour = 0;
  int level = 0;
  std::string label = {};
};

/// A whole file in fixed form, everything where it belongs: entity i (from 0) is D(2 i + 1).
struct FileText {
  std::vector<std::string> start{"Made for a test"};
  std::vector<std::string> global{"1H,,1H;,4HPart,8Hpart.igs,6Hisorim,3H0.1,32,38,6,308,15,4HPart,",
                                  "1.,2,2HMM,1,0.01,15H20260101.000000,1E-6,10.,2HMe,4HHere,11,0,",
                                  "15H20260101.000000,;"};
  std::vector<EntityText> entities;

  /// The lines of a section without their ends.
  std::string text() const {
    std::string text;
    int number = 0;
    for (const auto& line : start) text += section_line(line, 'S', ++number);
    number = 0;
    for (const auto& line : global) text += section_line(line, 'G', ++number);
    int parameter_line = 1;
    int directory_line = 0;
    for (const EntityText& e : entities) {
      const int lines = static_cast<int>(e.parameters.size());
      text += section_line(fmt::format("{:8}{:8}{:8}{:8}{:8}{:8}{:8}{:8}{:>8}", e.type, parameter_line, 0, 0, e.level,
                                       0, e.transformation, 0, e.status),
                           'D', ++directory_line);
      text += section_line(
          fmt::format("{:8}{:8}{:8}{:8}{:8}{:8}{:8}{:>8}{:8}", e.type, 0, e.colour, lines, e.form, "", "", e.label, 0),
          'D', ++directory_line);
      parameter_line += lines;
    }
    number = 0;
    for (std::size_t i = 0; i < entities.size(); ++i) {
      for (const auto& line : entities[i].parameters) {
        text += section_line(fmt::format("{:<64} {:7}", line, 2 * i + 1), 'P', ++number);
      }
    }
    text +=
        section_line(fmt::format("S{:7}G{:7}D{:7}P{:7}", start.size(), global.size(), directory_line, number), 'T', 1);
    return text;
  }
};

}  // namespace isorim::io::iges
