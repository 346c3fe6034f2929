#include <chrono>
#include <exception>
#include <iostream>
#include <string>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include "geometry/errors.h"
#include "io/cli/commands.h"
#include "io/excerpt.h"

namespace isorim::cli {
namespace {

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

void print_message(std::ostream& err, std::string_view message) {
  while (!message.empty()) {
    const std::size_t end = std::min(message.find('\n'), message.size());
    err << "isorim: " << io::excerpt(message.substr(0, end), std::string_view::npos) << '\n';
    message.remove_prefix(std::min(end + 1, message.size()));
  }
}

int exit_status_of(const std::exception& error) {
  const bool is_input =
      dynamic_cast<const InputError*>(&error) != nullptr || dynamic_cast<const GeometryError*>(&error) != nullptr;
  return is_input ? 2 : 3;
}

int report_failure(const std::exception& error, std::ostream& err) {
  print_message(err, error.what());
  return exit_status_of(error);
}

ProgressLine::ProgressLine(std::ostream& err) : err_(err), start_(now()) {}

ProgressLine::~ProgressLine() {
  if (shown_) err_ << "\r\033[K" << std::flush;
}

std::function<void(std::string_view, double)> ProgressLine::reporter() {
  if (&err_ != &std::cerr || isatty(STDERR_FILENO) == 0) return {};
  return [this](std::string_view stage, double fraction) { report(stage, fraction); };
}

void ProgressLine::report(std::string_view stage, double fraction) {
  const double elapsed = now() - start_;
  if (elapsed < shown_at_) return;
  err_ << fmt::format("\r\033[Kisorim: {} {:3.0f} %", stage, 100.0 * fraction) << std::flush;
  shown_ = true;
  shown_at_ = elapsed + 0.1;
}

}  // namespace isorim::cli
