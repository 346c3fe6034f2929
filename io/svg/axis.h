#pragma once

#include <vector>

#include "geometry/vocabulary.h"
#include "io/svg/markup.h"

namespace isorim::io::svg {

enum class Scale { linear, logarithmic };

/// What an axis shows; on a logarithmic one 0 < first.
struct AxisRange {
  Scale scale = Scale::linear;
  double first = 0.0;
  double last = 1.0;

  /// 0 at `first`, 1 at `last`. On a logarithmic axis the value must be positive.
  double fraction(double value) const;
};

/// A range that holds first..last and ends on round numbers: multiples of the tick step; on a logarithmic axis
/// decades, or 1, 2, 5 times a decade if it spans less than two. Equal ends are drawn apart.
AxisRange round_range(Scale scale, double first, double last);

/// The smallest of 1, 2, 5 times a power of ten that cuts `length` into at most `most` pieces (and two ends).
double tick_step(double length, int most);

struct Tick {
  double value = 0.0;
  Label label;
};

struct Ticks {
  std::vector<Tick> major;
  /// Unlabelled.
  std::vector<double> minor;
};

/// Linear: the multiples of tick_step. Logarithmic: decades, or every n-th so that
/// at most `most` are labelled, with minor ticks between; 1, 2, 5 times a decade where the range is short, and
/// linear steps below a factor of about 3.
Ticks ticks(const AxisRange& range, int most);

}  // namespace isorim::io::svg
