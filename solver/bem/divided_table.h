#pragma once

#include <cstddef>
#include <vector>

#include "geometry/bezier/element_table.h"
#include "geometry/vocabulary.h"
#include "quadrature/target_rules.h"

namespace isorim::solver {

/// A table whose elements are parts of another's, for integrands that need smaller ones.
template <int Dim>
class DividedTable {
 public:
  /// Bisects elements across their directions until none is much longer than `length` in any. Cut elements stay whole.
  DividedTable(const geometry::ElementTable<Dim>& table, double length);

  const geometry::ElementTable<Dim>& table() const { return table_; }
  /// A target of the given table as one of this.
  quadrature::Target<Dim> target(quadrature::Target<Dim> target) const;

 private:
  /// The cell of a part in its element's.
  struct Part {
    int element = 0;
    geometry::Point<Dim - 1> lower = geometry::Point<Dim - 1>::Zero();
    geometry::Point<Dim - 1> upper = geometry::Point<Dim - 1>::Ones();
  };
  geometry::ElementTable<Dim> table_;
  std::vector<Part> parts_;
  /// The parts of element e are parts_[first_[e]] to parts_[first_[e + 1] - 1].
  std::vector<std::size_t> first_;
};

/// The longest of the control polygons that run in a direction of an element's net, (Dim + 1) x points.
template <int Dim>
double extent(const Eigen::Ref<const geometry::HomogeneousPoints<Dim>>& net,
              const geometry::BezierElement<Dim>& element, int direction);

}  // namespace isorim::solver
