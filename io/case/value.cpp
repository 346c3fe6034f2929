#include "io/case/value.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/case/value_edit.h"
#include "io/excerpt.h"

namespace isorim::io {

std::string Place::describe() const {
  if (!source) return "";
  return line > 0 ? fmt::format("{}:{}", *source, line) : *source;
}

const Value* Value::find(std::string_view key) const {
  const auto* table = as<Table>();
  if (!table) return nullptr;
  const auto entry = std::find_if(table->begin(), table->end(), [&](const TableEntry& e) { return e.key == key; });
  return entry == table->end() ? nullptr : &entry->value;
}

namespace {

struct Describer {
  std::string operator()(bool value) const { return fmt::format("the boolean {}", value); }
  std::string operator()(std::int64_t value) const { return fmt::format("the integer {}", value); }
  std::string operator()(double value) const { return fmt::format("the real {}", value); }
  std::string operator()(const std::string& value) const { return fmt::format("the text \"{}\"", excerpt(value)); }
  std::string operator()(const DateOrTime& value) const { return fmt::format("the date or time {}", value.text); }
  std::string operator()(const Value::Array& value) const { return fmt::format("a list of {}", value.size()); }
  std::string operator()(const Value::Table&) const { return "a table"; }
};

std::vector<std::string> split_path(std::string_view path) {
  std::vector<std::string> parts(1);
  for (const char c : path) {
    if (c == '.') {
      parts.emplace_back();
    } else {
      parts.back().push_back(c);
    }
  }
  return parts;
}

std::string trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return "";
  return std::string(text.substr(first, text.find_last_not_of(" \t") - first + 1));
}

Value& table_entry(Value& table, const std::string& key, const Place& place) {
  auto& entries = std::get<Value::Table>(table.data);
  const auto found = std::find_if(entries.begin(), entries.end(), [&](const TableEntry& e) { return e.key == key; });
  if (found != entries.end()) return found->value;
  entries.push_back({key, Value{Value::Table{}, place}});
  return entries.back().value;
}

Value& list_entry(Value& list, const std::string& part, const std::string& option) {
  auto& values = std::get<Value::Array>(list.data);
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), index);
  if (error != std::errc{} || end != part.data() + part.size() || index >= values.size()) {
    throw InputError(fmt::format("{}: \"{}\" should be an index from 0 to {} into a list of {}", option, part,
                                 values.empty() ? 0 : values.size() - 1, values.size()));
  }
  return values[index];
}

void relocate(Value& value, const Place& place) {
  value.place = place;
  if (auto* list = std::get_if<Value::Array>(&value.data)) {
    for (Value& item : *list) relocate(item, place);
  } else if (auto* table = std::get_if<Value::Table>(&value.data)) {
    for (TableEntry& entry : *table) relocate(entry.value, place);
  }
}

bool is_bare_key(std::string_view key) {
  return !key.empty() && std::all_of(key.begin(), key.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

std::string toml_text(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      result += {'\\', c};
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      result += fmt::format("\\u{:04X}", static_cast<unsigned char>(c));
    } else {
      result += c;
    }
  }
  return result + '"';
}

std::string toml_key(std::string_view key) {
  return is_bare_key(key) ? std::string(key) : toml_text(key);
}

std::string toml_real(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0.0 ? "inf" : "-inf";
  std::string text = fmt::format("{:.17g}", value);
  const std::string shortest = fmt::format("{}", value);
  if (shortest.size() < text.size()) text = shortest;
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

std::string inline_list(const Value::Array& list) {
  std::vector<std::string> items;
  std::transform(list.begin(), list.end(), std::back_inserter(items), inline_toml);
  return fmt::format("[{}]", fmt::join(items, ", "));
}

std::string inline_table(const Value::Table& table) {
  if (table.empty()) return "{}";
  std::vector<std::string> items;
  for (const TableEntry& entry : table) items.push_back(toml_key(entry.key) + " = " + inline_toml(entry.value));
  return fmt::format("{{ {} }}", fmt::join(items, ", "));
}

struct InlineWriter {
  std::string operator()(bool value) const { return value ? "true" : "false"; }
  std::string operator()(std::int64_t value) const { return fmt::format("{}", value); }
  std::string operator()(double value) const { return toml_real(value); }
  std::string operator()(const std::string& value) const { return toml_text(value); }
  std::string operator()(const DateOrTime& value) const { return value.text; }
  std::string operator()(const Value::Array& value) const { return inline_list(value); }
  std::string operator()(const Value::Table& value) const { return inline_table(value); }
};

bool is_list_of_tables(const Value& value) {
  const auto* list = value.as<Value::Array>();
  return list && !list->empty() &&
         std::all_of(list->begin(), list->end(), [](const Value& item) { return item.as<Value::Table>() != nullptr; });
}

/// The entries of a section, one a line; what lies deeper is written inline.
std::string section_body(const Value::Table& table) {
  std::string text;
  for (const TableEntry& entry : table) {
    text += fmt::format("{} = {}\n", toml_key(entry.key), inline_toml(entry.value));
  }
  return text;
}

}  // namespace

std::string describe(const Value& value) {
  return std::visit(Describer{}, value.data);
}

std::string inline_toml(const Value& value) {
  return std::visit(InlineWriter{}, value.data);
}

Value value_from_text(std::string_view text, const Place& place) {
  const std::string content = trimmed(text);
  Value result{content, place};
  try {
    const Value parsed = parse_toml("value = " + content, "");
    if (const Value* value = parsed.find("value"); value && parsed.as<Value::Table>()->size() == 1) result = *value;
  } catch (const InputError&) {
    // Not TOML: plain text, as a shell user writes it.
  }
  relocate(result, place);
  return result;
}

void set_value(Value& root, std::string_view path, Value value, const std::string& what) {
  const std::vector<std::string> parts = split_path(trimmed(path));
  Value* target = &root;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].empty()) throw InputError(what + ": the path has an empty part; expected section.key");
    if (target->as<Value::Array>()) {
      target = &list_entry(*target, parts[i], what);
    } else if (target->as<Value::Table>()) {
      target = &table_entry(*target, parts[i], value.place);
    } else {
      throw InputError(fmt::format("{}: \"{}\" is {}, so \"{}\" has no place in it", what, parts[i - 1],
                                   describe(*target), parts[i]));
    }
  }
  *target = std::move(value);
}

void apply_override(Value& root, const std::string& assignment) {
  const auto equals = assignment.find('=');
  const std::string option = "--set " + assignment;
  if (equals == std::string::npos) throw InputError(option + ": found no '='; expected key=value");
  const Place place{std::make_shared<const std::string>(option)};
  set_value(root, assignment.substr(0, equals), value_from_text(assignment.substr(equals + 1), place), option);
}

std::string to_toml(const Value& root) {
  std::string plain;
  std::string sections;
  for (const TableEntry& entry : std::get<Value::Table>(root.data)) {
    if (const auto* table = entry.value.as<Value::Table>()) {
      sections += fmt::format("\n[{}]\n{}", toml_key(entry.key), section_body(*table));
    } else if (is_list_of_tables(entry.value)) {
      for (const Value& item : *entry.value.as<Value::Array>()) {
        sections += fmt::format("\n[[{}]]\n{}", toml_key(entry.key), section_body(*item.as<Value::Table>()));
      }
    } else {
      plain += fmt::format("{} = {}\n", toml_key(entry.key), inline_toml(entry.value));
    }
  }
  return plain + sections;
}

}  // namespace isorim::io
