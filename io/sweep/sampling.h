#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "io/sweep/sweep_keys.h"

/// Values of ranges and samples, the same bits on every machine: made by correctly rounded operations alone (no exp or
/// pow, whose last digits differ between libraries), and by a generator of our own.
namespace isorim::io {

/// Random numbers by SplitMix64 (G. Steele, D. Lea, C. Flood, "Fast splittable pseudorandom number generators", OOPSLA
/// 2014).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next();
  /// In [0, 1), a multiple of 2^-53.
  double fraction();
  /// In [0, count), each equally likely.
  std::uint64_t below(std::uint64_t count);

 private:
  std::uint64_t state_;
};

/// A Latin hypercube sample (M. McKay, R. Beckman, W. Conover, Technometrics 21, 1979): `dimensions` lists of `samples`
/// numbers in [0, 1), of which each interval [i / samples, (i + 1) / samples) holds one; the intervals of a sample are
/// drawn independently for each dimension. A further dimension leaves those before it as they are.
std::vector<std::vector<double>> latin_hypercube(std::size_t samples, std::size_t dimensions, std::uint64_t seed);

/// The number at `fraction` in [0, 1] of the way from one end of a range to the other, by differences or by ratios
/// (both ends positive then), rounded to 12 significant digits; the ends exactly. Lies between the ends.
double range_value(double from, double to, Spacing spacing, double fraction);

}  // namespace isorim::io
