#include <array>
#include <cmath>
#include <numbers>

#include "io/drawing/dxf_writer.h"

/// colour_index() of dxf_writer.h.
namespace isorim::io::drawing {

namespace {

using Rgb = std::array<double, 3>;

/// 24 hues 15 degrees apart, each in five shades, full and half as vivid.
Rgb hue_colour(int index) {
  constexpr std::array shades{1.0, 0.65, 0.5, 0.3, 0.15};
  const int hue = (index - 10) / 10;
  const double sector = 0.25 * hue;
  const double shade = shades[static_cast<std::size_t>(index % 10 / 2)];
  const double paleness = index % 2 == 1 ? 0.5 : 0.0;
  const auto channel = [&](double centre) {
    const double away = std::abs(std::remainder(sector - centre, 6.0));
    const double full = away <= 1.0 ? 1.0 : away >= 2.0 ? 0.0 : 2.0 - away;
    return 255.0 * shade * (paleness + (1.0 - paleness) * full);
  };
  return {channel(0.0), channel(2.0), channel(4.0)};
}

Rgb indexed_colour(int index) {
  constexpr std::array<Rgb, 10> basic{{{0, 0, 0},
                                       {255, 0, 0},
                                       {255, 255, 0},
                                       {0, 255, 0},
                                       {0, 255, 255},
                                       {0, 0, 255},
                                       {255, 0, 255},
                                       {0, 0, 0},
                                       {128, 128, 128},
                                       {192, 192, 192}}};
  constexpr std::array<double, 6> greys{51, 91, 132, 173, 214, 255};
  if (index < 10) return basic[static_cast<std::size_t>(index)];
  if (index < 250) return hue_colour(index);
  const double grey = greys[static_cast<std::size_t>(index - 250)];
  return {grey, grey, grey};
}

}  // namespace

int colour_index(const Colour& colour) {
  int best = 7;
  double least = INFINITY;
  for (int index = 1; index < 256; ++index) {
    const Rgb candidate = indexed_colour(index);
    const double distance =
        std::hypot(candidate[0] - colour.red, candidate[1] - colour.green, candidate[2] - colour.blue);
    if (distance < least) {
      least = distance;
      best = index;
    }
  }
  return best;
}

}  // namespace isorim::io::drawing
