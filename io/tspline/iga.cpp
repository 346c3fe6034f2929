#include "io/tspline/iga.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/spline/knot_vector.h"
#include "io/file_bytes.h"
#include "io/tspline/words.h"

namespace isorim::io::tspline {

using geometry::ExtractionElement;
using geometry::KnotVector;
using geometry::Point3;

namespace {

constexpr std::array<std::string_view, 7> keywords{"type", "nodeN", "elemN", "node", "belem", "set", "domain"};
/// Functions and elements are counted by std::int32_t.
constexpr long most_items = 1L << 30;

bool is_keyword(std::string_view word) {
  return std::ranges::find(keywords, word) != keywords.end();
}

class IgaReader {
 public:
  explicit IgaReader(std::string_view text) : text_(text), words_(text, '#') {}

  ExtractionData run() {
    while (!words_.at_end()) read_line();
    if (!has_type_) data_.warnings.emplace_back("no line \"type\": taken as a surface");
    require_count("nodeN", node_count_, nodes_.size() / 4);
    require_count("elemN", element_count_, data_.elements.size());
    require_known_functions();
    require_known_set_items();
    data_.points = Eigen::Map<const geometry::HomogeneousPoints<3>>(nodes_.data(), 4,
                                                                    static_cast<Eigen::Index>(nodes_.size() / 4));
    read_additions();
    data_.entities = {{"node", "control point", static_cast<int>(data_.points.cols()), 0},
                      {"belem", "Bézier element", static_cast<int>(data_.elements.size()), 0}};
    report_sets();
    return std::move(data_);
  }

 private:
  void read_line() {
    const int line = words_.line();
    const std::string_view keyword = words_.word("a keyword");
    if (keyword == "type") return read_type(line);
    if (keyword == "nodeN") return read_count(node_count_, line, "nodeN");
    if (keyword == "elemN") return read_count(element_count_, line, "elemN");
    if (keyword == "node") return read_node(line);
    if (keyword == "belem") return read_element(line);
    if (keyword == "set") return read_set(line);
    if (keyword == "domain") return skip_domain();
    words_.refuse(line,
                  fmt::format("found \"{}\"; expected one of {}", keyword.substr(0, 40), fmt::join(keywords, ", ")));
  }

  void read_type(int line) {
    const std::string_view type = words_.word("the type of the file");
    if (type == "volume" || type == "thickened_surface")
      words_.refuse(line, fmt::format("the file's type is {}, whose elements have a volume; expected the boundary of a "
                                      "solid: surface, or plane",
                                      type));
    if (type != "surface" && type != "plane")
      words_.refuse(line, fmt::format("found the type \"{}\"; expected surface or plane", type.substr(0, 40)));
    has_type_ = true;
  }

  void read_count(std::optional<long>& count, int line, std::string_view name) {
    if (count) words_.refuse(line, fmt::format("found a second {}", name));
    count = words_.integer("a count", 1, most_items);
  }

  void read_node(int line) {
    Point3 point;
    for (int d = 0; d < 3; ++d) point[d] = words_.real("a coordinate");
    const double weight = words_.real("a weight");
    if (!(weight > 0.0))
      words_.refuse(line,
                    fmt::format("the weight of node {} is {}; expected a positive number", node_number(), weight));
    for (const double x : point) nodes_.push_back(weight * x);
    nodes_.push_back(weight);
  }
  std::size_t node_number() const { return nodes_.size() / 4; }

  void read_element(int line) {
    ExtractionElement element;
    const std::size_t count = words_.count("the number of functions of an element", 1);
    std::size_t coefficients = 1;
    for (std::int8_t& degree : element.degree) {
      degree = static_cast<std::int8_t>(words_.integer("a degree", 1, KnotVector::max_degree));
      coefficients *= static_cast<std::size_t>(degree) + 1;
    }
    const std::size_t numbers = count * (1 + coefficients);
    if (numbers > (words_.remaining() + 1) / 2)
      words_.refuse(line, fmt::format("element {}: {} functions of {} coefficients; the file is too short for them",
                                      data_.elements.size(), count, coefficients));
    for (std::size_t k = 0; k < count; ++k)
      element.functions.push_back(static_cast<std::int32_t>(words_.integer("the node of a function", 0, most_items)));
    element.rows.resize(static_cast<Eigen::Index>(count), static_cast<Eigen::Index>(coefficients));
    for (Eigen::Index k = 0; k < element.rows.rows(); ++k) read_row(element, k);
    data_.elements.push_back(std::move(element));
    element_lines_.push_back(line);
  }

  void read_row(ExtractionElement& element, Eigen::Index k) {
    for (Eigen::Index j = 0; j < element.rows.cols(); ++j) {
      if (is_keyword(words_.peek()))
        words_.refuse(words_.line(), fmt::format("row {} of element {} has {} coefficients; expected {}", k,
                                                 data_.elements.size(), j, element.rows.cols()));
      element.rows(k, j) = words_.real("a coefficient");
    }
  }

  /// "set c node NAME id...", "set c elem NAME id...", "set c side NAME (elem SIDE)...".
  void read_set(int line) {
    const auto count = static_cast<std::size_t>(words_.integer("the number of items of a set", 0, most_items));
    const std::string_view kind = words_.word("the kind of a set");
    if (kind != "node" && kind != "elem" && kind != "side")
      words_.refuse(line, fmt::format("found a set of \"{}\"; expected node, elem or side", kind.substr(0, 40)));
    sets_.push_back(fmt::format("{} ({} {})", words_.word("the name of a set").substr(0, 40), count, kind));
    for (std::size_t i = 0; i < count; ++i) {
      const long item = words_.integer("an item of a set", 0, most_items);
      long& highest = kind == "node" ? highest_set_node_ : highest_set_element_;
      if (item > highest) {
        highest = item;
        (kind == "node" ? set_node_line_ : set_element_line_) = line;
      }
      if (kind == "side") read_side();
    }
  }

  /// Boundary conditions speak of patches and places, so nothing asks for them.
  void report_sets() {
    if (sets_.empty()) return;
    const int count = static_cast<int>(sets_.size());
    data_.entities.push_back({"set", "set of nodes, elements or sides", count, count});
    constexpr std::size_t most = 10;
    const auto last = sets_.begin() + static_cast<std::ptrdiff_t>(std::min(most, sets_.size()));
    data_.warnings.push_back(fmt::format("{} not used: {}{}", count == 1 ? "a set is" : "sets are",
                                         fmt::join(sets_.begin(), last, ", "),
                                         sets_.size() > most ? fmt::format(", ... ({} in all)", count) : ""));
  }

  void read_side() {
    const int line = words_.line();
    const std::string_view side = words_.word("LEFT, RIGHT, BOTTOM or TOP");
    if (side != "LEFT" && side != "RIGHT" && side != "BOTTOM" && side != "TOP")
      words_.refuse(line,
                    fmt::format("found the side \"{}\"; expected LEFT, RIGHT, BOTTOM or TOP", side.substr(0, 40)));
  }

  void skip_domain() {
    while (!words_.at_end() && !is_keyword(words_.peek())) words_.word("");
  }

  void require_count(std::string_view name, const std::optional<long>& announced, std::size_t found) const {
    const std::string_view item = name == "nodeN" ? "node" : "belem";
    if (found == 0) words_.refuse(words_.line(), fmt::format("the file ends without a {}", item));
    if (announced && static_cast<std::size_t>(*announced) != found)
      words_.refuse(words_.line(),
                    fmt::format("found {} lines \"{}\" in the file; {} announces {}", found, item, name, *announced));
  }

  void require_known_functions() const {
    const auto count = static_cast<std::int32_t>(nodes_.size() / 4);
    for (std::size_t e = 0; e < data_.elements.size(); ++e) {
      const std::int32_t highest = std::ranges::max(data_.elements[e].functions);
      if (highest >= count)
        words_.refuse(element_lines_[e],
                      fmt::format("element {}: node {} does not exist; expected 0 to {}", e, highest, count - 1));
    }
  }

  void require_known_set_items() const {
    const auto nodes = static_cast<long>(nodes_.size() / 4);
    const auto elements = static_cast<long>(data_.elements.size());
    if (highest_set_node_ >= nodes)
      words_.refuse(set_node_line_,
                    fmt::format("node {} of a set does not exist; expected 0 to {}", highest_set_node_, nodes - 1));
    if (highest_set_element_ >= elements)
      words_.refuse(set_element_line_, fmt::format("element {} of a set does not exist; expected 0 to {}",
                                                   highest_set_element_, elements - 1));
  }

  /// The lines that begin with "#isorim", once nodes and elements are known.
  void read_additions() {
    constexpr std::string_view mark = "#isorim ";
    int line = 1;
    for (std::size_t at = 0; at < text_.size(); ++line) {
      const std::size_t end = std::min(text_.find('\n', at), text_.size());
      const std::string_view content = text_.substr(at, end - at);
      if (content.starts_with(mark)) read_addition(content.substr(mark.size()), line);
      at = end + 1;
    }
  }

  void read_addition(std::string_view content, int line) {
    try {
      Words words(content);
      const std::string_view kind = words.word("cell or point");
      if (kind == "cell") {
        const long element = words.integer("an element", 0, static_cast<long>(data_.elements.size()) - 1);
        for (geometry::Interval& side : data_.elements[static_cast<std::size_t>(element)].domain)
          for (double* end : {&side.first, &side.last}) *end = words.real("an end of the element's domain");
      } else if (kind == "point") {
        read_exact_point(words, line);
      } else {
        throw InputError(fmt::format("found \"{}\"; expected cell or point", kind.substr(0, 40)));
      }
    } catch (const InputError& error) {
      words_.refuse(line, fmt::format("in what isorim added, {}", error.what()));
    }
  }

  /// Of nodes that were edited since the addition no longer holds.
  void read_exact_point(Words& words, int line) {
    constexpr double rounding = 4.0 * std::numeric_limits<double>::epsilon();
    auto point = data_.points.col(words.integer("a node", 0, data_.points.cols() - 1));
    Point3 exact;
    for (double& x : exact) x = words.real("a coordinate times the weight");
    if (((exact - point.head<3>()).array().abs() <= rounding * exact.array().abs()).all())
      point.head<3>() = exact;
    else
      data_.warnings.push_back(fmt::format("line {}: the node has been moved since; its line \"node\" counts", line));
  }

  std::string_view text_;
  Words words_;
  ExtractionData data_;
  /// Homogeneous.
  std::vector<double> nodes_;
  std::vector<int> element_lines_;
  bool has_type_ = false;
  std::optional<long> node_count_;
  std::optional<long> element_count_;
  /// Names, and how many of what they hold.
  std::vector<std::string> sets_;
  long highest_set_node_ = -1;
  long highest_set_element_ = -1;
  int set_node_line_ = 0;
  int set_element_line_ = 0;
};

}  // namespace

ExtractionData parse_iga(std::string_view text) {
  return IgaReader(text).run();
}

CadModel read_iga(const std::filesystem::path& path) {
  const std::string text = read_bytes(path);
  try {
    return model_of(parse_iga(text), "Bézier extraction (.iga)");
  } catch (Error& error) {
    error.add_context(path.string());
    throw;
  }
}

}  // namespace isorim::io::tspline
