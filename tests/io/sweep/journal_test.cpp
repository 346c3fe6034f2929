#include "io/sweep/journal.h"

#include <fstream>
#include <limits>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "geometry/errors.h"
#include "tests/io/cli/program_test.h"

namespace isorim::io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

CaseRecord record(std::size_t index, const std::string& status = "ok") {
  CaseRecord made;
  made.index = index;
  made.status = status;
  made.message = "two\nlines, \"quoted\"";
  made.exit_status = 3;
  made.expectations_met = 2;
  made.expectations_missed = 1;
  made.seconds = 0.1;
  made.peak_memory = 123456789012;
  made.files = {"a.vtu", "results.h5"};
  made.folder = "cases/1";
  made.results = {{"volume", 1.0 / 3.0}, {"area", std::nullopt}, {"a.b", 5e-324}};
  return made;
}

void expect_same(const CaseRecord& a, const CaseRecord& b) {
  EXPECT_EQ(a.index, b.index);
  EXPECT_EQ(a.status, b.status);
  EXPECT_EQ(a.message, b.message);
  EXPECT_EQ(a.exit_status, b.exit_status);
  EXPECT_EQ(a.expectations_met, b.expectations_met);
  EXPECT_EQ(a.expectations_missed, b.expectations_missed);
  EXPECT_EQ(a.seconds, b.seconds);
  EXPECT_EQ(a.peak_memory, b.peak_memory);
  EXPECT_EQ(a.files, b.files);
  EXPECT_EQ(a.folder, b.folder);
  EXPECT_EQ(a.results, b.results);
}

class Journals : public testing::ProgramTest {
 protected:
  Journals() : file(journal_path(folder())) {
    identity.sweep = "base = 'a.toml'\n[[parameter]]\nkey = 'geometry.radius'\nvalues = [1, 2]\n";
    identity.base = "[geometry]\nradius = 1.0\n";
    identity.files = {{"rows.csv", "0123456789abcdef"}};
    identity.cases = 10;
    identity.version = "0.1.0";
  }
  void write_records(std::size_t count) const {
    Journal journal = Journal::make(file, identity, {2, 3});
    for (std::size_t i = 0; i < count; ++i) journal.append(record(i));
  }

  std::filesystem::path file;
  SweepIdentity identity;
};

TEST_F(Journals, ReadBackWhatTheyRecord) {
  write_records(3);
  const JournalContent content = read_journal(file);
  EXPECT_THAT(differences(content.identity, identity), IsEmpty());
  EXPECT_EQ(content.shard.text(), "2/3");
  ASSERT_EQ(content.records.size(), 3);
  for (const auto& [index, found] : content.records) expect_same(found, record(index));
}

TEST_F(Journals, GoOnBehindATornLineWhereverItIsTorn) {
  write_records(3);
  const std::string whole = testing::read_file(file);
  const std::size_t begin = whole.rfind('\n', whole.size() - 2) + 1;
  for (std::size_t size = begin; size < whole.size(); size += 7) {
    std::ofstream(file, std::ios::binary) << whole.substr(0, size);
    JournalContent content;
    {
      Journal journal = Journal::resume(file, content);
      EXPECT_EQ(content.records.size(), 2);
      journal.append(record(2));
    }
    EXPECT_EQ(testing::read_file(file), whole);
  }
}

TEST_F(Journals, AreNoneWhileTheirFirstLineIsTorn) {
  EXPECT_FALSE(has_journal(folder()));
  write_records(0);
  const std::string whole = testing::read_file(file);
  EXPECT_TRUE(has_journal(folder()));
  for (std::size_t size = 0; size < whole.size(); ++size) {
    std::ofstream(file, std::ios::binary) << whole.substr(0, size);
    EXPECT_FALSE(has_journal(folder()));
  }
}

TEST_F(Journals, RefuseDamageBeforeTheLastLine) {
  write_records(3);
  std::string text = testing::read_file(file);
  const std::size_t line = text.find('\n') + 1;
  text[line + 40] ^= 1;
  std::ofstream(file, std::ios::binary) << text;
  EXPECT_THAT([&] { read_journal(file); }, ThrowsMessage<InputError>(HasSubstr("journal:2: the line is damaged")));
  std::ofstream(file, std::ios::binary) << "something else\n";
  EXPECT_THAT([&] { read_journal(file); }, ThrowsMessage<InputError>(HasSubstr("is no journal of a sweep")));
}

TEST_F(Journals, KeepTheLastRecordOfACase) {
  write_records(2);
  JournalContent content;
  {
    Journal journal = Journal::resume(file, content);
    journal.append(record(0, "failed"));
  }
  EXPECT_EQ(read_journal(file).records.at(0).status, "failed");
  EXPECT_EQ(read_journal(file).records.at(1).status, "ok");
}

TEST_F(Journals, AreWrittenByOneProcessAtATime) {
  const Journal journal = Journal::make(file, identity, {});
  const pid_t child = fork();
  if (child == 0) {
    try {
      JournalContent content;
      Journal::resume(file, content);
      _exit(1);
    } catch (const InputError& error) {
      _exit(std::string(error.what()).find("another process is running this sweep") == std::string::npos ? 2 : 0);
    }
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
}

TEST_F(Journals, AreReplacedWhole) {
  write_records(3);
  Journal::write(file, identity, {{4, record(4)}, {7, record(7)}});
  const JournalContent content = read_journal(file);
  EXPECT_EQ(content.shard.text(), "1/1");
  ASSERT_EQ(content.records.size(), 2);
  expect_same(content.records.at(7), record(7));
}

TEST_F(Journals, TellWhatIsDifferent) {
  SweepIdentity now = identity;
  EXPECT_THAT(differences(identity, now), IsEmpty());
  now.base = "[geometry]\nradius = 2.0\ntype = 'sphere'\n";
  EXPECT_THAT(differences(identity, now), ElementsAre("the base case: geometry.radius was 1.0, is 2.0",
                                                      "the base case: geometry.type was absent, is \"sphere\""));
  now = identity;
  now.sweep = "base = 'a.toml'\n[[parameter]]\nkey = 'geometry.radius'\nvalues = [1, 3]\n";
  EXPECT_THAT(differences(identity, now), ElementsAre("the sweep file: parameter.0.values was [1, 2], is [1, 3]"));
  now = identity;
  now.files = {{"rows.csv", "1123456789abcdef"}, {"part.igs", "0"}};
  EXPECT_THAT(differences(identity, now),
              ElementsAre("the file rows.csv has other contents", "the file part.igs is new"));
  EXPECT_THAT(differences(now, identity), ElementsAre("the file part.igs is no longer there or no longer named",
                                                      "the file rows.csv has other contents"));
}

TEST(Records, RefuseWhatIsNone) {
  for (const char* text : {"", "{}", "[1]", "{\"case\": \"a\"}", "{\"case\": 1}"}) {
    EXPECT_THROW(parse_record(text), InputError) << text;
  }
}

Quantity quantity(const std::string& name, const Entries& value) {
  Quantity made;
  made.name = name;
  made.value = value;
  return made;
}

TEST(Records, NameResultsByTheirPaths) {
  Report report;
  report.properties = {quantity("volume", single(2.0)), quantity("centroid", {{1, 2, 3}, 3, 1}), quantity("area", {})};
  report.properties[0].error = {1e-9};
  report.properties[0].evaluations = 7;
  report.properties[1].error = {0.5, 0.25, 0.125};
  report.integrals = {quantity("moment", single(std::numeric_limits<double>::infinity()))};
  report.geometry.elements = 8;
  const auto results = flat_results(report, {});
  const auto value = [&](const std::string& name) -> std::optional<double> {
    for (const auto& [known, number] : results)
      if (known == name) return number;
    return -1;
  };
  EXPECT_EQ(value("volume"), 2.0);
  EXPECT_EQ(value("volume.error"), 1e-9);
  EXPECT_EQ(value("volume.evaluations"), 7.0);
  EXPECT_EQ(value("centroid.2"), 3.0);
  EXPECT_EQ(value("centroid.error.1"), 0.25);
  EXPECT_EQ(value("area"), std::nullopt);
  EXPECT_EQ(value("moment"), std::nullopt);
  EXPECT_EQ(value("geometry.elements"), 8.0);
  EXPECT_EQ(value("geometry.closed"), 0.0);
}

TEST(Records, HoldLongListsIfTheyAreChosen) {
  Report report;
  report.properties = {quantity("long", {std::vector<double>(17, 1.5), 17, 1}),
                       quantity("short", {std::vector<double>(16, 1.5), 16, 1})};
  const auto count = [&](const std::vector<std::string>& chosen, const std::string& stem) {
    int found = 0;
    for (const auto& [name, value] : flat_results(report, chosen)) found += name.starts_with(stem) && value == 1.5;
    return found;
  };
  EXPECT_EQ(count({}, "long."), 0);
  EXPECT_EQ(count({}, "short."), 16);
  EXPECT_EQ(count({"long"}, "long."), 17);
  EXPECT_EQ(count({"long.16"}, "long."), 17);
}

}  // namespace
}  // namespace isorim::io
