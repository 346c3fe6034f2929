#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "geometry/boundary.h"
#include "geometry/intersection/plane_section.h"
#include "io/case/case_file.h"
#include "io/results/report.h"
#include "solver/plane_sections.h"

/// The plane sections that a case asks for: [[section]].
namespace isorim::io {

/// One family of parallel planes.
struct SectionFamily {
  std::string name;
  /// Of each plane, along the normal.
  std::vector<double> offsets;
  std::vector<geometry::PlaneFrame> planes;
  std::vector<solver::MeasuredSection> sections;
  /// Diagonal of the boundary's box.
  double size = 0.0;
  /// Of the boundary's patches.
  std::vector<std::string> patch_names;
  /// Units of the shape; empty if unknown.
  std::string unit;
};

/// Cuts an oriented boundary by all planes of the case. `largest_gap`: of its edges; up to twice this gaps are bridged.
std::vector<SectionFamily> cut_sections(const CaseFile& file, const geometry::Boundary<3>& boundary, double largest_gap,
                                        const std::function<void(double)>& progress, int threads);

/// "NAME.area", "NAME.perimeter", "NAME.loops", ...: one value a plane (section_quantity_names()).
std::vector<Quantity> section_quantities(const std::vector<SectionFamily>& families);

/// What a user should know: planes that failed, and what their messages say, with family and offset.
std::vector<std::string> section_warnings(const std::vector<SectionFamily>& families);

/// The lines about the sections in the terminal's table: one a plane.
std::string sections_text(const std::vector<SectionFamily>& families);

/// Writes, for each family, into the folder:
/// section_NAME.csv: points of all curves, with patch and parameters, tangents and plane coordinates;
/// section_NAME.vtu (if `output.vtk`): the fitted curves as Bézier cells, with offset and kind;
/// section_NAME.igs: the fitted curves in space as IGES 126;
/// section_NAME.svg (if `output.svg`): all planes on top of each other, true to scale; of up to 40 planes also each by
/// itself, section_NAME_1.svg, ...
void write_sections(const std::filesystem::path& folder, const std::vector<SectionFamily>& families,
                    const OutputKeys& output);

}  // namespace isorim::io
