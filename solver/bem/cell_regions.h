#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/bezier/element_table.h"
#include "geometry/vocabulary.h"

namespace isorim::solver {

/// A box about a boundary, in equal cubes (squares), of which those that the boundary does not come into are joined to
/// regions wherever they share a face: all points of a region lie on the same side of the boundary. Gaps of an open one
/// that are wider than a cube join what lies on either side.
template <int Dim>
class CellRegions {
 public:
  /// `count`: about how many cubes there are to be along the longest side of the box. `margin`: a cube that the
  /// boundary comes nearer to than this counts as touched. Memory: four bytes a cube. Elements are bisected until their
  /// control points lie within two cubes, so time goes with the number of cubes that are touched.
  CellRegions(const geometry::ElementTable<Dim>& table, int count, double margin);

  /// In a touched cube; where an element's weights are not positive its net bounds nothing, and all cubes are.
  static constexpr int touched = -1;
  /// The region of a point: 0 around the box.
  int region(const geometry::Point<Dim>& point) const;
  int count() const { return static_cast<int>(samples_.size()); }
  /// Middles of a few of the region's cubes, spread over it.
  const std::vector<geometry::Point<Dim>>& samples(int region) const {
    return samples_[static_cast<std::size_t>(region)];
  }

 private:
  using Index = std::array<std::int64_t, Dim>;

  void set_box(const geometry::ElementTable<Dim>& table, int count, double margin);
  std::int64_t coordinate(double x, std::size_t d) const;
  std::size_t number(const Index& cell) const;
  Index cell(std::size_t number) const;
  void touch(const std::vector<double>& net, const std::array<int, Dim - 1>& degrees, int depth);
  /// The cubes that hang together with one that belongs to no region yet become one.
  void fill(std::size_t first);

  geometry::Point<Dim> lower_;
  double width_ = 1.0;
  double margin_ = 0.0;
  Index counts_{};
  std::vector<std::int32_t> regions_;
  std::vector<std::vector<geometry::Point<Dim>>> samples_;
};

}  // namespace isorim::solver
