#include "io/python/values.h"

#include <cstdint>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/excerpt.h"

namespace isorim::python {
namespace {

namespace py = pybind11;

class Converter {
 public:
  explicit Converter(const std::string& name) : source_(std::make_shared<const std::string>(name)) {}

  io::Value convert(const py::handle& object, const std::string& path, int depth = 0) const {
    // As deep as TOML may be; a list that holds itself has no end.
    constexpr int most = 256;
    if (depth > most) throw InputError(fmt::format("{}: found more than {} levels", io::excerpt(path), most));
    io::Value value;
    value.place = {source_, 0, 0};
    if (py::isinstance<py::bool_>(object)) {
      value.data = object.cast<bool>();
    } else if (py::isinstance<py::int_>(object)) {
      value.data = integer(object, path);
    } else if (py::isinstance<py::float_>(object)) {
      value.data = object.cast<double>();
    } else if (py::isinstance<py::str>(object)) {
      value.data = object.cast<std::string>();
    } else if (py::isinstance<py::dict>(object)) {
      value.data = table(object.cast<py::dict>(), path, depth);
    } else if (py::isinstance<py::list>(object) || py::isinstance<py::tuple>(object)) {
      value.data = array(object.cast<py::sequence>(), path, depth);
    } else if (py::hasattr(object, "tolist")) {
      return convert(object.attr("tolist")(), path, depth + 1);
    } else if (py::hasattr(object, "__fspath__")) {
      value.data = object.attr("__fspath__")().cast<std::string>();
    } else {
      throw py::type_error(fmt::format("{}: found {}; expected a dictionary, list, array, number or text",
                                       path.empty() ? "case" : path,
                                       py::type::of(object).attr("__name__").cast<std::string>()));
    }
    return value;
  }

 private:
  static std::int64_t integer(const py::handle& object, const std::string& path) {
    int overflow = 0;
    const long long value = PyLong_AsLongLongAndOverflow(object.ptr(), &overflow);
    if (overflow == 0) return value;
    throw InputError(fmt::format("{}: found the integer {}; expected one of 64 bits", path,
                                 io::excerpt(py::str(object).cast<std::string>())));
  }

  io::Value::Table table(const py::dict& dict, const std::string& path, int depth) const {
    io::Value::Table entries;
    for (const auto& [key, entry] : dict) {
      if (!py::isinstance<py::str>(key)) throw py::type_error(path + ": found a key that is no text");
      if (entry.is_none()) continue;
      const auto name = key.cast<std::string>();
      entries.push_back({name, convert(entry, path.empty() ? name : fmt::format("{}.{}", path, name), depth + 1)});
    }
    return entries;
  }

  io::Value::Array array(const py::sequence& sequence, const std::string& path, int depth) const {
    io::Value::Array entries;
    for (std::size_t i = 0; i < sequence.size(); ++i) {
      entries.push_back(convert(sequence[i], fmt::format("{}[{}]", path, i + 1), depth + 1));
    }
    return entries;
  }

  std::shared_ptr<const std::string> source_;
};

}  // namespace

io::Value to_value(const py::handle& object, const std::string& name) {
  return Converter(name).convert(object, "");
}

}  // namespace isorim::python
