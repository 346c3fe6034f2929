#include "io/case/reference.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <vector>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/case/case_file.h"

namespace isorim::io {
namespace {

/// Every table that `root` can hold, itself first, each before what it holds.
std::vector<const Description*> all_descriptions(const Description& root) {
  std::vector<const Description*> found{&root};
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (const KeyDescription& key : found[i]->keys) {
      for (const Description* nested : key.nested ? key.nested() : std::vector<const Description*>{}) {
        if (std::find(found.begin(), found.end(), nested) == found.end()) found.push_back(nested);
      }
    }
  }
  return found;
}

/// The same declarations stand in several tables (a circle as a curve, as a loop): once is enough.
std::vector<const Description*> distinct_descriptions(const Description& root = schema<CaseKeys>().description()) {
  std::vector<const Description*> distinct;
  for (const Description* description : all_descriptions(root)) {
    const bool known = std::any_of(distinct.begin(), distinct.end(), [&](const Description* other) {
      return other->name == description->name && other->text == description->text;
    });
    if (!known) distinct.push_back(description);
  }
  return distinct;
}

std::string key_facts(const KeyDescription& key) {
  std::vector<std::string> facts{key.choices.empty() ? key.type
                                                     : fmt::format("\"{}\"", fmt::join(key.choices, "\" | \""))};
  if (!key.range_text.empty()) facts.push_back(key.range_text);
  if (!key.unit.empty()) facts.push_back(key.unit);
  if (key.presence == Presence::required) {
    facts.emplace_back("required");
  } else if (!key.default_text.empty()) {
    facts.push_back("default " + key.default_text);
  }
  return fmt::format("{}", fmt::join(facts, ", "));
}

/// Breaks a text into lines of at most `width` characters, each after the first begun with `indent` spaces.
std::string wrapped(const std::string& text, std::size_t width, std::size_t indent) {
  std::string result;
  std::size_t column = 0;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::size_t length = end - begin;
    if (column > 0 && column + 1 + length > width) {
      result += '\n';
      result.append(indent, ' ');
      column = 0;
    } else if (column > 0) {
      result += ' ';
      ++column;
    }
    result += text.substr(begin, length);
    column += length;
    begin = end + 1;
  }
  return result;
}

std::string topic_text(const Description& description) {
  std::string text = fmt::format("{}\n  {}\n", description.name, wrapped(description.text, 96, 2));
  for (const KeyDescription& key : description.keys) {
    text += fmt::format("\n  {:<18} {}\n{:21}{}\n", key.name, wrapped(key_facts(key), 78, 21), "",
                        wrapped(key.text, 78, 21));
  }
  return text;
}

/// A bar would end the cell.
std::string markdown_cell(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '|') result += '\\';
    result += c;
  }
  return result;
}

std::string markdown_table(const Description& description) {
  std::string text = fmt::format("\n## {}\n\n{}\n", description.name, description.text);
  if (description.keys.empty()) return text;
  text += "\n| key | value | meaning |\n| --- | --- | --- |\n";
  for (const KeyDescription& key : description.keys) {
    text += fmt::format("| `{}` | {} | {} |\n", key.name, markdown_cell(key_facts(key)), markdown_cell(key.text));
  }
  return text;
}

}  // namespace

std::string case_overview() {
  const Description& root = schema<CaseKeys>().description();
  std::string text = "A case file is TOML. Its keys and sections (isorim help case SECTION tells the keys of one):\n\n";
  for (const KeyDescription& key : root.keys) {
    text += fmt::format("  {:<18} {}\n", key.name, wrapped(key.text, 92, 21));
  }
  text += "\nThe types of [geometry] (isorim help case TYPE tells the keys of one):\n\n";
  const std::vector<std::string>& types = type_tags<GeometryKeys>().names;
  const std::vector<const Description*> shapes = KeyType<GeometryKeys>::nested();
  for (std::size_t i = 0; i < types.size(); ++i) {
    text += fmt::format("  {:<18} {}\n", types[i], wrapped(shapes[i]->text, 92, 21));
  }
  return text;
}

std::vector<const Description*> case_tables(const std::string& name) {
  std::vector<const Description*> all = distinct_descriptions();
  if (name.empty()) return all;
  if (name == "geometry") return KeyType<GeometryKeys>::nested();
  std::vector<const Description*> found;
  std::ranges::copy_if(all, std::back_inserter(found), [&](const Description* table) { return table->name == name; });
  if (!found.empty()) return found;
  std::vector<std::string> names;
  for (const Description* description : all) names.push_back(description->name);
  throw InputError(fmt::format("help case: found \"{}\"{}; expected a section or type: {}", name,
                               did_you_mean(name, names), fmt::join(names, ", ")));
}

std::string case_topic(const std::string& name) {
  if (name == "geometry") return case_overview();
  std::string text;
  for (const Description* description : case_tables(name))
    text += (text.empty() ? "" : "\n") + topic_text(*description);
  return text;
}

std::vector<std::string> case_topics() {
  std::vector<std::string> names;
  for (const Description* description : distinct_descriptions()) {
    if (std::find(names.begin(), names.end(), description->name) == names.end()) names.push_back(description->name);
  }
  return names;
}

std::string case_reference_markdown() {
  std::string text =
      "# Case files\n\nA case file is TOML. Unknown keys are errors. Where a real is asked an integer will do; numbers "
      "must be finite.\nThe type of a shape is told by its key `type`. Points have two coordinates in the plane and "
      "three in space.\n";
  return text + reference_markdown(schema<CaseKeys>().description());
}

std::vector<const Description*> described_tables(const Description& root) {
  return distinct_descriptions(root);
}

std::string reference_text(const Description& root) {
  std::string text;
  for (const Description* description : distinct_descriptions(root)) {
    text += (text.empty() ? "" : "\n") + topic_text(*description);
  }
  return text;
}

std::string reference_markdown(const Description& root) {
  std::string text;
  for (const Description* description : distinct_descriptions(root)) text += markdown_table(*description);
  return text;
}

}  // namespace isorim::io
