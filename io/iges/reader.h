#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "io/cad/cad_model.h"
#include "io/iges/file.h"

namespace isorim::io {

struct IgesOptions {
  /// Take entities that the file marks as blanked (invisible) too. Most are construction geometry, or an older state.
  bool include_blanked = false;
  /// Leave out faces and curves that cannot be read, with a warning each, instead of refusing the file. What is left is
  /// then not the part that the file describes.
  bool skip_bad_entities = false;
  /// How far what has no rational form may lie from its approximation, relative to the size of the entity.
  double tolerance = 1e-11;
  /// How many numbers the entities may amount to when all their uses are written out (those of subfigures above all):
  /// against files that would grow without bound. 0: 10 million, or 50 times what the file holds if that is more.
  std::size_t largest_size = 0;
};

/// The faces and curves of an IGES file, placed but not healed: B-splines arrive as written (knots and weights bit for
/// bit, points to the rounding of their product with the weight), all other entities as the NURBS that are the same to
/// rounding. What has no rational form is approximated, and listed.
///
/// T-splines as our writer puts them (t_splines.h) come as such, unless their surfaces have been edited since, which a
/// warning tells.
///
/// Solids (186), trimmed and bounded surfaces (144, 143), loose shells and faces (514, 510), bounded planes (108),
/// surfaces that no face uses, curves that nothing uses, points (116), and all of them in subfigures (308, 408). What
/// is blanked, what depends on something that is not there, and types that this program does not know are left out and
/// told.
///
/// Throws InputError if the file cannot be read, naming file, entity ("142 at D35") and what is wrong; and if it holds
/// nothing that could be read.
CadModel read_iges(const std::filesystem::path& path, const IgesOptions& options = {});
/// The same for a file that has been through the lexical layer.
CadModel read_iges(const iges::File& file, const IgesOptions& options = {});

}  // namespace isorim::io
