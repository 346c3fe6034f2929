#include "io/iges/parameter_map.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"

namespace isorim::io::iges {

using geometry::Interval;

namespace {

/// A boundary may wind round a closed surface a few times; more is no face.
constexpr double largest_turns = 64.0;

/// The fraction of the piece's image that lies before t, measured from the nearer end.
struct Fraction {
  double value = 0.0;
  bool from_last = false;
};

Fraction fraction(const ParameterMap::Piece& piece, double t) {
  const bool from_last = t > piece.from.middle();
  if (piece.half_rate == 0.0) {
    const double part = from_last ? piece.from.last - t : t - piece.from.first;
    return {part / piece.from.length(), from_last};
  }
  const double first = std::tan(piece.half_rate * (piece.from.first - piece.centre));
  const double last = std::tan(piece.half_rate * (piece.from.last - piece.centre));
  const double here = std::tan(piece.half_rate * (t - piece.centre));
  return {(from_last ? last - here : here - first) / (last - first), from_last};
}

double evaluate(const ParameterMap::Piece& piece, double t) {
  if (piece.half_rate == 0.0 && piece.from.first == piece.to.first && piece.from.last == piece.to.last) return t;
  const Fraction part = fraction(piece, t);
  const double step = part.value * piece.to.length();
  return part.from_last ? piece.to.last - step : piece.to.first + step;
}

double slope(const ParameterMap::Piece& piece, double t) {
  if (piece.half_rate == 0.0) return piece.to.length() / piece.from.length();
  const double first = std::tan(piece.half_rate * (piece.from.first - piece.centre));
  const double last = std::tan(piece.half_rate * (piece.from.last - piece.centre));
  const double cosine = std::cos(piece.half_rate * (t - piece.centre));
  return piece.to.length() * piece.half_rate / ((last - first) * cosine * cosine);
}

const ParameterMap::Piece& piece_at(std::span<const ParameterMap::Piece> pieces, double t) {
  for (const ParameterMap::Piece& piece : pieces.first(pieces.size() - 1))
    if (t < piece.from.last) return piece;
  return pieces.back();
}

}  // namespace

ParameterMap::ParameterMap(std::vector<Piece> pieces, bool periodic) : pieces_(std::move(pieces)), periodic_(periodic) {
  if (pieces_.empty()) throw GeometryError("parameter map: no pieces given");
  for (const Piece& piece : pieces_)
    if (!(piece.from.length() > 0.0 && piece.to.length() > 0.0 && std::isfinite(piece.from.length())))
      throw GeometryError("parameter map: a piece has no length");
}

ParameterMap ParameterMap::affine(Interval from, Interval to) {
  return ParameterMap({Piece{.from = from, .to = to, .half_rate = 0.0, .centre = 0.0}});
}

ParameterMap ParameterMap::arc(Interval angles, int pieces, double radians, bool periodic) {
  std::vector<Piece> result;
  const double step = angles.length() / pieces;
  for (int i = 0; i < pieces; ++i) {
    Piece piece;
    piece.from = {i == 0 ? angles.first : result.back().from.last,
                  i + 1 == pieces ? angles.last : angles.first + (i + 1) * step};
    piece.to = {static_cast<double>(i) / pieces, static_cast<double>(i + 1) / pieces};
    piece.half_rate = 0.5 * radians;
    piece.centre = piece.from.middle();
    result.push_back(piece);
  }
  return ParameterMap(std::move(result), periodic);
}

double ParameterMap::inside(double t) const {
  return evaluate(piece_at(pieces_, t), t);
}

double ParameterMap::operator()(double t) const {
  if (pieces_.empty()) return t;
  const Interval range = domain();
  if (range.contains(t)) return inside(t);
  if (periodic_) {
    const double turns = std::floor((t - range.first) / range.length());
    const double rest = std::clamp(t - turns * range.length(), range.first, range.last);
    return inside(rest) + turns * image().length();
  }
  if (t < range.first) return image().first + slope(pieces_.front(), range.first) * (t - range.first);
  return image().last + slope(pieces_.back(), range.last) * (t - range.last);
}

double ParameterMap::derivative(double t) const {
  if (pieces_.empty()) return 1.0;
  const Interval range = domain();
  if (!range.contains(t) && periodic_) t -= std::floor((t - range.first) / range.length()) * range.length();
  t = std::clamp(t, range.first, range.last);
  return slope(piece_at(pieces_, t), t);
}

bool ParameterMap::is_affine() const {
  return pieces_.empty() || (pieces_.size() == 1 && pieces_.front().half_rate == 0.0);
}

std::optional<double> ParameterMap::period() const {
  if (!periodic_) return std::nullopt;
  return domain().length();
}

std::vector<double> ParameterMap::breakpoints(Interval range) const {
  std::vector<double> result;
  if (is_affine()) return result;
  const Interval own = domain();
  const double first_turn = periodic_ ? std::floor((range.first - own.first) / own.length()) : 0.0;
  const double last_turn = periodic_ ? std::floor((range.last - own.first) / own.length()) : 0.0;
  const auto add = [&](double t) {
    if (range.first < t && t < range.last) result.push_back(t);
  };
  if (!(last_turn - first_turn <= largest_turns))
    throw GeometryError(
        fmt::format("parameters from {} to {} go on for more than {} turns", range.first, range.last, largest_turns));
  for (double turn = first_turn; turn <= last_turn; ++turn) {
    for (const Piece& piece : pieces_) add(piece.from.first + turn * own.length());
    if (!periodic_) add(own.last);
  }
  return result;
}

ParameterMap ParameterMap::shifted(double by) const {
  ParameterMap result = *this;
  for (Piece& piece : result.pieces_) {
    piece.from = {piece.from.first - by, piece.from.last - by};
    piece.centre -= by;
  }
  return result;
}

ParameterMap ParameterMap::over(Interval target) const {
  if (pieces_.empty()) throw GeometryError("parameter map: the identity has no domain that could be moved");
  const Interval own = domain();
  const double scale = target.length() / own.length();
  const auto moved = [&](double t) {
    if (t == own.first) return target.first;
    if (t == own.last) return target.last;
    return target.first + (t - own.first) * scale;
  };
  ParameterMap result = *this;
  for (Piece& piece : result.pieces_) {
    piece.from = {moved(piece.from.first), moved(piece.from.last)};
    piece.centre = moved(piece.centre);
    piece.half_rate /= scale;
  }
  return result;
}

}  // namespace isorim::io::iges
