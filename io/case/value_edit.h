#pragma once

#include <string>
#include <string_view>

#include "io/case/value.h"

/// Changes of a tree of values from within the program.
namespace isorim::io {

/// Puts `value` into the tree at `path` ("section.key", lists and missing tables as for apply_override()). Throws
/// InputError "what: ..." as apply_override() does.
void set_value(Value& root, std::string_view path, Value value, const std::string& what);

/// The value that `text` stands for behind the '=' of an override: TOML, else text. `place` is where it and all in it
/// were written.
Value value_from_text(std::string_view text, const Place& place);

/// A single value as TOML writes it behind a key, on one line.
std::string inline_toml(const Value& value);

}  // namespace isorim::io
