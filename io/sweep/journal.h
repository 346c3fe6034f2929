#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "io/sweep/plan.h"
#include "io/sweep/record.h"

/// The journal of a sweep: the one file that says which cases have ended. A line a case, written at once when it has
/// ended and on the disk before anything else is done; so a process that is killed loses the cases in flight alone.
///
/// Each line is 16 hexadecimal digits (FNV-1a of what follows), a blank, and JSON. The first line tells what the sweep
/// is: the texts of the sweep file and the base case, digests of the files that they name, and the shard. A last line
/// that is torn is cut off by whoever continues the journal.
namespace isorim::io {

/// What must not change between the runs of one sweep.
struct SweepIdentity {
  /// TOML.
  std::string sweep;
  std::string base;
  /// Name and digest of each further file.
  std::vector<std::pair<std::string, std::string>> files;
  std::size_t cases = 0;
  /// Of the program; a change is no reason to refuse.
  std::string version;
};

SweepIdentity identity_of(const SweepPlan& plan);

/// What is different, a line each: "sphere.toml: geometry.radius was 1, is 2". Empty if nothing is.
std::vector<std::string> differences(const SweepIdentity& before, const SweepIdentity& now);

struct JournalContent {
  SweepIdentity identity;
  Shard shard;
  /// By index; the last record of each case.
  std::map<std::size_t, CaseRecord> records;
  /// Bytes up to the end of the last whole line.
  std::size_t sound_size = 0;
};

/// Throws InputError if there is no such file, if it is no journal, and with the line if it is damaged before its last
/// line.
JournalContent read_journal(const std::filesystem::path& path);

/// A journal that is being written; no other process can do so meanwhile.
class Journal {
 public:
  /// Makes a new journal in place of what is there. Throws InputError if it cannot, or if another process writes there.
  static Journal make(const std::filesystem::path& path, const SweepIdentity& identity, const Shard& shard);
  /// Continues one, behind its last whole line; its content goes to `content`. Throws as make() and read_journal() do.
  static Journal resume(const std::filesystem::path& path, JournalContent& content);

  /// Puts a journal of the whole sweep with these records in the place of the one that is there, whole or not at all.
  /// Throws as make() does.
  static void write(const std::filesystem::path& path, const SweepIdentity& identity,
                    const std::map<std::size_t, CaseRecord>& records);

  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;
  Journal(Journal&& other) noexcept;
  Journal& operator=(Journal&&) = delete;

  /// On the disk when it returns. Throws InputError if it cannot be written.
  void append(const CaseRecord& record);

 private:
  Journal(std::filesystem::path path, int flags);
  void append_line(const std::string& json);
  void append_text(const std::string& text);

  std::filesystem::path path_;
  int descriptor_ = -1;
};

/// The journal of the sweep in this folder, and whether there is one: not if it was killed while the first line was
/// being written.
std::filesystem::path journal_path(const std::filesystem::path& folder);
bool has_journal(const std::filesystem::path& folder);

}  // namespace isorim::io
