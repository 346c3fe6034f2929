#include "io/sweep/sampling.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <string>

#include <fmt/format.h>

namespace isorim::io {
namespace {

double rounded(double value) {
  const std::string text = fmt::format("{:.11e}", value);
  double result = value;
  std::from_chars(text.data(), text.data() + text.size(), result);
  return result;
}

/// from (to / from)^fraction by square roots, which IEEE 754 rounds alike everywhere; pow it does not. Relative error
/// below 1e-14. Neither the ratio nor its powers are formed, which may overflow.
double geometric(double from, double to, double fraction) {
  double result = from;
  double rest = 2.0 * fraction;
  double factor = std::sqrt(to) / std::sqrt(from);
  for (int bit = 0; bit < 60 && rest > 0.0; ++bit) {
    if (rest >= 1.0) {
      result *= factor;
      rest -= 1.0;
    }
    rest *= 2.0;
    factor = std::sqrt(factor);
  }
  return result;
}

}  // namespace

std::uint64_t Random::next() {
  state_ += 0x9e3779b97f4a7c15U;
  std::uint64_t z = state_;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31U);
}

double Random::fraction() {
  return static_cast<double>(next() >> 11U) * 0x1p-53;
}

std::uint64_t Random::below(std::uint64_t count) {
  // The numbers below 2^64 mod count are one too many for an even share.
  const std::uint64_t least = (0 - count) % count;
  std::uint64_t drawn = next();
  while (drawn < least) drawn = next();
  return drawn % count;
}

std::vector<std::vector<double>> latin_hypercube(std::size_t samples, std::size_t dimensions, std::uint64_t seed) {
  Random random(seed);
  std::vector<std::vector<double>> result;
  std::vector<std::size_t> strata(samples);
  for (std::size_t d = 0; d < dimensions; ++d) {
    std::iota(strata.begin(), strata.end(), std::size_t{0});
    for (std::size_t i = samples; i > 1; --i) std::swap(strata[i - 1], strata[random.below(i)]);
    std::vector<double>& column = result.emplace_back();
    for (const std::size_t stratum : strata) {
      const double low = static_cast<double>(stratum) / static_cast<double>(samples);
      const double high = static_cast<double>(stratum + 1) / static_cast<double>(samples);
      const double value = (static_cast<double>(stratum) + random.fraction()) / static_cast<double>(samples);
      column.push_back(std::clamp(value, low, std::nextafter(high, 0.0)));
    }
  }
  return result;
}

double range_value(double from, double to, Spacing spacing, double fraction) {
  if (fraction <= 0.0) return from;
  if (fraction >= 1.0) return to;
  // fma, so that no compiler's choice of fusing matters.
  const double value = spacing == Spacing::linear ? std::fma(to - from, fraction, from) : geometric(from, to, fraction);
  return std::clamp(rounded(value), std::min(from, to), std::max(from, to));
}

}  // namespace isorim::io
