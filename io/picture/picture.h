#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/picture/views.h"

/// Pictures of what isorim writes, drawn by VTK without a display: exact rational Bézier cells, facets, lines, points
/// and images, seen from several sides, plain, by patch or coloured by a field.
namespace isorim::io::picture {

/// Components in [0, 1].
using Colour = std::array<double, 3>;

/// "#rrggbb", "#rgb", or one of black, white, grey. Throws InputError for another text.
Colour colour_from(const std::string& text);

enum class Lines {
  /// The borders of elements.
  elements,
  none,
};

enum class ColourMap {
  /// Perceptually uniform, readable in grey and to the colour-blind (van der Walt & Smith 2015).
  viridis,
  /// Blue, white, red (Moreland 2009): for what is told apart by its sign.
  coolwarm,
  grey,
};

/// What faces are coloured by where no field is shown.
enum class FaceColours {
  /// One colour a patch if there are several, as the file of a CAD model says if it tells colours.
  automatic,
  plain,
  patch,
};

struct FieldChoice {
  std::string name;
  /// "magnitude", a name of a component ("x", "xx", ...) or its number from 0. Needed where the field is a tensor;
  /// vectors are shown by their magnitude without it.
  std::string component;
  /// Ends of the colour map; those of the values shown if absent.
  std::optional<std::array<double, 2>> range;
  ColourMap map = ColourMap::viridis;
};

struct PictureOptions {
  /// Pixels.
  int width = 1200;
  int height = 900;
  /// One or more; several make a sheet of one scale. Empty: iso, or front for what lies in the plane z = 0.
  std::vector<View> views;
  std::optional<FieldChoice> field;
  FaceColours colours = FaceColours::automatic;
  Lines lines = Lines::elements;
  Colour background{1.0, 1.0, 1.0};
  /// No background at all (the PNG's alpha).
  bool transparent = false;
};

/// A file to draw, and what messages call it.
struct PictureInput {
  std::filesystem::path file;
  std::string label;
};

/// Draws the files into one PNG. Inputs: .vtu (Bézier curves and quadrilaterals, lines, facets), .vtp, .vti.
///
/// Bézier cells are evaluated, not approximated by VTK's subdivision: no chord is farther from the curve or surface
/// than a fifth of a pixel, about, and normals are those of the surface. Fields on them are evaluated in the cells'
/// rational bases. The drawing fills the picture but for a margin of 4 %, in parallel projection; the same scale in
/// all views.
///
/// Throws InputError with the label for what cannot be read or drawn, holds nothing, or for a field that none of the
/// files has (with a list of those that they have); NumericalError if the machine has no way to draw.
void draw_picture(const std::vector<PictureInput>& inputs, const PictureOptions& options,
                  const std::filesystem::path& output);

/// Throws InputError for options, or the name of a picture, that draw_picture() would refuse whatever it draws.
void check_options(const PictureOptions& options, const std::filesystem::path& output);

/// Whether a file has a field of the name. Errors as above.
bool has_field(const std::filesystem::path& file, const std::string& name);

}  // namespace isorim::io::picture
