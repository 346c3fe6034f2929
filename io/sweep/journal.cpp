#include "io/sweep/journal.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "geometry/errors.h"
#include "io/atomic_file.h"
#include "io/case/value_edit.h"
#include "io/file_bytes.h"
#include "io/results/json_parts.h"

namespace isorim::io {
namespace {

constexpr int format_version = 1;
constexpr std::size_t digest_size = 16;

/// FNV-1a of 64 bits, in hexadecimal.
std::string digest(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char c : text) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001b3U;
  }
  return fmt::format("{:016x}", hash);
}

std::string line_of(const std::string& json) {
  return digest(json) + ' ' + json + '\n';
}

/// The JSON of a line, without its end; nothing if the line is damaged.
std::optional<std::string_view> content_of(std::string_view line) {
  if (line.size() < digest_size + 2 || line[digest_size] != ' ') return std::nullopt;
  const std::string_view json = line.substr(digest_size + 1);
  if (digest(json) != line.substr(0, digest_size)) return std::nullopt;
  return json;
}

std::string header_json(const SweepIdentity& identity, const Shard& shard) {
  Json json;
  json["isorim_sweep"] = format_version;
  json["isorim"] = identity.version;
  json["cases"] = identity.cases;
  json["shard"] = shard.text();
  json["sweep"] = identity.sweep;
  json["base"] = identity.base;
  Json& files = json["files"] = Json::object();
  for (const auto& [name, hash] : identity.files) files[name] = hash;
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void parse_header(std::string_view text, JournalContent& content) {
  const Json json = Json::parse(text);
  if (json.at("isorim_sweep").get<int>() != format_version) throw InputError("a journal of another version of isorim");
  content.identity.version = json.at("isorim").get<std::string>();
  content.identity.cases = json.at("cases").get<std::size_t>();
  content.shard = parse_shard(json.at("shard").get<std::string>());
  content.identity.sweep = json.at("sweep").get<std::string>();
  content.identity.base = json.at("base").get<std::string>();
  for (const auto& [name, hash] : json.at("files").items()) {
    content.identity.files.emplace_back(name, hash.get<std::string>());
  }
}

JournalContent parse_journal(std::string_view text, const std::string& name) {
  JournalContent content;
  for (int line = 1;; ++line) {
    const std::size_t end = text.find('\n', content.sound_size);
    // Torn in the middle of being written, or the end.
    if (end == std::string_view::npos) break;
    const auto json = content_of(text.substr(content.sound_size, end - content.sound_size));
    if (!json && end + 1 == text.size() && line > 1) break;
    try {
      if (!json) throw InputError("the line is damaged");
      if (line == 1) {
        parse_header(*json, content);
      } else {
        CaseRecord record = parse_record(*json);
        if (record.index >= content.identity.cases) throw InputError("found a case that the sweep does not have");
        const std::size_t index = record.index;
        content.records[index] = std::move(record);
      }
    } catch (const std::exception& error) {
      throw InputError(fmt::format("{}:{}: {}", name, line, line == 1 ? "is no journal of a sweep" : error.what()));
    }
    content.sound_size = end + 1;
  }
  if (content.sound_size == 0) throw InputError(fmt::format("{}: is no journal of a sweep", name));
  return content;
}

[[noreturn]] void refuse(const std::filesystem::path& path, const char* what) {
  throw InputError(fmt::format("{}: cannot {}: {}", path.string(), what, std::strerror(errno)));
}

// --- Differences ----------------------------------------------------------------------------------------------

std::string shown(const Value* value) {
  if (!value) return "absent";
  const std::string text = inline_toml(*value);
  return text.size() <= 60 ? text : text.substr(0, 57) + "...";
}

/// Names where two trees differ, as deep as both have the place.
void compare_trees(const Value* before, const Value* now, const std::string& path, std::vector<std::string>& found) {
  if (before && now) {
    const auto* old_table = before->as<Value::Table>();
    const auto* new_table = now->as<Value::Table>();
    if (old_table && new_table) {
      const std::string stem = path.empty() ? "" : path + ".";
      for (const TableEntry& entry : *old_table) {
        compare_trees(&entry.value, now->find(entry.key), stem + entry.key, found);
      }
      for (const TableEntry& entry : *new_table) {
        if (!before->find(entry.key)) compare_trees(nullptr, &entry.value, stem + entry.key, found);
      }
      return;
    }
    const auto* old_list = before->as<Value::Array>();
    const auto* new_list = now->as<Value::Array>();
    const bool has_tables = old_list && !old_list->empty() && old_list->front().as<Value::Table>();
    if (has_tables && new_list && new_list->size() == old_list->size()) {
      for (std::size_t i = 0; i < old_list->size(); ++i) {
        compare_trees(&(*old_list)[i], &(*new_list)[i], fmt::format("{}.{}", path, i), found);
      }
      return;
    }
    if (inline_toml(*before) == inline_toml(*now)) return;
  }
  found.push_back(fmt::format("{} was {}, is {}", path, shown(before), shown(now)));
}

void compare_texts(const std::string& before, const std::string& now, const char* what,
                   std::vector<std::string>& found) {
  const Value old_tree = parse_toml(before, what);
  const Value new_tree = parse_toml(now, what);
  std::vector<std::string> lines;
  compare_trees(&old_tree, &new_tree, "", lines);
  for (const std::string& line : lines) found.push_back(fmt::format("{}: {}", what, line));
}

}  // namespace

SweepIdentity identity_of(const SweepPlan& plan) {
  SweepIdentity identity;
  identity.sweep = plan.definition;
  identity.base = to_toml(plan.base);
  for (const auto& [name, text] : plan.files) identity.files.emplace_back(name, digest(text));
  identity.cases = plan.cases.size();
  identity.version = std::string(program_version());
  return identity;
}

std::vector<std::string> differences(const SweepIdentity& before, const SweepIdentity& now) {
  std::vector<std::string> found;
  if (before.sweep != now.sweep) compare_texts(before.sweep, now.sweep, "the sweep file", found);
  if (before.base != now.base) compare_texts(before.base, now.base, "the base case", found);
  const std::map<std::string, std::string> old_files(before.files.begin(), before.files.end());
  const std::map<std::string, std::string> new_files(now.files.begin(), now.files.end());
  for (const auto& [name, hash] : old_files) {
    const auto same = new_files.find(name);
    if (same == new_files.end()) {
      found.push_back(fmt::format("the file {} is no longer there or no longer named", name));
    } else if (same->second != hash) {
      found.push_back(fmt::format("the file {} has other contents", name));
    }
  }
  for (const auto& [name, hash] : new_files) {
    if (!old_files.contains(name)) found.push_back(fmt::format("the file {} is new", name));
  }
  if (found.empty() && before.cases != now.cases) {
    found.push_back(fmt::format("the number of cases was {}, is {}", before.cases, now.cases));
  }
  return found;
}

JournalContent read_journal(const std::filesystem::path& path) {
  return parse_journal(read_bytes(path), path.string());
}

std::filesystem::path journal_path(const std::filesystem::path& folder) {
  return folder / "journal";
}

bool has_journal(const std::filesystem::path& folder) {
  std::error_code error;
  return std::filesystem::is_regular_file(journal_path(folder), error) &&
         read_bytes(journal_path(folder)).find('\n') != std::string::npos;
}

Journal::Journal(std::filesystem::path path, int flags) : path_(std::move(path)) {
  descriptor_ = open(path_.c_str(), flags | O_RDWR | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor_ < 0) refuse(path_, "open the journal");
  // Not flock(): its locks would live on in the processes of cases when this one is killed.
  struct flock lock {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  if (fcntl(descriptor_, F_SETLK, &lock) != 0) {
    close(std::exchange(descriptor_, -1));
    throw InputError(fmt::format("{}: another process is running this sweep", path_.string()));
  }
}

Journal::Journal(Journal&& other) noexcept
    : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

Journal::~Journal() {
  if (descriptor_ >= 0) close(descriptor_);
}

Journal Journal::make(const std::filesystem::path& path, const SweepIdentity& identity, const Shard& shard) {
  Journal journal(path, O_CREAT);
  if (ftruncate(journal.descriptor_, 0) != 0) refuse(path, "empty the journal");
  journal.append_line(header_json(identity, shard));
  // The folder's entry for it must be on the disk as well.
  const int folder = open(path.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder >= 0) {
    fsync(folder);
    close(folder);
  }
  return journal;
}

Journal Journal::resume(const std::filesystem::path& path, JournalContent& content) {
  Journal journal(path, 0);
  // By the same descriptor: closing another one would give up the lock.
  std::string text;
  std::array<char, 65536> buffer;
  while (true) {
    const ssize_t count = read(journal.descriptor_, buffer.data(), buffer.size());
    if (count < 0) refuse(path, "read the journal");
    if (count == 0) break;
    text.append(buffer.data(), static_cast<std::size_t>(count));
  }
  content = parse_journal(text, path.string());
  if (ftruncate(journal.descriptor_, static_cast<off_t>(content.sound_size)) != 0) refuse(path, "cut the journal");
  return journal;
}

void Journal::write(const std::filesystem::path& path, const SweepIdentity& identity,
                    const std::map<std::size_t, CaseRecord>& records) {
  // Held while the file under its name is replaced, so that nobody appends to the old one meanwhile.
  const Journal old(path, O_CREAT);
  AtomicFile target(path);
  {
    Journal journal = make(target.temporary(), identity, {});
    std::string lines;
    for (const auto& [index, record] : records) lines += line_of(record_json(record));
    journal.append_text(lines);
  }
  target.commit();
}

void Journal::append(const CaseRecord& record) {
  append_line(record_json(record));
}

void Journal::append_line(const std::string& json) {
  append_text(line_of(json));
}

void Journal::append_text(const std::string& text) {
  std::size_t written = 0;
  while (written < text.size()) {
    const ssize_t count = ::write(descriptor_, text.data() + written, text.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) refuse(path_, "write the journal");
    written += static_cast<std::size_t>(count);
  }
  if (fdatasync(descriptor_) != 0) refuse(path_, "write the journal");
}

}  // namespace isorim::io
