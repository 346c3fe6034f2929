#pragma once

#include <functional>
#include <string>

#include <gmock/gmock.h>

#include "geometry/errors.h"

namespace isorim::geometry::testing {

/// The message of the GeometryError that `action` throws; a remark if it throws none.
inline std::string refusal(const std::function<void()>& action) {
  try {
    action();
  } catch (const GeometryError& error) {
    return error.what();
  }
  return "(nothing was refused)";
}

}  // namespace isorim::geometry::testing
