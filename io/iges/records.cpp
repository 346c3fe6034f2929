#include "io/iges/records.h"

#include <algorithm>
#include <charconv>
#include <numeric>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"

namespace isorim::io::iges {
namespace {

/// The fields of a directory line, 8 columns each, counted from 1.
std::string_view field(const DirectoryLine& line, std::size_t number) {
  return trim(std::string_view(line.columns.data(), line.columns.size()).substr((number - 1) * 8, 8));
}

/// Two lines of the D section as one entry.
class EntryReader {
 public:
  EntryReader(const DirectoryLine& first, const DirectoryLine& second, Warnings& warnings)
      : first_(first), second_(second), warnings_(warnings) {}

  std::pair<Entity, RecordPlace> read() {
    Entity entity;
    entity.type = read_type();
    // What the geometry hangs on, and what only its looks do.
    RecordPlace place{needed(first_, 2, "parameter pointer"), needed(second_, 4, "parameter line count")};
    entity.structure = needed(first_, 3, "structure");
    entity.line_font = minor(first_, 4, "line font");
    entity.level = minor(first_, 5, "level");
    entity.view = minor(first_, 6, "view");
    entity.transformation = needed(first_, 7, "transformation");
    entity.label_display = minor(first_, 8, "label display");
    read_status(entity);
    entity.line_weight = minor(second_, 2, "line weight");
    entity.colour = minor(second_, 3, "colour");
    entity.form = needed(second_, 5, "form");
    entity.label = to_utf8(field(second_, 8));
    entity.subscript = minor(second_, 9, "subscript");
    entity.complaint = std::move(complaint_);
    return {std::move(entity), place};
  }

 private:
  static std::string place(const DirectoryLine& line) { return fmt::format("line {}", line.file_line); }

  int read_type() const {
    const auto type = parse_integer(field(first_, 1));
    if (!type || *type < 0) {
      throw InputError(fmt::format("line {}: found '{}' in columns 1 to 8 of a directory entry, expected a type number",
                                   first_.file_line, to_utf8(field(first_, 1))));
    }
    if (parse_integer(field(second_, 1)) != type) {
      warnings_.add("the second line of a directory entry has another type number; the first one holds",
                    place(second_));
    }
    return *type;
  }

  /// 0 if it is blank or no integer.
  int needed(const DirectoryLine& line, std::size_t number, const char* name) {
    const std::string_view text = field(line, number);
    if (text.empty()) return 0;
    const auto value = parse_integer(text);
    if (!value && complaint_.empty()) {
      complaint_ = fmt::format("field '{}' of its directory entry (line {}) holds '{}', expected an integer", name,
                               line.file_line, to_utf8(text));
    }
    return value.value_or(0);
  }
  int minor(const DirectoryLine& line, std::size_t number, const char* name) {
    const std::string_view text = field(line, number);
    if (text.empty()) return 0;
    const auto value = parse_integer(text);
    if (!value) {
      warnings_.add(fmt::format("field '{}' of a directory entry holds no integer; taken as 0", name), place(line));
    }
    return value.value_or(0);
  }

  /// Four pairs of digits; blanks in front are zeros.
  void read_status(Entity& entity) {
    std::string digits(first_.columns.begin() + 64, first_.columns.begin() + 72);
    std::replace(digits.begin(), digits.end(), ' ', '0');
    if (digits.find_first_not_of("0123456789") != std::string::npos) {
      warnings_.add("the status of a directory entry holds other than digits; taken as 00000000", place(first_));
      digits.assign(8, '0');
    }
    const auto pair = [&](std::size_t i) { return 10 * (digits[2 * i] - '0') + (digits[2 * i + 1] - '0'); };
    entity.blank = pair(0);
    entity.subordinate = pair(1);
    entity.use = pair(2);
    entity.hierarchy = pair(3);
  }

  const DirectoryLine& first_;
  const DirectoryLine& second_;
  Warnings& warnings_;
  std::string complaint_;
};

/// The number of an entry as its lines have it; 0 if they do not agree on one.
int written_number(const DirectoryLine& first, const DirectoryLine& second) {
  if (first.sequence % 2 == 1 && (second.sequence == first.sequence + 1 || second.sequence == 0)) return first.sequence;
  if (first.sequence == 0 && second.sequence > 0 && second.sequence % 2 == 0) return second.sequence - 1;
  return 0;
}

void sort_by_number(Directory& directory) {
  std::vector<std::size_t> order(directory.entities.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto number = [&](std::size_t i) { return directory.entities[i].sequence; };
  if (std::is_sorted(order.begin(), order.end(), [&](auto a, auto b) { return number(a) < number(b); })) return;
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return number(a) < number(b); });
  Directory sorted;
  for (const std::size_t i : order) {
    sorted.entities.push_back(std::move(directory.entities[i]));
    sorted.places.push_back(directory.places[i]);
  }
  directory = std::move(sorted);
}

}  // namespace

Directory read_directory(const std::vector<DirectoryLine>& lines, Warnings& warnings) {
  if (lines.size() % 2 != 0) {
    throw InputError(fmt::format("the directory section has {} lines, expected two for each entity", lines.size()));
  }
  Directory directory;
  directory.entities.reserve(lines.size() / 2);
  directory.places.reserve(lines.size() / 2);
  int previous = -1;
  for (std::size_t i = 0; i < lines.size(); i += 2) {
    auto [entity, place] = EntryReader(lines[i], lines[i + 1], warnings).read();
    entity.sequence = written_number(lines[i], lines[i + 1]);
    const std::string where = fmt::format("line {}", lines[i].file_line);
    if (entity.sequence == 0) {
      entity.sequence = previous + 2;
      warnings.add("a directory entry has no proper number; it was taken for the next one", where);
    } else if (entity.sequence != previous + 2) {
      warnings.add("the numbers of the directory entries do not follow each other; they were taken as written", where);
    }
    previous = entity.sequence;
    directory.entities.push_back(std::move(entity));
    directory.places.push_back(place);
  }
  sort_by_number(directory);
  const auto twin = std::adjacent_find(directory.entities.begin(), directory.entities.end(),
                                       [](const Entity& a, const Entity& b) { return a.sequence == b.sequence; });
  if (twin != directory.entities.end()) {
    throw InputError(fmt::format("two directory entries have the number D{}", twin->sequence));
  }
  return directory;
}

namespace {

/// Lines [first, last) of the P section.
struct LineRange {
  std::size_t first = 0;
  std::size_t last = 0;

  bool empty() const { return first == last; }
};

/// Which lines of the P section belong to which entity.
///
/// Directory entries point to the first line and tell their number, lines point back to their entity; either may be
/// wrong. Back pointers are believed first, as no two entities can claim the same line by them. A run of lines also
/// ends where another record begins: in some files all back pointers are the same.
class RecordFinder {
 public:
  RecordFinder(const Directory& directory, ParameterText& parameters, Warnings& warnings)
      : lines_(parameters.lines), warnings_(warnings) {
    numbered_ = number_lines();
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      if (i == 0 || lines_[i].back_pointer != lines_[i - 1].back_pointer) runs_.push_back(i);
    }
    std::stable_sort(runs_.begin(), runs_.end(),
                     [&](auto a, auto b) { return lines_[a].back_pointer < lines_[b].back_pointer; });
    is_start_.assign(lines_.size(), false);
    claimed_.assign(lines_.size(), false);
    for (std::size_t i = 0; i < directory.entities.size(); ++i) {
      const std::size_t first = index_of(directory.places[i].first_line);
      const int sequence = directory.entities[i].sequence;
      if (first < lines_.size() && (lines_[first].back_pointer == sequence || run_of(sequence) == lines_.size())) {
        is_start_[first] = true;
      }
    }
  }

  /// The lines whose back pointers name the entity.
  LineRange by_back_pointer(const Entity& entity, const RecordPlace& place) {
    const std::size_t first = index_of(place.first_line);
    const bool agrees = first < lines_.size() && lines_[first].back_pointer == entity.sequence;
    const std::size_t begin = agrees ? first : run_of(entity.sequence);
    if (begin >= lines_.size() || (!agrees && is_start_[begin])) return {};
    if (!agrees) {
      warnings_.add("the pointer to the parameters is wrong; the lines that point back to the entity were taken",
                    entity_text(entity));
    }
    return claim(begin, [&](std::size_t i) { return lines_[i].back_pointer == entity.sequence; });
  }

  /// The lines that the directory entry points to, up to the next record, if nobody has claimed them.
  LineRange by_directory(const Entity& entity, const RecordPlace& place) {
    const std::size_t first = index_of(place.first_line);
    if (first >= lines_.size() || claimed_[first]) return {};
    warnings_.add("the parameters do not point back to their entity", entity_text(entity));
    return claim(first, [](std::size_t) { return true; });
  }

 private:
  using Lines = std::vector<ParameterText::Line>;

  /// Whether the numbers of the lines rise; else the lines are counted.
  bool number_lines() {
    const auto falls = [](const auto& a, const auto& b) { return a.sequence >= b.sequence; };
    const bool rise = std::adjacent_find(lines_.begin(), lines_.end(), falls) == lines_.end();
    const bool usable = rise && !lines_.empty() && lines_.front().sequence > 0;
    const bool complete = usable && static_cast<std::size_t>(lines_.back().sequence) == lines_.size();
    if (!complete && !lines_.empty()) {
      warnings_.add(usable ? "numbers of lines are left out; they were taken as written"
                           : "the numbers of the lines do not rise; the lines were counted instead",
                    "parameter section");
    }
    return usable;
  }

  /// lines_.size() if there is no such line.
  std::size_t index_of(int number) const {
    if (number <= 0) return lines_.size();
    const auto guess = static_cast<std::size_t>(number) - 1;
    if (!numbered_ || (guess < lines_.size() && lines_[guess].sequence == number)) {
      return std::min(guess, lines_.size());
    }
    const auto found = std::lower_bound(lines_.begin(), lines_.end(), number,
                                        [](const auto& line, int value) { return line.sequence < value; });
    return found != lines_.end() && found->sequence == number ? static_cast<std::size_t>(found - lines_.begin())
                                                              : lines_.size();
  }

  /// The first line that points back to the entity; lines_.size() if none does.
  std::size_t run_of(int sequence) const {
    const auto found = std::lower_bound(runs_.begin(), runs_.end(), sequence,
                                        [&](std::size_t i, int value) { return lines_[i].back_pointer < value; });
    return found != runs_.end() && lines_[*found].back_pointer == sequence ? *found : lines_.size();
  }

  template <class Belongs>
  LineRange claim(std::size_t first, Belongs belongs) {
    std::size_t last = first;
    do {
      claimed_[last++] = true;
    } while (last < lines_.size() && !claimed_[last] && !is_start_[last] && belongs(last));
    return {first, last};
  }

  const Lines& lines_;
  Warnings& warnings_;
  bool numbered_ = true;
  /// The first line of each run of equal back pointers, sorted by these.
  std::vector<std::size_t> runs_;
  /// Lines at which directory entries whose pointers can be believed begin.
  std::vector<bool> is_start_;
  std::vector<bool> claimed_;
};

class ParameterAssigner {
 public:
  ParameterAssigner(Directory& directory, ParameterText& parameters, const Delimiters& delimiters, Warnings& warnings)
      : directory_(directory), parameters_(parameters), delimiters_(delimiters), warnings_(warnings) {}

  void assign() {
    RecordFinder finder(directory_, parameters_, warnings_);
    std::vector<LineRange> ranges(directory_.entities.size());
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      ranges[i] = finder.by_back_pointer(directory_.entities[i], directory_.places[i]);
    }
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      if (ranges[i].empty()) ranges[i] = finder.by_directory(directory_.entities[i], directory_.places[i]);
    }
    const std::string& text = parameters_.text;
    parameters_.tokens.reserve(static_cast<std::size_t>(std::count(text.begin(), text.end(), delimiters_.parameter)) +
                               ranges.size());
    std::vector<std::size_t> ends(ranges.size());
    std::vector<std::size_t> begins(ranges.size());
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      begins[i] = parameters_.tokens.size();
      scan(directory_.entities[i], ranges[i], directory_.places[i]);
      ends[i] = parameters_.tokens.size();
    }
    // Only now do the tokens stay where they are.
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      directory_.entities[i].tokens = std::span(parameters_.tokens).subspan(begins[i], ends[i] - begins[i]);
      take_type(directory_.entities[i]);
    }
  }

 private:
  std::size_t offset_of(std::size_t line) const {
    return line < parameters_.lines.size() ? parameters_.lines[line].offset : parameters_.text.size();
  }

  void scan(Entity& entity, const LineRange& range, const RecordPlace& place) {
    if (range.empty()) {
      complain(entity,
               fmt::format("its parameters are not where its directory entry points (line P{})", place.first_line));
      return;
    }
    entity.first_line = parameters_.lines[range.first].sequence;
    const std::string_view text = std::string_view(parameters_.text).substr(0, offset_of(range.last));
    const RecordEnd end = scan_record(text, offset_of(range.first), delimiters_, parameters_.tokens);
    const std::string where = entity_text(entity);
    if (end.delimiter_missing) {
      warnings_.add(fmt::format("the record delimiter '{}' behind the parameters is missing", delimiters_.record),
                    where);
    }
    if (end.wrong_counts > 0) {
      warnings_.add("the count of characters before an H is wrong; the string was ended at a delimiter", where);
    }
    if (static_cast<std::size_t>(std::max(place.line_count, 0)) != range.last - range.first) {
      warnings_.add("the directory entry has another number of parameter lines than there are", where);
    }
  }

  /// The first value repeats the type.
  static void take_type(Entity& entity) {
    if (entity.tokens.empty()) return;
    const std::string_view token = entity.tokens.front();
    if (parse_integer(token) != entity.type) {
      complain(entity, fmt::format("its parameters begin with '{}', expected its type number {}",
                                   to_utf8(token.substr(0, 40)), entity.type));
    }
    entity.tokens = entity.tokens.subspan(1);
  }

  static void complain(Entity& entity, const std::string& complaint) {
    // A null entity needs no parameters.
    if (entity.complaint.empty() && entity.type != 0) entity.complaint = complaint;
  }

  Directory& directory_;
  ParameterText& parameters_;
  Delimiters delimiters_;
  Warnings& warnings_;
};

}  // namespace

void assign_parameters(Directory& directory, ParameterText& parameters, const Delimiters& delimiters,
                       Warnings& warnings) {
  ParameterAssigner(directory, parameters, delimiters, warnings).assign();
}

}  // namespace isorim::io::iges
