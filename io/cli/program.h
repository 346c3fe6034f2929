#pragma once

#include <iosfwd>
#include <string>
#include <vector>

namespace isorim::cli {

/// The program: `args` are the arguments without the program's name. Results go to `out`, messages to `err`.
/// Exit status: 0 all well and every expectation met; 1 an expectation was missed; 2 bad input or usage; 3 a
/// numerical failure. Never throws.
int run_program(const std::vector<std::string>& args, std::ostream& out, std::ostream& err);

}  // namespace isorim::cli
