#pragma once

#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "io/case/schema.h"
#include "io/cli/commands.h"
#include "io/hull/hull_library.h"
#include "io/picture/picture.h"
#include "io/results/conversion.h"

namespace CLI {
class App;
}

/// What commands print with --json where it is not a file of results. Each is an object whose first key, "isorim", is
/// the version of the program.
namespace isorim::cli {

/// { "error": { "kind": "input" | "geometry" | "numerical" | "internal", "message", "exit_status" } }: in the place of
/// whatever a command prints that fails.
std::string failure_json(const std::exception& error, int exit_status);

/// { "input", "output", "format", what the file holds, "warnings": [..] }.
std::string conversion_json(const ConvertArguments& arguments, const io::Conversion& conversion,
                            const std::vector<std::string>& warnings);

/// { "inputs": [..], "output", "width", "height", "views": [names; empty: the one that suits the shape], "field",
/// "component" }; the last two null without a field.
std::string picture_json(const PictureArguments& arguments, const io::picture::PictureOptions& options);

/// { "library", "hulls": [ { "name", "title", "source", "length", "beam", "draught", "stations", "waterlines" } ] }.
std::string hulls_json(const std::filesystem::path& library, const std::vector<io::HullEntry>& hulls);

/// { "library", ACTION: name, "file" }; no "file" if the path is empty.
std::string hull_json(const std::string& action, const std::filesystem::path& library, const std::string& name,
                      const std::filesystem::path& file);

/// { "commands": [ { "name", "text", "arguments": [ { "names", "text", "value", "required" } ], "commands": [..] } ] };
/// of the command of that name alone if the name is not empty.
std::string commands_json(const CLI::App& app, const std::string& name);

/// { "tables": [ { "name", "text", "keys": [ { "name", "type", "text", "unit", "range", "default", "choices",
/// "required" } ] } ] }; what a key does not have is null.
std::string tables_json(const std::vector<const io::Description*>& tables);

}  // namespace isorim::cli
