#include "tests/io/svg/xml_check.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <stdexcept>

#include <fmt/format.h>

namespace isorim::io::svg {

namespace {

class Parser {
 public:
  explicit Parser(std::string_view text) : text_(text) {}

  std::vector<XmlElement> run() {
    skip_space();
    element();
    skip_space();
    if (at_ != text_.size()) fail("text after the root");
    return std::move(elements_);
  }

 private:
  [[noreturn]] void fail(std::string_view what) const {
    throw std::runtime_error(fmt::format("{} at '{}'", what, text_.substr(at_, 40)));
  }
  bool is_next(std::string_view token) const { return text_.substr(at_, token.size()) == token; }
  void expect(std::string_view token) {
    if (!is_next(token)) fail(fmt::format("expected '{}'", token));
    at_ += token.size();
  }
  void skip_space() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
  }
  std::string name() {
    const std::size_t start = at_;
    while (at_ < text_.size() &&
           (std::isalnum(static_cast<unsigned char>(text_[at_])) != 0 || text_[at_] == '-' || text_[at_] == ':')) {
      ++at_;
    }
    if (start == at_) fail("expected a name");
    return std::string(text_.substr(start, at_ - start));
  }
  /// Up to the first character of `ends`, with the entities decoded.
  std::string characters(std::string_view ends) {
    static const std::vector<std::pair<std::string_view, char>> entities{
        {"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&#39;", '\''}};
    std::string result;
    while (at_ < text_.size() && ends.find(text_[at_]) == std::string_view::npos) {
      if (text_[at_] == '<') fail("bare '<'");
      if (text_[at_] != '&') {
        result += text_[at_++];
        continue;
      }
      const auto entity =
          std::find_if(entities.begin(), entities.end(), [&](const auto& e) { return is_next(e.first); });
      if (entity == entities.end()) fail("bare '&'");
      result += entity->second;
      at_ += entity->first.size();
    }
    if (at_ == text_.size()) fail("unexpected end");
    return result;
  }
  void attributes(XmlElement& element) {
    for (skip_space(); !is_next(">") && !is_next("/>"); skip_space()) {
      const std::string key = name();
      expect("=\"");
      if (!element.attribute(key).empty()) fail("an attribute twice");
      element.attributes.emplace_back(key, characters("\""));
      expect("\"");
    }
  }
  void element() {
    expect("<");
    const std::size_t index = elements_.size();
    elements_.emplace_back();
    elements_[index].name = name();
    attributes(elements_[index]);
    if (is_next("/>")) return expect("/>");
    expect(">");
    elements_[index].text = characters("<");
    while (!is_next("</")) {
      element();
      characters("<");
    }
    expect("</" + elements_[index].name + ">");
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::vector<XmlElement> elements_;
};

}  // namespace

std::string XmlElement::attribute(std::string_view attribute_name) const {
  for (const auto& [key, value] : attributes) {
    if (key == attribute_name) return value;
  }
  return "";
}

std::vector<XmlElement> parse_xml(std::string_view text) {
  return Parser(text).run();
}

std::vector<XmlElement> with_class(const std::vector<XmlElement>& elements, std::string_view value) {
  std::vector<XmlElement> result;
  std::copy_if(elements.begin(), elements.end(), std::back_inserter(result),
               [&](const XmlElement& element) { return element.attribute("class") == value; });
  return result;
}

std::vector<XmlElement> inside_class(const std::vector<XmlElement>& elements, std::string_view value) {
  const auto first = std::find_if(elements.begin(), elements.end(),
                                  [&](const XmlElement& element) { return element.attribute("class") == value; });
  if (first == elements.end()) return {};
  const auto last = std::find_if(std::next(first), elements.end(),
                                 [](const XmlElement& element) { return !element.attribute("class").empty(); });
  return {std::next(first), last};
}

}  // namespace isorim::io::svg
