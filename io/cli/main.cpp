#include <iostream>
#include <string>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include "io/cli/commands.h"
#include "io/cli/program.h"

namespace {

/// A stream that the caller has closed must not pass its number on to a file of results.
void open_standard_streams() {
  for (int descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; ++descriptor) {
    if (fcntl(descriptor, F_GETFD) >= 0) continue;
    // The lowest free number is the one that is missing; if even this fails there is nobody to tell.
    [[maybe_unused]] const int opened = open("/dev/null", descriptor == STDIN_FILENO ? O_RDONLY : O_WRONLY);
  }
}

}  // namespace

int main(int argc, char** argv) {
  open_standard_streams();
  const int status = isorim::cli::run_program(std::vector<std::string>(argv + 1, argv + argc), std::cout, std::cerr);
  if (std::cout.flush()) return status;
  isorim::cli::print_message(std::cerr, "cannot write to the standard output");
  return status == 0 ? 2 : status;
}
