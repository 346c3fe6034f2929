#include "io/results/hdf5.h"

#include <cstdint>
#include <filesystem>
#include <iterator>
#include <numeric>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <hdf5.h>
#include <nlohmann/json.hpp>

#include "geometry/errors.h"
#include "io/results/hdf5_parts.h"
#include "io/results/json.h"
#include "tests/io/cli/program_test.h"

namespace isorim::io {
namespace {

using testing::ProgramTest;

/// Reads results.h5 back with the library itself.
class Reader {
 public:
  explicit Reader(const std::filesystem::path& path) : file_(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT)) {}
  ~Reader() { H5Fclose(file_); }

  std::vector<hsize_t> shape(const std::string& name) const {
    const hid_t set = H5Dopen2(file_, name.c_str(), H5P_DEFAULT);
    const hid_t space = H5Dget_space(set);
    std::vector<hsize_t> result(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
    if (!result.empty()) H5Sget_simple_extent_dims(space, result.data(), nullptr);
    H5Sclose(space);
    H5Dclose(set);
    return result;
  }
  std::vector<double> reals(const std::string& name) const {
    hsize_t count = 1;
    for (const hsize_t n : shape(name)) count *= n;
    std::vector<double> values(count);
    const hid_t set = H5Dopen2(file_, name.c_str(), H5P_DEFAULT);
    EXPECT_GE(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0) << name;
    H5Dclose(set);
    return values;
  }
  double attribute(const std::string& object, const std::string& name) const {
    double value = -1.0;
    const hid_t attribute = H5Aopen_by_name(file_, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
    EXPECT_GE(H5Aread(attribute, H5T_NATIVE_DOUBLE, &value), 0) << object << " " << name;
    H5Aclose(attribute);
    return value;
  }
  std::string text_attribute(const std::string& object, const std::string& name) const {
    const hid_t attribute = H5Aopen_by_name(file_, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
    const hid_t type = H5Aget_type(attribute);
    char* text = nullptr;
    H5Aread(attribute, type, &text);
    const std::string result = text ? text : "";
    H5free_memory(text);
    H5Tclose(type);
    H5Aclose(attribute);
    return result;
  }
  std::vector<std::string> texts(const std::string& name) const {
    hsize_t count = 1;
    for (const hsize_t n : shape(name)) count *= n;
    const hid_t set = H5Dopen2(file_, name.c_str(), H5P_DEFAULT);
    const hid_t type = H5Dget_type(set);
    std::vector<char*> pointers(count);
    H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, pointers.data());
    std::vector<std::string> result(pointers.begin(), pointers.end());
    for (char* pointer : pointers) H5free_memory(pointer);
    H5Tclose(type);
    H5Dclose(set);
    return result;
  }

 private:
  hid_t file_;
};

const std::string frustum =
    "title = 'A frustum'\n[geometry]\ntype = 'cone'\nradii = [2, 1]\nheight = 3\n[[integral]]\nname = 'moment'\n"
    "integrand = 'z'\n[expect]\nvolume = { value = 21.991148575128552, rtol = 1e-12 }\n";

class Hdf5 : public ProgramTest {};

TEST_F(Hdf5, HoldsTheNumbersOfTheJson) {
  ASSERT_EQ(run_case(frustum).status, 0);
  const nlohmann::json json = nlohmann::json::parse(testing::read_file(folder() / "out/results.json"));
  const Reader file(folder() / "out/results.h5");
  EXPECT_EQ(file.text_attribute("/", "case"), "A frustum");
  EXPECT_EQ(file.text_attribute("/", "isorim"), json["isorim"]);
  EXPECT_EQ(file.text_attribute("/", "status"), "ok");
  EXPECT_EQ(file.attribute("/", "threads"), json["threads"]);
  EXPECT_EQ(file.texts("/resolved_case").at(0), json["resolved_case"]);
  EXPECT_EQ(file.attribute("/geometry", "closed"), 1.0);
  EXPECT_EQ(file.attribute("/geometry", "closure_defect"), json["geometry"]["closure_defect"]);
  EXPECT_EQ(file.shape("/properties/volume/value").size(), 0U);
  EXPECT_EQ(file.reals("/properties/volume/value").at(0), json["properties"]["volume"]["value"]);
  EXPECT_EQ(file.reals("/properties/volume/error").at(0), json["properties"]["volume"]["error"]);
  EXPECT_EQ(file.attribute("/properties/volume", "evaluations"), json["properties"]["volume"]["evaluations"]);
  EXPECT_EQ(file.reals("/properties/centroid/value"),
            json["properties"]["centroid"]["value"].get<std::vector<double>>());
  EXPECT_EQ(file.shape("/properties/inertia/value"), (std::vector<hsize_t>{3, 3}));
  EXPECT_EQ(file.reals("/properties/inertia/value")[4], json["properties"]["inertia"]["value"][1][1]);
  EXPECT_EQ(file.reals("/integrals/moment/value").at(0), json["integrals"]["moment"]["value"]);
  EXPECT_EQ(file.reals("/expectations/volume/expected").at(0), 21.991148575128552);
  EXPECT_EQ(file.attribute("/expectations/volume", "met"), 1.0);
  EXPECT_EQ(file.attribute("/timings", "read"), json["timings"]["read"]);
}

TEST_F(Hdf5, HoldsTheElementTable) {
  ASSERT_EQ(run_case(frustum).status, 0);
  const CaseFile file = read_case(path("case.toml"));
  const AnyModel any = build_model(file);
  const Model<3>& model = std::get<Model<3>>(any);
  const Reader stored(folder() / "out/results.h5");
  const std::string group = "/geometry/elements/";
  EXPECT_EQ(stored.texts("/geometry/patch_names"), (std::vector<std::string>{"bottom", "side", "top"}));
  const std::vector<double> nets = stored.reals(group + "nets");
  const std::vector<double> offsets = stored.reals(group + "offsets");
  const std::vector<double> degrees = stored.reals(group + "degrees");
  const std::vector<double> domains = stored.reals(group + "domains");
  ASSERT_EQ(stored.shape(group + "nets").at(1), 4U);
  ASSERT_EQ(offsets.size(), model.table.elements.size() + 1);
  for (std::size_t e = 0; e < model.table.elements.size(); ++e) {
    const auto& element = model.table.elements[e];
    const auto net = model.table.net(element);
    const auto begin = nets.begin() + 4 * static_cast<std::ptrdiff_t>(offsets[e]);
    EXPECT_EQ(std::vector<double>(net.begin(), net.end()),
              std::vector<double>(begin, nets.begin() + 4 * static_cast<std::ptrdiff_t>(offsets[e + 1])));
    EXPECT_EQ(stored.reals(group + "patch")[e], element.patch);
    EXPECT_EQ(stored.reals(group + "orientation")[e], element.orientation);
    EXPECT_EQ(stored.reals(group + "polynomial")[e], element.polynomial ? 1.0 : 0.0);
    for (std::size_t d = 0; d < 2; ++d) {
      EXPECT_EQ(degrees[2 * e + d], element.degree[d]);
      EXPECT_EQ(domains[4 * e + 2 * d], element.domain[d].first);
      EXPECT_EQ(domains[4 * e + 2 * d + 1], element.domain[d].last);
    }
  }
}

TEST_F(Hdf5, RefusedQuantitiesHaveAReasonAndNoValue) {
  ASSERT_EQ(run_case("[geometry]\ntype = 'patches'\npatches = [{ type = 'disc', radius = 1 }]\n").status, 0);
  const Reader file(folder() / "out/results.h5");
  EXPECT_NE(file.text_attribute("/properties/volume", "reason").find("open"), std::string::npos);
  EXPECT_EQ(file.attribute("/geometry", "closed"), 0.0);
}

TEST_F(Hdf5, FileThatCannotBeWrittenIsNamedAndNothingIsLeft) {
  const CaseFile file = read_case(write("case.toml", frustum));
  const AnyModel model = build_model(file);
  const Report report = compute(file, model);
  const std::filesystem::path target = folder() / "missing" / "results.h5";
  try {
    write_hdf5(target, report, model);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("results.h5"), std::string::npos) << error.what();
  }
  EXPECT_FALSE(std::filesystem::exists(target));
}

/// Numbers that are not compressed and take more room than a file of HDF5 begins with.
void write_numbers(hid_t file, double first) {
  std::vector<double> numbers(100'000);
  std::iota(numbers.begin(), numbers.end(), first);
  hdf5::write_dataset(file, "numbers", numbers, {numbers.size()});
  hdf5::write_text_attribute(file, "text", "ß");
}

TEST_F(Hdf5, FilesMadeInMemoryAndOnTheDiskHoldTheSame) {
  for (const std::uintmax_t expected_size : {std::uintmax_t{0}, hdf5::largest_image + 1}) {
    hdf5::write_new_file(
        path("new.h5"), [](hid_t file) { write_numbers(file, 0.5); }, expected_size);
    const Reader file(path("new.h5"));
    const std::vector<double> numbers = file.reals("numbers");
    ASSERT_EQ(numbers.size(), 100'000U);
    EXPECT_EQ(numbers.back(), 99'999.5);
    EXPECT_EQ(file.text_attribute("/", "text"), "ß");
    const auto size = std::filesystem::file_size(path("new.h5"));
    EXPECT_LT(size, 8U * 100'000U + 10'000U);
    std::filesystem::remove(path("new.h5"));
  }
}

TEST_F(Hdf5, WritersThatFailLeaveWhatStoodThere) {
  hdf5::write_new_file(path("old.h5"), [](hid_t file) { write_numbers(file, 0.0); });
  const std::string before = testing::read_file(path("old.h5"));
  for (const std::uintmax_t expected_size : {std::uintmax_t{0}, hdf5::largest_image + 1}) {
    const auto twice = [](hid_t file) {
      write_numbers(file, 1.0);
      write_numbers(file, 2.0);
    };
    try {
      hdf5::write_new_file(path("old.h5"), twice, expected_size);
      FAIL();
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("old.h5: HDF5 failed: making dataset numbers"), std::string::npos)
          << error.what();
    }
    EXPECT_EQ(testing::read_file(path("old.h5")), before);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder()), {}), 1);
  }
}

}  // namespace
}  // namespace isorim::io
