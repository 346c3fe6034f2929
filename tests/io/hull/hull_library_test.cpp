#include "io/hull/hull_library.h"

#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "geometry/hull/hull.h"
#include "io/hull/offset_file.h"

namespace isorim::io {
namespace {

using ::testing::HasSubstr;

class HullLibrary : public ::testing::Test {
 protected:
  HullLibrary() {
    std::string pattern = (std::filesystem::temp_directory_path() / "isorim_test_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
    library_ = folder_ / "hulls.h5";
  }
  ~HullLibrary() override { std::filesystem::remove_all(folder_); }

  template <class Call>
  static std::string refusal(Call&& call) {
    try {
      call();
    } catch (const InputError& error) {
      return error.what();
    }
    return "not refused";
  }

  std::filesystem::path folder_;
  std::filesystem::path library_;
};

/// With all that a table may have.
const std::string yacht =
    "name,Yacht\nsource,nobody\nlength,10\nbeam,3\ndraught,0.6\n"
    "station,keel half-breadth,keel height,z=0.2,wl 0.6,1.2,chine half-breadth,chine height,area\n"
    "-4.5,0,0.3,-,0.5,1,0.7,0.8,0.1\n"
    "0,0,0,0.4,1.2,1.5,1.3,0.7,1\n"
    "4,0,0.1,0.1,0.5,0.8,0.6,0.9,0.2\n"
    "stem,4.5,0.2\nstem,4.8,0.8,chine\nstem,5,1.2\n";

TEST_F(HullLibrary, KeepsTablesBitForBit) {
  const geometry::OffsetTable table = parse_offsets(yacht, "yacht.csv");
  store_hull(library_, "yacht", table, ExistingHull::refuse);
  store_hull(library_, "wigley", geometry::wigley_offsets(10.0, 1.0, 0.625), ExistingHull::refuse);
  // The text has every number with all its digits.
  EXPECT_EQ(offsets_text(read_hull(library_, "yacht")), offsets_text(table));
  EXPECT_EQ(read_hull(library_, "yacht").station_names, table.station_names);
  const std::vector<HullEntry> entries = list_hulls(library_);
  ASSERT_EQ(entries.size(), 2u);
  EXPECT_EQ(entries[0].name, "wigley");
  EXPECT_EQ(entries[0].stations, 21);
  EXPECT_EQ(entries[1].title, "Yacht");
  EXPECT_EQ(entries[1].source, "nobody");
}

TEST_F(HullLibrary, KeepsBulbs) {
  const std::string bulbous =
      "name,Bulbous\nlength,10\nbeam,3\ndraught,0.6\n"
      "station,keel half-breadth,keel height,0.2,0.4,0.6,1.2,deck half-breadth,deck height\n"
      "0,0,0,0,0,0,0,0,1.4\n5,0,0,0.8,1.1,1.2,1.5,1.6,1.4\n10.5,0,0.1,0.2,0.15,,,0,0.5\n"
      "stem,10,0.55\nstem,10.5,1.4\nbulb,10.7,0.15\nbulb,11,0.3\nbulb,10.7,0.45\n";
  const geometry::OffsetTable table = parse_offsets(bulbous, "bulbous.csv");
  store_hull(library_, "bulbous", table, ExistingHull::refuse);
  EXPECT_EQ(read_hull(library_, "bulbous").bulb, table.bulb);
  EXPECT_EQ(offsets_text(read_hull(library_, "bulbous")), offsets_text(table));
}

TEST_F(HullLibrary, ReplacesAndRemovesOnlyWhatIsMeant) {
  const geometry::OffsetTable small = geometry::wigley_offsets(1.0, 0.1, 0.1);
  const geometry::OffsetTable large = geometry::wigley_offsets(10.0, 1.0, 0.625);
  store_hull(library_, "a", small, ExistingHull::refuse);
  store_hull(library_, "b", small, ExistingHull::refuse);
  EXPECT_THAT(refusal([&] { store_hull(library_, "a", large, ExistingHull::refuse); }),
              HasSubstr("has a hull \"a\" already"));
  EXPECT_EQ(read_hull(library_, "a").length, 1.0);
  store_hull(library_, "a", large, ExistingHull::replace);
  EXPECT_EQ(read_hull(library_, "a").length, 10.0);
  remove_hull(library_, "a");
  EXPECT_EQ(list_hulls(library_).size(), 1u);
  EXPECT_THAT(refusal([&] { remove_hull(library_, "a"); }), HasSubstr("found no hull \"a\""));
}

TEST_F(HullLibrary, RefusesOtherFilesAndNames) {
  const geometry::OffsetTable table = geometry::wigley_offsets(1.0, 0.1, 0.1);
  EXPECT_THAT(refusal([&] { list_hulls(library_); }), HasSubstr("there is no such file"));
  std::ofstream(library_) << "name,Wigley\n";
  EXPECT_THAT(refusal([&] { list_hulls(library_); }), HasSubstr("hulls.h5"));
  EXPECT_THAT(refusal([&] { store_hull(library_, "a", table, ExistingHull::refuse); }), HasSubstr("hulls.h5"));
  std::filesystem::remove(library_);
  EXPECT_THAT(refusal([&] { store_hull(library_, "a/b", table, ExistingHull::refuse); }),
              HasSubstr("found the name \"a/b\""));
  store_hull(library_, "tanker", table, ExistingHull::refuse);
  EXPECT_THAT(refusal([&] { read_hull(library_, "tankr"); }), HasSubstr("did you mean \"tanker\"?"));
}

}  // namespace
}  // namespace isorim::io
