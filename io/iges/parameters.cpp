#include "io/iges/parameters.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/iges/free_format.h"

namespace isorim::io::iges {
namespace {

/// The sequence number of the P line that the character at `offset` of the text stands in.
int line_of(const ParameterText& text, std::size_t offset) {
  const auto after = std::upper_bound(text.lines.begin(), text.lines.end(), offset,
                                      [](std::size_t value, const auto& line) { return value < line.offset; });
  return after == text.lines.begin() ? 0 : std::prev(after)->sequence;
}

std::string quoted(std::string_view token) {
  constexpr std::size_t longest = 40;
  return token.size() <= longest ? fmt::format("'{}'", to_utf8(token))
                                 : fmt::format("'{}...'", to_utf8(token.substr(0, longest)));
}

}  // namespace

Parameters::Parameters(const File& file, const Entity& entity) : file_(file), entity_(entity) {
  if (!entity.complaint.empty()) {
    throw InputError(fmt::format("{}: {}: {}", file.name, entity_text(entity), entity.complaint));
  }
}

void Parameters::refuse(const std::string& message, int parameter) const {
  const int number = parameter > 0 ? parameter : static_cast<int>(position_);
  std::string where;
  if (number > 0) where = fmt::format(", parameter {}", number);
  if (number > 0 && static_cast<std::size_t>(number) <= entity_.tokens.size()) {
    const auto& token = entity_.tokens[static_cast<std::size_t>(number) - 1];
    where +=
        fmt::format(" (line P{})",
                    line_of(*file_.parameters, static_cast<std::size_t>(token.data() - file_.parameters->text.data())));
  }
  throw InputError(fmt::format("{}: {}{}: {}", file_.name, entity_text(entity_), where, message));
}

bool Parameters::is_omitted() const {
  return position_ >= entity_.tokens.size() || entity_.tokens[position_].empty();
}

void Parameters::step_over() {
  if (position_ < entity_.tokens.size()) ++position_;
}

std::string_view Parameters::next() {
  if (position_ < entity_.tokens.size()) return entity_.tokens[position_++];
  refuse(fmt::format("the parameters end here ({} in all), expected more", entity_.tokens.size()),
         static_cast<int>(position_) + 1);
}

void Parameters::skip(int count) {
  for (int i = 0; i < count; ++i) next();
}

double Parameters::as_real(std::string_view token) {
  if (const auto value = parse_real(token)) return *value;
  refuse(fmt::format("found {}, expected a real number within +-1.8e308", quoted(token)));
}

int Parameters::as_integer(std::string_view token) {
  if (const auto value = parse_integer(token)) return *value;
  refuse(fmt::format("found {}, expected an integer", quoted(token)));
}

int Parameters::as_pointer(std::string_view token) {
  const auto value = parse_integer(token);
  if (!value) refuse(fmt::format("found {}, expected a pointer to a directory entry", quoted(token)));
  if (*value != 0 && file_.find(*value) == nullptr) {
    refuse(fmt::format("found the pointer {}, but there is no directory entry D{}", *value, *value));
  }
  return *value;
}

double Parameters::real() {
  const std::string_view token = next();
  return token.empty() ? 0.0 : as_real(token);
}

double Parameters::real(double fallback) {
  if (!is_omitted()) return as_real(next());
  step_over();
  return fallback;
}

int Parameters::integer() {
  const std::string_view token = next();
  return token.empty() ? 0 : as_integer(token);
}

int Parameters::integer(int fallback) {
  if (!is_omitted()) return as_integer(next());
  step_over();
  return fallback;
}

int Parameters::count(int values_each) {
  const int value = integer();
  if (value < 0) refuse(fmt::format("found the count {}, expected 0 or more", value));
  if (static_cast<long>(value) * values_each > remaining()) {
    refuse(fmt::format("{} times {} values are announced, but only {} follow", value, values_each, remaining()));
  }
  return value;
}

int Parameters::pointer() {
  const std::string_view token = next();
  return token.empty() ? 0 : as_pointer(token);
}

int Parameters::pointer(int fallback) {
  if (!is_omitted()) return as_pointer(next());
  step_over();
  return fallback;
}

const Entity& Parameters::target() {
  const int number = pointer();
  if (number == 0) refuse("no pointer is given, expected one to a directory entry");
  return *file_.find(number);
}

bool Parameters::logical() {
  const int value = integer();
  if (value != 0 && value != 1) refuse(fmt::format("found {}, expected 0 (false) or 1 (true)", value));
  return value == 1;
}

bool Parameters::logical(bool fallback) {
  if (!is_omitted()) return logical();
  step_over();
  return fallback;
}

std::string Parameters::text() {
  const std::string_view token = next();
  if (token.empty()) return {};
  if (auto value = parse_text(token)) return std::move(*value);
  refuse(fmt::format("found {}, expected a text such as 5HWhole", quoted(token)));
}

std::string Parameters::text(std::string fallback) {
  if (!is_omitted()) return text();
  step_over();
  return fallback;
}

void Parameters::reals(std::span<double> values) {
  for (double& value : values) value = real();
}

std::vector<double> Parameters::reals(int count) {
  if (count > remaining()) {
    refuse(fmt::format("{} values are expected from here, but only {} follow", count, remaining()), number());
  }
  std::vector<double> values(static_cast<std::size_t>(std::max(count, 0)));
  reals(values);
  return values;
}

std::vector<int> Parameters::pointers(int count) {
  if (count > remaining()) {
    refuse(fmt::format("{} pointers are expected from here, but only {} follow", count, remaining()), number());
  }
  std::vector<int> values(static_cast<std::size_t>(std::max(count, 0)));
  for (int& value : values) value = pointer();
  return values;
}

TrailingPointers Parameters::trailing_pointers() {
  TrailingPointers groups;
  try {
    if (remaining() > 0) groups.associativities = pointers(count());
    if (remaining() > 0) groups.properties = pointers(count());
    if (remaining() > 0) groups.complaint = fmt::format("{} parameters too many", remaining());
  } catch (const InputError& error) {
    groups = {{}, {}, error.what()};
  }
  position_ = entity_.tokens.size();
  return groups;
}

}  // namespace isorim::io::iges
