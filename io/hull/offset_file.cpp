#include "io/hull/offset_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/file_bytes.h"

namespace isorim::io {
namespace {

using geometry::OffsetTable;
using geometry::Points;

constexpr double none = std::numeric_limits<double>::quiet_NaN();

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

struct Line {
  int number = 0;
  std::vector<std::string_view> cells;
};

void check_encoding(std::string_view text, const std::string& file) {
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    throw InputError(fmt::format("{}: found text in UTF-16; expected UTF-8", file));
  const std::size_t zero = text.find('\0');
  if (zero == std::string_view::npos) return;
  const auto line = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(zero), '\n') + 1;
  throw InputError(fmt::format("{}:{}: found a byte 0; expected text, cells with commas between them", file, line));
}

/// The lines that say something, in cells. They end with LF, CR LF or CR.
std::vector<Line> content_lines(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  std::vector<Line> lines;
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    const std::size_t ending = text.substr(end).starts_with("\r\n") ? 2 : 1;
    std::string_view line = text.substr(0, end);
    line = trimmed(line.substr(0, line.find('#')));
    text.remove_prefix(std::min(end + ending, text.size()));
    if (line.empty()) continue;
    Line& cells = lines.emplace_back(Line{number, {}});
    for (std::size_t begin = 0; begin <= line.size();) {
      const std::size_t stop = std::min(line.find(',', begin), line.size());
      cells.cells.push_back(trimmed(line.substr(begin, stop - begin)));
      begin = stop + 1;
    }
  }
  return lines;
}

std::optional<double> as_number(std::string_view text) {
  double value = 0.0;
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// The height that a column's head names.
std::optional<double> as_height(std::string_view head) {
  for (const std::string_view prefix : {"wl", "z"}) {
    if (!head.starts_with(prefix)) continue;
    head.remove_prefix(prefix.size());
    head = trimmed(head);
    if (head.starts_with('=') || head.starts_with('_')) head.remove_prefix(1);
    return as_number(trimmed(head));
  }
  return as_number(head);
}

enum class ColumnKind { station, waterline, tangent, half_breadth, height, area };

struct Column {
  ColumnKind kind = ColumnKind::waterline;
  /// "keel", "deck", or a knuckle.
  std::string name;
  double height = 0.0;
};

enum class BreadthUnit { length, beam, waterline };

/// One place of the table that lies off the waterlines, as columns.
struct EdgeColumns {
  std::string name;
  std::optional<std::size_t> half_breadth;
  std::optional<std::size_t> height;
};

class OffsetReader {
 public:
  OffsetReader(std::string_view text, const std::string& file) : file_(file) {
    check_encoding(text, file);
    lines_ = content_lines(text);
  }

  OffsetTable read() {
    read_keys();
    read_head();
    read_rows();
    make_heights();
    make_stations();
    make_edges();
    make_baseline();
    read_contours();
    try {
      geometry::check(table_);
      geometry::hull_sections(table_);
    } catch (const GeometryError& error) {
      throw InputError(fmt::format("{}: {}", place_of(error.what()), error.what()));
    }
    return std::move(table_);
  }

 private:
  [[noreturn]] void refuse(const Line& line, const std::string& message) const {
    throw InputError(fmt::format("{}:{}: {}", file_, line.number, message));
  }

  /// The file, and the line of the first station that the message names.
  std::string place_of(std::string_view message) const {
    constexpr std::string_view word = "station ";
    const std::size_t at = message.find(word);
    if (at == std::string_view::npos) return file_;
    const std::string_view rest = message.substr(at + word.size());
    for (std::size_t row = 0; row < names_.size(); ++row) {
      const std::string& name = names_[row];
      const bool is_name = rest.starts_with(name) && (rest.size() == name.size() || rest[name.size()] == ' ' ||
                                                      rest[name.size()] == ',' || rest[name.size()] == ':');
      if (is_name) return fmt::format("{}:{}", file_, row_lines_[row]);
    }
    return file_;
  }

  double number(const Line& line, std::size_t cell, std::string_view column) const {
    const std::string_view text = cell < line.cells.size() ? line.cells[cell] : std::string_view{};
    if (const std::optional<double> value = as_number(text)) return *value;
    refuse(line, fmt::format("column {} ({}): found \"{}\"; expected a number", cell + 1, column, text));
  }

  // --- Keys ---

  void read_keys() {
    for (; next_ < lines_.size() && lines_[next_].cells.front() != "station"; ++next_) read_key(lines_[next_]);
    if (next_ == lines_.size()) {
      throw InputError(fmt::format("{}: found no table; expected a line that begins with \"station\"", file_));
    }
    for (const auto& [key, value] :
         {std::pair{"length", table_.length}, std::pair{"beam", table_.beam}, std::pair{"draught", table_.draught}}) {
      if (!(value > 0.0))
        refuse(lines_[next_], fmt::format("found no key \"{}\" before the table; expected its length", key));
    }
  }

  void read_key(const Line& line) {
    const std::string_view key = line.cells.front();
    const auto [earlier, is_new] = key_lines_.emplace(key, line.number);
    if (!is_new)
      refuse(line, fmt::format("found the key \"{}\" again, as in line {}; expected it once", key, earlier->second));
    const auto text = [&](std::size_t cell) { return cell < line.cells.size() ? line.cells[cell] : ""; };
    if (key == "name" || key == "source") {
      // The text may have commas.
      std::string joined(text(1));
      for (std::size_t i = 2; i < line.cells.size(); ++i) joined.append(", ").append(line.cells[i]);
      (key == "name" ? table_.name : table_.source) = joined;
    } else if (key == "length" || key == "beam" || key == "draught") {
      const double value = number(line, 1, key);
      if (!(value > 0.0)) refuse(line, fmt::format("the {} is {}; expected a positive number", key, value));
      (key == "length" ? table_.length : key == "beam" ? table_.beam : table_.draught) = value;
    } else if (key == "after_perpendicular") {
      after_perpendicular_ = number(line, 1, key);
    } else if (key == "baseline") {
      baseline_ = number(line, 1, key);
    } else if (key == "stations") {
      station_count_ = number(line, 1, key);
      if (!(*station_count_ > 0.0) || (text(2) != "aft" && text(2) != "forward")) {
        refuse(line, fmt::format("found stations {}, {}; expected the number of the last station and \"aft\" or "
                                 "\"forward\", the way in which they are counted",
                                 text(1), text(2)));
      }
      counts_aft_ = text(2) == "aft";
    } else if (key == "waterlines") {
      if (text(1) != "draught") refuse(line, fmt::format("found waterlines {}; expected \"draught\"", text(1)));
      heights_by_draught_ = true;
    } else if (key == "half_breadths") {
      if (text(1) != "beam" && text(1) != "waterline")
        refuse(line, fmt::format("found half_breadths {}; expected \"beam\" or \"waterline\"", text(1)));
      breadths_ = text(1) == "beam" ? BreadthUnit::beam : BreadthUnit::waterline;
    } else {
      if (key.find(';') != std::string_view::npos)
        refuse(line, fmt::format("found \"{}\"; expected cells with commas between them, and points in numbers", key));
      refuse(line, fmt::format("found the key \"{}\"; expected name, source, length, beam, draught, "
                               "after_perpendicular, baseline, stations, waterlines, half_breadths, or the head of the "
                               "table, which begins with \"station\"",
                               key));
    }
  }

  // --- The table ---

  Column column_of(const Line& line, std::size_t cell) const {
    const std::string_view head = line.cells[cell];
    if (const std::optional<double> height = as_height(head)) return {ColumnKind::waterline, {}, *height};
    if (head == "tangent") return {ColumnKind::tangent, "keel", 0.0};
    if (head == "area") return {ColumnKind::area, {}, 0.0};
    for (const auto& [ending, kind] :
         {std::pair{" half-breadth", ColumnKind::half_breadth}, std::pair{" height", ColumnKind::height}}) {
      if (head.ends_with(ending))
        return {kind, std::string(head.substr(0, head.size() - std::string_view(ending).size())), 0.0};
    }
    refuse(line, fmt::format("column {}: found \"{}\"; expected a height, \"tangent\", \"area\", or \"keel\", \"deck\" "
                             "or a knuckle's name with \" half-breadth\" or \" height\"",
                             cell + 1, head));
  }

  static bool is_breadth(const Column& column) {
    return column.kind == ColumnKind::waterline || column.kind == ColumnKind::half_breadth ||
           column.kind == ColumnKind::tangent;
  }

  EdgeColumns& edge(const std::string& name) {
    const auto found = std::find_if(edges_.begin(), edges_.end(), [&](const auto& e) { return e.name == name; });
    return found == edges_.end() ? edges_.emplace_back(EdgeColumns{name, {}, {}}) : *found;
  }

  void read_head() {
    const Line& head = lines_[next_++];
    head_line_ = head.number;
    columns_.push_back({ColumnKind::station, {}, 0.0});
    for (std::size_t cell = 1; cell < head.cells.size(); ++cell) {
      const Column column = column_of(head, cell);
      const bool is_edge = column.kind == ColumnKind::half_breadth || column.kind == ColumnKind::tangent;
      if (is_edge || column.kind == ColumnKind::height) {
        EdgeColumns& own = edge(column.name);
        std::optional<std::size_t>& place = is_edge ? own.half_breadth : own.height;
        if (place) refuse(head, fmt::format("column {}: \"{}\" is there twice", cell + 1, head.cells[cell]));
        place = cell;
      }
      for (std::size_t before = 1; before < cell && column.kind == ColumnKind::waterline; ++before) {
        if (columns_[before].kind != ColumnKind::waterline || columns_[before].height != column.height) continue;
        refuse(head, fmt::format("column {}: found the height {} again, as in column {}; expected it once", cell + 1,
                                 head.cells[cell], before + 1));
      }
      table_.has_tangent_bottom = table_.has_tangent_bottom || column.kind == ColumnKind::tangent;
      columns_.push_back(column);
    }
    heads_.assign(head.cells.begin(), head.cells.end());
  }

  static bool is_contour(std::string_view cell) { return cell == "stem" || cell == "stern" || cell == "bulb"; }

  void read_rows() {
    for (; next_ < lines_.size() && !is_contour(lines_[next_].cells.front()); ++next_) {
      const Line& line = lines_[next_];
      if (line.cells.size() != columns_.size()) {
        refuse(line, fmt::format("found {} cells; expected {}, as in the head of the table{}", line.cells.size(),
                                 columns_.size(),
                                 line.cells.size() > columns_.size()
                                     ? " (numbers have points, not commas)"
                                     : " (a cell without a value stays empty; commas are between cells)"));
      }
      std::vector<double> row(columns_.size(), none);
      const bool is_largest = line.cells.front() == "max";
      for (std::size_t cell = is_largest ? 1 : 0; cell < row.size(); ++cell) {
        const std::string_view text = line.cells[cell];
        if (cell > 0 && (text.empty() || text == "-")) continue;
        row[cell] = number(line, cell, heads_[cell]);
        if (row[cell] < 0.0 && is_breadth(columns_[cell])) {
          refuse(line, fmt::format("column {} ({}): found the half-breadth {}; expected none below 0", cell + 1,
                                   heads_[cell], text));
        }
      }
      if (is_largest) {
        if (breadths_ != BreadthUnit::waterline)
          refuse(line, "found a row \"max\"; expected it with \"half_breadths,waterline\" alone");
        largest_ = std::move(row);
      } else {
        names_.emplace_back(line.cells.front());
        row_lines_.push_back(line.number);
        rows_.push_back(std::move(row));
      }
    }
    if (rows_.size() < 2) {
      throw InputError(fmt::format("{}:{}: found {} station(s) below the head of the table; expected at least two",
                                   file_, head_line_, rows_.size()));
    }
    if (breadths_ == BreadthUnit::waterline && largest_.empty())
      throw InputError(fmt::format("{}: found no row \"max\"; expected one with \"half_breadths,waterline\"", file_));
  }

  double length_of_breadth(double value, std::size_t cell) const {
    switch (breadths_) {
      case BreadthUnit::length:
        return value;
      case BreadthUnit::beam:
        return 0.5 * table_.beam * value;
      case BreadthUnit::waterline:
        return 0.5 * table_.beam * (value * (std::isnan(largest_[cell]) ? 1.0 : largest_[cell]));
    }
    return value;
  }

  double height_of(double value) const { return heights_by_draught_ ? table_.draught * value : value; }

  double x_of(double station) const {
    if (!station_count_) return station;
    const double part = station / *station_count_;
    return table_.length * (counts_aft_ ? 1.0 - part : part);
  }

  /// Columns of waterlines from below, whatever their order in the file.
  void make_heights() {
    for (std::size_t cell = 0; cell < columns_.size(); ++cell) {
      if (columns_[cell].kind == ColumnKind::waterline) waterline_cells_.push_back(cell);
    }
    std::sort(waterline_cells_.begin(), waterline_cells_.end(),
              [&](std::size_t a, std::size_t b) { return columns_[a].height < columns_[b].height; });
    for (const std::size_t cell : waterline_cells_) table_.waterlines.push_back(height_of(columns_[cell].height));
  }

  /// Rows from aft, whatever their order in the file.
  void make_stations() {
    row_order_.resize(rows_.size());
    std::iota(row_order_.begin(), row_order_.end(), std::size_t{0});
    std::sort(row_order_.begin(), row_order_.end(),
              [&](std::size_t a, std::size_t b) { return x_of(rows_[a][0]) < x_of(rows_[b][0]); });
    const auto stations = static_cast<Eigen::Index>(rows_.size());
    table_.half_breadths.resize(static_cast<Eigen::Index>(waterline_cells_.size()), stations);
    for (Eigen::Index i = 0; i < stations; ++i) {
      const std::size_t row = row_order_[static_cast<std::size_t>(i)];
      table_.stations.push_back(x_of(rows_[row][0]));
      table_.station_names.push_back(names_[row]);
      for (std::size_t j = 0; j < waterline_cells_.size(); ++j) {
        const std::size_t cell = waterline_cells_[j];
        table_.half_breadths(static_cast<Eigen::Index>(j), i) = length_of_breadth(rows_[row][cell], cell);
      }
      if (i > 0 && table_.stations[std::size_t(i)] == table_.stations[std::size_t(i) - 1]) {
        throw InputError(fmt::format("{}:{}: station {} is there twice", file_, row_lines_[row], names_[row]));
      }
    }
    table_.after_perpendicular = after_perpendicular_.value_or(station_count_ ? 0.0 : table_.stations.front());
    make_areas();
  }

  void make_areas() {
    for (std::size_t cell = 0; cell < columns_.size(); ++cell) {
      if (columns_[cell].kind != ColumnKind::area) continue;
      for (const std::size_t row : row_order_) table_.area_ratios.push_back(rows_[row][cell]);
    }
  }

  Points<2> places(const EdgeColumns& edge, double default_height) const {
    Points<2> result(2, static_cast<Eigen::Index>(rows_.size()));
    for (std::size_t i = 0; i < row_order_.size(); ++i) {
      const std::vector<double>& row = rows_[row_order_[i]];
      const double breadth = edge.half_breadth ? length_of_breadth(row[*edge.half_breadth], *edge.half_breadth) : 0.0;
      const double height = edge.height ? height_of(row[*edge.height]) : default_height;
      result.col(static_cast<Eigen::Index>(i)) << breadth, std::isnan(breadth) ? none : height;
    }
    return result;
  }

  void make_edges() {
    for (const EdgeColumns& edge : edges_) {
      if (edge.name == "keel") {
        const double ground = baseline_ ? height_of(*baseline_) : 0.0;
        if (!edge.height && !table_.has_tangent_bottom) refuse_edge(edge, "keel height");
        table_.keel = places(edge, ground);
      } else if (!edge.height || !edge.half_breadth) {
        refuse_edge(edge, edge.name + (edge.height ? " half-breadth" : " height"));
      } else if (edge.name == "deck") {
        table_.deck = places(edge, none);
      } else {
        table_.knuckles.push_back({edge.name, places(edge, none)});
      }
    }
  }

  [[noreturn]] void refuse_edge(const EdgeColumns& edge, const std::string& missing) const {
    throw InputError(
        fmt::format("{}: the table has one column for \"{}\"; expected \"{}\" too", file_, edge.name, missing));
  }

  void make_baseline() {
    if (baseline_) {
      table_.baseline = height_of(*baseline_);
      return;
    }
    if (heights_by_draught_) return;
    double lowest = table_.waterlines.empty() ? std::numeric_limits<double>::max() : table_.waterlines.front();
    for (Eigen::Index i = 0; i < table_.keel.cols(); ++i) {
      if (!std::isnan(table_.keel(1, i))) lowest = std::min(lowest, table_.keel(1, i));
    }
    table_.baseline = lowest;
  }

  // --- Contours ---

  void read_contours() {
    for (; next_ < lines_.size(); ++next_) {
      const Line& line = lines_[next_];
      const std::string_view kind = line.cells.front();
      if (!is_contour(kind) || line.cells.size() < 3 || line.cells.size() > 4) {
        refuse(line,
               fmt::format("found \"{}\" with {} cells; expected \"stem\", \"stern\" or \"bulb\", x, a height, and "
                           "perhaps the name of a knuckle",
                           kind, line.cells.size()));
      }
      const bool is_stem = kind == "stem";
      Points<2>& contour = is_stem ? table_.stem : kind == "stern" ? table_.stern : table_.bulb;
      contour.conservativeResize(2, contour.cols() + 1);
      contour.rightCols<1>() << x_of(number(line, 1, "x")), height_of(number(line, 2, "height"));
      if (line.cells.size() == 4 && kind == "bulb")
        refuse(line, fmt::format("column 4: found \"{}\"; expected no knuckle on the bulb", line.cells[3]));
      if (line.cells.size() == 4) add_knuckle_end(line, is_stem, static_cast<int>(contour.cols()) - 1);
    }
    for (const bool is_stem : {true, false}) {
      const Points<2>& contour = is_stem ? table_.stem : table_.stern;
      std::vector<int>& ends = is_stem ? table_.stem_knuckles : table_.stern_knuckles;
      if (contour.cols() == 0) continue;
      ends.resize(table_.knuckles.size(), -1);
      for (std::size_t k = 0; k < ends.size(); ++k) {
        if (ends[k] >= 0) continue;
        throw InputError(
            fmt::format("{}: the knuckle \"{}\" has no end on the {}; expected its name at one of its "
                        "points",
                        file_, table_.knuckles[k].name, is_stem ? "stem" : "stern"));
      }
    }
  }

  void add_knuckle_end(const Line& line, bool is_stem, int column) {
    std::vector<int>& ends = is_stem ? table_.stem_knuckles : table_.stern_knuckles;
    ends.resize(table_.knuckles.size(), -1);
    for (std::size_t k = 0; k < ends.size(); ++k) {
      if (table_.knuckles[k].name != line.cells[3]) continue;
      ends[k] = column;
      return;
    }
    refuse(line, fmt::format("column 4: found the knuckle \"{}\"; expected one of the table's", line.cells[3]));
  }

  std::string file_;
  std::vector<Line> lines_;
  std::map<std::string_view, int> key_lines_;
  int head_line_ = 0;
  std::size_t next_ = 0;
  OffsetTable table_;
  std::optional<double> after_perpendicular_;
  std::optional<double> baseline_;
  std::optional<double> station_count_;
  bool counts_aft_ = true;
  bool heights_by_draught_ = false;
  BreadthUnit breadths_ = BreadthUnit::length;
  std::vector<Column> columns_;
  std::vector<std::string> heads_;
  std::vector<EdgeColumns> edges_;
  std::vector<std::string> names_;
  std::vector<int> row_lines_;
  std::vector<std::vector<double>> rows_;
  std::vector<double> largest_;
  std::vector<std::size_t> row_order_;
  std::vector<std::size_t> waterline_cells_;
};

// --- Writing --------------------------------------------------------------------------------------------------

std::string cell(double value) {
  return std::isnan(value) ? std::string() : fmt::format("{}", value);
}

std::string head_line(const OffsetTable& table) {
  std::string line = "station";
  if (table.keel.cols() > 0)
    line += table.has_tangent_bottom ? ",tangent,keel height" : ",keel half-breadth,keel height";
  for (const double z : table.waterlines) line += fmt::format(",z={}", z);
  if (table.deck.cols() > 0) line += ",deck half-breadth,deck height";
  for (const geometry::KnuckleLine& knuckle : table.knuckles)
    line += fmt::format(",{0} half-breadth,{0} height", knuckle.name);
  if (!table.area_ratios.empty()) line += ",area";
  return line + "\n";
}

std::string row_line(const OffsetTable& table, Eigen::Index i) {
  const auto place = [&](const Points<2>& places) {
    if (places.cols() == 0) return std::string();
    if (std::isnan(places(1, i))) return std::string(",,");
    return fmt::format(",{},{}", places(0, i), places(1, i));
  };
  std::string line = cell(table.stations[std::size_t(i)]) + place(table.keel);
  for (Eigen::Index j = 0; j < table.half_breadths.rows(); ++j) line += "," + cell(table.half_breadths(j, i));
  line += place(table.deck);
  for (const geometry::KnuckleLine& knuckle : table.knuckles) line += place(knuckle.places);
  if (!table.area_ratios.empty()) line += "," + cell(table.area_ratios[std::size_t(i)]);
  return line + "\n";
}

std::string contour_lines(const OffsetTable& table, const char* name, const Points<2>& contour,
                          const std::vector<int>& knuckles) {
  std::string lines;
  for (Eigen::Index i = 0; i < contour.cols(); ++i) {
    lines += fmt::format("{},{},{}", name, contour(0, i), contour(1, i));
    const auto end = std::find(knuckles.begin(), knuckles.end(), static_cast<int>(i));
    if (end != knuckles.end()) lines += "," + table.knuckles[std::size_t(end - knuckles.begin())].name;
    lines += "\n";
  }
  return lines;
}

}  // namespace

OffsetTable parse_offsets(std::string_view text, const std::string& name) {
  return OffsetReader(text, name).read();
}

OffsetTable read_offsets(const std::filesystem::path& path) {
  OffsetTable table = parse_offsets(read_bytes(path), path.string());
  if (table.name.empty()) table.name = path.stem().string();
  return table;
}

std::string offsets_text(const OffsetTable& table) {
  std::string text = fmt::format("name,{}\n", table.name);
  if (!table.source.empty()) text += fmt::format("source,{}\n", table.source);
  text += fmt::format("length,{}\nbeam,{}\ndraught,{}\nafter_perpendicular,{}\nbaseline,{}\n", table.length, table.beam,
                      table.draught, table.after_perpendicular, table.baseline);
  text += head_line(table);
  for (Eigen::Index i = 0; i < table.half_breadths.cols(); ++i) text += row_line(table, i);
  return text + contour_lines(table, "stem", table.stem, table.stem_knuckles) +
         contour_lines(table, "stern", table.stern, table.stern_knuckles) +
         contour_lines(table, "bulb", table.bulb, {});
}

}  // namespace isorim::io
