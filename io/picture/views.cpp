#include "io/picture/views.h"

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/case/complaints.h"

namespace isorim::io::picture {
namespace {

/// azimuth and elevation in degrees.
View view_at(std::string name, double azimuth, double elevation) {
  const double a = azimuth * std::numbers::pi / 180.0;
  const double e = elevation * std::numbers::pi / 180.0;
  // Straight up and down azimuth turns the picture: up is the limit.
  return {.name = std::move(name),
          .towards_eye = {std::cos(e) * std::sin(a), -std::cos(e) * std::cos(a), std::sin(e)},
          .up = {-std::sin(e) * std::sin(a), std::sin(e) * std::cos(a), std::cos(e)}};
}

struct Standard {
  const char* name;
  double azimuth;
  double elevation;
};

/// atan(1 / sqrt 2): the three axes are foreshortened alike.
constexpr double isometric = 35.26438968275465;
constexpr std::array<Standard, 8> standard_views{{{"iso", 45.0, isometric},
                                                  {"iso_back", 225.0, isometric},
                                                  {"front", 0.0, 0.0},
                                                  {"back", 180.0, 0.0},
                                                  {"left", -90.0, 0.0},
                                                  {"right", 90.0, 0.0},
                                                  {"top", 0.0, 90.0},
                                                  {"bottom", 0.0, -90.0}}};

/// Whether the whole text is a finite number.
bool read(std::string_view text, double& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
}

std::optional<View> view_by_angles(const std::string& text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos) return std::nullopt;
  double azimuth = 0.0;
  double elevation = 0.0;
  const std::string_view whole = text;
  if (!read(whole.substr(0, comma), azimuth) || !read(whole.substr(comma + 1), elevation)) return std::nullopt;
  if (std::abs(elevation) > 90.0) {
    throw InputError(fmt::format("found the view \"{}\"; expected an elevation between -90 and 90 degrees", text));
  }
  return view_at(text, azimuth, elevation);
}

}  // namespace

Eigen::Vector3d View::right() const {
  return up.cross(towards_eye);
}

std::vector<View> views_from(const std::string& text) {
  if (text == "all") {
    std::vector<View> all;
    for (const char* name : {"iso", "front", "top", "left"}) all.push_back(views_from(name).front());
    return all;
  }
  std::vector<std::string> names{"all"};
  for (const Standard& standard : standard_views) {
    if (text == standard.name) return {view_at(text, standard.azimuth, standard.elevation)};
    names.emplace_back(standard.name);
  }
  if (const std::optional<View> view = view_by_angles(text)) return {*view};
  throw InputError(fmt::format("found the view \"{}\"{}; expected one of {}, or \"azimuth,elevation\" in degrees", text,
                               did_you_mean(text, names), fmt::join(names, ", ")));
}

View plane_view() {
  return view_at("plane", 0.0, 90.0);
}

}  // namespace isorim::io::picture
