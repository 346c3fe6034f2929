#pragma once

#include <string>

#include <pybind11/pybind11.h>

#include "io/case/value.h"

namespace isorim::python {

/// The tree of a case from dictionaries, lists, tuples, numbers, texts, paths and numpy arrays, as TOML would give it;
/// entries that are None are left out. `name` is what messages call the case. Throws TypeError, with the path of the
/// key, for anything else.
io::Value to_value(const pybind11::handle& object, const std::string& name);

}  // namespace isorim::python
