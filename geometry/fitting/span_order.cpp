#include "geometry/fitting/span_order.h"

namespace isorim::geometry {

SpanOrder::SpanOrder(const KnotVector& knots, std::span<const double> parameters) : order_(parameters.size()) {
  const std::size_t spans = static_cast<std::size_t>(knots.basis_count() - knots.degree());
  const std::span<const double> all = knots.knots();
  std::vector<int> span_of(parameters.size());
  offsets_.assign(spans + 1, 0);
  int span = knots.degree();
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    // Mostly the span of the one before.
    const std::size_t s = static_cast<std::size_t>(span);
    if (!(all[s] <= parameters[i] && parameters[i] < all[s + 1])) span = knots.find_span(parameters[i]);
    span_of[i] = span - knots.degree();
    ++offsets_[static_cast<std::size_t>(span_of[i]) + 1];
  }
  for (std::size_t s = 0; s < spans; ++s) offsets_[s + 1] += offsets_[s];
  std::vector<int> next = offsets_;
  for (std::size_t i = 0; i < parameters.size(); ++i)
    order_[static_cast<std::size_t>(next[static_cast<std::size_t>(span_of[i])]++)] = static_cast<int>(i);
}

}  // namespace isorim::geometry
