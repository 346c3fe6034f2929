#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace isorim::io::svg {

/// An element as it stands in the text: its name, its attributes, and the text up to the next tag.
struct XmlElement {
  std::string name;
  std::vector<std::pair<std::string, std::string>> attributes;
  std::string text;

  /// Empty if there is none of that name.
  std::string attribute(std::string_view attribute_name) const;
  double number(std::string_view attribute_name) const { return std::stod(attribute(attribute_name)); }
};

/// The elements in the order of their opening tags. Throws std::runtime_error if the text is not well-formed: tags
/// that do not match, an attribute unquoted or given twice, a bare '<' or '&', anything after the root.
std::vector<XmlElement> parse_xml(std::string_view text);

/// Those whose class is `value`.
std::vector<XmlElement> with_class(const std::vector<XmlElement>& elements, std::string_view value);
/// Those inside the first element of that class (here: up to the next element that has a class).
std::vector<XmlElement> inside_class(const std::vector<XmlElement>& elements, std::string_view value);

}  // namespace isorim::io::svg
