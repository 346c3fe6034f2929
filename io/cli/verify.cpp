#include <algorithm>
#include <chrono>
#include <ostream>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/atomic_file.h"
#include "io/cli/commands.h"
#include "io/results/compute.h"
#include "io/results/json.h"
#include "io/results/table.h"

namespace isorim::cli {
namespace {

namespace fs = std::filesystem;

fs::path verification_root(const VerifyArguments& arguments) {
  if (arguments.where) {
    if (!fs::exists(*arguments.where)) throw InputError(fmt::format("{}: no such folder", arguments.where->string()));
    return *arguments.where;
  }
  const fs::path usual = "cases/verification";
  if (fs::is_directory(usual)) return usual;
  throw InputError("verify: found no folder cases/verification here; expected a folder with cases as the argument");
}

/// Sweep files stand among cases, as what they have in the place of a shape tells.
bool is_sweep(const fs::path& file) {
  try {
    const io::Value root = io::read_toml(file);
    return root.find("base") != nullptr && root.find("geometry") == nullptr;
  } catch (const InputError&) {
    return false;
  }
}

/// Every case file below a folder, sorted by path.
std::vector<fs::path> case_files(const fs::path& root) {
  if (!fs::is_directory(root)) return {root};
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root)) {
    const bool is_toml = entry.is_regular_file() && entry.path().extension() == ".toml";
    if (is_toml && !is_sweep(entry.path())) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  if (files.empty()) throw InputError(fmt::format("{}: found no case file (.toml)", root.string()));
  return files;
}

/// The path below the root, without the extension.
std::string short_name(const fs::path& file, const fs::path& root) {
  const fs::path relative = fs::is_directory(root) ? file.lexically_relative(root) : file.filename();
  return (relative.parent_path() / relative.stem()).generic_string();
}

/// Runs a case; nothing if it has no expectations.
std::optional<io::VerifiedCase> verify_case(const fs::path& path, const fs::path& root, int threads,
                                            const std::function<void(std::string_view, double)>& progress,
                                            std::ostream& err) {
  io::VerifiedCase result;
  result.file = short_name(path, root);
  const auto start = std::chrono::steady_clock::now();
  try {
    const io::CaseFile file = io::read_case(path);
    if (file.keys.expect.quantities.empty()) return std::nullopt;
    result.title = file.title();
    const io::RunOptions options{
        threads, progress ? [&](std::string_view stage,
                                double fraction) { progress(fmt::format("{}: {}", result.file, stage), fraction); }
                          : std::function<void(std::string_view, double)>()};
    const io::Report report = io::compute(file, io::build_model(file), options);
    result.expectations = report.expectations;
    result.status = report.status;
    result.exit_status = io::exit_status(report.status);
  } catch (const std::exception& error) {
    result.failure = error.what();
    result.exit_status = report_failure(error, err);
  }
  result.time = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

/// Input that cannot be read outweighs a numerical failure, and that a missed expectation.
int overall_exit_status(const std::vector<io::VerifiedCase>& cases) {
  for (const int status : {2, 3, 1}) {
    if (std::any_of(cases.begin(), cases.end(),
                    [&](const io::VerifiedCase& one) { return one.exit_status == status; })) {
      return status;
    }
  }
  return 0;
}

/// The table's file can be written, and is none that was meant as the argument before it.
void require_table_file(const fs::path& file) {
  if (file.extension() == ".toml") {
    throw InputError(
        fmt::format("--json {}: found a case file in the place of the table's; expected what is to be "
                    "verified before --json",
                    file.string()));
  }
  io::require_writable_file(file);
}

}  // namespace

int verify_cases(const VerifyArguments& arguments, std::ostream& out, std::ostream& err) {
  const fs::path root = verification_root(arguments);
  const bool is_printed = arguments.json && *arguments.json == "-";
  if (arguments.json && !is_printed) require_table_file(*arguments.json);
  std::vector<io::VerifiedCase> cases;
  {
    ProgressLine progress(err);
    const auto reporter = progress.reporter();
    for (const fs::path& path : case_files(root)) {
      std::optional<io::VerifiedCase> result = verify_case(path, root, arguments.threads, reporter, err);
      if (result) cases.push_back(std::move(*result));
    }
  }
  if (cases.empty()) throw InputError(fmt::format("{}: found no case with [expect]", root.string()));
  out << (is_printed ? io::verification_json(cases) : io::verification_text(cases));
  if (arguments.json && !is_printed) io::write_file(*arguments.json, io::verification_json(cases));
  return overall_exit_status(cases);
}

}  // namespace isorim::cli
