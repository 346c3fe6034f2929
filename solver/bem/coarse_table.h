#pragma once

#include <memory>
#include <vector>

#include "geometry/bezier/element_table.h"
#include "geometry/boundary.h"
#include "geometry/vocabulary.h"
#include "quadrature/target_rules.h"

namespace isorim::solver {

/// The boundary of a finer table in fewer elements, for integrands that know nothing of the functions on the fine ones:
/// rays of domain loads. Of NURBS patches these are the elements before any refinement; cut elements, and those of
/// other patches, are the fine ones.
template <int Dim>
class CoarseTable {
 public:
  /// `fine` holds the patches of the boundary, refined in their own parameters.
  CoarseTable(const geometry::Boundary<Dim>& boundary, const geometry::ElementTable<Dim>& fine);

  const geometry::ElementTable<Dim>& table() const { return table_; }
  /// A target of the fine table as one of this.
  quadrature::Target<Dim> target(quadrature::Target<Dim> target) const;

 private:
  /// Where the cell of a fine element lies in that of a coarse one.
  struct Cell {
    int element = 0;
    geometry::Point<Dim - 1> first = geometry::Point<Dim - 1>::Zero();
    geometry::Point<Dim - 1> length = geometry::Point<Dim - 1>::Ones();
  };
  int append(const geometry::ElementTable<Dim>& from, geometry::BezierElement<Dim> element);

  geometry::ElementTable<Dim> table_;
  /// Of each fine element.
  std::vector<Cell> cells_;
};

/// Null where it would have as many elements as the fine one.
template <int Dim>
std::shared_ptr<const CoarseTable<Dim>> coarse_table(const geometry::Boundary<Dim>& boundary,
                                                     const geometry::ElementTable<Dim>& fine);

}  // namespace isorim::solver
