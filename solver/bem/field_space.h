#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "geometry/bezier/element_table.h"
#include "geometry/topology/orientation.h"
#include "geometry/vocabulary.h"
#include "solver/bem/coarse_table.h"

namespace isorim::solver {

/// The functions that live on one element, as rows of Bernstein coefficients.
template <int Dim>
struct FieldElement {
  /// Of the Bernstein basis that the rows refer to; independent of the geometry's degree.
  std::array<std::int8_t, Dim - 1> degree{};
  /// The functions are sum_j row_j B_j / w, w the weight function of the element's net as it stands in the table; else
  /// the Bernstein sums themselves.
  bool rational = false;
  /// Its functions are FieldSpace::functions[first], ..., [first + count - 1].
  std::size_t first = 0;
  int count = 0;
  /// Where its rows start in FieldSpace::rows.
  std::size_t row = 0;

  int bernstein_count() const {
    int product = 1;
    for (const std::int8_t p : degree) product *= p + 1;
    return product;
  }
};

/// A point at which the integral equation is required to hold; inside a patch, off its edges and corners.
template <int Dim>
struct CollocationPoint {
  int element = 0;
  /// In the element's unit cell.
  geometry::Point<Dim - 1> place;
  geometry::Point<Dim> position;
  /// Unit, outward.
  geometry::Vector<Dim> normal;
};

/// A cell in the parameters of a patch. Level 0 are the cells of its uniform refinement, counted in each direction;
/// every level halves the cells of the level before.
template <int Dim>
struct GridCell {
  int level = 0;
  std::array<std::int64_t, Dim - 1> index{};

  friend auto operator<=>(const GridCell&, const GridCell&) = default;  // NOLINT(modernize-use-nullptr): takes its 0
};

/// A space of functions on a boundary and the points that go with them. Unknowns and known data of all equations live
/// here, one coefficient a function and component.
///
/// Functions are free to jump across the edges of patches and across creases inside them, where the normal jumps and
/// fluxes with it. Elsewhere they are as smooth as the geometry's knots say, and C^(p - 1) at the knots of refinements;
/// where a patch closes on itself with a continuous normal they are continuous across the seam, and at a pole with a
/// tangent plane they have one value. They sum up to one.
template <int Dim>
struct FieldSpace {
  /// The elements of the analysis with their geometry: those of the refined patches, exact copies of the shape.
  geometry::ElementTable<Dim> table;
  /// The same boundary in its own elements; null if those of the analysis are no smaller.
  std::shared_ptr<const CoarseTable<Dim>> coarse;
  /// One for each element of the table.
  std::vector<FieldElement<Dim>> elements;
  std::vector<std::int32_t> functions;
  /// Function by function of an element: bernstein_count() coefficients each, the first parameter fastest.
  std::vector<double> rows;
  /// One for each function, in the same order: point i lies where function i is large, and the matrix of the functions'
  /// values at the points is well conditioned.
  std::vector<CollocationPoint<Dim>> points;
  /// Of each element, where its patch can be refined locally; level -1 elsewhere.
  std::vector<GridCell<Dim>> cells;
  /// Of each patch the connected body that it bounds (bodies.h), and of each body the name of a patch; empty: one body.
  std::vector<std::int32_t> body_of_patch;
  std::vector<std::string> bodies;
  /// Of each element, what DiscretisationOptions::group says of the one of level 0 that it is a part of.
  std::vector<int> groups;

  std::int32_t body_count() const { return bodies.empty() ? 1 : static_cast<std::int32_t>(bodies.size()); }
  std::int32_t body_of(int element) const {
    if (body_of_patch.empty()) return 0;
    return body_of_patch[static_cast<std::size_t>(table.elements[static_cast<std::size_t>(element)].patch)];
  }
  int function_count() const { return static_cast<int>(points.size()); }
  std::span<const std::int32_t> functions_of(int element) const {
    const FieldElement<Dim>& field = elements[static_cast<std::size_t>(element)];
    return {functions.data() + field.first, static_cast<std::size_t>(field.count)};
  }
};

/// How the field's space is made from the boundary.
template <int Dim>
struct DiscretisationOptions {
  /// Of the functions, in every direction, 1 to max_degree; absent: that of the geometry in each direction, at least 2.
  std::optional<int> degree;
  /// Uniform bisections of every knot span, 0 to max_refine.
  int refine = 0;
  static constexpr int max_degree = 15;
  static constexpr int max_refine = 12;
  /// Of level 0 in all.
  static constexpr int max_elements = 1000000;
  struct PatchOptions {
    std::optional<int> degree;
    std::optional<int> refine;
  };
  /// By name of the patch: instead of the above.
  std::vector<std::pair<std::string, PatchOptions>> patches;
  /// Local refinement: a cell of a patch (by its index) that is bisected in every direction, of level 0 or a child of
  /// another one. Made by refine_locally().
  struct BisectedCell {
    int patch = 0;
    GridCell<Dim> cell;
  };
  std::vector<BisectedCell> bisected;
  /// Levels that there may be, that of the coarsest cells included. On curves the limit is what rounding leaves of a
  /// parameter, on surfaces the grid of the finest level.
  static constexpr int max_local_levels = Dim == 2 ? 33 : 8;
  /// Which elements may share functions: where the numbers of neighbouring elements of a patch differ (other boundary
  /// conditions), functions end along the knot line between them. Called with the patch, and a point and the outward
  /// normal in the middle of an element; empty: all the same.
  std::function<int(int patch, const geometry::Point<Dim>& point, const geometry::Vector<Dim>& normal)> group;
};

/// Builds the space. On NURBS patches functions are w_a N_a / W (W = sum w_a N_a the geometry's weight function) if
/// their degree is not below the geometry's in any direction, which puts constants and linear functions of the position
/// into the space; polynomial B-splines otherwise. Collocation points are the Gauss points of the splines
/// (gauss_points() in line_space.h), moved off the edges of elements where they would lie on them. On trimmed surfaces
/// functions of which little is left follow their neighbours (trimmed_space.h).
///
/// On extracted surfaces (T-splines) without refinement and with their own degree these are the surface's own functions
/// w_a N_a / W, divided at creases and between groups (extracted_space.h; the creases are found across the edges of the
/// topology). They are not refined themselves: with refinement, or another degree, every element is a patch by itself,
/// functions jump across its edges.
///
/// Throws InputError for a degree or refinement out of range, more than max_elements or a patch that does not exist,
/// NumericalError for
/// functions of an extracted surface that depend on one another.
template <int Dim>
FieldSpace<Dim> field_space(const geometry::OrientedBoundary<Dim>& boundary, const DiscretisationOptions<Dim>& options);

/// What to build the space from so that the marked elements are bisected. All functions of the space before stay in it.
/// On curves only they are bisected, and neighbours so that the lengths of adjacent elements of a patch keep their
/// ratio to a factor of 2: knots are inserted. On whole surfaces only they are, and neighbours so that levels change by
/// one within the reach of a function: truncated hierarchical B-splines (hierarchical_space.h). The groups remain those
/// of level 0. Trimmed and extracted surfaces with a marked element are bisected as a whole. Elements that cannot be
/// divided any further (max_local_levels, max_refine) stay as they are.
template <int Dim>
DiscretisationOptions<Dim> refine_locally(const geometry::OrientedBoundary<Dim>& boundary,
                                          const DiscretisationOptions<Dim>& options, const FieldSpace<Dim>& space,
                                          std::span<const int> marked);

/// Values of the element's functions at a place of its unit cell: elements[element].count numbers.
template <int Dim>
void basis_values(const FieldSpace<Dim>& space, int element, const geometry::Point<Dim - 1>& place,
                  std::span<double> values);
/// Values and derivatives by the cell's coordinates: row k of the count x Dim result holds (value, d/ds[, d/dt]).
template <int Dim>
Eigen::Matrix<double, Eigen::Dynamic, Dim> basis_jets(const FieldSpace<Dim>& space, int element,
                                                      const geometry::Point<Dim - 1>& place);

}  // namespace isorim::solver
