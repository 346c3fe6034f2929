#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/tspline/extracted_surface.h"
#include "io/cad/cad_model.h"
#include "io/iges/entity_list.h"
#include "io/iges/faces.h"

/// T-splines in IGES files, which have no entity for them.
///
/// Other programs see the Bézier elements: a B-spline surface (128) each, in an ordered group (402 form 15) in the
/// order of the elements. Among the group's properties are its name (406 form 15) and one 406 form 27 named "T-spline"
/// whose values are strings alone, since programs that rewrite files round numbers: format and version, the digest of
/// the rest, and the lines of the surface as `.iga` text (tspline::iga_text()).
namespace isorim::io::iges {

/// The property's record, which is complete.
Record t_spline_property(const geometry::ExtractedSurface& surface);

/// FNV-1a of 64 bits (Fowler, Noll and Vo): against accidents, not against forgers.
std::uint64_t digest_of(std::string_view text);

/// A group that stands for a T-spline.
struct TSplineGroup {
  CadTSpline t_spline;
  /// D numbers of its surfaces, which are not to be read besides.
  std::vector<int> members;
};

/// The T-spline that a group (402) stands for; empty if it is another group, or if its surfaces are no longer those of
/// the T-spline or the property is damaged, which is remarked: its surfaces count then. They are compared with the
/// T-spline's elements within the file's resolution (kept between 1e-12 and 1e-6 of the size).
std::optional<TSplineGroup> t_spline_group(EntityReader& reader, FaceReader& faces, const Entity& group);

}  // namespace isorim::io::iges
