#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "geometry/vocabulary.h"

/// Tables of offsets: what a hull form is drawn from. Conventions (README.md): x forward, y to port, z up; a hull is
/// symmetric about y = 0, and only its port half is given.
namespace isorim::geometry {

/// A line along the hull at which its surface has an edge: a chine, the edge of a deck or of a step.
struct KnuckleLine {
  std::string name;
  /// 2 x stations: half-breadth and height at each station.
  Points<2> places;
};

/// A hull by points. All in one unit of length.
struct OffsetTable {
  std::string name;
  std::string source;
  /// Between perpendiculars, moulded beam, design draught.
  double length = 0.0;
  double beam = 0.0;
  double draught = 0.0;
  /// x of the after perpendicular; the forward one lies `length` ahead of it.
  double after_perpendicular = 0.0;
  /// z from which draughts count.
  double baseline = 0.0;

  /// x, rising (forward), and how drawings call them.
  std::vector<double> stations;
  std::vector<std::string> station_names;
  /// z, rising.
  std::vector<double> waterlines;
  /// waterlines x stations; NaN where a waterline does not reach the station.
  Eigen::MatrixXd half_breadths;
  /// 2 x stations, half-breadth and height: where a section begins (half-breadth > 0: the edge of a flat of bottom) and
  /// ends. A NaN height: the section begins (ends) with its lowest (highest) half-breadth. May be empty.
  Points<2> keel;
  Points<2> deck;
  /// The sections leave the flat of bottom along it, without an edge.
  bool has_tangent_bottom = false;
  /// Contours in the centre plane, x and z, from the keel upwards, ahead of (abaft) all stations. May be empty: the
  /// hull ends with its last station then.
  Points<2> stem;
  Points<2> stern;
  /// The contour of a bulb, x and z, from its keel around the nose to its top, ahead of all stations. May be empty.
  /// Where there is a bulb, the stem begins at the notch above it, and the stations ahead of the notch
  /// (is_bulb_station()) are sections of the bulb alone: closed in the centre plane at their keel and deck.
  Points<2> bulb;
  /// Each from the first to the last station, in any order. Where there are contours the line ends on them at
  /// the contour's point of the same place in the list of knuckles: `stem_knuckles` and `stern_knuckles` hold these
  /// columns.
  std::vector<KnuckleLine> knuckles;
  std::vector<int> stem_knuckles;
  std::vector<int> stern_knuckles;
  /// Of the sections up to the design draught over the largest, as published beside the offsets; empty: not known.
  std::vector<double> area_ratios;
};

/// Whether the station cuts the bulb, ahead of the stem's first point.
bool is_bulb_station(const OffsetTable& table, Eigen::Index station);

/// Throws GeometryError naming the table and the station or waterline: counts that contradict each other, numbers that
/// are not finite, lengths that are not positive, stations or waterlines that do not rise, negative half-breadths,
/// contours that reach the stations, a bulb without a stem above it.
void check(const OffsetTable& table);

/// A transverse section of a hull, or its stem or stern contour, as points from the keel to the deck.
struct HullSection {
  /// "station 3", "stem", "stern", "bulb".
  std::string name;
  /// 3 x n.
  Points<3> points;
  /// Columns: 0, the knuckles in the order in which the section meets them, the last one.
  std::vector<int> ends;
  /// For each point which line of the table it lies on: the same number on two sections, the same line; -1: none.
  std::vector<int> lines;
  /// Leaves a flat of bottom along it.
  bool is_level_at_keel = false;
  /// The contour of stem, stern or bulb.
  bool is_contour = false;
  /// A section of the bulb ahead of the stem, or its contour.
  bool is_in_bulb = false;
};

/// The sections from aft forward, with the contours where the table has them; with a bulb the stem follows the last
/// station abaft of the notch, then come the bulb's stations and its contour. Throws GeometryError as check() does, and
/// for a section of fewer than two points, a knuckle at the height of a waterline with another half-breadth, knuckles
/// that the sections meet in different orders, and sections between the ends without thickness, those
/// of a bulb that do not end in the centre plane.
std::vector<HullSection> hull_sections(const OffsetTable& table);

/// All coordinates times the factors, about the origin.
OffsetTable scaled(const OffsetTable& table, const Vector3& factors);

}  // namespace isorim::geometry
