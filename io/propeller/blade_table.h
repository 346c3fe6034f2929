#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/case/schema.h"

/// A blade's table as users write it, by columns.
namespace isorim::io {

struct BladeTableKeys {
  std::vector<double> radius_ratio;
  std::vector<double> chord;
  std::vector<double> chord_ratio;
  std::vector<double> pitch;
  std::vector<double> pitch_ratio;
  /// Degrees.
  std::vector<double> skew;
  std::vector<double> rake;
  std::vector<double> rake_ratio;
  std::vector<double> thickness;
  std::vector<double> thickness_ratio;
  std::vector<double> thickness_of_chord;
  std::vector<double> camber;
  std::vector<double> camber_ratio;
  std::vector<double> camber_of_chord;
  KeyPlace where;
};

struct BladeColumn {
  /// In case files and in the first line of tables.
  std::string_view name;
  std::string_view text;
  std::vector<double> BladeTableKeys::*values;
};

inline constexpr std::array<BladeColumn, 14> blade_columns{{
    {"r/R", "Radius over that of the tip, rising to 1.", &BladeTableKeys::radius_ratio},
    {"chord", "Length of the section; 0 at a tip that is round in outline.", &BladeTableKeys::chord},
    {"c/D", "The same over the diameter.", &BladeTableKeys::chord_ratio},
    {"pitch", "Of the helix that the chord lies on.", &BladeTableKeys::pitch},
    {"P/D", "The same over the diameter.", &BladeTableKeys::pitch_ratio},
    {"skew", "Degrees, against the rotation, of the middle of the chord.", &BladeTableKeys::skew},
    {"rake", "Aft, a length.", &BladeTableKeys::rake},
    {"rake/D", "The same over the diameter.", &BladeTableKeys::rake_ratio},
    {"thickness", "The section's largest one.", &BladeTableKeys::thickness},
    {"t/D", "The same over the diameter.", &BladeTableKeys::thickness_ratio},
    {"t/c", "The same over the chord.", &BladeTableKeys::thickness_of_chord},
    {"camber", "The mean line's largest one, towards the back.", &BladeTableKeys::camber},
    {"f/D", "The same over the diameter.", &BladeTableKeys::camber_ratio},
    {"f/c", "The same over the chord.", &BladeTableKeys::camber_of_chord},
}};

/// Reads lines of numbers below a line of names (blade_columns, in any order and case; of others nothing is read).
/// Separators are commas, semicolons or tabs; empty lines and those that begin with # are passed over. Throws
/// InputError "name:line: ..." for a first line without r/R, a name given twice, another number of columns, what is no
/// finite number, and decimal commas.
BladeTableKeys parse_blade_table(std::string_view text, const std::string& name);

}  // namespace isorim::io
