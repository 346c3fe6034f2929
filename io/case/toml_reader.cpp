#include <algorithm>
#include <sstream>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "geometry/errors.h"
#include "io/case/value.h"
#include "io/file_bytes.h"

namespace isorim::io {
namespace {

using Source = std::shared_ptr<const std::string>;

Place place_of(const toml::source_region& region, const Source& source) {
  return {source, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

bool written_before(const Place& a, const Place& b) {
  return a.line != b.line ? a.line < b.line : a.column < b.column;
}

Value convert(const toml::node& node, const Source& source);

Value::Table convert_table(const toml::table& table, const Source& source) {
  std::vector<std::pair<Place, TableEntry>> entries;
  for (const auto& [key, node] : table) {
    entries.push_back({place_of(key.source(), source), {std::string(key.str()), convert(node, source)}});
  }
  std::stable_sort(entries.begin(), entries.end(),
                   [](const auto& a, const auto& b) { return written_before(a.first, b.first); });
  Value::Table result;
  for (auto& entry : entries) result.push_back(std::move(entry.second));
  return result;
}

template <class T>
DateOrTime date_or_time(const toml::value<T>& value) {
  std::ostringstream text;
  text << value;
  return {text.str()};
}

Value convert(const toml::node& node, const Source& source) {
  Value result;
  result.place = place_of(node.source(), source);
  if (const auto* table = node.as_table()) {
    result.data = convert_table(*table, source);
  } else if (const auto* array = node.as_array()) {
    Value::Array items;
    for (const toml::node& item : *array) items.push_back(convert(item, source));
    result.data = std::move(items);
  } else if (const auto* text = node.as_string()) {
    result.data = text->get();
  } else if (const auto* integer = node.as_integer()) {
    result.data = std::int64_t{integer->get()};
  } else if (const auto* real = node.as_floating_point()) {
    result.data = real->get();
  } else if (const auto* boolean = node.as_boolean()) {
    result.data = boolean->get();
  } else if (const auto* date = node.as_date()) {
    result.data = date_or_time(*date);
  } else if (const auto* time = node.as_time()) {
    result.data = date_or_time(*time);
  } else if (const auto* date_time = node.as_date_time()) {
    result.data = date_or_time(*date_time);
  }
  return result;
}

}  // namespace

Value parse_toml(std::string_view text, const std::string& name) {
  const auto source = std::make_shared<const std::string>(name);
  try {
    Value root = convert(toml::parse(text, name), source);
    root.place = {source, 1, 1};
    return root;
  } catch (const toml::parse_error& error) {
    const toml::source_position where = error.source().begin;
    throw InputError(fmt::format("{}:{}:{}: not TOML: {}", name, where.line, where.column, error.description()));
  }
}

Value read_toml(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) throw InputError(fmt::format("{}: no such file", path.string()));
  if (std::filesystem::is_directory(path, error)) {
    throw InputError(fmt::format("{}: is a folder; expected a case file (.toml)", path.string()));
  }
  return parse_toml(read_bytes(path), path.string());
}

}  // namespace isorim::io
