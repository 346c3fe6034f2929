#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include "io/case/complaints.h"
#include "io/case/value.h"

/// Declarations of what a case file may say. A key is declared once, with the struct member that takes its value;
/// the parser, the validator, `isorim help case` and the reference are all made from the declarations, and a default
/// is the member's own initialiser.
namespace isorim::io {

/// Admissible numbers; of a list, of each entry.
struct Range {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool least_is_open = false;
  bool most_is_open = false;

  static Range above(double limit) { return {.least = limit, .least_is_open = true}; }
  static Range at_least(double limit) { return {.least = limit}; }
  static Range between(double least, double most) { return {.least = least, .most = most}; }

  bool contains(double x) const;
  /// "> 0", ">= 1", "from 1 to 30"; empty if every number will do.
  std::string describe() const;
};

enum class Presence { optional, required };

struct Description;

/// What help and reference say of a key.
struct KeyDescription {
  std::string name;
  /// "real", "list of 3 reals", "table", ...
  std::string type;
  std::string text;
  std::string unit;
  /// As it would be written in the file; empty without a default.
  std::string default_text;
  std::string range_text;
  Presence presence = Presence::optional;
  std::vector<std::string> choices;
  /// What the table or tables under this key may hold; the list is empty for plain values.
  std::function<std::vector<const Description*>()> nested;
};

/// A kind of table: a section, a shape, a part of a shape.
struct Description {
  std::string name;
  std::string text;
  std::vector<KeyDescription> keys;
  /// Keys that the design knows and this version does not: refused as such.
  std::vector<std::string> later;
};

struct KeyOptions {
  std::string text;
  std::string unit = "";
  Range range = {};
  Presence presence = Presence::optional;
};

template <class T>
class Schema;

/// The declarations of the table that fills a T; specialised for each such struct.
template <class T>
const Schema<T>& schema();

/// How a member of type M is read from a value: type(), read(), print() and, for tables, nested(). The primary
/// template reads a struct that has a schema.
template <class M>
struct KeyType;

// --- Plain values ---------------------------------------------------------------------------------------------

/// A point or direction whose number of coordinates depends on the shape it belongs to.
struct Coordinates {
  std::vector<double> values;
  KeyPlace where;
};

/// Points on a grid: one flat list (the first parameter fastest), or a list of rows.
struct PointGrid {
  std::vector<Coordinates> points;
  /// The length of the rows; 0 if the list was flat.
  int row_length = 0;
  KeyPlace where;
};

/// A number, a list of numbers or a list of such lists, entry by entry.
struct NumberArray {
  std::vector<double> values;
  int rows = 1;
  int columns = 1;
  KeyPlace where;
};

/// The messages "found the text "x"; expected a real".
void complain_type(Complaints& complaints, const KeyPlace& where, const Value& value, std::string_view expected);

bool read_boolean(const Value& value, bool& target, const KeyPlace& where, Complaints& complaints);
bool read_integer(const Value& value, int& target, const Range& range, const KeyPlace& where, Complaints& complaints);
/// Integers are taken as reals; what is not finite is refused.
bool read_real(const Value& value, double& target, const Range& range, const KeyPlace& where, Complaints& complaints);
bool read_text(const Value& value, std::string& target, const KeyPlace& where, Complaints& complaints);
/// `count` is the number of entries wanted; 0 for any number but none.
bool read_reals(const Value& value, std::vector<double>& target, std::size_t count, const Range& range,
                const KeyPlace& where, Complaints& complaints);
bool read_integers(const Value& value, std::span<int> target, const Range& range, const KeyPlace& where,
                   Complaints& complaints);
bool read_coordinates(const Value& value, Coordinates& target, const Range& range, const KeyPlace& where,
                      Complaints& complaints);
bool read_grid(const Value& value, PointGrid& target, const KeyPlace& where, Complaints& complaints);
bool read_number_array(const Value& value, NumberArray& target, const KeyPlace& where, Complaints& complaints);
std::string print_reals(const double* values, std::size_t count);
std::string print_real(double value);

struct PlainKey {
  static std::vector<const Description*> nested() { return {}; }
};

template <>
struct KeyType<bool> : PlainKey {
  static std::string type() { return "true or false"; }
  static bool read(const Value& v, bool& t, const Range&, const KeyPlace& w, Complaints& c) {
    return read_boolean(v, t, w, c);
  }
  static std::string print(bool value) { return value ? "true" : "false"; }
};

template <>
struct KeyType<int> : PlainKey {
  static std::string type() { return "integer"; }
  static bool read(const Value& v, int& t, const Range& r, const KeyPlace& w, Complaints& c) {
    return read_integer(v, t, r, w, c);
  }
  static std::string print(int value) { return std::to_string(value); }
};

template <>
struct KeyType<double> : PlainKey {
  static std::string type() { return "real"; }
  static bool read(const Value& v, double& t, const Range& r, const KeyPlace& w, Complaints& c) {
    return read_real(v, t, r, w, c);
  }
  static std::string print(double value) { return print_real(value); }
};

template <>
struct KeyType<std::string> : PlainKey {
  static std::string type() { return "text"; }
  static bool read(const Value& v, std::string& t, const Range&, const KeyPlace& w, Complaints& c) {
    return read_text(v, t, w, c);
  }
  static std::string print(const std::string& value) { return value.empty() ? "" : '"' + value + '"'; }
};

template <>
struct KeyType<Coordinates> : PlainKey {
  static std::string type() { return "point"; }
  static bool read(const Value& v, Coordinates& t, const Range& r, const KeyPlace& w, Complaints& c) {
    return read_coordinates(v, t, r, w, c);
  }
  static std::string print(const Coordinates& value) {
    return value.values.empty() ? "" : print_reals(value.values.data(), value.values.size());
  }
};

template <>
struct KeyType<PointGrid> : PlainKey {
  static std::string type() { return "list of points or of rows of points"; }
  static bool read(const Value& v, PointGrid& t, const Range&, const KeyPlace& w, Complaints& c) {
    return read_grid(v, t, w, c);
  }
  static std::string print(const PointGrid&) { return ""; }
};

template <>
struct KeyType<NumberArray> : PlainKey {
  static std::string type() { return "real, list of reals or list of rows"; }
  static bool read(const Value& v, NumberArray& t, const Range&, const KeyPlace& w, Complaints& c) {
    return read_number_array(v, t, w, c);
  }
  static std::string print(const NumberArray&) { return ""; }
};

template <int N>
struct KeyType<Eigen::Matrix<double, N, 1>> : PlainKey {
  using Vector = Eigen::Matrix<double, N, 1>;
  static std::string type() { return "list of " + std::to_string(N) + " reals"; }
  static bool read(const Value& v, Vector& t, const Range& r, const KeyPlace& w, Complaints& c) {
    std::vector<double> values;
    if (!read_reals(v, values, N, r, w, c)) return false;
    t = Eigen::Map<const Vector>(values.data());
    return true;
  }
  static std::string print(const Vector& value) { return print_reals(value.data(), N); }
};

template <int N>
struct KeyType<Eigen::Matrix<int, N, 1>> : PlainKey {
  using Vector = Eigen::Matrix<int, N, 1>;
  static std::string type() { return "list of " + std::to_string(N) + " integers"; }
  static bool read(const Value& v, Vector& t, const Range& r, const KeyPlace& w, Complaints& c) {
    return read_integers(v, {t.data(), N}, r, w, c);
  }
  static std::string print(const Vector&) { return ""; }
};

template <>
struct KeyType<std::vector<double>> : PlainKey {
  static std::string type() { return "list of reals"; }
  static bool read(const Value& v, std::vector<double>& t, const Range& r, const KeyPlace& w, Complaints& c) {
    return read_reals(v, t, 0, r, w, c);
  }
  static std::string print(const std::vector<double>& value) {
    return value.empty() ? "" : print_reals(value.data(), value.size());
  }
};

template <class M>
struct KeyType<std::optional<M>> {
  static std::string type() { return KeyType<M>::type(); }
  static std::vector<const Description*> nested() { return KeyType<M>::nested(); }
  static bool read(const Value& v, std::optional<M>& t, const Range& r, const KeyPlace& w, Complaints& c) {
    M value{};
    if (!KeyType<M>::read(v, value, r, w, c)) return false;
    t = std::move(value);
    return true;
  }
  static std::string print(const std::optional<M>&) { return ""; }
};

/// A list, each entry read by its own type.
template <class M>
struct KeyType<std::vector<M>> {
  static std::string type() { return "list of " + plural(KeyType<M>::type()); }
  static std::vector<const Description*> nested() { return KeyType<M>::nested(); }
  static bool read(const Value& v, std::vector<M>& t, const Range& r, const KeyPlace& w, Complaints& c) {
    const auto* list = v.as<Value::Array>();
    if (!list) {
      complain_type(c, w, v, "a " + type());
      return false;
    }
    bool good = true;
    for (std::size_t i = 0; i < list->size(); ++i) {
      M item{};
      good &= KeyType<M>::read((*list)[i], item, r, w.item(i, (*list)[i].place), c);
      t.push_back(std::move(item));
    }
    return good;
  }
  static std::string print(const std::vector<M>& value) {
    std::string text;
    for (const M& item : value) text += (text.empty() ? "" : ", ") + KeyType<M>::print(item);
    return text.empty() ? "" : "[" + text + "]";
  }

 private:
  static std::string plural(const std::string& type) { return type == "true or false" ? "booleans" : type + "s"; }
};

/// One M or a list of them.
template <class M>
struct OneOrMany {
  std::vector<M> items;
  /// Found "[]", not nothing.
  bool is_empty_list = false;
};

template <class M>
struct KeyType<OneOrMany<M>> {
  static std::string type() { return KeyType<M>::type() + " or list of " + KeyType<M>::type() + "s"; }
  static std::vector<const Description*> nested() { return KeyType<M>::nested(); }
  static bool read(const Value& v, OneOrMany<M>& t, const Range& r, const KeyPlace& w, Complaints& c) {
    if (const auto* list = v.as<Value::Array>()) {
      t.is_empty_list = list->empty();
      return KeyType<std::vector<M>>::read(v, t.items, r, w, c);
    }
    M item{};
    if (!KeyType<M>::read(v, item, r, w, c)) return false;
    t.items.push_back(std::move(item));
    return true;
  }
  static std::string print(const OneOrMany<M>&) { return ""; }
};

// --- Tables ---------------------------------------------------------------------------------------------------

template <class M>
struct KeyType {
  static std::string type() { return "table"; }
  static std::vector<const Description*> nested() { return {&schema<M>().description()}; }
  static bool read(const Value& v, M& t, const Range&, const KeyPlace& w, Complaints& c) {
    return schema<M>().read(v, t, w, c);
  }
  static std::string print(const M&) { return ""; }
};

/// Complains of the keys of `table` that `description` does not have. `passed_over` is the tag of a shape.
bool check_keys(const Value& table, const Description& description, std::string_view passed_over, const KeyPlace& where,
                Complaints& complaints);
/// Reads a choice; complains with the list of them and the nearest.
bool read_choice(const Value& value, std::span<const std::string> choices, std::size_t& index, const KeyPlace& where,
                 Complaints& complaints);

/// The declarations of a table that fills a T, built up key by key.
template <class T>
class Schema {
 public:
  Schema(std::string name, std::string text) { description_ = {std::move(name), std::move(text), {}, {}}; }

  template <class Base, class M>
  Schema& key(const std::string& name, M Base::*member, KeyOptions options) {
    using Type = KeyType<M>;
    const std::string default_text = options.presence == Presence::required ? "" : Type::print(T{}.*member);
    declare(name, Type::type(), default_text, options).nested = &Type::nested;
    readers_.push_back([member, range = options.range](const Value& v, T& t, const KeyPlace& w, Complaints& c) {
      return Type::read(v, t.*member, range, w, c);
    });
    return *this;
  }

  /// A text out of few, each standing for a value of E.
  template <class Base, class E>
  Schema& choice(const std::string& name, E Base::*member, std::vector<std::pair<std::string, E>> choices,
                 KeyOptions options) {
    std::vector<std::string> names;
    std::string default_text;
    for (const auto& [text, value] : choices) {
      names.push_back(text);
      if (options.presence == Presence::optional && T{}.*member == value) default_text = '"' + text + '"';
    }
    declare(name, "text", default_text, options).choices = names;
    readers_.push_back([member, choices, names](const Value& v, T& t, const KeyPlace& w, Complaints& c) {
      std::size_t index = 0;
      if (!read_choice(v, names, index, w, c)) return false;
      t.*member = choices[index].second;
      return true;
    });
    return *this;
  }

  Schema& later(std::vector<std::string> names) {
    description_.later = std::move(names);
    return *this;
  }

  /// A rule between keys, met after all of them were read without complaint.
  Schema& check(std::function<void(const T&, const KeyPlace&, Complaints&)> rule) {
    checks_.push_back(std::move(rule));
    return *this;
  }

  const Description& description() const { return description_; }

  /// Fills `target`; false if there was something to complain of. `passed_over` is a key that belongs to the caller.
  bool read(const Value& value, T& target, const KeyPlace& where, Complaints& complaints,
            std::string_view passed_over = "") const {
    if (!value.as<Value::Table>()) {
      complain_type(complaints, where, value, "a table");
      return false;
    }
    bool good = check_keys(value, description_, passed_over, where, complaints);
    if constexpr (requires { target.where; }) target.where = where;
    for (std::size_t i = 0; i < readers_.size(); ++i) {
      const std::string& name = description_.keys[i].name;
      if (const Value* found = value.find(name)) {
        good &= readers_[i](*found, target, where.key(name, found->place), complaints);
      }
    }
    if (!good) return false;
    const std::size_t before = complaints.count();
    for (const auto& rule : checks_) rule(target, where, complaints);
    return complaints.count() == before;
  }

 private:
  KeyDescription& declare(const std::string& name, std::string type, std::string default_text,
                          const KeyOptions& options) {
    KeyDescription key;
    key.name = name;
    key.type = std::move(type);
    key.text = options.text;
    key.unit = options.unit;
    key.default_text = std::move(default_text);
    key.range_text = options.range.describe();
    key.presence = options.presence;
    description_.keys.push_back(std::move(key));
    return description_.keys.back();
  }

  Description description_;
  std::vector<std::function<bool(const Value&, T&, const KeyPlace&, Complaints&)>> readers_;
  std::vector<std::function<void(const T&, const KeyPlace&, Complaints&)>> checks_;
};

/// The values of the key `type` of a shape.
struct TypeTags {
  /// What this version builds.
  std::vector<std::string> names;
  /// What the design knows and this version does not build: refused as such.
  std::vector<std::string> later;
  /// A table with this key and without `type` is of type `implied_type`; empty if there is no such thing.
  std::string implying_key;
  std::string implied_type;
  /// Other names of types: {alias, name}.
  std::vector<std::pair<std::string, std::string>> aliases = {};
};
/// Finds which of `tags.names` the table `value` is.
bool read_type(const Value& value, const TypeTags& tags, std::size_t& index, const KeyPlace& where,
               Complaints& complaints);

/// The `type` names of the alternatives of a variant, in its order; specialised for each variant of shapes.
template <class V>
const TypeTags& type_tags();

/// A table whose key `type` tells which struct it fills.
template <class... Ts>
struct KeyType<std::variant<Ts...>> {
  using Variant = std::variant<Ts...>;
  static std::string type() { return "table"; }
  static std::vector<const Description*> nested() { return {&schema<Ts>().description()...}; }
  static bool read(const Value& v, Variant& t, const Range&, const KeyPlace& w, Complaints& c) {
    std::size_t index = 0;
    if (!read_type(v, type_tags<Variant>(), index, w, c)) return false;
    return read_alternative(v, t, index, w, c, std::index_sequence_for<Ts...>{});
  }
  static std::string print(const Variant&) { return ""; }

 private:
  template <std::size_t... I>
  static bool read_alternative(const Value& v, Variant& t, std::size_t index, const KeyPlace& w, Complaints& c,
                               std::index_sequence<I...>) {
    bool good = false;
    const auto read_if = [&]<std::size_t J>(std::integral_constant<std::size_t, J>) {
      if (J != index) return;
      using Shape = std::variant_alternative_t<J, Variant>;
      good = schema<Shape>().read(v, t.template emplace<J>(), w, c, "type");
    };
    (read_if(std::integral_constant<std::size_t, I>{}), ...);
    return good;
  }
};

}  // namespace isorim::io
