#include "io/case/value.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "io/case/complaints.h"

namespace isorim::io {
namespace {

using ::testing::HasSubstr;

const std::string text =
    "title = 'a \"quoted\" \\ title'\n[geometry]\nradius = 0.1\nlist = [1, 2.0, true]\n"
    "[[integral]]\nname = 'one'\ndeep = { a = [[1, 2], [3, 4]], b = {} }\n[[integral]]\nname = 'two'\n"
    "[table.inner]\nx = -1e300\n";

std::string message_of(void (*call)()) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Toml, PlacesAreThoseOfTheFile) {
  const Value root = parse_toml(text, "a.toml");
  const Value* radius = root.find("geometry")->find("radius");
  EXPECT_EQ(radius->place.describe(), "a.toml:3");
  EXPECT_EQ(std::get<double>(radius->data), 0.1);
  const auto& integrals = *root.find("integral")->as<Value::Array>();
  EXPECT_EQ(integrals[1].find("name")->place.line, 9);
}

TEST(Toml, KeepsTheOrderOfTheFile) {
  const Value root = parse_toml("z = 1\na = 2\nm = 3\n", "");
  const auto& table = *root.as<Value::Table>();
  EXPECT_EQ(table[0].key + table[1].key + table[2].key, "zam");
}

TEST(Toml, WrittenTextParsesBackToTheSameValues) {
  const std::string once = to_toml(parse_toml(text, "a"));
  EXPECT_EQ(to_toml(parse_toml(once, "b")), once);
  EXPECT_THAT(once, HasSubstr("radius = 0.1\n"));
  EXPECT_THAT(once, HasSubstr("deep = { a = [[1, 2], [3, 4]], b = {} }"));
  EXPECT_THAT(once, HasSubstr("list = [1, 2.0, true]"));
  EXPECT_EQ(*parse_toml(once, "b").find("title")->as<std::string>(), "a \"quoted\" \\ title");
  EXPECT_EQ(*parse_toml(once, "b").find("table")->find("inner")->find("x")->as<double>(), -1e300);
}

TEST(Toml, RealsKeepTheirBits) {
  const Value root = parse_toml("a = 0.1\nb = 12.566370614359173\nc = 5e-324\nd = 1e22\ne = 100.0\n", "");
  const Value back = parse_toml(to_toml(root), "");
  for (const char* key : {"a", "b", "c", "d", "e"}) {
    EXPECT_EQ(*root.find(key)->as<double>(), *back.find(key)->as<double>()) << key;
  }
}

TEST(Override, ReplacesMakesAndIndexes) {
  Value root = parse_toml(text, "a.toml");
  apply_override(root, "geometry.radius=2.5");
  apply_override(root, "integral.1.name = three");
  apply_override(root, "new.section.key=[1, 2]");
  EXPECT_EQ(*root.find("geometry")->find("radius")->as<double>(), 2.5);
  EXPECT_EQ(*root.find("integral")->as<Value::Array>()->at(1).find("name")->as<std::string>(), "three");
  EXPECT_EQ(root.find("new")->find("section")->find("key")->as<Value::Array>()->size(), 2U);
  EXPECT_EQ(root.find("geometry")->find("radius")->place.describe(), "--set geometry.radius=2.5");
}

TEST(Override, QuotedAndTypedValuesAreToml) {
  Value root = parse_toml("", "");
  apply_override(root, "a=\"3\"");
  apply_override(root, "b=3");
  apply_override(root, "c=two words");
  apply_override(root, "d=1\ne=2");
  EXPECT_EQ(*root.find("a")->as<std::string>(), "3");
  EXPECT_EQ(*root.find("b")->as<std::int64_t>(), 3);
  EXPECT_EQ(*root.find("c")->as<std::string>(), "two words");
  EXPECT_EQ(*root.find("d")->as<std::string>(), "1\ne=2");
}

TEST(Override, FaultsAreNamed) {
  EXPECT_THAT(message_of([] {
                Value root = parse_toml("a = [1]", "");
                apply_override(root, "a.1=2");
              }),
              HasSubstr("\"1\" should be an index from 0 to 0 into a list of 1"));
  EXPECT_THAT(message_of([] {
                Value root = parse_toml("a = 1", "");
                apply_override(root, "a..b=2");
              }),
              HasSubstr("the path has an empty part"));
}

TEST(DidYouMean, FindsTheNearestAndOnlyNearOnes) {
  const std::vector<std::string> names{"radius", "radii", "centre", "rotation"};
  EXPECT_EQ(did_you_mean("raduis", names), " (did you mean \"radius\"?)");
  EXPECT_EQ(did_you_mean("center", names), " (did you mean \"centre\"?)");
  EXPECT_EQ(did_you_mean("roation", names), " (did you mean \"rotation\"?)");
  EXPECT_EQ(did_you_mean("height", names), "");
  EXPECT_EQ(did_you_mean("x", std::vector<std::string>{"y"}), "");
  EXPECT_EQ(did_you_mean("x", {}), "");
}

TEST(Complaints, ComeInTheOrderOfTheFileAndAllTogether) {
  const auto source = std::make_shared<const std::string>("a.toml");
  Complaints complaints;
  EXPECT_NO_THROW(complaints.throw_if_any());
  const auto at = [&](int line, const char* path) {
    KeyPlace place;
    place.place = Place{source, line, 1};
    place.path = path;
    return place;
  };
  complaints.add(at(7, "b"), "second");
  complaints.add(at(2, "a"), "first");
  try {
    complaints.throw_if_any();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "a.toml:2: a: first\na.toml:7: b: second");
  }
}

}  // namespace
}  // namespace isorim::io
