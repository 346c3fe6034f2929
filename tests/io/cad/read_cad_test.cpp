#include "io/cad/read_cad.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "tests/io/cli/program_test.h"

namespace isorim::io {
namespace {

using ::testing::HasSubstr;

class ReadCad : public testing::ProgramTest {
 protected:
  std::string refusal(const std::string& file) const {
    try {
      read_cad(file);
    } catch (const InputError& error) {
      return error.what();
    }
    return "(nothing was refused)";
  }
};

const std::string iges_line = std::string(72, ' ') + "S0000001";

TEST_F(ReadCad, ContentTellsTheFormatBeforeTheExtension) {
  EXPECT_EQ(cad_format(write("a.txt", iges_line + "\n")), CadFormat::iges);
  EXPECT_EQ(cad_format(write("b.stp", iges_line + "\r\nmore")), CadFormat::iges);
  EXPECT_EQ(cad_format(write("c.igs", "ISO-10303-21;\nHEADER;\n")), CadFormat::step);
  EXPECT_EQ(cad_format(write("d.dat", "\n\n" + iges_line + "\n")), CadFormat::iges);
  EXPECT_EQ(cad_format(write("compressed", std::string(72, ' ') + "C0000001\n")), CadFormat::iges);
}

TEST_F(ReadCad, ExtensionTellsWhereTheContentDoesNot) {
  EXPECT_EQ(cad_format(write("a.IGES", "")), CadFormat::iges);
  EXPECT_EQ(cad_format(write("a.Step", "what")), CadFormat::step);
  EXPECT_EQ(cad_format(write("a.toml", "[geometry]\n")), std::nullopt);
  // A letter S in column 73 alone is no section of IGES.
  EXPECT_EQ(cad_format(write("a.txt", std::string(72, ' ') + "Some words\n")), std::nullopt);
}

TEST_F(ReadCad, CadExtensions) {
  EXPECT_TRUE(has_cad_extension("part.igs"));
  EXPECT_TRUE(has_cad_extension("part.IGS"));
  EXPECT_TRUE(has_cad_extension("a.b/part.stp"));
  EXPECT_FALSE(has_cad_extension("part.toml"));
  EXPECT_FALSE(has_cad_extension("igs"));
}

TEST_F(ReadCad, RefusesWhatItDoesNotKnow) {
  EXPECT_THAT(refusal(write("part.stl", "solid part\n")),
              ::testing::AllOf(HasSubstr("part.stl: found no format that is known"), HasSubstr("IGES (.igs, .iges)")));
  EXPECT_THAT(refusal(path("missing.igs")), HasSubstr("missing.igs: cannot be opened"));
  EXPECT_THAT(refusal(folder().string()), HasSubstr("is a folder"));
}

}  // namespace
}  // namespace isorim::io
