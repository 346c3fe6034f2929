#include <iostream>
#include <string>
#include <vector>

#include "io/cli/program.h"

int main(int argc, char** argv) {
  return isorim::cli::run_program(std::vector<std::string>(argv + 1, argv + argc), std::cout, std::cerr);
}
