#include <algorithm>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/shapes/solids.h"
#include "geometry/topology/orientation.h"
#include "io/iges/file.h"
#include "io/iges/reader.h"
#include "io/iges/writer.h"
#include "tests/io/cli/program_test.h"

namespace isorim::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string torus = "title = 'A torus'\n[geometry]\ntype = 'torus'\nmajor_radius = 2\nminor_radius = 0.5\n";
const std::string rectangle = "[geometry]\ntype = 'rectangle'\nsize = [2, 1]\n";

class Convert : public ProgramTest {
 protected:
  long count(const std::string& file, int type) const {
    const io::iges::File read = io::iges::read_file(path(file));
    EXPECT_TRUE(read.warnings.empty());
    return std::count_if(read.entities.begin(), read.entities.end(), [&](const auto& e) { return e.type == type; });
  }
};

TEST_F(Convert, CasesBecomeSolids) {
  const ProgramResult result = run({"convert", write("torus.toml", torus), path("torus.igs")});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.out, path("torus.igs") + ": 1 solid of 1 face, unit mm\n");
  EXPECT_EQ(count("torus.igs", 186), 1);
  EXPECT_EQ(io::iges::read_file(path("torus.igs")).global.product, "A torus");
  const io::CadModel model = io::read_iges(path("torus.igs"));
  ASSERT_EQ(model.faces.size(), 1U);
  EXPECT_EQ(model.faces[0].solid, 0);
  EXPECT_EQ(model.faces[0].origin.name, "torus");
}

TEST_F(Convert, OptionsSayHow) {
  const ProgramResult result = run({"convert", write("torus.toml", torus), path("torus.IGES"), "--faces", "--unit",
                                    "in", "--set", "geometry.major_radius=3"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.out, path("torus.IGES") + ": 1 loose face, unit in\n");
  EXPECT_EQ(count("torus.IGES", 186), 0);
  EXPECT_EQ(io::iges::read_file(path("torus.IGES")).global.unit, "in");
  EXPECT_NEAR(io::iges::read_file(path("torus.IGES")).global.largest_coordinate, 3.5, 1e-14);
}

TEST_F(Convert, RegionsOfThePlaneBecomeCurves) {
  const ProgramResult result = run({"convert", write("rectangle.toml", rectangle), path("rectangle.igs")});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.out, path("rectangle.igs") + ": 4 curves, unit mm\n");
  EXPECT_EQ(count("rectangle.igs", 102), 1);
  EXPECT_EQ(count("rectangle.igs", 126), 4);
}

TEST_F(Convert, PicturesOfEitherKind) {
  EXPECT_EQ(run({"convert", write("torus.toml", torus), path("torus.vtu")}).status, 0);
  EXPECT_THAT(read_file(path("torus.vtu")), HasSubstr("RationalWeights"));
  EXPECT_EQ(run({"convert", write("rectangle.toml", rectangle), path("rectangle.svg")}).status, 0);
  EXPECT_THAT(read_file(path("rectangle.svg")), HasSubstr("</svg>"));
}

TEST_F(Convert, CadFilesKeepNamesLooksAndBits) {
  io::iges::WriterOptions options;
  options.unit = "cm";
  for (int i = 0; i < 6; ++i) options.looks.push_back({io::Colour{1.0, 0.5, 0.0}, i});
  io::iges::write_iges(path("cube.igs"), orient(geometry::cube(1.0)), options);
  const ProgramResult result = run({"convert", path("cube.igs"), path("again.igs")});
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(result.out, path("again.igs") + ": 1 solid of 6 faces, unit cm\n");
  const io::CadModel once = io::read_iges(path("cube.igs"));
  const io::CadModel twice = io::read_iges(path("again.igs"));
  ASSERT_EQ(twice.faces.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(twice.faces[i].origin.name, once.faces[i].origin.name);
    EXPECT_EQ(twice.faces[i].origin.level, once.faces[i].origin.level);
    EXPECT_EQ(twice.faces[i].origin.colour, (io::Colour{1.0, 0.5, 0.0}));
    EXPECT_EQ(twice.faces[i].face.surface.homogeneous(), once.faces[i].face.surface.homogeneous());
  }
}

TEST_F(Convert, UnitsOfCadFilesAreConverted) {
  io::iges::write_iges(path("cube.igs"), orient(geometry::cube(1.0)), {.unit = "in"});
  EXPECT_EQ(run({"convert", path("cube.igs"), path("mm.igs"), "--unit", "mm"}).status, 0);
  const io::iges::File file = io::iges::read_file(path("mm.igs"));
  EXPECT_EQ(file.global.unit, "mm");
  EXPECT_NEAR(file.global.largest_coordinate, 25.4, 1e-14);
}

TEST_F(Convert, WhatCannotBeIsRefusedBeforeAnythingIsWritten) {
  const std::string case_file = write("torus.toml", torus);
  const auto refusal = [&](const std::vector<std::string>& more) {
    std::vector<std::string> args{"convert"};
    args.insert(args.end(), more.begin(), more.end());
    const ProgramResult result = run(args);
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(result.out, "");
    return result.err;
  };
  EXPECT_THAT(refusal({case_file, path("torus.step")}),
              AllOf(HasSubstr("found the extension \".step\""),
                    HasSubstr("expected one of .igs, .iges, .iga, .vtu, .svg, .stl")));
  EXPECT_THAT(refusal({case_file, path("torus")}), HasSubstr("found the extension \"\""));
  EXPECT_THAT(refusal({case_file, path("torus.svg")}), HasSubstr("this is a shape in space"));
  EXPECT_THAT(refusal({case_file, path("torus.igs"), "--unit", "furlong"}),
              HasSubstr("IGES has no unit \"furlong\"; expected one of in, mm"));
  EXPECT_THAT(refusal({case_file, path("no_such_folder/torus.igs")}), HasSubstr("No such file or directory"));
  EXPECT_THAT(refusal({path("missing.toml"), path("torus.igs")}), HasSubstr("missing.toml"));
  EXPECT_THAT(refusal({write("bad.toml", "[geometry]\ntype = 'torus'\n"), path("torus.igs")}),
              HasSubstr("major_radius"));
  const std::string twin = write("twin.igs", "whatever");
  EXPECT_THAT(refusal({twin, twin}), HasSubstr("are the same file"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder()), {}), 3);
}

}  // namespace
}  // namespace isorim::testing
