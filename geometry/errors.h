#pragma once

#include <stdexcept>
#include <string>
#include <utility>

/// The three ways in which isorim fails. A library never prints or exits: it throws one of these, each layer that
/// knows more (the patch, the case key, the file and line) adds it with `add_context`, and the program prints
/// "context: context: message" and picks the exit status.
namespace isorim {

class Error : public std::runtime_error {
 public:
  explicit Error(std::string message) : std::runtime_error(message), message_(std::move(message)) {}

  /// "context: message". Outer layers call it last, so the file stands first.
  const char* what() const noexcept override { return message_.c_str(); }

  /// Puts "context: " before the message.
  void add_context(const std::string& context) { message_ = context + ": " + message_; }

 private:
  std::string message_;
};

/// A file, a case or a command line says something that cannot be meant. Exit status 2.
class InputError : public Error {
 public:
  using Error::Error;
};

/// Data that do not describe a shape: a falling knot vector, a weight <= 0, an open loop. Exit status 2.
class GeometryError : public Error {
 public:
  using Error::Error;
};

/// The numbers fail though the input is sound: an integrand that is not finite, a singular matrix. Exit status 3.
class NumericalError : public Error {
 public:
  using Error::Error;
};

}  // namespace isorim
