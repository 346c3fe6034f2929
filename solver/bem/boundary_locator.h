#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "geometry/bezier/element_table.h"
#include "geometry/vocabulary.h"
#include "quadrature/element_shape.h"
#include "quadrature/target_rules.h"
#include "solver/bem/cell_regions.h"

namespace isorim::solver {

/// A point of the boundary, and how far from it what was asked for lies.
template <int Dim>
struct BoundaryPlace {
  int element = 0;
  /// In the element's unit cell.
  geometry::Point<Dim - 1> place;
  double distance = 0.0;
  /// The radius of a ball that holds the element.
  double element_size = 0.0;
};

/// Where points lie relative to a closed boundary. Safe to use from several threads, each with its own buffer.
template <int Dim>
class BoundaryLocator {
 public:
  /// The table must outlive the object.
  explicit BoundaryLocator(const geometry::ElementTable<Dim>& table);

  /// Divides the box around the boundary into cells, so that `point_count` points spread over it, and more, are told
  /// where they lie at once; points nearer to the boundary than `margin` are always left to winding_number(). Time and
  /// memory in proportion to the points.
  void prepare(std::size_t point_count, double margin, int threads);
  /// The body holds the point; nothing where that has not been prepared or the point is too near to the boundary.
  std::optional<bool> known_inside(const geometry::Point<Dim>& point) const;

  /// The nearest place of the elements' cells; of cut elements it may lie in a part that is cut off.
  BoundaryPlace<Dim> nearest(const geometry::Point<Dim>& point) const;

  /// How often the boundary encloses the point, by the solid angle under which it is seen: 1 inside the body, 0 outside
  /// but for errors of quadrature, which aims at 1e-3. Meaningless on the boundary itself.
  double winding_number(const geometry::Point<Dim>& point, quadrature::NodeBuffer<Dim>& buffer) const;

  /// The place belongs to the boundary, not to the cut-off part of a cut element: seen from both sides of it.
  bool is_kept(const BoundaryPlace<Dim>& place, quadrature::NodeBuffer<Dim>& buffer) const;

 private:
  const geometry::ElementTable<Dim>* table_;
  quadrature::TargetRules<Dim> rules_;
  std::vector<quadrature::ElementShape<Dim>> shapes_;
  std::unique_ptr<const CellRegions<Dim>> regions_;
  /// Of each region.
  std::vector<std::optional<bool>> is_inside_;
};

}  // namespace isorim::solver
