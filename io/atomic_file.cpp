#include "io/atomic_file.h"

#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "geometry/errors.h"

namespace isorim::io {

namespace {

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& reason) {
  throw InputError(fmt::format("cannot write '{}': {}", path.string(), reason));
}

/// A hidden name in the same folder, so that the rename stays within one file system; unique among processes and
/// threads.
std::filesystem::path temporary_name(const std::filesystem::path& target) {
  static std::atomic<int> counter = 0;
  return target.parent_path() / fmt::format(".{}.{}-{}.tmp", target.filename().string(), getpid(), counter++);
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path target) : target_(std::move(target)), temporary_(temporary_name(target_)) {
  if (std::filesystem::is_directory(target_)) refuse(target_, "it is a folder");
  const int descriptor = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor < 0) refuse(target_, std::strerror(errno));
  close(descriptor);
}

AtomicFile::~AtomicFile() {
  std::error_code ignored;
  if (!committed_) std::filesystem::remove(temporary_, ignored);
}

void AtomicFile::commit() {
  std::error_code error;
  std::filesystem::rename(temporary_, target_, error);
  if (error) refuse(target_, error.message());
  committed_ = true;
}

void write_file(const std::filesystem::path& path, std::string_view content) {
  AtomicFile file(path);
  errno = 0;
  std::ofstream stream(file.temporary(), std::ios::binary);
  stream.write(content.data(), static_cast<std::streamsize>(content.size()));
  stream.close();
  if (!stream) refuse(path, errno != 0 ? std::strerror(errno) : "the system gave no reason");
  file.commit();
}

void require_writable_file(const std::filesystem::path& path) {
  const AtomicFile probe(path);
}

void require_writable_folder(const std::filesystem::path& folder) {
  if (folder.empty()) throw InputError("the name of the output folder is empty");
  std::error_code error;
  std::filesystem::path existing = std::filesystem::absolute(folder, error);
  while (existing.has_relative_path() && !std::filesystem::exists(existing, error)) existing = existing.parent_path();
  if (!std::filesystem::is_directory(existing, error)) {
    throw InputError(fmt::format("{}: cannot make the folder: '{}' is a file", folder.string(), existing.string()));
  }
  if (access(existing.c_str(), W_OK | X_OK) != 0) {
    throw InputError(fmt::format("{}: cannot write to the folder '{}': {}", folder.string(), existing.string(),
                                 std::strerror(errno)));
  }
}

void make_folder(const std::filesystem::path& folder) {
  require_writable_folder(folder);
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder)) {
    throw InputError(fmt::format("{}: cannot make the folder: {}", folder.string(), error.message()));
  }
}

}  // namespace isorim::io
