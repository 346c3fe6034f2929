#pragma once

#include <optional>

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include "io/picture/shown_field.h"

class vtkDataSet;

namespace isorim::io::picture {

/// A data set as what a renderer draws. Point data: `shown`, the field (NaN where there is none), and of faces
/// `Normals`. Cell data of faces: `patch`, and `colour` (red, green, blue in [0, 1]) if the data set has it.
struct Drawable {
  /// Triangles and polygons, counter-clockwise seen from outside.
  vtkSmartPointer<vtkPolyData> faces;
  /// The borders of elements.
  vtkSmartPointer<vtkPolyData> borders;
  /// Cells that are curves, in the order of their parameter.
  vtkSmartPointer<vtkPolyData> curves;
  vtkSmartPointer<vtkPolyData> points;
  bool has_field = false;
};

/// Bézier cells are evaluated so finely that no chord is farther from them than about `chord_tolerance`; facets get
/// normals that are smooth where they turn by less than 30 degrees. Throws InputError for cells of other kinds: those
/// that fill space, and non-linear ones besides Bézier curves and quadrilaterals.
Drawable make_drawable(vtkDataSet* data, const std::optional<ShownField>& field, double chord_tolerance);

/// The region that closed curves in a plane z = const enclose (even-odd rule; they may touch), as faces with `Normals`
/// along z. Empty where the curves are not in such a plane; nothing where an odd number of them is met, at heights at
/// which a curve is open.
vtkSmartPointer<vtkPolyData> filled_region(vtkPolyData* curves);

}  // namespace isorim::io::picture
