#include "io/case/schema.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include <fmt/format.h>

namespace isorim::io {

bool Range::contains(double x) const {
  return (least_is_open ? x > least : x >= least) && (most_is_open ? x < most : x <= most);
}

std::string Range::describe() const {
  const bool below = std::isfinite(least);
  const bool above = std::isfinite(most);
  const std::string lower = fmt::format("{} {}", least_is_open ? ">" : ">=", least);
  const std::string upper = fmt::format("{} {}", most_is_open ? "<" : "<=", most);
  if (below && above) {
    if (!least_is_open && !most_is_open) return fmt::format("from {} to {}", least, most);
    return lower + " and " + upper;
  }
  if (below) return lower;
  return above ? upper : "";
}

void complain_type(Complaints& complaints, const KeyPlace& where, const Value& value, std::string_view expected) {
  const bool lacks_brackets = expected == "a list of tables" && value.as<Value::Table>();
  complaints.add(where, fmt::format("found {}; expected {}{}", describe(value), expected,
                                    lacks_brackets ? fmt::format(", [[{}]]", where.path) : ""));
}

namespace {

bool check_range(double x, const Range& range, const KeyPlace& where, Complaints& complaints) {
  if (range.contains(x)) return true;
  complaints.add(where, fmt::format("found {}; expected a number {}", x, range.describe()));
  return false;
}

std::string list_name(std::size_t count) {
  return count == 0 ? "a list of reals" : fmt::format("a list of {} reals", count);
}

}  // namespace

bool read_boolean(const Value& value, bool& target, const KeyPlace& where, Complaints& complaints) {
  if (const bool* found = value.as<bool>()) {
    target = *found;
    return true;
  }
  complain_type(complaints, where, value, "true or false");
  return false;
}

bool read_integer(const Value& value, int& target, const Range& range, const KeyPlace& where, Complaints& complaints) {
  const auto* found = value.as<std::int64_t>();
  if (!found) {
    complain_type(complaints, where, value, "an integer");
    return false;
  }
  if (!check_range(static_cast<double>(*found), range, where, complaints)) return false;
  if (*found < std::numeric_limits<int>::min() || *found > std::numeric_limits<int>::max()) {
    complain_type(complaints, where, value, "an integer of 32 bits");
    return false;
  }
  target = static_cast<int>(*found);
  return true;
}

bool read_real(const Value& value, double& target, const Range& range, const KeyPlace& where, Complaints& complaints) {
  if (const auto* integer = value.as<std::int64_t>()) {
    target = static_cast<double>(*integer);
  } else if (const auto* real = value.as<double>()) {
    target = *real;
  } else {
    complain_type(complaints, where, value, "a real");
    return false;
  }
  if (!std::isfinite(target)) {
    complain_type(complaints, where, value, "a finite real");
    return false;
  }
  return check_range(target, range, where, complaints);
}

bool read_text(const Value& value, std::string& target, const KeyPlace& where, Complaints& complaints) {
  if (const auto* text = value.as<std::string>()) {
    target = *text;
    return true;
  }
  complain_type(complaints, where, value, "a text in quotes");
  return false;
}

bool read_reals(const Value& value, std::vector<double>& target, std::size_t count, const Range& range,
                const KeyPlace& where, Complaints& complaints) {
  const auto* list = value.as<Value::Array>();
  if (!list || list->empty() || (count > 0 && list->size() != count)) {
    complain_type(complaints, where, value, list_name(count));
    return false;
  }
  bool good = true;
  target.assign(list->size(), 0.0);
  for (std::size_t i = 0; i < list->size(); ++i) {
    good &= read_real((*list)[i], target[i], range, where.item(i, (*list)[i].place), complaints);
  }
  return good;
}

bool read_integers(const Value& value, std::span<int> target, const Range& range, const KeyPlace& where,
                   Complaints& complaints) {
  const auto* list = value.as<Value::Array>();
  if (!list || list->size() != target.size()) {
    complain_type(complaints, where, value, fmt::format("a list of {} integers", target.size()));
    return false;
  }
  bool good = true;
  for (std::size_t i = 0; i < list->size(); ++i) {
    good &= read_integer((*list)[i], target[i], range, where.item(i, (*list)[i].place), complaints);
  }
  return good;
}

bool read_coordinates(const Value& value, Coordinates& target, const Range& range, const KeyPlace& where,
                      Complaints& complaints) {
  target.where = where;
  const auto* list = value.as<Value::Array>();
  if (!list || list->size() < 2 || list->size() > 4) {
    complain_type(complaints, where, value, "a list of coordinates");
    return false;
  }
  return read_reals(value, target.values, 0, range, where, complaints);
}

bool read_grid(const Value& value, PointGrid& target, const KeyPlace& where, Complaints& complaints) {
  target.where = where;
  const auto* list = value.as<Value::Array>();
  if (!list || list->empty()) {
    complain_type(complaints, where, value, "a list of points or of rows of points");
    return false;
  }
  const auto* first = list->front().as<Value::Array>();
  const bool rows = first && !first->empty() && first->front().as<Value::Array>();
  if (!rows) return KeyType<std::vector<Coordinates>>::read(value, target.points, {}, where, complaints);
  target.row_length = static_cast<int>(first->size());
  bool good = true;
  for (std::size_t i = 0; i < list->size(); ++i) {
    const KeyPlace row = where.item(i, (*list)[i].place);
    const auto* points = (*list)[i].as<Value::Array>();
    if (!points || points->size() != first->size()) {
      complain_type(complaints, row, (*list)[i], fmt::format("a row of {} points like the first", first->size()));
      good = false;
      continue;
    }
    good &= KeyType<std::vector<Coordinates>>::read((*list)[i], target.points, {}, row, complaints);
  }
  return good;
}

bool read_number_array(const Value& value, NumberArray& target, const KeyPlace& where, Complaints& complaints) {
  target.where = where;
  const auto* list = value.as<Value::Array>();
  if (!list) {
    target.values.resize(1);
    return read_real(value, target.values[0], {}, where, complaints);
  }
  if (list->empty()) {
    complain_type(complaints, where, value, "a real, a list of reals or a list of rows");
    return false;
  }
  if (!list->front().as<Value::Array>()) {
    target.rows = static_cast<int>(list->size());
    return read_reals(value, target.values, 0, {}, where, complaints);
  }
  bool good = true;
  const std::size_t columns = list->front().as<Value::Array>()->size();
  for (std::size_t i = 0; i < list->size(); ++i) {
    std::vector<double> row;
    good &= read_reals((*list)[i], row, columns, {}, where.item(i, (*list)[i].place), complaints);
    target.values.insert(target.values.end(), row.begin(), row.end());
  }
  target.rows = static_cast<int>(list->size());
  target.columns = static_cast<int>(columns);
  return good;
}

std::string print_real(double value) {
  std::string text = fmt::format("{}", value);
  return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

std::string print_reals(const double* values, std::size_t count) {
  std::vector<std::string> texts;
  std::transform(values, values + count, std::back_inserter(texts), print_real);
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

bool check_keys(const Value& table, const Description& description, std::string_view passed_over, const KeyPlace& where,
                Complaints& complaints) {
  std::vector<std::string> known;
  for (const KeyDescription& key : description.keys) known.push_back(key.name);
  bool good = true;
  for (const TableEntry& entry : *table.as<Value::Table>()) {
    if (entry.key == passed_over || std::find(known.begin(), known.end(), entry.key) != known.end()) continue;
    good = false;
    const KeyPlace place = where.key(entry.key, entry.value.place);
    if (std::find(description.later.begin(), description.later.end(), entry.key) != description.later.end()) {
      complaints.add(place, "not available in this version");
      continue;
    }
    const std::string guess = did_you_mean(entry.key, known);
    complaints.add(place, guess.empty() ? fmt::format("unknown key; expected one of {}", fmt::join(known, ", "))
                                        : "unknown key" + guess);
  }
  for (const KeyDescription& key : description.keys) {
    if (key.presence == Presence::optional || table.find(key.name)) continue;
    complaints.add(where, fmt::format("the key \"{}\" ({}) is missing", key.name, key.type));
    good = false;
  }
  return good;
}

bool read_choice(const Value& value, std::span<const std::string> choices, std::size_t& index, const KeyPlace& where,
                 Complaints& complaints) {
  const auto* text = value.as<std::string>();
  const auto found = text ? std::find(choices.begin(), choices.end(), *text) : choices.end();
  if (found != choices.end()) {
    index = static_cast<std::size_t>(found - choices.begin());
    return true;
  }
  complaints.add(where, fmt::format("found {}; expected one of \"{}\"{}", describe(value), fmt::join(choices, "\", \""),
                                    text ? did_you_mean(*text, choices) : ""));
  return false;
}

bool read_type(const Value& value, const TypeTags& tags, std::size_t& index, const KeyPlace& where,
               Complaints& complaints) {
  if (!value.as<Value::Table>()) {
    complain_type(complaints, where, value, "a table with the key \"type\"");
    return false;
  }
  const Value* type = value.find("type");
  if (!type && !tags.implying_key.empty() && value.find(tags.implying_key)) {
    index = static_cast<std::size_t>(std::find(tags.names.begin(), tags.names.end(), tags.implied_type) -
                                     tags.names.begin());
    return true;
  }
  if (!type) {
    complaints.add(where,
                   fmt::format("the key \"type\" is missing; expected one of \"{}\"", fmt::join(tags.names, "\", \"")));
    return false;
  }
  const KeyPlace type_place = where.key("type", type->place);
  const auto* text = type->as<std::string>();
  for (const auto& [alias, name] : tags.aliases) {
    if (!text || *text != alias) continue;
    index = static_cast<std::size_t>(std::find(tags.names.begin(), tags.names.end(), name) - tags.names.begin());
    return true;
  }
  if (text && std::find(tags.later.begin(), tags.later.end(), *text) != tags.later.end()) {
    complaints.add(type_place, fmt::format("the type \"{}\" is not available in this version; expected one of \"{}\"",
                                           *text, fmt::join(tags.names, "\", \"")));
    return false;
  }
  return read_choice(*type, tags.names, index, type_place, complaints);
}

}  // namespace isorim::io
