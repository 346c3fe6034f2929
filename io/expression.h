#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "quadrature/rim.h"

/// Expressions in the coordinates, as case files hold them.
namespace isorim::io {

/// What an expression may name besides the coordinates: nothing in the domain, the outward unit normal nx, ny (nz) on
/// the boundary.
enum class ExpressionScope { domain, boundary };

/// A name for an expression in the coordinates and in the names defined before it.
struct Definition {
  std::string name;
  std::string text;
};
using Definitions = std::vector<Definition>;

/// The function that `text` describes, in x, y (and z), with the constants pi and e, the operators + - * / ^, the
/// comparisons and a ? b : c, the functions of muParser (sqrt, exp, ln, log10, sin, atan2, min, max, ...) and the names
/// of `definitions`, of which only those that are named cost time, and those that are constant none.
///
/// Every call of the factory parses anew, so each thread has its own parser. Throws InputError "at character 5: found
/// ...; expected ..." for what does not parse, names what the scope does not have, assigns, or has several results.
/// About 0.1 us a point and operation.
template <int Dim>
quadrature::IntegrandFactory<Dim> compile_integrand(const std::string& text, ExpressionScope scope,
                                                    const Definitions& definitions = {});

/// A function of named numbers; an object serves one thread.
using NamedFunction = std::function<double(std::span<const double>)>;

/// The function of `names` that `text` describes. The first `coordinates` of them are x, y (and z), which alone the
/// definitions know. Otherwise as compile_integrand().
std::function<NamedFunction()> compile_function(const std::string& text, std::vector<std::string> names,
                                                int coordinates, const Definitions& definitions = {});

/// The number that `text` is if it names no coordinate, directly or by definitions. Errors as compile_integrand().
std::optional<double> constant_value(const std::string& text, int coordinates, const Definitions& definitions = {});

/// Throws InputError as compile_integrand() does for the last of `definitions`, and if its name is no name, is taken or
/// means something already; those before it must be sound.
void check_last_definition(const Definitions& definitions, int coordinates);

}  // namespace isorim::io
