#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/case/case_file.h"
#include "io/results/compute.h"
#include "io/results/conversion.h"

/// The commands of the program, apart from how they are spelled on the command line. Each returns its exit status and
/// throws what ends it early.
namespace isorim::cli {

enum class Verbosity { normal, quiet };

/// Of what goes to the standard output.
enum class OutputFormat { text, json };

struct RunArguments {
  /// A case or a CAD file.
  std::filesystem::path case_file;
  /// out/<case name>/ if absent.
  std::optional<std::filesystem::path> output;
  std::vector<std::string> overrides;
  /// 0: all.
  int threads = 0;
  Verbosity verbosity = Verbosity::normal;
  OutputFormat format = OutputFormat::text;
};
/// Computes a case, prints the table (or what results.json holds) and writes the files that it asks for.
int run_case(const RunArguments& arguments, std::ostream& out, std::ostream& err);

/// Computes a case that has been read since `start`, and writes its files if there is a folder for them.
io::Report compute_and_write(const io::CaseFile& file, std::chrono::steady_clock::time_point start,
                             const io::RunOptions& options, const std::optional<std::filesystem::path>& folder);

/// Why the exit status of a run is 1 or 3, a line each.
std::vector<std::string> shortfalls(const io::Report& report);

enum class SweepAction { run, list, merge };

/// What to do with a folder that holds the sweep already.
enum class EarlierCases { refuse, resume, discard };

struct SweepArguments {
  std::filesystem::path sweep_file;
  /// out/<sweep name>/ if absent. A shard's folder is in it.
  std::optional<std::filesystem::path> output;
  /// Cases at a time; 0: as many as there are processors.
  int processes = 0;
  /// "K/N".
  std::optional<std::string> shard;
  SweepAction action = SweepAction::run;
  EarlierCases earlier = EarlierCases::refuse;
  /// Runs cases again that have failed.
  bool retries = false;
  OutputFormat format = OutputFormat::text;
};
/// Runs the cases of a sweep, each in a process of its own, and writes their results together; or lists the cases, or
/// joins the folders of shards. Ctrl-C ends the cases that run; what has ended is kept.
int run_sweep(const SweepArguments& arguments, std::ostream& out, std::ostream& err);

struct VerifyArguments {
  /// A folder, or one case file; cases/verification if absent.
  std::optional<std::filesystem::path> where;
  /// Where the table goes as JSON; "-": to the standard output, in the place of its text.
  std::optional<std::filesystem::path> json;
  int threads = 0;
};
/// Runs every case with [expect] below a folder and prints one table.
int verify_cases(const VerifyArguments& arguments, std::ostream& out, std::ostream& err);

struct CheckArguments {
  /// A case or a CAD file.
  std::filesystem::path case_file;
  /// For free edges; out/<name>/ if absent.
  std::optional<std::filesystem::path> output;
  std::vector<std::string> overrides;
  OutputFormat format = OutputFormat::text;
  /// 0: all.
  int threads = 0;
};
/// Tells what a case or CAD file holds without integrating over it, and writes its free edges if there are any. Open
/// boundaries are no failure; what makes no boundary at all is (exit status 2).
int check_case(const CheckArguments& arguments, std::ostream& out, std::ostream& err);

struct ConvertArguments {
  /// A case or a CAD file.
  std::filesystem::path input;
  /// Its extension says what it becomes.
  std::filesystem::path output;
  std::vector<std::string> overrides;
  io::FaceForm faces = io::FaceForm::solids;
  /// Unit of the lengths of a case, which says nothing of it; mm if absent. A CAD file's are converted into it.
  std::optional<std::string> unit;
  OutputFormat format = OutputFormat::text;
};
/// Writes the boundary of a case or CAD file in another format; see io/results/conversion.h.
int convert(const ConvertArguments& arguments, std::ostream& out, std::ostream& err);

struct PictureArguments {
  /// Cases, CAD files, and .vtu, .vtp and .vti files, drawn together.
  std::vector<std::filesystem::path> inputs;
  std::filesystem::path output;
  /// Of the cases.
  std::vector<std::string> overrides;
  std::vector<std::string> views;
  /// Pixels, "WIDTHxHEIGHT".
  std::string size = "1200x900";
  std::optional<std::string> field;
  std::string component;
  /// Two ends, or none.
  std::vector<double> range;
  std::string map = "viridis";
  std::string colours = "automatic";
  std::string lines = "elements";
  /// A colour, or transparent.
  std::string background = "white";
  /// 0: all.
  int threads = 0;
  OutputFormat format = OutputFormat::text;
};
/// Draws a PNG without a display. A case is drawn as `run` writes it; an analysis is solved if the field that is shown
/// is one of its solution.
int draw_picture(const PictureArguments& arguments, std::ostream& out, std::ostream& err);

/// The hulls of a library as a table.
int list_hulls(const std::filesystem::path& library, OutputFormat format, std::ostream& out);

struct HullImportArguments {
  /// Made if it is not there.
  std::filesystem::path library;
  /// Offsets in CSV.
  std::filesystem::path file;
  /// The file's name without its extension if absent.
  std::optional<std::string> name;
  bool replaces = false;
  OutputFormat format = OutputFormat::text;
};
/// Puts a table of offsets into a library.
int import_hull(const HullImportArguments& arguments, std::ostream& out);

struct HullExportArguments {
  std::filesystem::path library;
  std::string name;
  std::filesystem::path file;
  OutputFormat format = OutputFormat::text;
  /// By how much half-breadths may be moved to make the hull fair, in its unit of length; as they are if absent.
  std::optional<double> fair;
};
/// Writes a hull of a library as a table of offsets in CSV; if it is faired, tells how much was moved and what for.
int export_hull(const HullExportArguments& arguments, std::ostream& out);

int remove_hull(const std::filesystem::path& library, const std::string& name, OutputFormat format, std::ostream& out);

/// Prints each line of a message as "isorim: line".
void print_message(std::ostream& err, std::string_view message);

/// 2 for bad input and shapes, 3 for whatever else.
int exit_status_of(const std::exception& error);

/// What an exception that ends a command means: its message on `err`, its exit status.
int report_failure(const std::exception& error, std::ostream& err);

/// A line on `err` that tells how far a long run is: shown after half a second and then at most ten times a second, if
/// `err` is the terminal; wiped away by the destructor.
class ProgressLine {
 public:
  explicit ProgressLine(std::ostream& err);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// For RunOptions::progress; empty if `err` is no terminal. Valid as long as this object.
  std::function<void(std::string_view, double)> reporter();

 private:
  void report(std::string_view stage, double fraction);

  std::ostream& err_;
  double shown_at_ = 0.5;
  bool shown_ = false;
  double start_ = 0.0;
};

}  // namespace isorim::cli
