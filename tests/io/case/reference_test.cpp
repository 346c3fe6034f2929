#include "io/case/reference.h"

#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/case/case_file.h"

namespace isorim::io {
namespace {

using ::testing::HasSubstr;

/// Every table of the declarations, found by walking them.
std::vector<const Description*> all_tables() {
  std::vector<const Description*> tables{&schema<CaseKeys>().description()};
  for (std::size_t i = 0; i < tables.size(); ++i) {
    for (const KeyDescription& key : tables[i]->keys) {
      if (!key.nested) continue;
      for (const Description* nested : key.nested()) {
        if (std::find(tables.begin(), tables.end(), nested) == tables.end()) tables.push_back(nested);
      }
    }
  }
  return tables;
}

TEST(Declarations, EveryKeyHasATextAndATypeAndNoneIsTwice) {
  for (const Description* table : all_tables()) {
    EXPECT_NE(table->text, "") << table->name;
    std::vector<std::string> names;
    for (const KeyDescription& key : table->keys) {
      EXPECT_NE(key.text, "") << table->name << "." << key.name;
      EXPECT_NE(key.type, "") << table->name << "." << key.name;
      EXPECT_EQ(key.text.back(), '.') << table->name << "." << key.name;
      names.push_back(key.name);
    }
    std::sort(names.begin(), names.end());
    EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end()) << table->name;
  }
}

TEST(Declarations, TypesHaveTheNamesOfTheirTables) {
  const auto shapes = KeyType<GeometryKeys>::nested();
  const auto& names = type_tags<GeometryKeys>().names;
  ASSERT_EQ(shapes.size(), names.size());
  for (std::size_t i = 0; i < names.size(); ++i) EXPECT_EQ(shapes[i]->name, names[i]);
  ASSERT_EQ(KeyType<SurfaceKeys>::nested().size(), type_tags<SurfaceKeys>().names.size());
  ASSERT_EQ(KeyType<CurveKeys>::nested().size(), type_tags<CurveKeys>().names.size());
  ASSERT_EQ(KeyType<LoopKeys>::nested().size(), type_tags<LoopKeys>().names.size());
  ASSERT_EQ(KeyType<PlaneRegionKeys>::nested().size(), type_tags<PlaneRegionKeys>().names.size());
  for (std::size_t i = 0; i < type_tags<SurfaceKeys>().names.size(); ++i) {
    EXPECT_EQ(KeyType<SurfaceKeys>::nested()[i]->name, type_tags<SurfaceKeys>().names[i]);
  }
}

TEST(Reference, HoldsEveryKeyWithItsDefaultAndRange) {
  const std::string reference = case_reference_markdown();
  for (const Description* table : all_tables()) {
    EXPECT_THAT(reference, HasSubstr("\n## " + table->name + "\n"));
    for (const KeyDescription& key : table->keys) {
      if (key.name == "role") continue;  // Told with the loops of a region.
      EXPECT_THAT(reference, HasSubstr("| `" + key.name + "` |"));
    }
  }
  EXPECT_THAT(reference, HasSubstr("| `tolerance` | real, > 0 and <= 0.1, default 1e-12 |"));
  EXPECT_THAT(reference, HasSubstr("| `over` | \"domain\" \\| \"boundary\", default \"domain\" |"));
  EXPECT_THAT(reference, HasSubstr("| `angle` | real, > 0 and <= 360, degrees, default 360.0 |"));
}

TEST(Reference, TopicLinesFitTheTerminal) {
  for (const Description* table : all_tables()) {
    const std::string topic = case_topic(table->name);
    for (std::size_t begin = 0; begin < topic.size();) {
      const std::size_t end = topic.find('\n', begin);
      EXPECT_LE(end - begin, 101U) << topic.substr(begin, end - begin);
      begin = end + 1;
    }
  }
}

}  // namespace
}  // namespace isorim::io
