#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <hdf5.h>

/// The few calls of the HDF5 library that our writers make; for .cpp files. Failures are InputError "HDF5 failed: ...".
namespace isorim::io::hdf5 {

/// Throws InputError with `what` and the reason that the system gave to the library, if there is one, for a negative
/// status.
void check(herr_t status, std::string_view what);

/// A handle of the library, closed at the end of its scope. Throws when the library gives none.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t), std::string_view what) : id_(id), close_(close) {
    check(id_ < 0 ? -1 : 0, what);
  }
  ~Handle() { close_(id_); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }  // NOLINT(google-explicit-constructor): it is one for the C functions

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// Keeps the library from printing.
class SilentErrors {
 public:
  SilentErrors() {
    H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~SilentErrors() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }
  SilentErrors(const SilentErrors&) = delete;
  SilentErrors& operator=(const SilentErrors&) = delete;

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

/// Largest file that is made in memory first.
inline constexpr std::uintmax_t largest_image = std::uintmax_t{1} << 28;

/// Makes the file `path`, which `write` fills; it appears whole or not at all. Throws InputError with the path if
/// anything fails, on a full disk too; what stood there before is left then.
///
/// The file is made in memory unless `expected_size` (bytes) exceeds largest_image: the library cannot let go of a file
/// on a disk that is full; it tries again as the process ends, and crashes.
void write_new_file(const std::filesystem::path& path, const std::function<void(hid_t file)>& write,
                    std::uintmax_t expected_size = 0);

template <class T>
hid_t native_type();
template <>
inline hid_t native_type<double>() {
  return H5T_NATIVE_DOUBLE;
}
template <>
inline hid_t native_type<std::int64_t>() {
  return H5T_NATIVE_INT64;
}
template <>
inline hid_t native_type<std::int32_t>() {
  return H5T_NATIVE_INT32;
}
template <>
inline hid_t native_type<std::int8_t>() {
  return H5T_NATIVE_INT8;
}

/// Makes a group.
Handle open_group(hid_t parent, const std::string& name);

/// A dataset of the given shape; rank 0 is a single number.
template <class T>
void write_dataset(hid_t group, const std::string& name, const std::vector<T>& values,
                   const std::vector<hsize_t>& shape) {
  const Handle space(
      shape.empty() ? H5Screate(H5S_SCALAR) : H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
      H5Sclose, "space of " + name);
  const Handle set(H5Dcreate2(group, name.c_str(), native_type<T>(), space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                   H5Dclose, "making dataset " + name);
  if (values.empty()) return;
  check(H5Dwrite(set, native_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), "writing dataset " + name);
}

template <class T>
void write_attribute(hid_t object, const std::string& name, T value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, "space of " + name);
  const Handle attribute(H5Acreate2(object, name.c_str(), native_type<T>(), space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                         "making attribute " + name);
  check(H5Awrite(attribute, native_type<T>(), &value), "writing attribute " + name);
}

/// UTF-8 of variable length, zero-terminated.
Handle text_type();

/// As text_type().
void write_text_attribute(hid_t object, const std::string& name, std::string_view text);

/// A list of texts, or a single one if `texts` has one and the rank is 0.
void write_texts(hid_t group, const std::string& name, const std::vector<std::string>& texts,
                 const std::vector<hsize_t>& shape);

}  // namespace isorim::io::hdf5
