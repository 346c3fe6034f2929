#include "io/tspline/be.h"

#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/spline/knot_vector.h"
#include "io/file_bytes.h"
#include "io/tspline/words.h"

namespace isorim::io::tspline {

using geometry::ExtractionElement;
using geometry::KnotVector;

namespace {

constexpr long highest_number = 1L << 30;

/// Whether elements have a line of four face nodes.
enum class FaceLines { absent, present };

/// Numbers of the file and the indices that they stand for.
using Numbers = std::unordered_map<long, std::int32_t>;

class BeReader {
 public:
  BeReader(std::string_view text, FaceLines faces) : words_(text), faces_(faces) {}

  ExtractionData run() {
    read_nodes();
    read_elements();
    read_collocation_points();
    data_.entities = {{"node", "control point", static_cast<int>(data_.points.cols()), 0},
                      {"element", "Bézier element", static_cast<int>(data_.elements.size()), 0}};
    report_what_is_not_used();
    return std::move(data_);
  }

  /// How far it came.
  int line() const { return words_.line(); }

 private:
  void read_nodes() {
    const std::size_t count = words_.count("the number of nodes", 5);
    data_.points.resize(4, static_cast<Eigen::Index>(count));
    for (Eigen::Index i = 0; i < data_.points.cols(); ++i) {
      const int line = words_.line();
      const long number = words_.integer("the number of a node", 0, highest_number);
      if (!nodes_.emplace(number, static_cast<std::int32_t>(i)).second)
        words_.refuse(line, fmt::format("node {} is there twice", number));
      std::array<double, 4> values{};
      for (double& value : values) value = words_.real("x, y, z or the weight of a node");
      const double weight = values[3];
      if (!(weight > 0.0))
        words_.refuse(line, fmt::format("the weight of node {} is {}; expected a positive number", number, weight));
      data_.points.col(i) << weight * values[0], weight * values[1], weight * values[2], weight;
    }
  }

  std::int32_t node(std::string_view what) {
    const int line = words_.line();
    const long number = words_.integer(what, 0, highest_number);
    const auto found = nodes_.find(number);
    if (found == nodes_.end()) words_.refuse(line, fmt::format("node {} does not exist", number));
    return found->second;
  }

  void read_elements() {
    const std::size_t count = words_.count("the number of elements", 3);
    for (std::size_t e = 0; e < count; ++e) read_element();
  }

  void read_element() {
    const int line = words_.line();
    const long number = words_.integer("the number of an element", 0, highest_number);
    if (!elements_.emplace(number, static_cast<std::int32_t>(data_.elements.size())).second)
      words_.refuse(line, fmt::format("element {} is there twice", number));
    const std::size_t count = words_.count(fmt::format("the number of functions of element {}", number), 2);
    const long degree = words_.integer(fmt::format("the degree of element {}", number), 1, KnotVector::max_degree);
    const auto coefficients = static_cast<std::size_t>((degree + 1) * (degree + 1));
    if (count * (2 + coefficients) > (words_.remaining() + 1) / 2)
      words_.refuse(line, fmt::format("element {}: {} functions of {} coefficients; the file is too short for them",
                                      number, count, coefficients));
    if (faces_ == FaceLines::present)
      for (int i = 0; i < 4; ++i) node(fmt::format("a face node of element {}", number));
    ExtractionElement element;
    element.degree.fill(static_cast<std::int8_t>(degree));
    for (std::size_t k = 0; k < count; ++k) element.functions.push_back(node("a node of an element"));
    for (std::size_t k = 0; k < count; ++k)
      regions_.insert(words_.integer("the region of a node", -highest_number, highest_number));
    element.rows.resize(static_cast<Eigen::Index>(count), static_cast<Eigen::Index>(coefficients));
    for (Eigen::Index k = 0; k < element.rows.rows(); ++k)
      for (Eigen::Index j = 0; j < element.rows.cols(); ++j) element.rows(k, j) = words_.real("a coefficient");
    data_.elements.push_back(std::move(element));
  }

  /// Regions tell programs with several bodies which one a node belongs to; points to collocate at are our own.
  void report_what_is_not_used() {
    if (regions_.size() > 1)
      data_.warnings.push_back(
          fmt::format("the regions of nodes are not used; found {} different ones", regions_.size()));
    if (collocation_points_ == 0) return;
    data_.entities.push_back({"collocation", "collocation point", collocation_points_, collocation_points_});
    data_.warnings.push_back(fmt::format("{} not used: analyses place their own",
                                         collocation_points_ == 1
                                             ? "a collocation point is"
                                             : fmt::format("{} collocation points are", collocation_points_)));
  }

  /// For each of some nodes: its number, how many places follow, and each of these: element, u and v in [-1, 1].
  void read_collocation_points() {
    while (!words_.at_end()) {
      node("the node of a collocation point");
      const std::size_t places = words_.count("the number of a collocation point's places", 3);
      for (std::size_t i = 0; i < places; ++i) read_place();
      ++collocation_points_;
    }
  }

  void read_place() {
    const int line = words_.line();
    const long number = words_.integer("the element of a collocation point", 0, highest_number);
    if (!elements_.contains(number)) words_.refuse(line, fmt::format("element {} does not exist", number));
    for (int d = 0; d < 2; ++d) {
      const double place = words_.real("a coordinate of a collocation point");
      if (place < -1.0 || place > 1.0)
        words_.refuse(line, fmt::format("a collocation point lies at {}; expected -1 to 1", place));
    }
  }

  Words words_;
  FaceLines faces_;
  ExtractionData data_;
  Numbers nodes_;
  Numbers elements_;
  std::set<long> regions_;
  int collocation_points_ = 0;
};

}  // namespace

ExtractionData parse_be(std::string_view text) {
  BeReader without(text, FaceLines::absent);
  try {
    return without.run();
  } catch (const InputError& without_faces) {
    BeReader with(text, FaceLines::present);
    try {
      return with.run();
    } catch (const InputError&) {
      // The way that came farther is what the file means.
      if (with.line() >= without.line()) throw;
    }
    throw;
  }
}

CadModel read_be(const std::filesystem::path& path) {
  const std::string text = read_bytes(path);
  try {
    return model_of(parse_be(text), "Bézier elements (.be)");
  } catch (Error& error) {
    error.add_context(path.string());
    throw;
  }
}

}  // namespace isorim::io::tspline
