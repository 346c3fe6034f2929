#pragma once

#include <vector>

#include "geometry/fitting/point_reduction.h"
#include "geometry/vocabulary.h"

/// From the unordered points of a section to contours: points in the order in which the curve runs through them.
namespace isorim::geometry {

/// A contour of a section.
struct Contour {
  /// 2 x n, in order; counter-clockwise if closed, then without the first point again at the end.
  Points<2> points;
  /// How many of the points that were given each stands for.
  std::vector<double> weights;
  bool closed = false;
  /// The longest step between neighbours, that from the last to the first included if closed.
  double largest_gap = 0.0;
};

enum class DropReason {
  /// Lies where another point does.
  duplicate,
  /// In the reference's neighbourhood, but not chosen by the count-and-distance rule.
  passed_over,
  /// The walk ended before it came here.
  not_reached,
  /// Alone, or in a group too small for a contour, away from all others.
  outlier,
  /// Sticks out of its contour by several steps.
  spike,
};

struct DroppedPoint {
  /// Among the points given.
  int index = 0;
  DropReason reason = DropReason::outlier;
};

struct OrderedContours {
  /// Those with most points first.
  std::vector<Contour> contours;
  /// By index. Points that were merged or thinned are not dropped: the weights count them.
  std::vector<DroppedPoint> dropped;
  /// The points were a band wider than their spacing: the contours' points lie on its middle line.
  bool thinned = false;
  /// If thinned: the part of the contours' length along which the points lie in two heaps across them, or other parts
  /// of the contours within 7.5 standard deviations of the points; and such a place. Two contours are so near to each
  /// other there, for the noise, that they may have been taken for one or mixed up.
  double doubtful_share = 0.0;
  Point2 doubtful_place = Point2::Zero();
};

/// "duplicate", "passed over", ...
const char* drop_reason_name(DropReason reason);

struct DensityWalkOptions {
  /// The neighbourhood ("macro-region") reaches this many cells to every side of the reference's cell; at least 1.
  int reach = 1;
};

/// The count-and-distance rule (L. R. Pereira, thesis, UFU 2014, section 4.4): from the densest cell, the next is the
/// one of the neighbourhood with the largest product of count and distance to the reference; the others there are
/// dropped; so on until none is left there. One contour, closed if the walk ends within two neighbourhoods of the first
/// cell (whose own was taken in the first step). The rule can jump and cut corners, and takes a second loop for
/// unreached points; order_contours() does neither. Throws GeometryError if the reach is not positive.
OrderedContours order_by_density(const ReducedPoints& cells, const DensityWalkOptions& options = {});

enum class ContourEnds {
  /// A contour is closed if the gap between its ends is at most `largest_gap`.
  automatic,
  closed,
  open,
};

struct OrderingOptions {
  ContourEnds ends = ContourEnds::automatic;
  /// Ends of pieces are joined across gaps up to this part of the length of the pieces, at most 1. 0.15 bridges what a
  /// scanner does not see and leaves a half circle open.
  double largest_gap = 0.15;
  /// Groups of fewer points are outliers; at least 3.
  int least_points = 6;
};

/// The contours by shortest tours: for points on a curve whose samples are nearer to each other along it than to other
/// parts of it, the shortest closed polygon runs in the order of the curve, corners included (J. Giesen, Curve
/// reconstruction, the traveling salesman problem and Menger's theorem on length, Discrete & Computational Geometry 24,
/// 2000). Points are grouped by distance to their neighbours, each group is toured, tours are parted where two loops
/// are shorter than one and each encloses an area, cut at gaps, and pieces joined end to end.
///
/// Where the polygon zigzags over most of its length the points are a band of noise: they are first moved onto its
/// middle line by moving least squares in neighbourhoods just large enough to be longish (I.-K. Lee, Curve
/// reconstruction from unorganized points, CAGD 17, 2000), and merged to even steps. Contours that are eight standard
/// deviations of the noise apart, or more, are told apart then; nearer ones are not, which `doubtful_share` says down
/// to about five.
///
/// `counts` (empty: 1 each) weigh the points. The same result for the same points in any order but for rounding and
/// ties. About n log n; meant for up to some 10^4 points, reduce_points() before. Throws GeometryError if a coordinate
/// is not finite, counts do not fit, options are out of range, or no group has enough points.
OrderedContours order_contours(const Points<2>& points, const std::vector<int>& counts = {},
                               const OrderingOptions& options = {});

}  // namespace isorim::geometry
