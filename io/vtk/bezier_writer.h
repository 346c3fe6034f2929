#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "geometry/bezier/element_table.h"
#include "geometry/nurbs/curve.h"

/// Exact shapes for ParaView: XML files (.vtu) of rational Bézier cells, VTK_BEZIER_CURVE (75) and
/// VTK_BEZIER_QUADRILATERAL (77). No cell shares a point with another one, since weights may differ where elements
/// meet. Points are Cartesian (not multiplied by their weights); the weights are the point data's attribute
/// RationalWeights, the degrees (p, q, 0) the cell data's attribute HigherOrderDegrees. All reals are stored as
/// doubles, bit for bit.
///
/// What is left of a cut element is written as flat triangles with their vertices exactly on the surface (see
/// region_triangles.h); whole elements stay exact.
///
/// Each cell also carries `patch`, `element` (its index in the table) and `orientation`. The cell of an element with
/// orientation -1 is written with its first parameter reversed, s -> 1 - s, so that the natural normal of every cell
/// in the file is the outward one, which is what VTK shades; `orientation` keeps the value of the table. The names of
/// the patches are the field data `patch_names`.
///
/// ParaView draws the exact shape when its Nonlinear Subdivision Level is raised to 3 or 4 (the default is 1).
namespace isorim::io {

/// Values for the points or for the cells of a file.
struct VtuField {
  std::string name;
  int components = 1;
  /// components x n, column-major. Point fields: n is the number of all control points, element by element in the
  /// order of the table, each in the order of its net; the values are control values in the element's own rational
  /// basis (sum of N_i w_i f_i / sum of N_i w_i), not values at the control points; vertices of triangles get the
  /// values of that field. Cell fields: n is the number of elements; the triangles of one share its value.
  std::span<const double> values;
};

/// What goes into the file besides the shape. Views: the caller keeps the data.
struct VtuContent {
  /// One a patch, or none.
  std::span<const std::string> patch_names;
  std::vector<VtuField> point_fields;
  std::vector<VtuField> cell_fields = {};
  /// How far the triangles of cut elements may be from the surface, relative to the diagonal of the bounding box.
  double chord_tolerance = 2e-4;
};

/// Writes the curves (Dim = 2, with z = 0) or surfaces (Dim = 3) of a boundary, of any mixture of degrees.
///
/// The file appears whole or not at all. Throws InputError with the path if it cannot be written or if a field has the
/// wrong number of values or a name that is taken.
template <int Dim>
void write_vtu(const std::filesystem::path& path, const geometry::ElementTable<Dim>& table,
               const VtuContent& content = {});

/// Writes curves alone, for example edges or free edges: one cell a Bézier segment, `patch` being the index of the
/// curve and `element` that of the segment within it. `names`: one a curve, or none; `fields`: components x number of
/// curves, for all cells of each. Errors as for write_vtu.
template <int Dim>
void write_curves_vtu(const std::filesystem::path& path, std::span<const geometry::NurbsCurve<Dim>> curves,
                      std::span<const std::string> names = {}, std::span<const VtuField> fields = {});

}  // namespace isorim::io
