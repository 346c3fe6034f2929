#include "io/svg/axis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

namespace isorim::io::svg {

namespace {

/// Ticks and range ends may miss each other by rounding.
constexpr double slack = 1e-9;

/// U+2212 in place of the hyphen.
std::string with_minus_sign(std::string text) {
  if (!text.empty() && text.front() == '-') text.replace(0, 1, "\u2212");
  return text;
}

/// mantissa 10^exponent; 10^exponent alone where the mantissa is 1.
Label power_label(double mantissa, int exponent) {
  const std::string power = with_minus_sign(fmt::format("{}", exponent));
  if (mantissa == 1.0) return {"10", power};
  return {with_minus_sign(number(mantissa, 9)) + "\u00d710", power};
}

/// The largest power of ten not above |value|.
int decade(double value) {
  return static_cast<int>(std::floor(std::log10(std::abs(value)) + slack));
}

/// 1, 2 or 5 times a power of ten: the smallest step that cuts `length` into at most `most` pieces.
struct Step {
  int mantissa = 1;
  int exponent = 0;

  double value() const { return multiple(1.0); }
  /// count * step, correctly rounded where the step is a decimal fraction.
  double multiple(double count) const {
    const double power = std::pow(10.0, std::abs(exponent));
    return exponent < 0 ? count * mantissa / power : count * mantissa * power;
  }
};

Step linear_step(double length, int most) {
  const double least = length / most;
  Step step{1, decade(least)};
  for (const int mantissa : {1, 2, 5}) {
    step.mantissa = mantissa;
    if (step.value() >= least * (1.0 - slack)) return step;
  }
  return {1, step.exponent + 1};
}

std::vector<Tick> linear_ticks(double first, double last, int most) {
  const Step step = linear_step(last - first, most);
  const double largest = std::max(std::abs(first), std::abs(last));
  const bool plain = step.exponent >= -5 && largest < 1e6;
  std::vector<Tick> result;
  const double end = std::floor(last / step.value() + slack);
  for (double i = std::ceil(first / step.value() - slack); i <= end; ++i) {
    const double value = step.multiple(i);
    Label label{with_minus_sign(number(value, std::max(0, -step.exponent))), ""};
    if (!plain && value != 0.0) {
      const int exponent = decade(largest);
      label = power_label(step.multiple(i) / std::pow(10.0, exponent), exponent);
    }
    result.push_back({value, label});
  }
  return result;
}

/// The mantissas that a logarithmic axis of this length labels; decades alone from two decades on.
bool is_short(double first, double last) {
  return std::log10(last / first) < 2.0 - slack;
}

Label logarithmic_label(int mantissa, int exponent, bool plain) {
  if (!plain) return power_label(mantissa, exponent);
  return {number(mantissa * std::pow(10.0, exponent), 4), ""};
}

/// Adds mantissa * 10^exponent if it lies in the range.
template <class Add>
void visit_in_range(const AxisRange& range, int mantissa, int exponent, const Add& add) {
  const double value = Step{mantissa, exponent}.value();
  if (value >= range.first * (1.0 - slack) && value <= range.last * (1.0 + slack)) add(value);
}

Ticks logarithmic_ticks(const AxisRange& range, int most) {
  const int low = decade(range.first);
  const int high = decade(range.last);
  const bool plain = low >= -3 && high <= 4;
  const bool with_mantissas = is_short(range.first, range.last);
  constexpr std::array strides{1, 2, 3, 4, 5, 10, 20, 30, 50, 100};
  const auto stride =
      *std::find_if(strides.begin(), strides.end() - 1, [&](int n) { return (high - low) / n + 1 <= most; });
  Ticks result;
  for (int exponent = low; exponent <= high; ++exponent) {
    for (int mantissa = 1; mantissa <= 9; ++mantissa) {
      const bool is_decade = mantissa == 1 && exponent % stride == 0;
      const bool is_labelled = is_decade || (with_mantissas && (mantissa == 2 || mantissa == 5));
      const bool is_minor = stride == 1 || mantissa == 1;
      visit_in_range(range, mantissa, exponent, [&](double value) {
        if (is_labelled) {
          result.major.push_back({value, logarithmic_label(mantissa, exponent, plain)});
        } else if (is_minor) {
          result.minor.push_back(value);
        }
      });
    }
  }
  return result;
}

/// The largest of 1, 2, 5 times a power of ten that is not above `value`, times a decade.
double round_down(double value) {
  const int exponent = decade(value);
  double best = Step{1, exponent}.value();
  for (const int mantissa : {2, 5}) {
    const double candidate = Step{mantissa, exponent}.value();
    if (candidate <= value * (1.0 + slack)) best = candidate;
  }
  return best;
}

double round_up(double value) {
  const double below = round_down(value);
  if (below >= value * (1.0 - slack)) return below;
  const int exponent = decade(value);
  for (const int mantissa : {2, 5}) {
    const double candidate = Step{mantissa, exponent}.value();
    if (candidate >= value * (1.0 - slack)) return candidate;
  }
  return Step{1, exponent + 1}.value();
}

AxisRange round_logarithmic(double first, double last) {
  if (is_short(first, last)) return {Scale::logarithmic, round_down(first), round_up(last)};
  const int high = decade(last);
  const double top = Step{1, high}.value();
  return {Scale::logarithmic, Step{1, decade(first)}.value(),
          top >= last * (1.0 - slack) ? top : Step{1, high + 1}.value()};
}

}  // namespace

double AxisRange::fraction(double value) const {
  if (scale == Scale::linear) return (value - first) / (last - first);
  return std::log(value / first) / std::log(last / first);
}

AxisRange round_range(Scale scale, double first, double last) {
  if (scale == Scale::logarithmic) {
    if (first == last) return round_logarithmic(first / 3.0, last * 3.0);
    return round_logarithmic(first, last);
  }
  if (first == last) {
    const double half_width = first == 0.0 ? 1.0 : 0.1 * std::abs(first);
    first -= half_width;
    last += half_width;
  }
  const Step step = linear_step(last - first, 8);
  return {scale, step.multiple(std::floor(first / step.value() + slack)),
          step.multiple(std::ceil(last / step.value() - slack))};
}

double tick_step(double length, int most) {
  return linear_step(length, most).value();
}

Ticks ticks(const AxisRange& range, int most) {
  const bool narrow = range.last / range.first < 3.0;
  if (range.scale == Scale::linear || narrow) return {linear_ticks(range.first, range.last, most), {}};
  return logarithmic_ticks(range, most);
}

}  // namespace isorim::io::svg
