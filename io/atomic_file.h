#pragma once

#include <filesystem>
#include <string_view>

namespace isorim::io {

/// A file that appears whole or not at all: written under a temporary name beside its target, renamed by `commit`,
/// removed when it goes out of scope without that. What stood at the target before stays until then.
class AtomicFile {
 public:
  /// Creates the temporary, empty. Throws InputError with the target's path and the system's reason if it cannot.
  explicit AtomicFile(std::filesystem::path target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::filesystem::path& target() const { return target_; }
  /// Where to write.
  const std::filesystem::path& temporary() const { return temporary_; }
  /// Puts the temporary in the target's place. Throws InputError if it cannot.
  void commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path temporary_;
  bool committed_ = false;
};

/// Writes the whole file atomically. Throws InputError with the path and the system's reason (no such folder, no
/// permission, disk full); then the target is as it was.
void write_file(const std::filesystem::path& path, std::string_view content);

/// Throws InputError as AtomicFile does if a file cannot be made there: to be asked before work that takes long.
void require_writable_file(const std::filesystem::path& path);

/// Throws InputError, with the path and the reason, if the folder cannot be made or written to, as far as that can be
/// seen beforehand. Makes nothing.
void require_writable_folder(const std::filesystem::path& folder);

/// Makes a folder for results, with those that it stands in. Throws InputError with its path if it cannot.
void make_folder(const std::filesystem::path& folder);

}  // namespace isorim::io
