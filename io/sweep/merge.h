#pragma once

#include <filesystem>

#include "io/sweep/journal.h"
#include "io/sweep/results.h"

namespace isorim::io {

/// Joins what the shards in `folder` (its subfolders that hold a journal) have recorded, and what `folder` itself has
/// from before, in a journal of the whole sweep there; the files of the cases stay where they are. Of two records of a
/// case the one that did not fail is taken, else the later one. Throws InputError if there are no shards, or if one is
/// of another sweep, with what is different.
SweepResults merge_shards(const SweepPlan& plan, const std::filesystem::path& folder);

/// Throws InputError "journal: ...", line by line, if the journal is not one of this sweep.
void require_same_sweep(const std::filesystem::path& journal, const SweepIdentity& before, const SweepPlan& plan);

}  // namespace isorim::io
