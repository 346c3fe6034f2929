#include "io/expression.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <memory>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <muParser.h>

#include "geometry/errors.h"
#include "io/excerpt.h"
#include "io/expression_names.h"

namespace isorim::io {
namespace {

/// What an expression may name: numbers, of which the first are the coordinates, and definitions in these.
struct Names {
  std::vector<std::string> variables;
  int coordinates = 0;
  Definitions definitions;
};

void define_variables(mu::Parser& parser, const std::vector<std::string>& names, std::size_t count,
                      std::vector<double>& slots) {
  for (std::size_t i = 0; i < count; ++i) parser.DefineVar(names[i], &slots[i]);
}

/// A text with the variables and definitions that it is bound to; neither copied nor moved, since parsers know their
/// addresses.
class BoundExpression {
 public:
  BoundExpression(const std::string& text, const Names& names) : variables_(names.variables.size()) {
    values_.reserve(names.definitions.size());
    for (std::size_t i = 0; i < names.definitions.size(); ++i) {
      auto definition = std::make_unique<mu::Parser>();
      prepare(*definition, names.definitions[i].text, names, static_cast<std::size_t>(names.coordinates), i);
      values_.push_back(0.0);
      add_definition(std::move(definition));
    }
    prepare(main_, text, names, variables_.size(), names.definitions.size());
    const auto used = used_definitions(main_);
    needed_.assign(used.begin(), used.end());
    for (const std::size_t i : used)
      needed_.insert(needed_.end(), definitions_[i].uses.begin(), definitions_[i].uses.end());
    std::sort(needed_.begin(), needed_.end());
    needed_.erase(std::unique(needed_.begin(), needed_.end()), needed_.end());
  }
  BoundExpression(const BoundExpression&) = delete;
  BoundExpression& operator=(const BoundExpression&) = delete;

  double* variables() { return variables_.data(); }
  double value() {
    for (const std::size_t i : needed_) values_[i] = definitions_[i].parser->Eval();
    return main_.Eval();
  }
  const mu::Parser& parser() const { return main_; }
  /// No variable plays a part.
  bool is_constant() const { return main_.GetUsedVar().empty(); }

 private:
  struct BoundDefinition {
    std::unique_ptr<mu::Parser> parser;
    /// Its value is known already.
    bool constant = false;
    /// All definitions that are not constant and that it needs.
    std::set<std::size_t> uses;
  };

  /// Binds the text to the first `variable_count` variables and `definition_count` definitions.
  void prepare(mu::Parser& parser, const std::string& text, const Names& names, std::size_t variable_count,
               std::size_t definition_count) {
    parser.ClearConst();
    parser.DefineConst("pi", std::numbers::pi);
    parser.DefineConst("e", std::numbers::e);
    define_variables(parser, names.variables, variable_count, variables_);
    for (std::size_t i = 0; i < definition_count; ++i) {
      if (definitions_[i].constant) {
        parser.DefineConst(names.definitions[i].name, values_[i]);
      } else {
        parser.DefineVar(names.definitions[i].name, &values_[i]);
      }
    }
    parser.SetExpr(text);
    // Faults show here; GetUsedVar() would pass over unknown names.
    parser.Eval();
  }

  /// The definitions, not constant, that a text names.
  std::set<std::size_t> used_definitions(mu::Parser& parser) const {
    std::set<std::size_t> used;
    for (const auto& [name, slot] : parser.GetUsedVar()) {
      if (slot >= values_.data() && slot < values_.data() + values_.size()) {
        used.insert(static_cast<std::size_t>(slot - values_.data()));
      }
    }
    return used;
  }

  void add_definition(std::unique_ptr<mu::Parser> parser) {
    BoundDefinition definition;
    definition.uses = used_definitions(*parser);
    for (const std::size_t i : std::set<std::size_t>(definition.uses)) {
      definition.uses.insert(definitions_[i].uses.begin(), definitions_[i].uses.end());
    }
    definition.constant = parser->GetUsedVar().empty();
    if (definition.constant) values_.back() = parser->Eval();
    definition.parser = std::move(parser);
    definitions_.push_back(std::move(definition));
  }

  std::vector<double> variables_;
  std::vector<double> values_;
  std::vector<BoundDefinition> definitions_;
  mu::Parser main_;
  /// In the order of their definition.
  std::vector<std::size_t> needed_;
};

std::string at_character(std::size_t position) {
  return fmt::format("at character {}: ", position + 1);
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
std::string name_reason(const std::string& name, const Names& names) {
  const bool is_normal = name == "nx" || name == "ny" || name == "nz";
  if (names.coordinates == 2 && (name == "z" || name == "nz")) return fmt::format("\"{}\" in the plane", name);
  if (is_normal) return fmt::format("\"{}\", the normal, which only a boundary has", name);
  return fmt::format("the unknown name \"{}\"", name);
}

std::string known_names(const Names& names) {
  std::vector<std::string> known = names.variables;
  for (const Definition& definition : names.definitions) known.push_back(definition.name);
  return fmt::format("{}, pi, e or a function", fmt::join(known, ", "));
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

[[noreturn]] void report(const mu::Parser::exception_type& error, const std::string& text, const Names& names) {
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
                                 name_reason(whole, names), known_names(names)));
  }
  throw InputError(fmt::format("{}in \"{}\": {}", at_character(position), excerpt(text), message_of(error)));
}

/// Parses and evaluates once, so that every fault shows now and not in a thread.
void check(const std::string& text, const Names& names) {
  if (std::all_of(text.begin(), text.end(), [](char c) { return std::isspace(static_cast<unsigned char>(c)); })) {
    throw InputError("found an empty expression");
  }
  refuse_control_characters(text);
  refuse_assignment(text);
  try {
    BoundExpression bound(text, names);
    bound.value();
    if (const int count = bound.parser().GetNumResults(); count != 1) {
      throw InputError(
          fmt::format("found {} expressions in \"{}\", separated by commas; expected one", count, excerpt(text)));
    }
  } catch (const mu::Parser::exception_type& error) {
    report(error, text, names);
  }
}

std::vector<std::string> coordinate_names(int coordinates) {
  std::vector<std::string> names{"x", "y", "z"};
  names.resize(static_cast<std::size_t>(coordinates));
  return names;
}

template <int Dim>
Names integrand_names(ExpressionScope scope, const Definitions& definitions) {
  std::vector<std::string> variables = coordinate_names(Dim);
  if (scope == ExpressionScope::boundary) {
    const std::array<const char*, 3> normal{"nx", "ny", "nz"};
    variables.insert(variables.end(), normal.begin(), normal.begin() + Dim);
  }
  return {std::move(variables), Dim, definitions};
}

bool is_plain_name(const std::string& name) {
  return is_name(name) && std::all_of(name.begin(), name.end(),
                                      [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; });
}

/// What the name means without any definition; empty if nothing.
std::string built_in_meaning(const std::string& name) {
  for (const char* variable : {"x", "y", "z", "nx", "ny", "nz"}) {
    if (name == variable) return name.size() == 1 ? "a coordinate" : "the normal";
  }
  for (const char* result : {"u", "q", "ux", "uy", "uz", "tx", "ty", "tz"}) {
    if (name == result) return "a result of analyses";
  }
  return constant_or_function(name);
}

}  // namespace

std::string constant_or_function(const std::string& name) {
  if (name == "pi" || name == "e") return "a constant";
  const mu::Parser parser;
  return parser.GetFunDef().contains(name) ? "a function" : "";
}

template <int Dim>
quadrature::IntegrandFactory<Dim> compile_integrand(const std::string& text, ExpressionScope scope,
                                                    const Definitions& definitions) {
  const Names names = integrand_names<Dim>(scope, definitions);
  check(text, names);
  return [text, names]() -> quadrature::Integrand<Dim> {
    auto bound = std::make_shared<BoundExpression>(text, names);
    const bool takes_normals = names.variables.size() > Dim;
    return [bound, takes_normals](const Eigen::Ref<const geometry::Points<Dim>>& points,
                                  const Eigen::Ref<const geometry::Points<Dim>>& normals, std::span<double> values) {
      const bool has_normals = takes_normals && normals.cols() == points.cols();
      // Not muParser's bulk mode: it opens a parallel region of its own for every call and is no faster in one thread.
      for (Eigen::Index i = 0; i < points.cols(); ++i) {
        Eigen::Map<geometry::Point<Dim>>(bound->variables()) = points.col(i);
        if (has_normals) Eigen::Map<geometry::Point<Dim>>(bound->variables() + Dim) = normals.col(i);
        values[static_cast<std::size_t>(i)] = bound->value();
      }
    };
  };
}

std::function<NamedFunction()> compile_function(const std::string& text, std::vector<std::string> variables,
                                                int coordinates, const Definitions& definitions) {
  const Names names{std::move(variables), coordinates, definitions};
  check(text, names);
  return [text, names]() -> NamedFunction {
    auto bound = std::make_shared<BoundExpression>(text, names);
    return [bound](std::span<const double> values) {
      std::copy(values.begin(), values.end(), bound->variables());
      return bound->value();
    };
  };
}

std::optional<double> constant_value(const std::string& text, int coordinates, const Definitions& definitions) {
  const Names names{coordinate_names(coordinates), coordinates, definitions};
  check(text, names);
  BoundExpression bound(text, names);
  if (!bound.is_constant()) return std::nullopt;
  return bound.value();
}

void check_last_definition(const Definitions& definitions, int coordinates) {
  const Definition& last = definitions.back();
  if (!is_plain_name(last.name)) {
    throw InputError(fmt::format("found the name \"{}\"; expected letters, digits and _, a letter first", last.name));
  }
  if (const std::string meaning = built_in_meaning(last.name); !meaning.empty()) {
    throw InputError(fmt::format("the name \"{}\" is {}; expected another", last.name, meaning));
  }
  const Definitions before(definitions.begin(), definitions.end() - 1);
  check(last.text, {coordinate_names(coordinates), coordinates, before});
}

template quadrature::IntegrandFactory<2> compile_integrand<2>(const std::string&, ExpressionScope, const Definitions&);
template quadrature::IntegrandFactory<3> compile_integrand<3>(const std::string&, ExpressionScope, const Definitions&);

}  // namespace isorim::io
