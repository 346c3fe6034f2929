#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/drawing/drawing.h"

/// Drawings to test the writers with, and other people's programs to read what they write.
namespace isorim::io::drawing {

/// Curves of every kind: a straight line, a parabola, a cubic B-spline with an inner knot, a rational circle, a
/// rational curve of degree 5 and a polynomial one of degree 12; in mm, within (0, 0) and (200, 150).
std::vector<geometry::NurbsCurve<2>> sample_curves();

/// Each of them as a path on the layer "curves", 0.35 mm wide.
Drawing curves_drawing();

/// The largest distance between two curves, from 400 points of each to the nearest of the other.
double distance(const geometry::NurbsCurve<2>& a, const geometry::NurbsCurve<2>& b);

/// What a command prints, or an empty text where it fails or its program is missing.
std::string output_of(const std::string& command);
bool has_program(const std::string& name);

/// 8 bits a pixel, 0 black, from the top.
struct GreyImage {
  int width = 0;
  int height = 0;
  std::string pixels;

  int at(int x, int y) const { return static_cast<unsigned char>(pixels.at(static_cast<std::size_t>(y * width + x))); }
  /// Some pixel at most one away is darker than `level`.
  bool is_dark_near(int x, int y, int level) const;
};

/// The pages of a PDF file at 10 pixels a millimetre, by poppler's pdftoppm.
std::vector<GreyImage> render(const std::filesystem::path& pdf);

}  // namespace isorim::io::drawing
