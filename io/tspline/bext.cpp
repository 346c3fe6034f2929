#include "io/tspline/bext.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "geometry/errors.h"
#include "geometry/spline/knot_vector.h"
#include "io/file_bytes.h"
#include "io/tspline/extraction_data.h"

namespace isorim::io::tspline {

using geometry::ExtractionElement;
using geometry::HomogeneousPoints;
using geometry::KnotVector;

namespace {

using Json = nlohmann::json;

/// A value and where it stands.
class Node {
 public:
  Node(const Json& value, std::string path) : value_(&value), path_(std::move(path)) {}

  Node at(const char* key) const {
    const std::string path = path_.empty() ? key : path_ + '.' + key;
    if (!value_->is_object()) refuse("expected an object");
    const auto found = value_->find(key);
    if (found == value_->end()) throw InputError(fmt::format("{}: is missing", path));
    return {*found, path};
  }
  bool has(const char* key) const { return value_->is_object() && value_->contains(key); }
  std::size_t size() const {
    if (!value_->is_array()) refuse("expected a list");
    return value_->size();
  }
  Node operator[](std::size_t i) const { return {(*value_)[i], fmt::format("{}[{}]", path_, i)}; }

  long integer(long low, long high) const {
    if (!value_->is_number_integer()) refuse("expected an integer");
    const bool too_large = value_->is_number_unsigned() &&
                           value_->get<std::uint64_t>() > static_cast<std::uint64_t>(std::numeric_limits<long>::max());
    const long found = too_large ? std::numeric_limits<long>::max() : value_->get<long>();
    if (found < low || found > high) refuse(fmt::format("found {}; expected {} to {}", value_->dump(), low, high));
    return found;
  }
  double real() const {
    if (!value_->is_number()) refuse("expected a number");
    return value_->get<double>();
  }
  /// The list has so many entries.
  void require_size(std::size_t wanted) const {
    if (size() != wanted) refuse(fmt::format("found {} entries; expected {}", size(), wanted));
  }
  [[noreturn]] void refuse(const std::string& reason) const {
    throw InputError(fmt::format("{}: {}", path_.empty() ? "the text" : path_, reason));
  }

 private:
  const Json* value_;
  std::string path_;
};

/// The elements of one kind.
struct Block {
  /// One of curves, two of surfaces.
  std::vector<int> degrees;
  std::size_t elements = 0;

  std::size_t coefficients() const {
    std::size_t product = 1;
    for (const int degree : degrees) product *= static_cast<std::size_t>(degree) + 1;
    return product;
  }
};

class BextReader {
 public:
  BextReader(const Json& root, std::size_t bytes)
      : root_(root, ""), most_numbers_(std::max(10'000'000UL, 50 * bytes)) {}

  CadModel run() {
    read_points();
    read_vectors();
    read_blocks();
    for (const Block& block : blocks_)
      for (std::size_t e = 0; e < block.elements; ++e) read_element(block);
    CadModel model = data_.elements.empty() ? CadModel{} : surfaces();
    model.format = "BEXT";
    model.reader = "isorim";
    model.unit = "";
    model.curves = std::move(curves_);
    model.entities = {{"node", "control point", static_cast<int>(data_points_), 0},
                      {"element", "Bézier element", static_cast<int>(next_), 0}};
    if (model.t_splines.empty() && model.curves.empty()) throw InputError("the text holds no element");
    return model;
  }

 private:
  CadModel surfaces() {
    data_.points = points_;
    data_.warnings.emplace_back(
        "BEXT is experimental for surfaces: the order of Bernstein coefficients, s fastest, is that of .iga files");
    return model_of(std::move(data_), "BEXT");
  }

  void read_points() {
    const Node nodes = root_.at("nodes");
    points_.resize(4, static_cast<Eigen::Index>(nodes.size()));
    data_points_ = nodes.size();
    if (root_.has("num_nodes")) require_number(root_.at("num_nodes"), nodes.size(), "nodes");
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      nodes[i].require_size(4);
      const double weight = nodes[i][3].real();
      if (!(weight > 0.0)) nodes[i][3].refuse(fmt::format("the weight is {}; expected a positive number", weight));
      for (std::size_t d = 0; d < 3; ++d)
        points_(static_cast<Eigen::Index>(d), static_cast<Eigen::Index>(i)) = weight * nodes[i][d].real();
      points_(3, static_cast<Eigen::Index>(i)) = weight;
    }
  }

  static void require_number(const Node& announced, std::size_t found, const char* what) {
    const long number = announced.integer(0, std::numeric_limits<std::int32_t>::max());
    if (static_cast<std::size_t>(number) != found)
      announced.refuse(fmt::format("found {}, but there are {} {}", number, found, what));
  }

  void read_vectors() {
    const Node coefficients = root_.at("coefficients");
    if (coefficients.has("sparse_coefficient_vectors") && coefficients.at("sparse_coefficient_vectors").size() > 0)
      coefficients.at("sparse_coefficient_vectors").refuse("sparse coefficient vectors are not supported");
    const Node vectors = coefficients.at("dense_coefficient_vectors");
    for (std::size_t i = 0; i < vectors.size(); ++i) {
      const Node components = vectors[i].at("components");
      std::vector<double>& vector = vectors_.emplace_back();
      for (std::size_t j = 0; j < components.size(); ++j) vector.push_back(components[j].real());
    }
    if (root_.has("num_coeff_vecs")) require_number(root_.at("num_coeff_vecs"), vectors_.size(), "coefficient vectors");
  }

  void read_blocks() {
    const Node info = root_.at("elements").at("element_block_info");
    std::size_t total = 0;
    for (std::size_t b = 0; b < info.size(); ++b) {
      if (info[b].at("deg_u").integer(-1, KnotVector::max_degree) != -1)
        info[b].at("deg_u").refuse("the elements have a volume; expected surfaces, or curves, with deg_u = -1");
      Block block;
      block.degrees.push_back(static_cast<int>(info[b].at("deg_s").integer(1, KnotVector::max_degree)));
      const long degree_t = info[b].at("deg_t").integer(-1, KnotVector::max_degree);
      if (degree_t == 0) info[b].at("deg_t").refuse("found 0; expected -1 or a degree from 1");
      if (degree_t > 0) block.degrees.push_back(static_cast<int>(degree_t));
      block.elements =
          static_cast<std::size_t>(info[b].at("num_elems").integer(0, std::numeric_limits<std::int32_t>::max()));
      total += block.elements;
      blocks_.push_back(std::move(block));
    }
    root_.at("elements").at("element_blocks").require_size(total);
  }

  void read_element(const Block& block) {
    const Node record = root_.at("elements").at("element_blocks")[next_++];
    const Node nodes = record.at("node_ids");
    const Node vectors = record.at("coeff_vector_ids");
    vectors.require_size(nodes.size());
    if (nodes.size() == 0) nodes.refuse("no function lives on the element");
    numbers_ += nodes.size() * block.coefficients();
    if (numbers_ > most_numbers_)
      record.refuse(fmt::format("the elements up to this one have more than {} coefficients", most_numbers_));
    ExtractionElement element;
    element.rows.resize(static_cast<Eigen::Index>(nodes.size()), static_cast<Eigen::Index>(block.coefficients()));
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      element.functions.push_back(static_cast<std::int32_t>(nodes[k].integer(0, points_.cols() - 1)));
      const auto id = static_cast<std::size_t>(vectors[k].integer(0, static_cast<long>(vectors_.size()) - 1));
      if (vectors_[id].size() != block.coefficients())
        vectors[k].refuse(fmt::format("vector {} has {} components; the element's degrees need {}", id,
                                      vectors_[id].size(), block.coefficients()));
      element.rows.row(static_cast<Eigen::Index>(k)) =
          Eigen::Map<const Eigen::RowVectorXd>(vectors_[id].data(), element.rows.cols());
    }
    if (block.degrees.size() == 1) return add_curve(element, block.degrees[0], record);
    for (std::size_t d = 0; d < 2; ++d) element.degree[d] = static_cast<std::int8_t>(block.degrees[d]);
    data_.elements.push_back(std::move(element));
  }

  void add_curve(const ExtractionElement& element, int degree, const Node& record) {
    HomogeneousPoints<3> local(4, element.rows.rows());
    for (Eigen::Index k = 0; k < local.cols(); ++k)
      local.col(k) = points_.col(element.functions[static_cast<std::size_t>(k)]);
    const HomogeneousPoints<3> net = local.lazyProduct(element.rows);
    try {
      curves_.push_back({geometry::NurbsCurve<3>(KnotVector::bezier(degree), net), {}});
    } catch (const GeometryError& error) {
      record.refuse(error.what());
    }
  }

  Node root_;
  HomogeneousPoints<3> points_;
  std::size_t data_points_ = 0;
  std::vector<std::vector<double>> vectors_;
  std::vector<Block> blocks_;
  /// Coefficients so far, and how many there may be: a file can name a few long vectors very often.
  std::size_t numbers_ = 0;
  std::size_t most_numbers_;
  /// Of the next element among the records.
  std::size_t next_ = 0;
  ExtractionData data_;
  std::vector<CadCurve> curves_;
};

}  // namespace

CadModel parse_bext(std::string_view text) {
  Json root;
  try {
    root = Json::parse(text.begin(), text.end());
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("is no JSON that can be read: {}", error.what()));
  }
  return BextReader(root, text.size()).run();
}

CadModel read_bext(const std::filesystem::path& path) {
  const std::string text = read_bytes(path);
  try {
    return parse_bext(text);
  } catch (Error& error) {
    error.add_context(path.string());
    throw;
  }
}

}  // namespace isorim::io::tspline
