#include "io/iges/file.h"

#include <gtest/gtest.h>

#include "io/iges/parameters.h"
#include "tests/io/iges/file_text.h"

namespace isorim::io::iges {
namespace {

TEST(IgesFile, ReadsAFileThatIsAsTheStandardSays) {
  FileText text;
  text.entities = {{110, {"110,1.5,-2.,3.E0,4D1,+.5,6;"}, 0, 3, "00010500", -5, 7, "Edge"},
                   {124, {"124,1.,0.,0.,0.,0.,1.,0.,0.,", "0.,0.,1.,2.5;"}},
                   {314, {"314,100.,0.,0.,3HRed;"}}};
  const File file = parse(text.text(), "small.igs");

  EXPECT_EQ(file.warnings, std::vector<std::string>{});
  EXPECT_EQ(file.start, std::vector<std::string>{"Made for a test"});
  EXPECT_EQ(file.global.unit, "mm");
  EXPECT_EQ(file.global.author, "Me");
  EXPECT_EQ(file.global.resolution, 1e-6);
  ASSERT_EQ(file.entities.size(), 3U);
  const Entity& line = file.entities[0];
  EXPECT_EQ(line.sequence, 1);
  EXPECT_EQ(line.transformation, 3);
  EXPECT_EQ(line.subordinate, 1);
  EXPECT_EQ(line.use, 5);
  EXPECT_EQ(line.colour, -5);
  EXPECT_EQ(line.level, 7);
  EXPECT_EQ(line.label, "Edge");
  Parameters parameters(file, line);
  EXPECT_EQ(parameters.reals(6), (std::vector<double>{1.5, -2.0, 3.0, 40.0, 0.5, 6.0}));
  EXPECT_EQ(file.find(3)->type, 124);
  EXPECT_EQ(Parameters(file, *file.find(3)).reals(12).back(), 2.5);
  EXPECT_EQ(file.find(2), nullptr);
  EXPECT_EQ(file.find(7), nullptr);
}

}  // namespace
}  // namespace isorim::io::iges
