#include "io/hull/offset_file.h"

#include <cmath>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "geometry/hull/hull_surface.h"

namespace isorim::io {
namespace {

using ::testing::HasSubstr;

/// Heights and half-breadths as parts, stations from forward, rows and columns in no order.
const std::string cargo =
    "# A small form\n"
    "name,Cargo, small\n"
    "length,100\nbeam,16\ndraught,6\n"
    "stations,10,aft\nwaterlines,draught\nhalf_breadths,waterline\n"
    "station,tangent,1,0.5,deck height,deck half-breadth,area\n"
    "0,0,0,0,1.5,0.1,0\n"
    "10,0,0.5,,1.5,0.75,0.1   # no half-breadth at 0.5\n"
    "5,1,1,1,1.4,1,1\n"
    "max,0.7,1,0.95,,1,\n";

TEST(OffsetFile, ReadsPartsOfDraughtAndBreadth) {
  const geometry::OffsetTable table = parse_offsets(cargo, "cargo.csv");
  EXPECT_EQ(table.name, "Cargo, small");
  EXPECT_EQ(table.stations, (std::vector<double>{0.0, 50.0, 100.0}));
  EXPECT_EQ(table.station_names, (std::vector<std::string>{"10", "5", "0"}));
  EXPECT_EQ(table.waterlines, (std::vector<double>{3.0, 6.0}));
  EXPECT_TRUE(std::isnan(table.half_breadths(0, 0)));
  EXPECT_DOUBLE_EQ(table.half_breadths(0, 1), 7.6);
  EXPECT_DOUBLE_EQ(table.half_breadths(1, 0), 4.0);
  EXPECT_DOUBLE_EQ(table.keel(0, 1), 5.6);
  EXPECT_EQ(table.keel(1, 1), 0.0);
  EXPECT_DOUBLE_EQ(table.deck(1, 1), 8.4);
  EXPECT_DOUBLE_EQ(table.deck(0, 0), 6.0);
  EXPECT_TRUE(table.has_tangent_bottom);
  EXPECT_EQ(table.baseline, 0.0);
  EXPECT_EQ(table.after_perpendicular, 0.0);
  EXPECT_EQ(table.area_ratios, (std::vector<double>{0.1, 1.0, 0.0}));
}

const std::string yacht =
    "name,Yacht\nlength,10\nbeam,3\ndraught,0.6\n"
    "station,keel half-breadth,keel height,z=0.2,wl 0.6,1.2,chine half-breadth,chine height\n"
    "-4.5,0,0.3,-,0.5,1,0.7,0.8\n"
    "0,0,0,0.4,1.2,1.5,1.3,0.7\n"
    "4,0,0.1,0.1,0.5,0.8,0.6,0.9\n"
    "stem,4.5,0.2\nstem,4.8,0.8,chine\nstem,5,1.2\n";

TEST(OffsetFile, ReadsLengthsKnucklesAndContours) {
  const geometry::OffsetTable table = parse_offsets(yacht, "yacht.csv");
  EXPECT_EQ(table.after_perpendicular, -4.5);
  ASSERT_EQ(table.knuckles.size(), 1u);
  EXPECT_EQ(table.knuckles[0].name, "chine");
  EXPECT_EQ(table.knuckles[0].places(1, 0), 0.8);
  EXPECT_EQ(table.stem.cols(), 3);
  EXPECT_EQ(table.stem_knuckles, std::vector<int>{1});
  EXPECT_FALSE(table.has_tangent_bottom);
  EXPECT_EQ(table.baseline, 0.0);
}

const std::string bulbous =
    "name,Bulbous\nlength,10\nbeam,3\ndraught,0.6\n"
    "station,keel half-breadth,keel height,0.2,0.4,0.6,1.2,deck half-breadth,deck height\n"
    "0,0,0,0,0,0,0,0,1.4\n"
    "5,0,0,0.8,1.1,1.2,1.5,1.6,1.4\n"
    "9,0,0,0.4,0.4,0.3,0.5,0.6,1.4\n"
    "10.5,0,0.1,0.2,0.15,,,0,0.5\n"
    "stem,10,0.55\nstem,10.5,1.4\nbulb,10.7,0.15\nbulb,11,0.3\nbulb,10.7,0.45\n";

TEST(OffsetFile, ReadsBulbs) {
  const geometry::OffsetTable table = parse_offsets(bulbous, "bulbous.csv");
  EXPECT_EQ(table.stem.cols(), 2);
  ASSERT_EQ(table.bulb.cols(), 3);
  EXPECT_EQ(table.bulb(0, 1), 11.0);
  EXPECT_EQ(table.bulb(1, 1), 0.3);
  EXPECT_FALSE(is_bulb_station(table, 2));
  EXPECT_TRUE(is_bulb_station(table, 3));
}

std::string with_ends(std::string text, const std::string& end) {
  for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + end.size()))
    text.replace(at, 1, end);
  return text;
}

TEST(OffsetFile, ReadsAnyLineEndsAndAByteOrderMark) {
  const geometry::OffsetTable table = parse_offsets(yacht, "yacht.csv");
  for (const std::string& text : {with_ends(yacht, "\r\n"), with_ends(yacht, "\r"), "\xEF\xBB\xBF" + yacht}) {
    const geometry::OffsetTable same = parse_offsets(text, "yacht.csv");
    EXPECT_EQ(same.name, table.name);
    EXPECT_EQ(same.stations, table.stations);
    EXPECT_EQ(same.stem, table.stem);
  }
  // Lines count the same.
  for (const char* end : {"\n", "\r\n", "\r"}) {
    std::string text = with_ends(yacht, end);
    text.replace(text.find("1.2,1.5"), 3, "1.x");
    try {
      parse_offsets(text, "bad.csv");
      ADD_FAILURE() << "not refused";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("bad.csv:7: column 5"));
    }
  }
}

void expect_equal(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  ASSERT_EQ(a.rows(), b.rows());
  ASSERT_EQ(a.cols(), b.cols());
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    const double x = a.reshaped()(i);
    const double y = b.reshaped()(i);
    EXPECT_TRUE(x == y || (std::isnan(x) && std::isnan(y))) << x << " " << y;
  }
}

TEST(OffsetFile, WritesWhatItReads) {
  for (const std::string& text : {cargo, yacht, bulbous}) {
    const geometry::OffsetTable table = parse_offsets(text, "given.csv");
    const geometry::OffsetTable back = parse_offsets(offsets_text(table), "written.csv");
    EXPECT_EQ(back.name, table.name);
    EXPECT_EQ(back.stations, table.stations);
    EXPECT_EQ(back.waterlines, table.waterlines);
    EXPECT_EQ(back.length, table.length);
    EXPECT_EQ(back.after_perpendicular, table.after_perpendicular);
    EXPECT_EQ(back.has_tangent_bottom, table.has_tangent_bottom);
    EXPECT_EQ(back.area_ratios, table.area_ratios);
    EXPECT_EQ(back.stem_knuckles, table.stem_knuckles);
    expect_equal(back.half_breadths, table.half_breadths);
    expect_equal(back.keel, table.keel);
    expect_equal(back.deck, table.deck);
    expect_equal(back.stem, table.stem);
    expect_equal(back.bulb, table.bulb);
    ASSERT_EQ(back.knuckles.size(), table.knuckles.size());
    for (std::size_t k = 0; k < table.knuckles.size(); ++k)
      expect_equal(back.knuckles[k].places, table.knuckles[k].places);
  }
}

TEST(OffsetFile, ReadsTheSeries60Tables) {
  const auto folder = std::filesystem::path(ISORIM_SOURCE_DIR) / "cases/hull";
  const geometry::OffsetTable table = read_offsets(folder / "series60_cb060.csv");
  EXPECT_EQ(table.stations.size(), 25u);
  EXPECT_EQ(table.waterlines.size(), 7u);
  // Station 14, 0.075 T: 0.701 of the largest, 0.866 of B / 2.
  EXPECT_EQ(table.station_names[8], "14");
  EXPECT_NEAR(table.half_breadths(0, 8), 0.5 * 0.701 * 0.866, 1e-15);
}

TEST(OffsetFile, HullsOfSeries60StayOnTheirSide) {
  for (const char* file : {"series60_cb060.csv", "series60_cb080.csv"}) {
    const geometry::OffsetTable table = read_offsets(std::filesystem::path(ISORIM_SOURCE_DIR) / "cases/hull" / file);
    const geometry::NurbsSurface<3> surface = hull_surface(hull_sections(table)).front();
    for (int i = 0; i <= 800; ++i) {
      for (int j = 0; j <= 100; ++j)
        EXPECT_GE(evaluate(surface, geometry::Point2(table.length * i / 800, j / 100.0)).y(), 0.0);
    }
  }
}

void expect_refused(std::string text, const std::string& from, const std::string& to, const std::string& fragment) {
  const std::size_t place = text.find(from);
  ASSERT_NE(place, std::string::npos) << from;
  text.replace(place, from.size(), to);
  try {
    parse_offsets(text, "bad.csv");
    ADD_FAILURE() << "not refused: " << fragment;
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr(fragment));
    EXPECT_THAT(error.what(), HasSubstr("bad.csv"));
  }
}

TEST(OffsetFile, RefusesWithLineAndColumn) {
  expect_refused(cargo, "10,0,0.5,", "10,0,0.x5,", "bad.csv:11: column 3 (1): found \"0.x5\"; expected a number");
  expect_refused(cargo, "length,100", "lenght,100", "bad.csv:3: found the key \"lenght\"");
  expect_refused(cargo, "beam,16\n", "", "found no key \"beam\" before the table");
  expect_refused(cargo, "beam,16", "beam,-16", "the beam is -16; expected a positive number");
  expect_refused(cargo, "10,aft", "10,back", "found stations 10, back");
  expect_refused(cargo, "tangent,1", "tangens,1", "bad.csv:9: column 2: found \"tangens\"");
  expect_refused(cargo, "5,1,1,1,1.4,1,1", "5,1,1,1,1.4,1", "bad.csv:12: found 6 cells; expected 7");
  expect_refused(cargo, "5,1,1,1,1.4,1,1", "5,1,1,1,1,4,1,1",
                 "bad.csv:12: found 8 cells; expected 7, as in the head of "
                 "the table (numbers have points, not commas)");
  expect_refused(cargo, "length,100", "length;100", "bad.csv:3: found \"length;100\"; expected cells with commas");
  expect_refused(cargo, "length,100", "length,100 m", "bad.csv:3: column 2 (length): found \"100 m\"");
  expect_refused(cargo, "max,0.7,1,0.95,,1,\n", "", "found no row \"max\"");
  expect_refused(cargo, "10,0,0.5", "5,0,0.5", "station 5 is there twice");
  expect_refused(cargo, "deck height", "deck half-breadth", "is there twice");
  expect_refused(yacht, "-4.5,0,0.3,-,0.5,1", "-4.5,0,0.3,-,0.5,-1",
                 "bad.csv:6: column 6 (1.2): found the half-breadth -1; expected none below 0");
  expect_refused(yacht, "0.8,chine", "0.8,chain", "column 4: found the knuckle \"chain\"");
  expect_refused(yacht, "0.8,chine", "0.8", "the knuckle \"chine\" has no end on the stem");
  expect_refused(yacht, "stem,5,1.2", "stem,3,1.2", "expected it ahead of all stations");
  expect_refused(yacht, "stem,5,1.2", "stern", "found \"stern\" with 1 cells");
  expect_refused(yacht, "z=0.2", "0.6", "bad.csv:5: column 5: found the height wl 0.6 again, as in column 4");
  expect_refused(yacht, "beam,3\n", "beam,3\nbeam,4\n", "bad.csv:4: found the key \"beam\" again, as in line 3");
  expect_refused(yacht, "0,0,0,0.4,1.2,1.5,", "0,0,0,0.4;1.2;1.5;", "found 5 cells; expected 8, as in the head of the");
  expect_refused(yacht, "0,0,0,0.4,1.2,1.5,", "0,0,0,nan,1.2,1.5,", "bad.csv:7: column 4 (z=0.2): found \"nan\"");
  expect_refused(yacht, "0,0,0,0.4,1.2,1.5,", "0,0,0,inf,1.2,1.5,", "bad.csv:7: column 4 (z=0.2): found \"inf\"");
  expect_refused(cargo, "5,1,1,1,1.4,1,1", "5,,,,,,", "bad.csv:12: hull \"Cargo, small\": station 5 has 0 point(s)");
  expect_refused(bulbous, "5,0,0,0.8,1.1", "5,0,0,0,1.1", "bad.csv:7: hull \"Bulbous\": station 5 has no thickness");
  expect_refused(bulbous, "0.15,,,0,0.5", "0.15,,,0.1,0.5", "bad.csv:9: hull \"Bulbous\": station 10.5 lies ahead of");
  expect_refused(bulbous, "bulb,11,0.3", "bulb,11,0.3,chine", "bad.csv:13: column 4: found \"chine\"; expected no");
  expect_refused(bulbous, "stem,10,0.55\nstem,10.5,1.4\n", "", "there is a bulb but no stem");
  expect_refused(bulbous, "bulb,11", "bulb,10.2", "point 2 of the bulb lies at x = 10.2; expected it ahead of all");
  const std::size_t row = yacht.find("0,0,0,0.4");
  expect_refused(yacht, yacht.substr(row), "", "bad.csv:5: found 1 station(s) below the head of the table");
  expect_refused(yacht, yacht, "", "bad.csv: found no table; expected a line that begins with \"station\"");
  expect_refused(yacht, "name", "\xFF\xFEn", "found text in UTF-16; expected UTF-8");
  expect_refused(yacht, "0.4", std::string(1, '\0'), "bad.csv:7: found a byte 0; expected text");
  expect_refused(yacht, "chine half-breadth", "chine area", "column 7: found \"chine area\"");
}

}  // namespace
}  // namespace isorim::io
