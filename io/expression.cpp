#include "io/expression.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <memory>
#include <numbers>
#include <vector>

#include <fmt/format.h>
#include <muParser.h>

#include "geometry/errors.h"

namespace isorim::io {
namespace {

template <int Dim>
constexpr std::array<const char*, 2 * Dim> variable_names() {
  if constexpr (Dim == 2) {
    return {"x", "y", "nx", "ny"};
  } else {
    return {"x", "y", "z", "nx", "ny", "nz"};
  }
}

/// A parser with the variables that it is bound to; neither copied nor moved, since it knows their addresses.
template <int Dim>
struct BoundParser {
  mu::Parser parser;
  std::array<double, 2 * Dim> variables{};

  BoundParser(const std::string& text, ExpressionScope scope) {
    parser.ClearConst();
    parser.DefineConst("pi", std::numbers::pi);
    parser.DefineConst("e", std::numbers::e);
    const auto names = variable_names<Dim>();
    const std::size_t count = scope == ExpressionScope::boundary ? names.size() : Dim;
    for (std::size_t i = 0; i < count; ++i) parser.DefineVar(names[i], &variables[i]);
    parser.SetExpr(text);
  }
  BoundParser(const BoundParser&) = delete;
  BoundParser& operator=(const BoundParser&) = delete;
};

std::string at_character(std::size_t position) {
  return fmt::format("at character {}: ", position + 1);
}

/// The text as messages show it: no longer than a line.
std::string excerpt(const std::string& text) {
  constexpr std::size_t most = 60;
  return text.size() <= most ? text : text.substr(0, most) + "...";
}

/// muParser would end the text at a NUL and stumble over the others; white space is no such character.
void refuse_control_characters(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    if (std::iscntrl(c) == 0 || std::isspace(c) != 0) continue;
    throw InputError(fmt::format("{}found the control character {:#04x}", at_character(i), c));
  }
}

/// muParser would take "x = 1" as an assignment.
void refuse_assignment(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '=') continue;
    const bool compares = (i > 0 && std::string("=<>!").find(text[i - 1]) != std::string::npos) ||
                          (i + 1 < text.size() && text[i + 1] == '=');
    if (!compares) throw InputError(at_character(i) + "found an assignment; expected an expression (== compares)");
  }
}

bool is_name(const std::string& token) {
  return !token.empty() && (std::isalpha(static_cast<unsigned char>(token.front())) || token.front() == '_');
}

/// Why the name is not there, if it would be elsewhere.
template <int Dim>
std::string name_reason(const std::string& name, ExpressionScope scope) {
  const bool is_normal = name == "nx" || name == "ny" || name == "nz";
  if (Dim == 2 && (name == "z" || name == "nz")) return fmt::format("\"{}\" in the plane", name);
  if (is_normal && scope == ExpressionScope::domain) {
    return fmt::format("\"{}\", the normal, which only a boundary has", name);
  }
  return fmt::format("the unknown name \"{}\"", name);
}

template <int Dim>
std::string known_names(ExpressionScope scope) {
  const auto names = variable_names<Dim>();
  const auto end = scope == ExpressionScope::boundary ? names.end() : names.begin() + Dim;
  return fmt::format("{}, pi, e or a function", fmt::join(names.begin(), end, ", "));
}

/// The name that begins at or spans `position`; muParser's own token may hold only its beginning.
std::string name_at(const std::string& text, std::size_t position) {
  const auto belongs = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
  std::size_t end = position;
  while (end < text.size() && belongs(text[end])) ++end;
  return text.substr(position, end - position);
}

/// muParser's words without the position, which we give ourselves and count from 1.
std::string message_of(const mu::Parser::exception_type& error) {
  std::string message = error.GetMsg();
  for (const char* position : {" found at position", " at position", " at expression position"}) {
    message = message.substr(0, message.find(position));
  }
  return message;
}

template <int Dim>
[[noreturn]] void report(const mu::Parser::exception_type& error, const std::string& text, ExpressionScope scope) {
  if (error.GetCode() == mu::ecUNEXPECTED_EOF || error.GetPos() < 0) {
    throw InputError(fmt::format("at the end of \"{}\": {}", excerpt(text), message_of(error)));
  }
  const std::size_t position = std::min(static_cast<std::size_t>(error.GetPos()), text.size());
  if (error.GetCode() == mu::ecUNASSIGNABLE_TOKEN && is_name(error.GetToken())) {
    // muParser counts from the end of a name in some versions: look for it itself.
    const std::string& name = error.GetToken();
    const std::size_t begin = text.compare(position, name.size(), name) == 0 ? position : text.find(name);
    const std::string whole = begin == std::string::npos ? name : name_at(text, begin);
    throw InputError(fmt::format("{}found {}; expected {}", at_character(std::min(begin, position)),
                                 name_reason<Dim>(whole, scope), known_names<Dim>(scope)));
  }
  throw InputError(fmt::format("{}in \"{}\": {}", at_character(position), excerpt(text), message_of(error)));
}

/// Parses and evaluates once, so that every fault shows now and not in a thread.
template <int Dim>
void check(const std::string& text, ExpressionScope scope) {
  if (std::all_of(text.begin(), text.end(), [](char c) { return std::isspace(static_cast<unsigned char>(c)); })) {
    throw InputError("found an empty expression");
  }
  refuse_control_characters(text);
  refuse_assignment(text);
  try {
    BoundParser<Dim> bound(text, scope);
    bound.parser.Eval();
    if (const int count = bound.parser.GetNumResults(); count != 1) {
      throw InputError(
          fmt::format("found {} expressions in \"{}\", separated by commas; expected one", count, excerpt(text)));
    }
  } catch (const mu::Parser::exception_type& error) {
    report<Dim>(error, text, scope);
  }
}

}  // namespace

template <int Dim>
quadrature::IntegrandFactory<Dim> compile_integrand(const std::string& text, ExpressionScope scope) {
  check<Dim>(text, scope);
  return [text, scope]() -> quadrature::Integrand<Dim> {
    auto bound = std::make_shared<BoundParser<Dim>>(text, scope);
    return [bound](const Eigen::Ref<const geometry::Points<Dim>>& points,
                   const Eigen::Ref<const geometry::Points<Dim>>& normals, std::span<double> values) {
      const bool has_normals = normals.cols() == points.cols();
      // Not muParser's bulk mode: it opens a parallel region of its own for every call and is no faster in one thread.
      for (Eigen::Index i = 0; i < points.cols(); ++i) {
        Eigen::Map<geometry::Point<Dim>>(bound->variables.data()) = points.col(i);
        if (has_normals) Eigen::Map<geometry::Point<Dim>>(bound->variables.data() + Dim) = normals.col(i);
        values[static_cast<std::size_t>(i)] = bound->parser.Eval();
      }
    };
  };
}

template quadrature::IntegrandFactory<2> compile_integrand<2>(const std::string&, ExpressionScope);
template quadrature::IntegrandFactory<3> compile_integrand<3>(const std::string&, ExpressionScope);

}  // namespace isorim::io
