#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "io/sweep/plan.h"
#include "io/sweep/record.h"

/// What is known of a sweep, and the files made of it. All of them are made anew from the records each time, so they do
/// not depend on how often the sweep was stopped and continued.
namespace isorim::io {

struct SweepResults {
  const SweepPlan* plan = nullptr;
  Shard shard;
  std::map<std::size_t, CaseRecord> records;

  /// The cases of the shard, in order.
  std::vector<std::size_t> share() const;
  /// Those of them that have no record.
  std::vector<std::size_t> missing() const;
  /// Null if the case has not ended.
  const CaseRecord* find(std::size_t index) const;
};

struct SweepCounts {
  std::size_t cases = 0;
  std::size_t finished = 0;
  std::size_t failed = 0;
  int expectations_met = 0;
  int expectations_missed = 0;
};
SweepCounts count(const SweepResults& results);

/// Of the whole sweep: that of bad input outweighs that of a numerical failure, and that a missed expectation.
int exit_status(const SweepResults& results);

/// The names of results that are the columns of tables: those that [output] results chooses ("centroid" stands for
/// "centroid.0", ...), or without it the usual ones: properties, integrals, unknowns and errors of analyses and the
/// like, not error estimates, sizes and times. In the order of the first case that has them.
std::vector<std::string> result_columns(const SweepResults& results);

/// What the column of a result is called: by its name, or "results.NAME" if another column is called so.
std::string column_heading(const SweepPlan& plan, const std::string& result);

/// The number of a column, be it parameter, derived value or result; nothing if the case has none.
std::optional<double> column_value(const SweepResults& results, std::size_t index, const std::string& column);

/// What the sweep file chooses as result, or plots, and no case has: a line each, with the nearest name. Empty as long
/// as no case has results.
std::vector<std::string> unknown_results(const SweepResults& results);

/// sweep.csv: a row a case in their order: number, parameters, derived values, status, exit status, expectations met
/// and missed, results, message. The same bytes whenever the results are the same: no times.
std::string sweep_csv(const SweepResults& results);

/// The summary that --json prints and sweep.json holds.
std::string sweep_json(const SweepResults& results, const std::filesystem::path& folder);

/// The cases, for --dry-run.
std::string plan_text(const SweepPlan& plan, const Shard& shard);
std::string plan_json(const SweepPlan& plan, const Shard& shard);

/// sweep.h5:
///
///   /                attributes isorim, sweep, shard; datasets definition and base_case (TOML)
///   /table/COLUMN    one entry a case, in the order of sweep.csv: its columns, and seconds and peak_memory (bytes);
///                    NaN where there is no number. A slash in a name becomes a colon.
///   /cases/NUMBER    results.h5 of each case that has written one, as it is: geometry and fields
///
/// `folder` is that of the sweep. A results.h5 that cannot be read is left out and named in the messages returned.
std::vector<std::string> write_sweep_hdf5(const std::filesystem::path& path, const SweepResults& results,
                                          const std::filesystem::path& folder);

/// A collection for ParaView of each kind of file for it that the cases have written, NAME.pvd for NAME.vtu, with a
/// time step a case: its time is the parameter, if there is a single one whose values increase, else the number of the
/// case.
void write_collections(const std::filesystem::path& folder, const SweepResults& results);

/// The pictures of [[plot]]: of the cases that have results, the points of a line in the order of x.
void write_plots(const std::filesystem::path& folder, const SweepResults& results);

/// All of the above files; the summary last. Returns messages for the user.
std::vector<std::string> write_sweep_files(const std::filesystem::path& folder, const SweepResults& results);

}  // namespace isorim::io
