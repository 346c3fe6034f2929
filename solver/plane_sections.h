#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "geometry/intersection/plane_section.h"
#include "geometry/intersection/section_spline.h"
#include "geometry/vocabulary.h"
#include "quadrature/estimate.h"

/// Families of plane sections with their properties, in parallel.
namespace isorim::solver {

struct PlaneSectionOptions {
  geometry::SectionOptions cutting = {};
  /// Relative error of areas and lengths aimed at.
  double tolerance = 1e-12;
  /// Of the B-splines, relative to the size of the boundary; 0: none are made.
  double fit_tolerance = 1e-8;
  /// 0: all that OpenMP offers. The results are the same bits for any number.
  int threads = 0;
  /// Called from the calling thread with the fraction of planes that are done; may be empty.
  std::function<void(double)> progress = {};
};

/// One plane of a family. Lengths in the units of the shape.
struct MeasuredSection {
  /// Absent if the plane could not be cut; then `failure` says why.
  std::optional<geometry::PlaneSection> section;
  std::string failure;
  /// Of a plane that could not be cut since it only touches the boundary: it ends within this distance of the plane, so
  /// what the two have in common is a degenerate section.
  std::optional<double> touches_within = std::nullopt;
  /// Of the region that the loops bound: zero without loops.
  quadrature::Estimate area;
  /// Of all loops.
  quadrature::Estimate perimeter;
  /// In space; absent without loops.
  std::optional<geometry::Point3> centroid;
  geometry::Vector2 centroid_error = geometry::Vector2::Zero();
  /// About the centroid, along the axes of the plane's frame: [[int y^2, -int x y], [-int x y, int x^2]].
  Eigen::Matrix2d second_moments = Eigen::Matrix2d::Zero();
  /// Of every loop, open chain and touching curve, in the order of the section; none if not asked for. Absent where the
  /// fit failed: a message of the section says why.
  std::vector<std::optional<geometry::SectionSpline>> loops;
  std::vector<std::optional<geometry::SectionSpline>> chains;
  std::vector<std::optional<geometry::SectionSpline>> touching;
};

/// Cuts the boundary by every plane and measures the sections: area, perimeter and centroid by the radial integration
/// method on the region's own exact boundary. A plane that fails does not spoil the others.
std::vector<MeasuredSection> measure_sections(const geometry::PlaneCutter& cutter,
                                              std::span<const geometry::PlaneFrame> planes,
                                              const PlaneSectionOptions& options = {});

}  // namespace isorim::solver
