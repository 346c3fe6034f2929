#include "solver/bem/trimmed_space.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include "geometry/bezier/subdivision.h"
#include "geometry/errors.h"
#include "geometry/trimming/face_locator.h"
#include "quadrature/cut_region.h"
#include "quadrature/gauss_legendre.h"
#include "solver/bem/extension.h"
#include "solver/bem/point_selection.h"

namespace isorim::solver {

using geometry::BezierElement;
using geometry::ElementTable;
using geometry::FaceLocator;
using geometry::Interval;
using geometry::Point2;
using geometry::TrimmedRegion;
using geometry::TrimmedSurface;
using geometry::Vector2;

namespace {

/// A function of the degree p of which less is seen (its largest value, where they sum up to one) is an extension. At
/// the edge of a whole cell the last B-spline that lives there takes 1 / p!.
double smallest_value(int degree) {
  return 0.1 / (degree * degree);
}
/// Points keep this share of an element away from trims.
constexpr double trim_clearance = 0.08;
/// Elements of which less is kept than this part of the largest share in their block carry no collocation points.
constexpr double smallest_share = 0.05;

/// At least so much is kept of one of the cells on which functions of the whole surface rest.
constexpr double least_sound_share = 0.4;
/// Functions of which less is left beside the others are extensions, too.
constexpr double indistinct = 1e-5;

/// An element of a part between jumps that has no sound cell.
struct Fitted {
  PartFunctions functions;
  /// The number of the first one.
  std::int32_t first = 0;
};

/// A term of a function that is an extension.
struct Share {
  int function = 0;
  double factor = 0.0;
};

class Builder {
 public:
  Builder(const TensorSpace<3>& whole, const TrimmedSurface& face, std::span<const BezierElement<3>> kept,
          std::span<const TrimmedRegion> regions)
      : whole_(whole),
        regions_(regions),
        surface_(face.surface()),
        kept_(kept),
        locator_(face),
        table_(bezier_elements(geometry::Boundary<3>{{{"", surface_}}})),
        cells_(patch_space<3>(whole, table_.elements)),
        count_{static_cast<int>(whole.lines[0].elements.size()), static_cast<int>(whole.lines[1].elements.size())} {
    for (const BezierElement<3>& element : kept) {
      cell_of_.push_back(cell_of(element));
      share_.push_back(share_of(element));
    }
    share_of_cell_.assign(cells_.elements.size(), 0.0);
    for (std::size_t e = 0; e < kept.size(); ++e) {
      share_of_cell_[static_cast<std::size_t>(cell_of_[e])] += share_[e];
      double& largest = largest_share_.try_emplace(block_of(cell_of_[e]), 0.0).first->second;
      largest = std::max(largest, share_[e]);
    }
    for (std::size_t e = 0; e < kept.size(); ++e) candidates_.push_back(find_candidates(e));
  }

  PatchSpace<3> build() {
    const std::vector<double> seen = seen_values();
    while (true) {
      number_functions(seen);
      fit_functions();
      extend_functions();
      fill_elements();
      const std::vector<int> dependent = place_points();
      if (dependent.empty()) return std::move(result_);
      leave_out(dependent);
    }
  }

 private:
  int cell_of(const BezierElement<3>& element) const;
  double share_of(const BezierElement<3>& element) const;
  Interval cell_interval(int cell, int d) const;
  /// The part between jumps that a cell belongs to.
  int block_of(int cell) const;
  std::span<const std::int32_t> functions_of(int cell) const;
  Point2 place_in_cell(std::size_t e, const Point2& place) const;
  std::vector<double> seen_values() const;
  void number_functions(const std::vector<double>& seen);
  void leave_out(const std::vector<int>& functions);
  int nearest_sound_cell(int cell) const;
  bool has_sound_cell(int block) const { return fitted_blocks_.find(block) == fitted_blocks_.end(); }
  CellPart part_of(std::size_t e) const;
  void fit_functions();
  std::size_t nearest_fitted(std::size_t e) const;
  void append_fitted(std::size_t e);
  void extend_functions();
  void fill_elements();
  void append_element(std::size_t e);
  std::vector<int> place_points();
  bool carries_points(std::size_t e) const;
  bool is_clear(std::size_t e, const Point2& uv, double clearance) const;
  std::vector<Point2> find_candidates(std::size_t e) const;

  const TensorSpace<3>& whole_;
  std::span<const TrimmedRegion> regions_;
  const geometry::NurbsSurface<3>& surface_;
  std::span<const BezierElement<3>> kept_;
  FaceLocator locator_;
  ElementTable<3> table_;
  PatchSpace<3> cells_;
  std::array<int, 2> count_;
  /// Of each kept element.
  std::vector<int> cell_of_;
  std::vector<double> share_;
  std::vector<double> share_of_cell_;
  /// Of each kept element: places for collocation points.
  std::vector<std::vector<Point2>> candidates_;
  std::map<int, double> largest_share_;
  std::vector<char> is_sound_;
  /// Parts between jumps without a sound cell, and their elements with functions of their own.
  std::set<int> fitted_blocks_;
  std::map<std::size_t, Fitted> fitted_;
  /// For each function of the whole surface its number in the result, or -1.
  std::vector<std::int32_t> number_;
  /// Those that no points can tell from the others.
  std::vector<char> is_left_out_;
  std::int32_t count_functions_ = 0;
  /// For those without a number, if they are seen.
  std::vector<std::vector<Share>> shares_;
  PatchSpace<3> result_;
};

int Builder::cell_of(const BezierElement<3>& element) const {
  std::array<int, 2> index{};
  for (std::size_t d = 0; d < 2; ++d) {
    const auto& elements = whole_.lines[d].elements;
    const double middle = element.domain[d].middle();
    const auto behind = std::upper_bound(elements.begin() + 1, elements.end(), middle,
                                         [](double u, const auto& e) { return u < e.domain.first; });
    index[d] = static_cast<int>(behind - elements.begin()) - 1;
  }
  return index[0] + count_[0] * index[1];
}

Interval Builder::cell_interval(int cell, int d) const {
  const int index = d == 0 ? cell % count_[0] : cell / count_[0];
  return whole_.lines[static_cast<std::size_t>(d)].elements[static_cast<std::size_t>(index)].domain;
}

double Builder::share_of(const BezierElement<3>& element) const {
  if (!element.is_cut()) return 1.0;
  const quadrature::CutRegion region(regions_[static_cast<std::size_t>(element.region)]);
  double share = region.moments({1, 1}).area();
  for (int d = 0; d < 2; ++d)
    share *= element.domain[static_cast<std::size_t>(d)].length() / cell_interval(cell_of(element), d).length();
  return share;
}

int Builder::block_of(int cell) const {
  const auto piece = [&](std::size_t d, int index) {
    const LineSpace& line = whole_.lines[d];
    return line
        .piece[static_cast<std::size_t>(line.number(line.elements[static_cast<std::size_t>(index)].first_function))];
  };
  return piece(0, cell % count_[0]) + count_[0] * piece(1, cell / count_[0]);
}

std::span<const std::int32_t> Builder::functions_of(int cell) const {
  const FieldElement<3>& field = cells_.elements[static_cast<std::size_t>(cell)];
  return std::span(cells_.functions).subspan(field.first, static_cast<std::size_t>(field.count));
}

/// The largest value of each function at the candidates.
std::vector<double> Builder::seen_values() const {
  std::vector<double> largest(cells_.points.size(), 0.0);
  std::vector<double> values;
  for (std::size_t e = 0; e < kept_.size(); ++e) {
    const int cell = cell_of_[e];
    const auto functions = functions_of(cell);
    values.resize(functions.size());
    for (const Point2& place : candidates_[e]) {
      numerators<3>(cells_, cell, place_in_cell(e, place), values);
      const double sum = std::accumulate(values.begin(), values.end(), 0.0);
      for (std::size_t k = 0; k < values.size(); ++k) {
        double& value = largest[static_cast<std::size_t>(functions[k])];
        value = std::max(value, values[k] / sum);
      }
    }
  }
  return largest;
}

void Builder::number_functions(const std::vector<double>& seen) {
  number_.assign(seen.size(), -1);
  is_left_out_.resize(seen.size(), 0);
  const double least = smallest_value(std::max(whole_.lines[0].knots.degree(), whole_.lines[1].knots.degree()));
  for (std::size_t f = 0; f < seen.size(); ++f)
    if (seen[f] >= least && is_left_out_[f] == 0) number_[f] = 0;
  // A cell is sound if all its functions have coefficients of their own.
  is_sound_.assign(cells_.elements.size(), 0);
  for (const int cell : cell_of_) {
    const bool sound = std::ranges::all_of(functions_of(cell),
                                           [&](std::int32_t f) { return number_[static_cast<std::size_t>(f)] == 0; });
    is_sound_[static_cast<std::size_t>(cell)] = sound ? 1 : 0;
  }
  for (const int cell : cell_of_) fitted_blocks_.insert(block_of(cell));
  for (const int cell : cell_of_) {
    const auto index = static_cast<std::size_t>(cell);
    if (is_sound_[index] != 0 && share_of_cell_[index] >= least_sound_share) fitted_blocks_.erase(block_of(cell));
  }
  for (const int cell : cell_of_)
    if (!has_sound_cell(block_of(cell)))
      for (const std::int32_t f : functions_of(cell)) number_[static_cast<std::size_t>(f)] = -1;
  for (std::int32_t& number : number_)
    if (number == 0) number = count_functions_++;
}

/// Starts again without these functions (of the result).
void Builder::leave_out(const std::vector<int>& functions) {
  for (std::size_t f = 0; f < number_.size(); ++f)
    if (std::ranges::find(functions, number_[f]) != functions.end()) is_left_out_[f] = 1;
  count_functions_ = 0;
  fitted_blocks_.clear();
  fitted_.clear();
  shares_.clear();
  result_ = {};
}

CellPart Builder::part_of(std::size_t e) const {
  CellPart part{cell_of_[e], {}};
  for (std::size_t d = 0; d < 2; ++d) {
    const Interval cell = cell_interval(part.cell, static_cast<int>(d));
    const Interval kept = kept_[e].domain[d];
    part.within[d] = {(kept.first - cell.first) / cell.length(), (kept.last - cell.first) / cell.length()};
  }
  return part;
}

/// Where no cell is sound every element stands by itself, but for the least.
void Builder::fit_functions() {
  for (std::size_t e = 0; e < kept_.size(); ++e) {
    if (has_sound_cell(block_of(cell_of_[e])) || !carries_points(e)) continue;
    Fitted& fitted = fitted_[e];
    fitted.functions = fitted_functions(cells_, table_, part_of(e), candidates_[e]);
    fitted.first = count_functions_;
    count_functions_ += static_cast<std::int32_t>(fitted.functions.points.size());
  }
}

/// Of the same part between jumps.
std::size_t Builder::nearest_fitted(std::size_t e) const {
  const auto middle = [&](std::size_t of) {
    return Vector2(kept_[of].domain[0].middle() / cell_interval(cell_of_[of], 0).length(),
                   kept_[of].domain[1].middle() / cell_interval(cell_of_[of], 1).length());
  };
  std::size_t best = e;
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& [other, fitted] : fitted_) {
    const double distance = (middle(other) - middle(e)).norm();
    if (distance >= nearest || block_of(cell_of_[other]) != block_of(cell_of_[e])) continue;
    nearest = distance;
    best = other;
  }
  return best;
}

void Builder::append_fitted(std::size_t e) {
  FieldElement<3> field = cells_.elements[static_cast<std::size_t>(cell_of_[e])];
  const std::size_t from = fitted_.contains(e) ? e : nearest_fitted(e);
  const Fitted& fitted = fitted_.at(from);
  const Eigen::MatrixXd rows =
      from == e ? fitted.functions.rows : continued_rows(cells_, table_, part_of(from), fitted.functions, part_of(e));
  field.first = result_.functions.size();
  field.row = result_.rows.size();
  field.count = static_cast<int>(rows.rows());
  for (Eigen::Index k = 0; k < rows.rows(); ++k) {
    result_.functions.push_back(fitted.first + static_cast<std::int32_t>(k));
    for (Eigen::Index j = 0; j < rows.cols(); ++j) result_.rows.push_back(rows(k, j));
  }
  result_.elements.push_back(field);
}

/// In rings of the grid about the cell.
int Builder::nearest_sound_cell(int cell) const {
  const int column = cell % count_[0];
  const int row = cell / count_[0];
  const int block = block_of(cell);
  int best = -1;
  double nearest = std::numeric_limits<double>::infinity();
  for (int radius = 0; radius <= std::max(count_[0], count_[1]) && radius <= nearest; ++radius)
    for (int j = std::max(0, row - radius); j <= std::min(count_[1] - 1, row + radius); ++j)
      for (int i = std::max(0, column - radius); i <= std::min(count_[0] - 1, column + radius); ++i) {
        if (std::max(std::abs(i - column), std::abs(j - row)) != radius) continue;
        const int other = i + count_[0] * j;
        const double distance = std::hypot(i - column, j - row);
        if (distance >= nearest || !is_sound_[static_cast<std::size_t>(other)] || block_of(other) != block) continue;
        nearest = distance;
        best = other;
      }
  return best;
}

void Builder::extend_functions() {
  shares_.resize(number_.size());
  // The cell on which most of each function is seen.
  std::vector<int> target(number_.size(), -1);
  for (const int cell : cell_of_) {
    if (!has_sound_cell(block_of(cell))) continue;
    for (const std::int32_t f : functions_of(cell)) {
      int& best = target[static_cast<std::size_t>(f)];
      if (number_[static_cast<std::size_t>(f)] >= 0) continue;
      if (best < 0 || share_of_cell_[static_cast<std::size_t>(cell)] > share_of_cell_[static_cast<std::size_t>(best)])
        best = cell;
    }
  }
  std::map<int, std::vector<std::int32_t>> functions_by_target;
  for (std::size_t f = 0; f < target.size(); ++f)
    if (target[f] >= 0) functions_by_target[target[f]].push_back(static_cast<std::int32_t>(f));
  for (const auto& [cell, functions] : functions_by_target) {
    const int donor = nearest_sound_cell(cell);
    const Eigen::MatrixXd factors = extension(cells_, table_, donor, cell);
    const auto givers = functions_of(donor);
    const auto takers = functions_of(cell);
    for (const std::int32_t f : functions) {
      const Eigen::Index column = std::ranges::find(takers, f) - takers.begin();
      for (std::size_t k = 0; k < givers.size(); ++k)
        shares_[static_cast<std::size_t>(f)].push_back(
            {number_[static_cast<std::size_t>(givers[k])], factors(static_cast<Eigen::Index>(k), column)});
    }
  }
}

void Builder::append_element(std::size_t e) {
  const int cell = cell_of_[e];
  FieldElement<3> field = cells_.elements[static_cast<std::size_t>(cell)];
  const std::size_t length = static_cast<std::size_t>(field.bernstein_count());
  const double* row = cells_.rows.data() + field.row;
  field.first = result_.functions.size();
  field.row = result_.rows.size();
  const auto add = [&](std::int32_t function, double factor) {
    const auto begin = result_.functions.begin() + static_cast<std::ptrdiff_t>(field.first);
    const auto known = std::find(begin, result_.functions.end(), function);
    const std::size_t at = field.row + static_cast<std::size_t>(known - begin) * length;
    if (known == result_.functions.end()) {
      result_.functions.push_back(function);
      result_.rows.resize(result_.rows.size() + length, 0.0);
    }
    for (std::size_t j = 0; j < length; ++j) result_.rows[at + j] += factor * row[j];
  };
  for (const std::int32_t f : functions_of(cell)) {
    if (number_[static_cast<std::size_t>(f)] >= 0) add(number_[static_cast<std::size_t>(f)], 1.0);
    for (const Share& share : shares_[static_cast<std::size_t>(f)]) add(share.function, share.factor);
    row += length;
  }
  field.count = static_cast<int>(result_.functions.size() - field.first);
  // To the rectangle of the region.
  const std::array<int, 2> degrees{field.degree[0], field.degree[1]};
  const CellPart part = part_of(e);
  for (std::size_t d = 0; d < 2; ++d)
    for (int k = 0; k < field.count; ++k)
      geometry::restrict_net(std::span(result_.rows).subspan(field.row + static_cast<std::size_t>(k) * length, length),
                             1, degrees, static_cast<int>(d), part.within[d]);
  result_.elements.push_back(field);
}

void Builder::fill_elements() {
  for (std::size_t e = 0; e < kept_.size(); ++e) {
    if (has_sound_cell(block_of(cell_of_[e])))
      append_element(e);
    else
      append_fitted(e);
  }
}

bool Builder::carries_points(std::size_t e) const {
  return share_[e] >= smallest_share * largest_share_.at(block_of(cell_of_[e]));
}

/// Whether a place is kept, and all around it at a distance of `clearance` sides of the element too.
bool Builder::is_clear(std::size_t e, const Point2& uv, double clearance) const {
  if (locator_.winding_number(uv) != 1) return false;
  const auto& sides = kept_[e].domain;
  const Vector2 radius = clearance * Vector2(sides[0].length(), sides[1].length());
  for (int k = 0; k < 8; ++k) {
    const double angle = 0.25 * std::numbers::pi * k;
    Point2 probe = uv + radius.cwiseProduct(Vector2(std::cos(angle), std::sin(angle)));
    // The edges of the cell are no trims.
    for (int d = 0; d < 2; ++d) {
      const Interval cell = cell_interval(cell_of_[e], d);
      probe(d) = std::clamp(probe(d), cell.first + 1e-6 * cell.length(), cell.last - 1e-6 * cell.length());
    }
    if (locator_.winding_number(probe) != 1) return false;
  }
  return true;
}

Point2 Builder::place_in_cell(std::size_t e, const Point2& place) const {
  Point2 result;
  for (int d = 0; d < 2; ++d) {
    const Interval cell = cell_interval(cell_of_[e], d);
    const Interval part = kept_[e].domain[static_cast<std::size_t>(d)];
    result(d) = (part.first + place(d) * part.length() - cell.first) / cell.length();
  }
  return result;
}

/// Gauss points of the element's rectangle that are kept, off the trims if there are any such; as many as tell the
/// functions of the element from one another.
std::vector<Point2> Builder::find_candidates(std::size_t e) const {
  constexpr int most_nodes = 30;
  const BezierElement<3>& element = kept_[e];
  if (!carries_points(e)) return {};
  const int degree_u = whole_.lines[0].knots.degree();
  const int degree_v = whole_.lines[1].knots.degree();
  const auto enough = static_cast<std::size_t>(2 * (degree_u + 1) * (degree_v + 1));
  std::vector<Point2> places;
  for (int more = element.is_cut() ? 4 : 2; places.size() < enough && degree_u + more <= most_nodes; more += 3) {
    places.clear();
    for (const double t : quadrature::gauss_legendre(degree_v + more).nodes)
      for (const double s : quadrature::gauss_legendre(degree_u + more).nodes) {
        const Point2 uv(element.domain[0].first + s * element.domain[0].length(),
                        element.domain[1].first + t * element.domain[1].length());
        if (!element.is_cut() || is_clear(e, uv, 0.5 * trim_clearance)) places.emplace_back(s, t);
      }
    if (!element.is_cut()) return places;
  }
  // A sliver.
  if (places.size() < enough)
    places = quadrature::CutRegion(regions_[static_cast<std::size_t>(element.region)])
                 .inner_points(4 * (std::max(degree_u, degree_v) + 1));
  return places;
}

std::vector<int> Builder::place_points() {
  const auto count = static_cast<std::size_t>(count_functions_);
  result_.points.resize(count);
  std::vector<char> has_point(count, 0);
  for (const auto& [e, fitted] : fitted_)
    for (std::size_t k = 0; k < fitted.functions.points.size(); ++k) {
      const std::size_t function = static_cast<std::size_t>(fitted.first) + k;
      result_.points[function] = {static_cast<int>(e), fitted.functions.points[k]};
      has_point[function] = 1;
    }
  std::vector<int> element_of(share_of_cell_.size(), -1);
  for (std::size_t e = 0; e < kept_.size(); ++e)
    element_of[static_cast<std::size_t>(cell_of_[e])] = static_cast<int>(e);
  for (std::size_t f = 0; f < number_.size(); ++f) {
    if (number_[f] < 0) continue;
    const auto& point = cells_.points[f];
    const int e = element_of[static_cast<std::size_t>(point.element)];
    if (e < 0 || !carries_points(static_cast<std::size_t>(e))) continue;
    const BezierElement<3>& element = kept_[static_cast<std::size_t>(e)];
    Point2 place = point.place;
    if (element.is_cut()) {
      Point2 uv;
      for (int d = 0; d < 2; ++d) {
        const Interval cell = cell_interval(point.element, d);
        const Interval part = element.domain[static_cast<std::size_t>(d)];
        uv(d) = cell.first + place(d) * cell.length();
        place(d) = (uv(d) - part.first) / part.length();
      }
      if (!is_clear(static_cast<std::size_t>(e), uv, trim_clearance)) continue;
    }
    result_.points[static_cast<std::size_t>(number_[f])] = {e, place};
    has_point[static_cast<std::size_t>(number_[f])] = 1;
  }
  return choose_points<3>(
      result_, std::move(has_point), [this](int e) { return candidates_[static_cast<std::size_t>(e)]; }, indistinct);
}

}  // namespace

PatchSpace<3> trimmed_space(const TensorSpace<3>& whole, const TrimmedSurface& face,
                            std::span<const BezierElement<3>> kept, std::span<const TrimmedRegion> regions) {
  return Builder(whole, face, kept, regions).build();
}

}  // namespace isorim::solver
