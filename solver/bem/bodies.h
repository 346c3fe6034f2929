#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "geometry/bezier/element_table.h"
#include "geometry/topology/orientation.h"
#include "geometry/vocabulary.h"
#include "quadrature/target_rules.h"
#include "solver/bem/field_space.h"

namespace isorim::solver {

/// The connected bodies that a boundary encloses: each outer shell with the voids directly inside it. (A shell inside a
/// void is a body of its own.) One number a patch, counted from 0 in the order of the outer shells; empty if there is
/// one body, or if a shell is open, which says nothing of inside and outside.
///
/// table: elements of the boundary's patches, refined or not. A void belongs to the smallest outer shell that sees one
/// of its points under the whole solid angle (Gauss's integral).
template <int Dim>
std::vector<std::int32_t> bodies_of_patches(const geometry::Topology<Dim>& topology,
                                            const geometry::ElementTable<Dim>& table);

/// Which body of a space a point inside lies in; by Gauss's integral over every body's boundary.
template <int Dim>
class BodyLocator {
 public:
  explicit BodyLocator(const FieldSpace<Dim>& space);
  /// 0 if it lies in none.
  std::int32_t operator()(const geometry::Point<Dim>& point) const;

 private:
  struct Body {
    geometry::ElementTable<Dim> boundary;
    std::unique_ptr<quadrature::TargetRules<Dim>> rules;
  };
  std::vector<Body> bodies_;
};

}  // namespace isorim::solver
