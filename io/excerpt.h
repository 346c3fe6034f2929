#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace isorim::io {

/// A text as messages show it: control characters, which a terminal would act on, as "\x1b", and after `most` bytes
/// "...". Characters of UTF-8 stay whole.
std::string excerpt(std::string_view text, std::size_t most = 60);

}  // namespace isorim::io
