#include "io/hull/hull_library.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <hdf5.h>

#include "geometry/errors.h"
#include "io/case/complaints.h"
#include "io/results/hdf5_parts.h"

namespace isorim::io {

using namespace hdf5;

namespace {

using geometry::KnuckleLine;
using geometry::OffsetTable;
using geometry::Points;

/// What the root says, so that other HDF5 files are told from libraries.
constexpr const char* schema_name = "isorim-hulls-1";

using Hulls = std::map<std::string, OffsetTable>;

// --- Writing --------------------------------------------------------------------------------------------------

/// Columns of the matrix are rows of the dataset.
void write_matrix(hid_t group, const char* name, const Eigen::MatrixXd& values) {
  const std::array<hsize_t, 2> shape{static_cast<hsize_t>(values.cols()), static_cast<hsize_t>(values.rows())};
  const Handle space(H5Screate_simple(2, shape.data(), nullptr), H5Sclose, name);
  const Handle set(H5Dcreate2(group, name, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose,
                   name);
  if (values.size() > 0) check(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), name);
}

void write_list(hid_t group, const char* name, const std::vector<double>& values) {
  write_matrix(group, name, Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size())));
}

Eigen::MatrixXd column_numbers(const std::vector<int>& columns) {
  Eigen::MatrixXd result(static_cast<Eigen::Index>(columns.size()), 1);
  for (std::size_t k = 0; k < columns.size(); ++k) result(static_cast<Eigen::Index>(k), 0) = columns[k];
  return result;
}

void write_table(hid_t group, const OffsetTable& table) {
  write_text_attribute(group, "name", table.name);
  write_text_attribute(group, "source", table.source);
  write_attribute(group, "length", table.length);
  write_attribute(group, "beam", table.beam);
  write_attribute(group, "draught", table.draught);
  write_attribute(group, "after_perpendicular", table.after_perpendicular);
  write_attribute(group, "baseline", table.baseline);
  write_attribute(group, "tangent_bottom", table.has_tangent_bottom ? 1.0 : 0.0);
  write_list(group, "stations", table.stations);
  write_texts(group, "station_names", table.station_names, {table.station_names.size()});
  write_list(group, "waterlines", table.waterlines);
  write_matrix(group, "half_breadths", table.half_breadths);
  write_matrix(group, "keel", table.keel);
  write_matrix(group, "deck", table.deck);
  write_matrix(group, "stem", table.stem);
  write_matrix(group, "stern", table.stern);
  write_matrix(group, "bulb", table.bulb);
  write_matrix(group, "stem_knuckles", column_numbers(table.stem_knuckles));
  write_matrix(group, "stern_knuckles", column_numbers(table.stern_knuckles));
  write_list(group, "area_ratios", table.area_ratios);
  std::vector<std::string> names;
  for (const KnuckleLine& line : table.knuckles) names.push_back(line.name);
  write_texts(group, "knuckles", names, {names.size()});
  for (std::size_t k = 0; k < names.size(); ++k)
    write_matrix(group, fmt::format("knuckle_{}", k + 1).c_str(), table.knuckles[k].places);
}

void write_library(const std::filesystem::path& path, const Hulls& hulls) {
  write_new_file(path, [&](hid_t file) {
    write_text_attribute(file, "schema", schema_name);
    for (const auto& [name, table] : hulls) {
      const Handle group = open_group(file, name);
      write_table(group, table);
    }
  });
}

// --- Reading --------------------------------------------------------------------------------------------------

std::string read_text(hid_t object, const char* name) {
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose, name);
  const Handle type = text_type();
  char* pointer = nullptr;
  check(H5Aread(attribute, type, static_cast<void*>(&pointer)), name);
  std::string text = pointer ? pointer : "";
  H5free_memory(pointer);
  return text;
}

double read_number(hid_t object, const char* name) {
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose, name);
  double value = 0.0;
  check(H5Aread(attribute, H5T_NATIVE_DOUBLE, &value), name);
  return value;
}

Eigen::MatrixXd read_matrix(hid_t group, const char* name) {
  const Handle set(H5Dopen2(group, name, H5P_DEFAULT), H5Dclose, name);
  const Handle space(H5Dget_space(set), H5Sclose, name);
  std::array<hsize_t, 2> shape{};
  if (H5Sget_simple_extent_ndims(space) != 2) throw InputError(fmt::format("\"{}\" is no table", name));
  check(H5Sget_simple_extent_dims(space, shape.data(), nullptr), name);
  Eigen::MatrixXd values(static_cast<Eigen::Index>(shape[1]), static_cast<Eigen::Index>(shape[0]));
  if (values.size() > 0) check(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), name);
  return values;
}

std::vector<double> read_list(hid_t group, const char* name) {
  const Eigen::MatrixXd values = read_matrix(group, name);
  return {values.data(), values.data() + values.size()};
}

Points<2> read_places(hid_t group, const char* name) {
  const Eigen::MatrixXd values = read_matrix(group, name);
  if (values.rows() != 2)
    throw InputError(fmt::format("\"{}\" has {} numbers a point; expected 2", name, values.rows()));
  return values;
}

std::vector<int> read_columns(hid_t group, const char* name) {
  std::vector<int> columns;
  for (const double value : read_list(group, name)) columns.push_back(static_cast<int>(value));
  return columns;
}

std::vector<std::string> read_texts(hid_t group, const char* name) {
  const Handle set(H5Dopen2(group, name, H5P_DEFAULT), H5Dclose, name);
  const Handle space(H5Dget_space(set), H5Sclose, name);
  const Handle type = text_type();
  const hssize_t count = H5Sget_simple_extent_npoints(space);
  std::vector<char*> pointers(static_cast<std::size_t>(std::max<hssize_t>(count, 0)), nullptr);
  std::vector<std::string> texts;
  if (pointers.empty()) return texts;
  check(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, static_cast<void*>(pointers.data())), name);
  for (char* pointer : pointers) {
    texts.emplace_back(pointer ? pointer : "");
    H5free_memory(pointer);
  }
  return texts;
}

OffsetTable read_table(hid_t group) {
  OffsetTable table;
  table.name = read_text(group, "name");
  table.source = read_text(group, "source");
  table.length = read_number(group, "length");
  table.beam = read_number(group, "beam");
  table.draught = read_number(group, "draught");
  table.after_perpendicular = read_number(group, "after_perpendicular");
  table.baseline = read_number(group, "baseline");
  table.has_tangent_bottom = read_number(group, "tangent_bottom") != 0.0;
  table.stations = read_list(group, "stations");
  table.station_names = read_texts(group, "station_names");
  table.waterlines = read_list(group, "waterlines");
  table.half_breadths = read_matrix(group, "half_breadths");
  table.keel = read_places(group, "keel");
  table.deck = read_places(group, "deck");
  table.stem = read_places(group, "stem");
  table.stern = read_places(group, "stern");
  // Files of before have none.
  if (H5Lexists(group, "bulb", H5P_DEFAULT) > 0) table.bulb = read_places(group, "bulb");
  table.stem_knuckles = read_columns(group, "stem_knuckles");
  table.stern_knuckles = read_columns(group, "stern_knuckles");
  table.area_ratios = read_list(group, "area_ratios");
  const std::vector<std::string> names = read_texts(group, "knuckles");
  for (std::size_t k = 0; k < names.size(); ++k)
    table.knuckles.push_back({names[k], read_places(group, fmt::format("knuckle_{}", k + 1).c_str())});
  check(table);
  return table;
}

herr_t add_name(hid_t /*group*/, const char* name, const H5L_info_t* /*info*/, void* names) {
  static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  return 0;
}

std::vector<std::string> group_names(hid_t file) {
  std::vector<std::string> names;
  check(H5Literate(file, H5_INDEX_NAME, H5_ITER_INC, nullptr, add_name, &names), "listing the hulls");
  return names;
}

Hulls read_library(const std::filesystem::path& path) {
  const SilentErrors silence;
  try {
    if (!std::filesystem::is_regular_file(path)) throw InputError("there is no such file; expected a library of hulls");
    const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, "opening the file");
    if (H5Aexists(file, "schema") <= 0 || read_text(file, "schema") != schema_name)
      throw InputError("the file is no library of hulls; expected one that \"isorim hulls import\" has made");
    Hulls hulls;
    for (const std::string& name : group_names(file)) {
      const Handle group(H5Gopen2(file, name.c_str(), H5P_DEFAULT), H5Gclose, name);
      hulls.emplace(name, read_table(group));
    }
    return hulls;
  } catch (Error& error) {
    throw InputError(fmt::format("{}: {}", path.string(), error.what()));
  }
}

Hulls::const_iterator find_hull(const std::filesystem::path& path, const Hulls& hulls, const std::string& name) {
  const auto found = hulls.find(name);
  if (found != hulls.end()) return found;
  std::vector<std::string> names;
  for (const auto& [known, table] : hulls) names.push_back(known);
  throw InputError(fmt::format("{}: found no hull \"{}\"{}; the library has {}", path.string(), name,
                               did_you_mean(name, names),
                               names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

void check_name(const std::string& name) {
  const bool is_sound =
      !name.empty() && name != "." && name != ".." && std::all_of(name.begin(), name.end(), [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-' || c == '.';
      });
  if (!is_sound) {
    throw InputError(
        fmt::format("found the name \"{}\"; expected letters, digits, \"_\", \"-\" and \".\" for a hull", name));
  }
}

}  // namespace

std::vector<HullEntry> list_hulls(const std::filesystem::path& library) {
  std::vector<HullEntry> entries;
  for (const auto& [name, table] : read_library(library)) {
    entries.push_back({name, table.name, table.source, table.length, table.beam, table.draught,
                       static_cast<int>(table.stations.size()), static_cast<int>(table.waterlines.size())});
  }
  return entries;
}

OffsetTable read_hull(const std::filesystem::path& library, const std::string& name) {
  const Hulls hulls = read_library(library);
  return find_hull(library, hulls, name)->second;
}

void store_hull(const std::filesystem::path& library, const std::string& name, const OffsetTable& table,
                ExistingHull existing) {
  check_name(name);
  check(table);
  Hulls hulls;
  if (std::filesystem::exists(library)) hulls = read_library(library);
  if (existing == ExistingHull::refuse && hulls.contains(name)) {
    throw InputError(fmt::format("{}: the library has a hull \"{}\" already; expected another name, or --replace",
                                 library.string(), name));
  }
  hulls[name] = table;
  const SilentErrors silence;
  write_library(library, hulls);
}

void remove_hull(const std::filesystem::path& library, const std::string& name) {
  Hulls hulls = read_library(library);
  hulls.erase(find_hull(library, hulls, name));
  const SilentErrors silence;
  write_library(library, hulls);
}

}  // namespace isorim::io
