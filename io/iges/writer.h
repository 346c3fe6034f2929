#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "geometry/topology/orientation.h"
#include "io/cad/cad_model.h"

/// Boundaries as IGES 5.3 files in fixed form.
namespace isorim::io::iges {

/// What closed shells become.
enum class Form {
  /// A manifold solid (186) for each outer shell and its voids, with shared edges and outward normals.
  solids,
  /// Loose faces (128, 144): nothing says what belongs together nor which side is out.
  faces,
};

/// How a patch looks.
struct Look {
  std::optional<Colour> colour = {};
  int level = 0;
};

struct WriterOptions {
  Form form = Form::solids;
  /// How far the curves in space may lie from the parameter curves' images, relative to the diagonal of the bounding
  /// box. Such a curve is no NURBS in general; readers that go by the parameter curves never see the difference. 1e-8
  /// is what the best CAD kernels ask for.
  double curve_tolerance = 1e-8;
  /// One that IGES has a flag for: in, mm, ft, mi, m, km, mil, um, cm, uin. "" and "?" are written as mm.
  std::string unit = "mm";
  /// Name of the part, also in the start section.
  std::string title = {};
  /// YYYYMMDD.HHMMSS; empty: now.
  std::string date = {};
  /// One a patch, or none.
  std::vector<Look> looks = {};
};

struct WriterReport {
  int solids = 0;
  /// Faces of solids, and loose ones.
  int solid_faces = 0;
  int loose_faces = 0;
  /// Curves of plane boundaries.
  int curves = 0;
  /// In the units of the shape: to which curves in space were fitted where they have no exact form.
  double curve_tolerance = 0.0;
};

/// Writes a boundary in space, atomically. Open shells, and those with a T-spline, are written as faces whatever the
/// form; a T-spline as t_splines.h says, from which read_iges() gets it back to the last bit.
///
/// Surfaces, and the parameter curves of trimmed ones, keep every bit of their knots and weights, and of their points
/// as nurbs_records.h says; a curve that solids have to cut at a vertex is cut there by knot insertion. Patches carry
/// their names (406 form 15). A trimmed surface whose kept part falls into several pieces becomes a face for each.
///
/// Throws InputError if the file cannot be written or the unit is unknown; GeometryError if the options hold looks for
/// another number of patches, or a coordinate is beyond the range of doubles.
WriterReport write_iges(const std::filesystem::path& path, const geometry::OrientedBoundary<3>& oriented,
                        const WriterOptions& options = {});

/// Writes a boundary in the plane: its curves (126) in z = 0, each loop whose curves all run the same way round as a
/// composite curve (102) of them. `form` and `curve_tolerance` play no part.
WriterReport write_iges(const std::filesystem::path& path, const geometry::OrientedBoundary<2>& oriented,
                        const WriterOptions& options = {});

/// Writes curves in space (126), with a name each or none; a clamped curve keeps every bit, others are clamped.
WriterReport write_iges_curves(const std::filesystem::path& path, std::span<const geometry::NurbsCurve<3>> curves,
                               std::span<const std::string> names = {}, const WriterOptions& options = {});

/// The texts of such files.
struct IgesText {
  std::string text;
  WriterReport report;
};
IgesText iges_text(const geometry::OrientedBoundary<3>& oriented, const WriterOptions& options = {});
IgesText iges_text(const geometry::OrientedBoundary<2>& oriented, const WriterOptions& options = {});

}  // namespace isorim::io::iges
