#include "tests/io/drawing/samples.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <sstream>

#include <fmt/format.h>

#include "geometry/shapes/curves.h"

namespace isorim::io::drawing {

namespace {

using geometry::KnotVector;
using geometry::NurbsCurve;
using geometry::Points;

/// Points on a wave from the left to the right.
Points<2> wave(int count, double height) {
  Points<2> points(2, count);
  for (int i = 0; i < count; ++i) points.col(i) << 10.0 + 180.0 * i / (count - 1), height + (i % 2 == 0 ? -9.0 : 9.0);
  return points;
}

double one_way(const NurbsCurve<2>& from, const NurbsCurve<2>& to) {
  double largest = 0.0;
  const geometry::Interval domain = from.domain();
  for (int k = 0; k <= 400; ++k) {
    const geometry::Point2 point = evaluate(from, domain.first + domain.length() * k / 400.0);
    largest = std::max(largest, closest_point(to, point).distance);
  }
  return largest;
}

}  // namespace

std::vector<NurbsCurve<2>> sample_curves() {
  const std::vector<double> inner{0.0, 0.3, 0.3, 0.7, 1.0};
  const std::vector<double> weights{1.0, 0.5, 2.0, 1.0, 3.0, 1.0};
  return {NurbsCurve<2>::from_points(KnotVector::bezier(1), wave(2, 12.0)),
          NurbsCurve<2>::from_points(KnotVector::bezier(2), wave(3, 30.0)),
          NurbsCurve<2>::from_points(KnotVector::clamped(3, inner), wave(7, 50.0)),
          geometry::circle_curve(17.0, {160.0, 125.0}),
          NurbsCurve<2>::from_points(KnotVector::bezier(5), wave(6, 75.0), weights),
          NurbsCurve<2>::from_points(KnotVector::bezier(12), wave(13, 100.0))};
}

Drawing curves_drawing() {
  Drawing drawing;
  const std::size_t layer = drawing.add_layer({"curves", black, 0.35});
  for (const auto& curve : sample_curves()) drawing.add(layer, Path{{curve}});
  return drawing;
}

double distance(const NurbsCurve<2>& a, const NurbsCurve<2>& b) {
  return std::max(one_way(a, b), one_way(b, a));
}

std::string output_of(const std::string& command) {
  FILE* pipe = popen((command + " 2>/dev/null").c_str(), "r");
  if (pipe == nullptr) return "";
  std::string text;
  std::array<char, 4096> buffer{};
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe)) text.append(buffer.data(), count);
  return pclose(pipe) == 0 ? text : "";
}

bool has_program(const std::string& name) {
  return !output_of("command -v " + name).empty();
}

bool GreyImage::is_dark_near(int x, int y, int level) const {
  for (int i = std::max(0, x - 1); i <= std::min(width - 1, x + 1); ++i) {
    for (int j = std::max(0, y - 1); j <= std::min(height - 1, y + 1); ++j) {
      if (at(i, j) < level) return true;
    }
  }
  return false;
}

std::vector<GreyImage> render(const std::filesystem::path& pdf) {
  const std::string all = output_of(fmt::format("pdftoppm -r 254 -gray '{}' && echo end", pdf.string()));
  std::vector<GreyImage> images;
  std::istringstream stream(all);
  for (std::string magic; stream >> magic && magic == "P5";) {
    GreyImage image;
    int largest = 0;
    stream >> image.width >> image.height >> largest;
    stream.get();
    image.pixels.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
    stream.read(image.pixels.data(), static_cast<std::streamsize>(image.pixels.size()));
    images.push_back(std::move(image));
  }
  return images;
}

}  // namespace isorim::io::drawing
