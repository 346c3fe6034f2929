#pragma once

#include <array>
#include <span>
#include <vector>

#include "geometry/bezier/element_table.h"
#include "solver/bem/patch_space.h"
#include "solver/bem/tensor_space.h"

/// Locally refined spaces: truncated hierarchical B-splines (C. Giannelli, B. Jüttler & H. Speleers, CAGD 29, 2012).
namespace isorim::solver {

/// Cells bisected in all directions again and again, and the levels of the grid below them.
template <int Dim>
class CellTree {
 public:
  /// counts: cells of level 0 in each direction. bisected: in any order; each of level 0 or a child of another one.
  /// Throws InputError for one that is neither.
  CellTree(std::array<int, Dim - 1> counts, std::vector<GridCell<Dim>> bisected);

  const std::array<int, Dim - 1>& counts() const { return counts_; }
  int levels() const { return levels_; }
  bool is_bisected(const GridCell<Dim>& cell) const;
  /// Of level 0, or a child of a bisected cell.
  bool exists(const GridCell<Dim>& cell) const;
  bool is_inside(const GridCell<Dim>& cell) const;
  /// Cells that are not bisected: one of level 0 after the other (the first parameter fastest), within each the first
  /// children first.
  std::vector<GridCell<Dim>> leaves() const;
  const std::vector<GridCell<Dim>>& bisected() const { return bisected_; }

 private:
  std::array<int, Dim - 1> counts_;
  std::vector<GridCell<Dim>> bisected_;
  int levels_ = 1;
};

template <int Dim>
GridCell<Dim> parent(const GridCell<Dim>& cell);

/// The cells to bisect so that `marked` leaves are, and neighbouring levels differ by one at most within `radius`
/// cells: all of the tree's and those added.
template <int Dim>
std::vector<GridCell<Dim>> graded(const CellTree<Dim>& tree, std::span<const GridCell<Dim>> marked, int radius);

/// levels: the spaces on the grid of each level of the tree, each within the next. elements: the leaves', in order.
/// Functions of a level that live on cells of this level alone, if not of the next alone; truncated where functions of
/// finer levels take over, so that all sum up to one, and functions of level 0 keep their coefficients: the space holds
/// whatever that of level 0 holds. Points of functions that finer levels leave alone are those of the tensor-product
/// spaces, the others are chosen by require_points().
template <int Dim>
PatchSpace<Dim> hierarchical_space(const CellTree<Dim>& tree, std::span<const TensorSpace<Dim>> levels,
                                   std::span<const geometry::BezierElement<Dim>> elements);

}  // namespace isorim::solver
