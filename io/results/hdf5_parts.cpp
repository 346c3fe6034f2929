#include "io/results/hdf5_parts.h"

#include <cstddef>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/atomic_file.h"

namespace isorim::io::hdf5 {
namespace {

/// Stops at the first entry of the library's stack of errors that quotes the system, "... error message = 'No space
/// left on device', ...".
herr_t find_reason(unsigned /*depth*/, const H5E_error2_t* entry, void* reason) {
  constexpr std::string_view mark = "error message = '";
  const std::string_view text = entry->desc ? entry->desc : "";
  const std::size_t found = text.find(mark);
  if (found == std::string_view::npos) return 0;
  const std::string_view quoted = text.substr(found + mark.size());
  *static_cast<std::string*>(reason) = quoted.substr(0, quoted.find('\''));
  return 1;
}

/// ": No space left on device", or nothing.
std::string system_reason() {
  std::string reason;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, find_reason, &reason);
  return reason.empty() ? reason : ": " + reason;
}

/// The content of a file that is made in memory.
std::string image_of(const std::function<void(hid_t file)>& write) {
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "access to memory");
  constexpr std::size_t increment = std::size_t{1} << 20;
  check(H5Pset_fapl_core(access, increment, 0), "access to memory");
  const Handle file(H5Fcreate("image", H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose, "making the file");
  write(file);
  check(H5Fflush(file, H5F_SCOPE_GLOBAL), "writing the file");
  const ssize_t size = H5Fget_file_image(file, nullptr, 0);
  check(size < 0 ? -1 : 0, "writing the file");
  std::string image(static_cast<std::size_t>(size), '\0');
  check(H5Fget_file_image(file, image.data(), image.size()) < 0 ? -1 : 0, "writing the file");
  return image;
}

void write_on_disk(const std::filesystem::path& path, const std::function<void(hid_t file)>& write) {
  AtomicFile target(path);
  {
    const Handle file(H5Fcreate(target.temporary().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose,
                      "making the file");
    write(file);
    check(H5Fflush(file, H5F_SCOPE_GLOBAL), "writing the file");
  }
  target.commit();
}

}  // namespace

void check(herr_t status, std::string_view what) {
  if (status < 0) throw InputError(fmt::format("HDF5 failed: {}{}", what, system_reason()));
}

void write_new_file(const std::filesystem::path& path, const std::function<void(hid_t file)>& write,
                    std::uintmax_t expected_size) {
  const SilentErrors silence;
  std::string image;
  try {
    if (expected_size > largest_image) return write_on_disk(path, write);
    image = image_of(write);
  } catch (InputError& error) {
    error.add_context(path.string());
    throw;
  }
  write_file(path, image);
}

Handle open_group(hid_t parent, const std::string& name) {
  return {H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, "making group " + name};
}

Handle text_type() {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return {type, H5Tclose, "text type"};
}

void write_text_attribute(hid_t object, const std::string& name, std::string_view text) {
  const Handle type = text_type();
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, "space of " + name);
  const Handle attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                         "making attribute " + name);
  const std::string copy(text);
  const char* pointer = copy.c_str();
  check(H5Awrite(attribute, type, &pointer), "writing attribute " + name);
}

void write_texts(hid_t group, const std::string& name, const std::vector<std::string>& texts,
                 const std::vector<hsize_t>& shape) {
  const Handle type = text_type();
  const Handle space(
      shape.empty() ? H5Screate(H5S_SCALAR) : H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
      H5Sclose, "space of " + name);
  const Handle set(H5Dcreate2(group, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose,
                   "making dataset " + name);
  std::vector<const char*> pointers;
  for (const std::string& text : texts) pointers.push_back(text.c_str());
  check(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, pointers.data()), "writing dataset " + name);
}

}  // namespace isorim::io::hdf5
