#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace isorim::cli {

enum class Shell { bash, zsh };

/// A script that completes the command line of `app` in a shell: commands, options, files where options and operands
/// are named FILE or in any other way but DIR (folders) and N, UNIT, KEY=VALUE and the like (nothing). The operands of
/// `help` are the commands and, after `case`, `topics`.
std::string completion_script(const CLI::App& app, Shell shell, const std::vector<std::string>& topics);

}  // namespace isorim::cli
