#pragma once

#include <cstddef>
#include <filesystem>

#include "io/sweep/plan.h"
#include "io/sweep/record.h"

namespace isorim::cli {

struct SweepCaseOptions {
  const io::SweepPlan* plan = nullptr;
  /// Of the sweep; the files of the case go to cases/<number>/ in it.
  std::filesystem::path folder;
  int threads = 1;
};

/// Computes one case of a sweep and writes its files. Whatever goes wrong becomes part of the record.
io::CaseRecord run_sweep_case(const SweepCaseOptions& options, std::size_t index);

}  // namespace isorim::cli
