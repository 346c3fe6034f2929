#include "io/cli/program.h"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <functional>
#include <ostream>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/case/complaints.h"
#include "io/case/reference.h"
#include "io/cli/commands.h"
#include "io/cli/completion.h"
#include "io/cli/replies.h"
#include "io/results/report.h"
#include "io/sweep/sweep_keys.h"

namespace isorim::cli {
namespace {

constexpr const char* about = "isorim: integrals over what CAD boundaries enclose, exactly, without a mesh";

struct HullsArguments {
  std::filesystem::path library;
  std::string name;
  HullImportArguments import;
  HullExportArguments exported;
};

struct HelpArguments {
  std::vector<std::string> topic;
  bool markdown = false;
  std::string completion;
};

struct SweepFlags {
  bool resume = false;
  bool restart = false;
  bool dry_run = false;
  bool merge = false;
};

/// CLI11 keeps references to what it fills.
struct Arguments {
  RunArguments run;
  bool quiet = false;
  SweepArguments sweep;
  SweepFlags sweep_flags;
  VerifyArguments verify;
  CheckArguments check;
  /// Of whichever command.
  bool json = false;
  ConvertArguments convert;
  bool loose_faces = false;
  PictureArguments picture;
  HullsArguments hulls;
  HelpArguments help;
};

void add_overrides(CLI::App& command, std::vector<std::string>& overrides) {
  command.add_option("--set", overrides, "Overrides a key of the case: section.key=value; may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

void add_case_options(CLI::App& command, std::filesystem::path& file, std::vector<std::string>& overrides) {
  command.add_option("CASE", file, "Case file (.toml) or CAD file")->required();
  add_overrides(command, overrides);
}

void add_json(CLI::App& command, bool& json, const char* text) {
  command.add_flag("--json", json, text);
}

void add_threads(CLI::App& command, int& threads) {
  command.add_option("-j,--threads", threads, "Number of threads; all if absent")
      ->type_name("N")
      ->check(CLI::Range(1, 4096));
}

void declare_picture(CLI::App& app, PictureArguments& arguments, bool& json) {
  CLI::App& picture =
      *app.add_subcommand("picture", "Draws cases, CAD files and VTK files as a PNG, without a display");
  picture.add_option("IN", arguments.inputs, "Case files (.toml), CAD files, .vtu, .vtp, .vti; drawn together")
      ->required();
  picture.add_option("-o,--output", arguments.output, "The picture (.png)")->required()->type_name("FILE");
  add_overrides(picture, arguments.overrides);
  picture
      .add_option("--view", arguments.views,
                  "iso, iso_back, front, back, left, right, top, bottom, all, or \"azimuth,elevation\" in degrees; "
                  "several make a sheet")
      ->type_name("VIEW");
  picture.add_option("--size", arguments.size, "Pixels; 1200x900 if absent")->type_name("WxH");
  picture.add_option("--field", arguments.field, "Field that colours show; an analysis is solved for its own")
      ->type_name("NAME");
  picture.add_option("--component", arguments.component, "x, xx, ..., magnitude, or a number from 0")->type_name("C");
  picture.add_option("--range", arguments.range, "Ends of the colours; those of the values if absent")
      ->expected(2)
      ->type_name("LOW HIGH");
  picture.add_option("--map", arguments.map, "Colours: viridis, coolwarm or grey")->type_name("MAP");
  picture.add_option("--colours", arguments.colours, "Without a field: automatic, patch or plain")->type_name("BY");
  picture.add_option("--lines", arguments.lines, "Borders of elements: elements or none")->type_name("LINES");
  picture.add_option("--background", arguments.background, "white, grey, black, #rrggbb or transparent")
      ->type_name("COLOUR");
  add_json(picture, json, "Prints what was drawn as JSON");
  add_threads(picture, arguments.threads);
}

void declare_sweep(CLI::App& sweep, SweepArguments& arguments, SweepFlags& flags, bool& json) {
  sweep.add_option("SWEEP", arguments.sweep_file, "Sweep file (.toml); its keys stand below")->required();
  sweep.add_option("-o,--output", arguments.output, "Output folder; out/<sweep name> if absent")->type_name("DIR");
  sweep.add_option("-j,--processes", arguments.processes, "Cases at a time; as many as processors if absent")
      ->type_name("N")
      ->check(CLI::Range(1, 4096));
  sweep.add_option("--shard", arguments.shard, "Runs the K-th of N parts of the cases, in DIR/shard_K_of_N")
      ->type_name("K/N");
  sweep.add_flag("--resume", flags.resume, "Goes on where the sweep in the output folder has stopped");
  sweep.add_flag("--restart", flags.restart, "Discards what the output folder holds")->excludes("--resume");
  sweep.add_flag("--retry", arguments.retries, "With --resume: runs failed cases again")->needs("--resume");
  sweep.add_flag("--merge", flags.merge, "Joins the shards in the output folder, and tells which cases are missing")
      ->excludes("--resume")
      ->excludes("--restart")
      ->excludes("--shard");
  sweep.add_flag("--dry-run", flags.dry_run, "Lists the cases")->excludes("--merge");
  add_json(sweep, json, "Prints the summary (or the list) as JSON");
}

void declare_hulls(CLI::App& app, HullsArguments& arguments, bool& json) {
  CLI::App& hulls = *app.add_subcommand("hulls", "Keeps tables of offsets of hulls in a library file (HDF5)");
  hulls.require_subcommand(1);
  const auto add_library = [&json](CLI::App& command, std::filesystem::path& library) {
    command.add_option("LIBRARY", library, "The library file (.h5)")->required();
    add_json(command, json, "Prints the hulls (or what was done) as JSON");
  };
  CLI::App& list = *hulls.add_subcommand("list", "Tells what hulls a library has");
  add_library(list, arguments.library);
  CLI::App& import = *hulls.add_subcommand("import", "Puts a table of offsets into a library, a new one if need be");
  add_library(import, arguments.import.library);
  import.add_option("FILE", arguments.import.file, "Offsets (.csv)")->required();
  import.add_option("--name", arguments.import.name, "Name in the library; that of the file if absent");
  import.add_flag("--replace", arguments.import.replaces, "Replaces a hull of the same name");
  CLI::App& exported = *hulls.add_subcommand("export", "Writes a hull of a library as a table of offsets");
  add_library(exported, arguments.exported.library);
  exported.add_option("NAME", arguments.exported.name, "Of the hull")->required();
  exported.add_option("FILE", arguments.exported.file, "Offsets (.csv)")->required();
  exported.add_option("--fair", arguments.exported.fair, "Moves half-breadths by at most this to make the hull fair")
      ->type_name("LENGTH");
  CLI::App& remove = *hulls.add_subcommand("remove", "Takes a hull out of a library");
  add_library(remove, arguments.library);
  remove.add_option("NAME", arguments.name, "Of the hull")->required();
}

int dispatch_hulls(const CLI::App& hulls, HullsArguments& arguments, OutputFormat format, std::ostream& out) {
  arguments.import.format = arguments.exported.format = format;
  if (hulls.got_subcommand("list")) return list_hulls(arguments.library, format, out);
  if (hulls.got_subcommand("import")) return import_hull(arguments.import, out);
  if (hulls.got_subcommand("export")) return export_hull(arguments.exported, out);
  return remove_hull(arguments.library, arguments.name, format, out);
}

void declare_check(CLI::App& app, CheckArguments& arguments, bool& json) {
  CLI::App& check =
      *app.add_subcommand("check", "Tells what is in a case or CAD file, closed or not, without integrating");
  add_case_options(check, arguments.case_file, arguments.overrides);
  check.add_option("-o,--output", arguments.output, "Folder for free edges; out/<name> if absent")->type_name("DIR");
  add_json(check, json, "Prints everything as JSON");
  add_threads(check, arguments.threads);
}

void declare_convert(CLI::App& app, ConvertArguments& arguments, bool& loose_faces, bool& json) {
  CLI::App& convert = *app.add_subcommand("convert", "Writes the boundary of a case or CAD file in another format");
  convert.add_option("IN", arguments.input, "Case file (.toml) or CAD file")->required();
  convert
      .add_option(
          "OUT", arguments.output,
          "IGES (.igs, .iges), T-splines by their extraction (.iga), exact cells for ParaView (.vtu), a drawing of "
          "a region of the plane (.svg), or a watertight mesh of a solid (.stl; --set output.stl_tolerance=T)")
      ->required();
  add_overrides(convert, arguments.overrides);
  convert.add_flag("--faces", loose_faces, "IGES: loose faces even where shells are closed; no solids");
  convert
      .add_option("--unit", arguments.unit,
                  "IGES: unit of the case's lengths, mm if absent; a CAD file's are converted")
      ->type_name("UNIT");
  add_json(convert, json, "Prints what was written as JSON");
}

void declare(CLI::App& app, Arguments& arguments) {
  app.set_version_flag("--version", std::string(io::program_version()), "Prints the version");
  app.require_subcommand(0, 1);

  CLI::App& run = *app.add_subcommand("run", "Computes a case, prints its results and writes them");
  add_case_options(run, arguments.run.case_file, arguments.run.overrides);
  run.add_option("-o,--output", arguments.run.output, "Output folder; out/<case name> if absent")->type_name("DIR");
  add_threads(run, arguments.run.threads);
  run.add_flag("-q,--quiet", arguments.quiet, "Prints no table");
  add_json(run, arguments.json, "Prints what results.json holds");

  CLI::App& sweep = *app.add_subcommand("sweep", "Runs a case for many values of its keys");
  declare_sweep(sweep, arguments.sweep, arguments.sweep_flags, arguments.json);

  CLI::App& verify = *app.add_subcommand("verify", "Runs every case with [expect] below a folder, as one table");
  verify.add_option("DIR", arguments.verify.where, "Folder or case file; cases/verification if absent");
  verify
      .add_option("--json", arguments.verify.json,
                  "Writes the table as JSON; without FILE, at the end of the line, prints it")
      ->type_name("FILE")
      ->expected(0, 1)
      ->default_str("-");
  add_threads(verify, arguments.verify.threads);

  declare_check(app, arguments.check, arguments.json);
  declare_convert(app, arguments.convert, arguments.loose_faces, arguments.json);
  declare_picture(app, arguments.picture, arguments.json);
  declare_hulls(app, arguments.hulls, arguments.json);

  CLI::App& help = *app.add_subcommand("help", "Explains a command (help run) or case files (help case [SECTION])");
  help.add_option("TOPIC", arguments.help.topic, "A command; or case, with a section or type")->expected(0, 2);
  help.add_flag("--markdown", arguments.help.markdown,
                "Prints the reference of case files (or with sweep of sweep files) as Markdown");
  add_json(help, arguments.json, "Prints commands with their options, or the tables and keys of files, as JSON");
  help.add_option("--completion", arguments.help.completion, "Prints a script that completes command lines: bash, zsh")
      ->type_name("SHELL")
      ->check(CLI::IsMember({"bash", "zsh"}));
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(command->get_name());
  }
  return names;
}

void check_command(const CLI::App& app, const std::string& word, const std::string& what) {
  const std::vector<std::string> names = command_names(app);
  if (std::find(names.begin(), names.end(), word) != names.end()) return;
  throw InputError(fmt::format("found the {} \"{}\"{}; expected one of {}", what, word, io::did_you_mean(word, names),
                               fmt::join(names, ", ")));
}

/// Commands; or the tables of case files, or of sweep files.
std::string help_json(const CLI::App& app, const std::vector<std::string>& topic) {
  if (topic.empty()) return commands_json(app, "");
  if (topic.front() == "case") return tables_json(io::case_tables(topic.size() > 1 ? topic[1] : ""));
  check_command(app, topic.front(), "topic");
  return topic.front() == "sweep" ? tables_json(io::sweep_tables()) : commands_json(app, topic.front());
}

int print_help(const HelpArguments& arguments, OutputFormat format, std::ostream& out) {
  // Not the one that has parsed the command line: it would tell of the command help alone.
  CLI::App app(about, "isorim");
  Arguments unused;
  declare(app, unused);
  const bool is_sweep = !arguments.topic.empty() && arguments.topic.front() == "sweep";
  if (format == OutputFormat::json) {
    out << help_json(app, arguments.topic);
  } else if (arguments.markdown) {
    out << (is_sweep ? io::sweep_reference_markdown() : io::case_reference_markdown());
  } else if (!arguments.completion.empty()) {
    const Shell shell = arguments.completion == "bash" ? Shell::bash : Shell::zsh;
    out << completion_script(app, shell, io::case_topics());
  } else if (arguments.topic.empty()) {
    out << app.help() << "\nExit status: 0 all well; 1 an expectation was missed; 2 bad input or usage; 3 a numerical "
        << "failure.\n";
  } else if (arguments.topic.front() == "case") {
    out << (arguments.topic.size() == 1 ? io::case_overview() : io::case_topic(arguments.topic[1]));
  } else {
    check_command(app, arguments.topic.front(), "topic");
    out << app.get_subcommand(arguments.topic.front())->help("isorim");
    if (is_sweep) out << '\n' << io::sweep_reference();
  }
  return 0;
}

int dispatch_sweep(SweepArguments& arguments, const SweepFlags& flags, std::ostream& out, std::ostream& err) {
  if (flags.merge) arguments.action = SweepAction::merge;
  if (flags.dry_run) arguments.action = SweepAction::list;
  if (flags.resume) arguments.earlier = EarlierCases::resume;
  if (flags.restart) arguments.earlier = EarlierCases::discard;
  return run_sweep(arguments, out, err);
}

int dispatch(CLI::App& app, Arguments& arguments, std::ostream& out, std::ostream& err) {
  const OutputFormat format = arguments.json ? OutputFormat::json : OutputFormat::text;
  arguments.run.format = arguments.sweep.format = arguments.check.format = format;
  arguments.convert.format = arguments.picture.format = format;
  if (app.got_subcommand("run")) {
    arguments.run.verbosity = arguments.quiet ? Verbosity::quiet : Verbosity::normal;
    return run_case(arguments.run, out, err);
  }
  if (app.got_subcommand("sweep")) return dispatch_sweep(arguments.sweep, arguments.sweep_flags, out, err);
  if (app.got_subcommand("verify")) return verify_cases(arguments.verify, out, err);
  if (app.got_subcommand("check")) return check_case(arguments.check, out, err);
  if (app.got_subcommand("convert")) {
    arguments.convert.faces = arguments.loose_faces ? io::FaceForm::loose : io::FaceForm::solids;
    return convert(arguments.convert, out, err);
  }
  if (app.got_subcommand("picture")) return draw_picture(arguments.picture, out, err);

  if (app.got_subcommand("hulls")) return dispatch_hulls(*app.get_subcommand("hulls"), arguments.hulls, format, out);
  if (app.got_subcommand("help")) return print_help(arguments.help, format, out);
  err << app.help();
  return 2;
}

bool asks_for_json(const std::vector<std::string>& args) {
  return std::ranges::find(args, "--json") != args.end();
}

int parse_and_dispatch(const std::vector<std::string>& args, std::ostream& out, std::ostream& err) {
  CLI::App app(about, "isorim");
  Arguments arguments;
  declare(app, arguments);
  if (!args.empty() && !args.front().starts_with('-')) check_command(app, args.front(), "command");
  try {
    // CLI11 takes them from the back.
    app.parse(std::vector<std::string>(args.rbegin(), args.rend()));
  } catch (const CLI::Success& success) {
    return app.exit(success, out, err);
  } catch (const CLI::ParseError& error) {
    print_message(err, error.what());
    print_message(err, "isorim help lists the commands, isorim help COMMAND its options");
    if (asks_for_json(args)) out << failure_json(InputError(error.what()), 2);
    return 2;
  }
  return dispatch(app, arguments, out, err);
}

}  // namespace

int run_program(const std::vector<std::string>& args, std::ostream& out, std::ostream& err) {
  try {
    return parse_and_dispatch(args, out, err);
  } catch (const std::exception& error) {
    const int status = report_failure(error, err);
    if (asks_for_json(args)) out << failure_json(error, status);
    return status;
  }
}

}  // namespace isorim::cli
