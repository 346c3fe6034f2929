#pragma once

#include <string>

#include "quadrature/rim.h"

/// Expressions in the coordinates, as case files hold them.
namespace isorim::io {

/// What an expression may name besides the coordinates: nothing in the domain, the outward unit normal nx, ny (nz) on
/// the boundary.
enum class ExpressionScope { domain, boundary };

/// The function that `text` describes, in x, y (and z), with the constants pi and e, the operators + - * / ^, the
/// comparisons and a ? b : c, and the functions of muParser (sqrt, exp, ln, log10, sin, atan2, min, max, ...).
///
/// Every call of the factory parses anew, so each thread has its own parser. Throws InputError "at character 5: found
/// ...; expected ..." for what does not parse, names what the scope does not have, assigns, or has several results.
/// About 0.1 us a point and operation.
template <int Dim>
quadrature::IntegrandFactory<Dim> compile_integrand(const std::string& text, ExpressionScope scope);

}  // namespace isorim::io
