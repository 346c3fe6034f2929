#include "io/sweep/merge.h"

#include <algorithm>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "geometry/errors.h"

namespace isorim::io {
namespace {

namespace fs = std::filesystem;

/// The subfolders with a journal, sorted.
std::vector<fs::path> shard_folders(const fs::path& folder) {
  std::vector<fs::path> found;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    if (entry.is_directory() && has_journal(entry.path())) found.push_back(entry.path());
  }
  if (found.empty()) {
    throw InputError(
        fmt::format("{}: found no shard of a sweep; expected folders such as shard_1_of_2 in it", folder.string()));
  }
  std::ranges::sort(found);
  return found;
}

void add_records(const fs::path& folder, const fs::path& subfolder, const SweepPlan& plan, SweepResults& results) {
  JournalContent content = read_journal(journal_path(folder / subfolder));
  require_same_sweep(journal_path(folder / subfolder), content.identity, plan);
  for (auto& [index, record] : content.records) {
    if (!record.folder.empty()) record.folder = (subfolder / record.folder).generic_string();
    const CaseRecord* known = results.find(index);
    if (known && !known->is_failed() && record.is_failed()) continue;
    results.records[index] = std::move(record);
  }
}

}  // namespace

void require_same_sweep(const fs::path& journal, const SweepIdentity& before, const SweepPlan& plan) {
  std::vector<std::string> lines;
  for (const std::string& difference : differences(before, identity_of(plan))) {
    lines.push_back(fmt::format("{}: {}", journal.string(), difference));
  }
  if (lines.empty()) return;
  throw InputError(
      fmt::format("{}\n{}: the sweep is another one now; --restart discards what is there, -o DIR leaves "
                  "it alone",
                  fmt::join(lines, "\n"), journal.string()));
}

SweepResults merge_shards(const SweepPlan& plan, const fs::path& folder) {
  SweepResults results{&plan, {}, {}};
  const std::vector<fs::path> shards = shard_folders(folder);
  const bool has_own = has_journal(folder);
  JournalContent own;
  if (has_own) {
    own = read_journal(journal_path(folder));
    require_same_sweep(journal_path(folder), own.identity, plan);
    results.records = std::move(own.records);
  }
  for (const fs::path& shard : shards) add_records(folder, shard.lexically_relative(folder), plan, results);
  Journal::write(journal_path(folder), identity_of(plan), results.records);
  return results;
}

}  // namespace isorim::io
