#pragma once

#include <string>

#include <gmock/gmock.h>

#include "geometry/errors.h"

/// The statement throws GeometryError, and its message holds the fragment.
#define EXPECT_GEOMETRY_ERROR(statement, fragment)                              \
  EXPECT_THROW(                                                                 \
      try { statement; } catch (const isorim::GeometryError& error) {           \
        EXPECT_THAT(std::string(error.what()), ::testing::HasSubstr(fragment)); \
        throw;                                                                  \
      },                                                                        \
      isorim::GeometryError)
