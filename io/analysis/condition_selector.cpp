#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/analysis/boundary_value_problem.h"
#include "io/case/analysis_checks.h"

namespace isorim::io {

template <int Dim>
ConditionSelector<Dim>::ConditionSelector(const CaseFile& file, const geometry::Boundary<Dim>& boundary)
    : file_(&file), boundary_(&boundary) {
  for (std::size_t i = 0; i < file.keys.boundary_condition.size(); ++i) {
    const BoundaryConditionKeys& keys = file.keys.boundary_condition[i];
    const std::vector<std::string>& on = keys.on.items;
    const bool all = on.empty() || (on.size() == 1 && on.front() == "all");
    Candidate candidate;
    candidate.condition = static_cast<int>(i);
    candidate.rank = keys.selection ? 2 : all ? 0 : 1;
    if (keys.selection) {
      candidate.selection = compile_integrand<Dim>(keys.selection->text, ExpressionScope::boundary, file.definitions)();
    }
    for (const auto& patch : boundary.patches) {
      if (!all) candidate.on_patch.push_back(std::find(on.begin(), on.end(), patch.name) != on.end() ? 1 : 0);
    }
    candidates_.push_back(std::move(candidate));
  }
}

template <int Dim>
bool ConditionSelector<Dim>::holds(const Candidate& candidate, int patch, const geometry::Point<Dim>& point,
                                   const geometry::Vector<Dim>& normal) const {
  if (!candidate.on_patch.empty() && candidate.on_patch[static_cast<std::size_t>(patch)] == 0) return false;
  if (!candidate.selection) return true;
  std::array<double, 1> value{};
  candidate.selection(point, normal, value);
  if (std::isnan(value[0])) {
    const ExpressionText& text =
        *file_->keys.boundary_condition[static_cast<std::size_t>(candidate.condition)].selection;
    throw InputError(fmt::format("{}: {}: {} is no number at ({}); expected 0 where the condition does not hold",
                                 text.where.place.describe(), text.where.path, text.text,
                                 fmt::join(point.begin(), point.end(), ", ")));
  }
  return value[0] != 0.0;
}

template <int Dim>
int ConditionSelector<Dim>::select(int patch, const geometry::Point<Dim>& point, const geometry::Vector<Dim>& normal) {
  const Candidate* best = nullptr;
  const Candidate* rival = nullptr;
  for (const Candidate& candidate : candidates_) {
    if (best && candidate.rank < best->rank) continue;
    if (!holds(candidate, patch, point, normal)) continue;
    rival = best && candidate.rank == best->rank ? best : nullptr;
    best = &candidate;
  }
  if (rival) {
    const CaseKeys& keys = file_->keys;
    const auto name = [&](const Candidate& one) {
      return fmt::format("\"{}\" (line {})", condition_name(keys, static_cast<std::size_t>(one.condition)),
                         keys.boundary_condition[static_cast<std::size_t>(one.condition)].where.place.line);
    };
    throw InputError(
        fmt::format("the boundary conditions {} and {} both hold on patch \"{}\" at ({}); expected "
                    "one",
                    name(*rival), name(*best), boundary_->patches[static_cast<std::size_t>(patch)].name,
                    fmt::join(point.begin(), point.end(), ", ")));
  }
  return best ? best->condition : -1;
}

template class ConditionSelector<2>;
template class ConditionSelector<3>;

}  // namespace isorim::io
