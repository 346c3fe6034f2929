#pragma once

#include <string>
#include <vector>

#include "io/case/schema.h"

/// Help texts and the reference, made from the declarations that the reader uses.
namespace isorim::io {

/// The sections of a case file and the types of shapes, a line each.
std::string case_overview();

/// All keys of a section ("properties") or of a type ("sphere", "nurbs", "axis"); of every one if several have the
/// name. Throws InputError with the nearest name if there is none.
std::string case_topic(const std::string& name);

/// The declarations behind case_topic(); those of all tables that a case file may hold if the name is empty. Throws as
/// case_topic() does.
std::vector<const Description*> case_tables(const std::string& name = "");

/// What case_topic() knows, once each, in the order of case_reference_markdown().
std::vector<std::string> case_topics();

/// Everything, as Markdown.
std::string case_reference_markdown();

/// A table and the tables in it, each once.
std::vector<const Description*> described_tables(const Description& root);

/// All keys of a table and of the tables in it, for the terminal and as Markdown.
std::string reference_text(const Description& root);
std::string reference_markdown(const Description& root);

}  // namespace isorim::io
