#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "io/results/compute.h"
#include "io/results/report.h"

/// What `isorim check` tells of a file or case.
namespace isorim::io {

/// Of a T-spline, given by its extraction.
struct InspectedExtraction {
  int functions = 0;
  /// How many live on an element: the numbers that occur, in increasing order.
  std::vector<std::size_t> functions_per_element;
  /// The largest |sum of the functions - 1|, and on how many elements it is more than rounding.
  double partition_defect = 0.0;
  int defective_elements = 0;
  /// Sides of elements that face several others (at T-junctions).
  int hanging_sides = 0;
};

struct InspectedPatch {
  std::string name;
  /// One of a curve, two of a surface: of a T-spline the highest among its elements.
  std::vector<int> degrees;
  int elements = 0;
  int cut_elements = 0;
  bool polynomial = false;
  bool trimmed = false;
  std::optional<InspectedExtraction> extraction;
  /// +1 as the file gives it, -1 reversed.
  int orientation = 1;
  /// Entity, solid, level, colour, repairs, if the patch is from a CAD file.
  std::optional<PatchOrigin> origin;
};

struct InspectedShell {
  bool closed = false;
  bool is_void = false;
  /// Names of its patches.
  std::vector<std::string> patches;
};

/// An edge, or end of a plane curve, that nothing continues.
struct InspectedFreeEdge {
  std::string patch;
  /// "start", "v = first", "loop 2, curve 1", "t = 0 of element 12", ...
  std::string place;
  std::vector<double> from;
  std::vector<double> to;
  /// Of edges: the length; the patch of the free edge that the middle lies nearest to (empty if there is none), and how
  /// far: the size of the gap.
  double length = 0.0;
  std::string nearest;
  double gap = 0.0;
};

struct Inspection {
  std::string title;
  std::optional<CadFacts> cad;
  /// Empty if no boundary could be made; `failure` says why.
  std::optional<GeometrySummary> geometry;
  std::string failure;
  std::vector<InspectedPatch> patches;
  std::vector<InspectedShell> shells;
  std::vector<InspectedFreeEdge> free_edges;
  /// Where the free edges were written; empty if there are none.
  std::string free_edges_file;
};

/// Everything there is to know without integrating over the domain: the boundary's measure is computed roughly, for the
/// closure defect.
Inspection inspect(const CaseFile& file, const AnyModel& model, const RunOptions& options = {});

/// For the terminal. Of long lists the beginning.
std::string inspection_text(const Inspection& inspection);

/// Everything: { "isorim", "case", "geometry", "cad", "patches": [..], "shells": [..], "free_edges": [..] }.
std::string inspection_json(const Inspection& inspection);

}  // namespace isorim::io
