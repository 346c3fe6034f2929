#include "io/results/hdf5_parts.h"

namespace isorim::io::hdf5 {

void check(herr_t status, std::string_view what) {
  if (status < 0) throw InputError(fmt::format("HDF5 failed: {}", what));
}

Handle open_group(hid_t parent, const std::string& name) {
  return {H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, "making group " + name};
}

namespace {

hid_t make_text_type() {
  const hid_t type = H5Tcopy(H5T_C_S1);
  check(H5Tset_size(type, H5T_VARIABLE), "text type");
  check(H5Tset_cset(type, H5T_CSET_UTF8), "text type");
  return type;
}

}  // namespace

void write_text_attribute(hid_t object, const std::string& name, std::string_view text) {
  const Handle type(make_text_type(), H5Tclose, "text type");
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, "space of " + name);
  const Handle attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                         "making attribute " + name);
  const std::string copy(text);
  const char* pointer = copy.c_str();
  check(H5Awrite(attribute, type, &pointer), "writing attribute " + name);
}

void write_texts(hid_t group, const std::string& name, const std::vector<std::string>& texts,
                 const std::vector<hsize_t>& shape) {
  const Handle type(make_text_type(), H5Tclose, "text type");
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
