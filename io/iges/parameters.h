#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/iges/file.h"

namespace isorim::io::iges {

/// The pointers that may follow an entity's own parameters.
struct TrailingPointers {
  /// To associativities, notes and views that the entity belongs to.
  std::vector<int> associativities;
  /// To properties (406) and attributes: the name of the entity is one of them.
  std::vector<int> properties;
  /// Why what follows is not such a list, and was left out; empty if all was well.
  std::string complaint;
};

/// A cursor over the parameters of an entity.
///
/// An omitted value (nothing between two delimiters) is 0, an empty text, no pointer; a cursor beyond the last
/// parameter throws. With a fallback both give the fallback. Every function throws InputError that names file, entity,
/// number of the parameter (counted from 1 after the type number) and line of the P section, what was found and what
/// was expected.
class Parameters {
 public:
  /// Throws InputError if the entity has a complaint. The file must outlive the cursor.
  Parameters(const File& file, const Entity& entity);

  const Entity& entity() const { return entity_; }
  /// How many parameters are left.
  int remaining() const { return static_cast<int>(entity_.tokens.size()) - static_cast<int>(position_); }
  /// Number of the parameter that comes next.
  int number() const { return static_cast<int>(position_) + 1; }
  /// Nothing is written where the next parameter should be, or the parameters end before.
  bool is_omitted() const;
  void skip(int count = 1);

  /// The double that is nearest to the decimal number; too small ones are 0.
  double real();
  double real(double fallback);
  /// Values written like 3.0 are integers too.
  int integer();
  int integer(int fallback);
  /// Number of the things that follow, each of which takes at least `values_each` parameters: neither negative nor more
  /// than are left, so that it is safe to make room for them.
  int count(int values_each = 1);
  /// D number of an entity that exists, or 0 for none.
  int pointer();
  int pointer(int fallback);
  /// As pointer(), but there must be one.
  const Entity& target();
  /// Integer 0 or 1.
  bool logical();
  bool logical(bool fallback);
  /// A Hollerith string in UTF-8 (bytes that are not are taken for Latin-1; control characters become blanks).
  std::string text();
  std::string text(std::string fallback);

  /// Exactly as many as there is room for, or as asked for.
  void reals(std::span<double> values);
  std::vector<double> reals(int count);
  std::vector<int> pointers(int count);

  /// The two groups of pointers behind the entity's own parameters, from the cursor to the end.
  TrailingPointers trailing_pointers();

  /// Throws InputError with the message behind file, entity, parameter and line: for what only the reader of the entity
  /// sees. `parameter` is counted from 1; by default the one that was read last.
  [[noreturn]] void refuse(const std::string& message, int parameter = 0) const;

 private:
  std::string_view next();
  /// Past an omitted parameter; beyond the last one there is nowhere to go.
  void step_over();
  double as_real(std::string_view token);
  int as_integer(std::string_view token);
  int as_pointer(std::string_view token);

  const File& file_;
  const Entity& entity_;
  std::size_t position_ = 0;
};

}  // namespace isorim::io::iges
