#pragma once

#include <string>

/// Help texts and the reference, made from the declarations that the reader uses.
namespace isorim::io {

/// The sections of a case file and the types of shapes, a line each.
std::string case_overview();

/// All keys of a section ("properties") or of a type ("sphere", "nurbs", "axis"); of every one if several have the
/// name. Throws InputError with the nearest name if there is none.
std::string case_topic(const std::string& name);

/// Everything, as Markdown.
std::string case_reference_markdown();

}  // namespace isorim::io
