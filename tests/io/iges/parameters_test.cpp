#include "io/iges/parameters.h"

#include <functional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "tests/io/iges/file_text.h"

namespace isorim::io::iges {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A file of one entity, type 144, at D3; D1 is a 0.
File file_of(std::vector<std::string> lines) {
  FileText text;
  text.entities = {{0, {"0;"}}, {144, std::move(lines)}};
  return parse(text.text(), "part.igs");
}

std::string refusal(const std::string& record, const std::function<void(Parameters&)>& read) {
  const File file = file_of({record});
  Parameters parameters(file, file.entities[1]);
  try {
    read(parameters);
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

TEST(IgesParameters, OmittedValuesAreZeroOrTheFallback) {
  const File file = file_of({"144,,,,,,,,,,;"});
  Parameters zero(file, file.entities[1]);
  EXPECT_TRUE(zero.is_omitted());
  EXPECT_EQ(zero.real(), 0.0);
  EXPECT_EQ(zero.integer(), 0);
  EXPECT_EQ(zero.pointer(), 0);
  EXPECT_FALSE(zero.logical());
  EXPECT_EQ(zero.text(), "");
  Parameters fallback(file, file.entities[1]);
  EXPECT_EQ(fallback.real(1.5), 1.5);
  EXPECT_EQ(fallback.integer(7), 7);
  EXPECT_EQ(fallback.pointer(1), 1);
  EXPECT_TRUE(fallback.logical(true));
  EXPECT_EQ(fallback.text("name"), "name");
}

TEST(IgesParameters, BeyondTheEndFallbacksHoldAndAllElseIsRefused) {
  const File file = file_of({"144,1;"});
  Parameters parameters(file, file.entities[1]);
  EXPECT_EQ(parameters.integer(), 1);
  EXPECT_EQ(parameters.remaining(), 0);
  EXPECT_TRUE(parameters.is_omitted());
  EXPECT_EQ(parameters.real(2.5), 2.5);
  EXPECT_EQ(parameters.pointer(0), 0);
  EXPECT_EQ(parameters.remaining(), 0);
  EXPECT_THAT(refusal("144,1;",
                      [](auto& p) {
                        p.real();
                        p.real();
                      }),
              HasSubstr("part.igs: 144 at D3, parameter 2: the parameters end here (1 in all), expected more"));
}

TEST(IgesParameters, ErrorsNameTheParameterAndItsLine) {
  const File file = file_of({"144,1.,2.,", "3.,abc;"});
  Parameters parameters(file, file.entities[1]);
  parameters.skip(3);
  EXPECT_EQ(parameters.number(), 4);
  try {
    parameters.real();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "part.igs: 144 at D3, parameter 4 (line P3): found 'abc', expected a real number within +-1.8e308");
  }
}

TEST(IgesParameters, WhatIsFoundIsNamed) {
  EXPECT_THAT(refusal("144,1E999;", [](auto& p) { p.real(); }), HasSubstr("found '1E999', expected a real number"));
  EXPECT_THAT(refusal("144,1.5;", [](auto& p) { p.integer(); }), HasSubstr("found '1.5', expected an integer"));
  EXPECT_THAT(refusal("144,7;", [](auto& p) { p.pointer(); }), HasSubstr("but there is no directory entry D7"));
  EXPECT_THAT(refusal("144,2;", [](auto& p) { p.pointer(); }), HasSubstr("no directory entry D2"));
  EXPECT_THAT(refusal("144,-1;", [](auto& p) { p.pointer(); }), HasSubstr("no directory entry D-1"));
  EXPECT_THAT(refusal("144,1Hx;", [](auto& p) { p.pointer(); }), HasSubstr("found '1Hx', expected a pointer"));
  EXPECT_THAT(refusal("144,0;", [](auto& p) { p.target(); }), HasSubstr("no pointer is given"));
  EXPECT_THAT(refusal("144,2;", [](auto& p) { p.logical(); }), HasSubstr("found 2, expected 0 (false) or 1 (true)"));
  EXPECT_THAT(refusal("144,abc;", [](auto& p) { p.text(); }), HasSubstr("found 'abc', expected a text"));
  EXPECT_THAT(refusal("144,-1;", [](auto& p) { p.count(); }), HasSubstr("found the count -1"));
  EXPECT_THAT(refusal("144," + std::string(50, 'x') + ";", [](auto& p) { p.real(); }),
              HasSubstr("found '" + std::string(40, 'x') + "...'"));
}

TEST(IgesParameters, CountsThatLieMakeNoRoom) {
  EXPECT_THAT(refusal("144,2000000000,1.,2.;", [](auto& p) { p.count(3); }),
              HasSubstr("parameter 1 (line P2): 2000000000 times 3 values are announced, but only 2 follow"));
  EXPECT_THAT(refusal("144,1.,2.;", [](auto& p) { p.reals(2000000000); }),
              HasSubstr("2000000000 values are expected from here, but only 2 follow"));
  EXPECT_THAT(refusal("144,1,1;", [](auto& p) { p.pointers(3); }), HasSubstr("3 pointers are expected"));
  const File file = file_of({"144,2,1.,2.,3.,4.;"});
  Parameters parameters(file, file.entities[1]);
  EXPECT_EQ(parameters.count(2), 2);
  EXPECT_THAT(parameters.reals(4), ElementsAre(1.0, 2.0, 3.0, 4.0));
}

TEST(IgesParameters, TargetsAreEntities) {
  const File file = file_of({"144,1,3;"});
  Parameters parameters(file, file.entities[1]);
  EXPECT_EQ(parameters.target().type, 0);
  EXPECT_EQ(&parameters.target(), &file.entities[1]);
}

TEST(IgesParameters, PointersMayFollowTheParameters) {
  const auto trailing = [](const std::string& record) {
    const File file = file_of({record});
    Parameters parameters(file, file.entities[1]);
    parameters.skip();
    return parameters.trailing_pointers();
  };
  EXPECT_THAT(trailing("144,9.;").properties, IsEmpty());
  EXPECT_EQ(trailing("144,9.;").complaint, "");
  EXPECT_THAT(trailing("144,9.,0,1,3;").properties, ElementsAre(3));
  EXPECT_THAT(trailing("144,9.,2,1,3,1,3;").associativities, ElementsAre(1, 3));
  EXPECT_THAT(trailing("144,9.,2,1,3;").associativities, ElementsAre(1, 3));
  EXPECT_THAT(trailing("144,9.,,1,3;").properties, ElementsAre(3));
  for (const char* record : {"144,9.,5,1;", "144,9.,1,99;", "144,9.,x;", "144,9.,0,0,7;", "144,9.,-1;"}) {
    EXPECT_THAT(trailing(record).properties, IsEmpty()) << record;
    EXPECT_NE(trailing(record).complaint, "") << record;
  }
}

}  // namespace
}  // namespace isorim::io::iges
