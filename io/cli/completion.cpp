#include "io/cli/completion.h"

#include <algorithm>
#include <string_view>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace isorim::cli {
namespace {

enum class Operand { none, file, folder };

/// What may stand for a value of this name.
Operand operand_of(std::string_view name) {
  if (name == "DIR") return Operand::folder;
  if (name == "FILE") return Operand::file;
  return Operand::none;
}

struct Option {
  /// "-o", "--output"
  std::vector<std::string> names;
  std::string text;
  bool takes_value = false;
  std::string value;
};

struct Command {
  std::string name;
  std::string text;
  std::vector<Option> options;
  std::vector<std::string> operands;
};

Option describe(const CLI::Option& option) {
  Option described;
  for (const std::string& name : option.get_snames()) described.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) described.names.push_back("--" + name);
  described.text = option.get_description();
  described.takes_value = option.get_items_expected_max() > 0;
  // "N:INT in [1 - 4096]" with the range that is checked.
  const std::string type = option.get_type_name();
  described.value = type.substr(0, type.find(':'));
  return described;
}

Command describe(const CLI::App& app) {
  Command command{.name = app.get_name(), .text = app.get_description(), .options = {}, .operands = {}};
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_positional()) {
      command.operands.push_back(option->get_name(true));
    } else {
      command.options.push_back(describe(*option));
    }
  }
  return command;
}

std::vector<Command> commands_of(const CLI::App& app) {
  std::vector<Command> commands;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    commands.push_back(describe(*command));
  }
  return commands;
}

std::vector<std::string> names_of(const std::vector<Command>& commands) {
  std::vector<std::string> names;
  for (const Command& command : commands) names.push_back(command.name);
  return names;
}

std::vector<std::string> names_of(const std::vector<Option>& options) {
  std::vector<std::string> names;
  for (const Option& option : options) names.insert(names.end(), option.names.begin(), option.names.end());
  return names;
}

std::vector<std::string> help_words(const std::vector<Command>& commands) {
  std::vector<std::string> words = names_of(commands);
  words.emplace_back("case");
  return words;
}

// --- bash -----------------------------------------------------------------------------------------------------

constexpr std::string_view bash_frame = R"(# bash completion of isorim, made by: isorim help --completion bash
_isorim() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}} command=${{COMP_WORDS[1]}} options=
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    mapfile -t COMPREPLY < <(compgen -W '{commands} {options}' -- "$current")
    return
  fi
  case "$command $previous" in
{values}    'help case')
      mapfile -t COMPREPLY < <(compgen -W '{topics}' -- "$current")
      return
      ;;
  esac
  case $command in
{command_options}  esac
  if [[ $current == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$current")
  elif [[ $command == help ]]; then
    mapfile -t COMPREPLY < <(compgen -W '{help_words}' -- "$current")
  else
    compopt -o filenames
    mapfile -t COMPREPLY < <(compgen -f -- "$current")
  fi
}}
complete -F _isorim isorim
)";

/// The cases of `values`: options after which a file, a folder or nothing that is known stands.
std::string bash_values(const std::vector<Command>& commands) {
  std::vector<std::string> files;
  std::vector<std::string> folders;
  std::vector<std::string> others;
  for (const Command& command : commands) {
    for (const Option& option : command.options) {
      if (!option.takes_value) continue;
      const Operand operand = operand_of(option.value);
      auto& list = operand == Operand::file ? files : operand == Operand::folder ? folders : others;
      for (const std::string& name : option.names) list.push_back(fmt::format("'{} {}'", command.name, name));
    }
  }
  std::string text;
  const auto add = [&](const std::vector<std::string>& patterns, std::string_view compgen) {
    if (patterns.empty()) return;
    text += fmt::format("    {})\n", fmt::join(patterns, " | "));
    if (!compgen.empty()) {
      text += fmt::format("      compopt -o filenames\n      mapfile -t COMPREPLY < <(compgen {} -- \"$current\")\n",
                          compgen);
    }
    text += "      return\n      ;;\n";
  };
  add(files, "-f");
  add(folders, "-d");
  add(others, "");
  return text;
}

std::string bash_script(const CLI::App& app, const std::vector<std::string>& topics) {
  const std::vector<Command> commands = commands_of(app);
  std::string command_options;
  for (const Command& command : commands) {
    command_options +=
        fmt::format("    {}) options='{}' ;;\n", command.name, fmt::join(names_of(command.options), " "));
  }
  return fmt::format(bash_frame, fmt::arg("commands", fmt::join(names_of(commands), " ")),
                     fmt::arg("options", fmt::join(names_of(describe(app).options), " ")),
                     fmt::arg("values", bash_values(commands)), fmt::arg("topics", fmt::join(topics, " ")),
                     fmt::arg("command_options", command_options),
                     fmt::arg("help_words", fmt::join(help_words(commands), " ")));
}

// --- zsh ------------------------------------------------------------------------------------------------------

/// For single quotes, the characters `marks` escaped.
std::string zsh_quoted(std::string_view text, std::string_view marks = "[]:\\") {
  std::string quoted;
  for (const char c : text) {
    if (c == '\'') {
      quoted += "'\\''";
      continue;
    }
    if (marks.find(c) != std::string_view::npos) quoted += '\\';
    quoted += c;
  }
  return quoted;
}

std::string_view zsh_action(Operand operand) {
  switch (operand) {
    case Operand::file:
      return "_files";
    case Operand::folder:
      return "_files -/";
    case Operand::none:
      return " ";
  }
  return " ";
}

std::string zsh_option(const Option& option) {
  const std::string value =
      option.takes_value ? fmt::format(":{}:{}", zsh_quoted(option.value), zsh_action(operand_of(option.value))) : "";
  if (option.names.size() == 1) {
    return fmt::format("'*{}[{}]{}'", option.names.front(), zsh_quoted(option.text), value);
  }
  return fmt::format("'({})'{{{}}}'[{}]{}'", fmt::join(option.names, " "), fmt::join(option.names, ","),
                     zsh_quoted(option.text), value);
}

std::string zsh_command(const Command& command) {
  std::string text = fmt::format("        {})\n          _arguments", command.name);
  for (const Option& option : command.options) text += " \\\n            " + zsh_option(option);
  for (const std::string& operand : command.operands) {
    const std::string action = command.name == "help" ? "_isorim_topics" : operand == "DIR" ? "_files -/" : "_files";
    text += fmt::format(" \\\n            '{}:{}:{}'", command.name == "help" ? "*" : "", zsh_quoted(operand), action);
  }
  return text + "\n          ;;\n";
}

constexpr std::string_view zsh_frame = R"(#compdef isorim
# zsh completion of isorim, made by: isorim help --completion zsh
_isorim_topics() {{
  if ((CURRENT > 2)); then
    compadd {topics}
  else
    compadd {help_words}
  fi
}}

_isorim() {{
  local line state
  local -a commands=(
{descriptions}  )
  _arguments -C {options} '1: :->command' '*:: :->arguments'
  case $state in
    command) _describe command commands ;;
    arguments)
      case $line[1] in
{commands}      esac
      ;;
  esac
}}

_isorim "$@"
)";

std::string zsh_script(const CLI::App& app, const std::vector<std::string>& topics) {
  const std::vector<Command> commands = commands_of(app);
  std::string descriptions;
  std::string cases;
  std::vector<std::string> options;
  for (const Option& option : describe(app).options) options.push_back(zsh_option(option));
  for (const Command& command : commands) {
    descriptions += fmt::format("    '{}:{}'\n", command.name, zsh_quoted(command.text, ":\\"));
    cases += zsh_command(command);
  }
  return fmt::format(zsh_frame, fmt::arg("topics", fmt::join(topics, " ")),
                     fmt::arg("help_words", fmt::join(help_words(commands), " ")),
                     fmt::arg("options", fmt::join(options, " ")), fmt::arg("descriptions", descriptions),
                     fmt::arg("commands", cases));
}

}  // namespace

std::string completion_script(const CLI::App& app, Shell shell, const std::vector<std::string>& topics) {
  return shell == Shell::bash ? bash_script(app, topics) : zsh_script(app, topics);
}

}  // namespace isorim::cli
