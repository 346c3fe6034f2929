#include "io/iges/file.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "io/iges/parameters.h"
#include "tests/io/iges/file_text.h"

namespace isorim::io::iges {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Two lines and a name: lengths, pointers and strings.
FileText sample() {
  FileText text;
  text.entities = {
      {110, {"110,0.,0.,0.,1.,0.,0.,0,1,5;"}}, {110, {"110,1.,0.,0.,", "1.,2.,0.;"}}, {406, {"406,1,5HEdge1;"}, 15}};
  return text;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

std::string joined(const std::vector<std::string>& lines, const std::string& end = "\n") {
  std::string text;
  for (const auto& line : lines) text += line + end;
  return text;
}

/// The sample with each of its lines changed.
std::string changed(const std::function<void(std::string&)>& change) {
  std::vector<std::string> lines = lines_of(sample().text());
  for (auto& line : lines) change(line);
  return joined(lines);
}

std::string right_stripped(std::string line) {
  line.erase(line.find_last_not_of(' ') + 1);
  return line;
}

/// What the sample holds, whatever was done to its lines.
void expect_sample(const File& file) {
  ASSERT_EQ(file.entities.size(), 3U);
  EXPECT_EQ(file.global.unit, "mm");
  for (const Entity& entity : file.entities) EXPECT_EQ(entity.complaint, "");
  Parameters first(file, file.entities[0]);
  EXPECT_EQ(first.reals(6), (std::vector<double>{0, 0, 0, 1, 0, 0}));
  EXPECT_THAT(first.trailing_pointers().properties, ElementsAre(5));
  EXPECT_EQ(Parameters(file, file.entities[1]).reals(6), (std::vector<double>{1, 0, 0, 1, 2, 0}));
  Parameters name(file, file.entities[2]);
  EXPECT_EQ(name.integer(), 1);
  EXPECT_EQ(name.text(), "Edge1");
}

void expect_sample_with(const std::string& bytes, const std::string& warning) {
  const File file = parse(bytes, "sample.igs");
  expect_sample(file);
  EXPECT_THAT(file.warnings, Contains(HasSubstr(warning)));
}

void expect_clean_sample(const std::string& bytes) {
  const File file = parse(bytes, "sample.igs");
  expect_sample(file);
  EXPECT_THAT(file.warnings, IsEmpty());
}

std::string refusal(const std::string& bytes) {
  try {
    parse(bytes, "bad.igs");
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

TEST(IgesFile, ReadsAFileThatIsAsTheStandardSays) {
  FileText text;
  text.entities = {{110, {"110,1.5,-2.,3.E0,4D1,+.5,6;"}, 0, 3, "00010500", -5, 7, "Edge"},
                   {124, {"124,1.,0.,0.,0.,0.,1.,0.,0.,", "0.,0.,1.,2.5;"}},
                   {314, {"314,100.,0.,0.,3HRed;"}}};
  const File file = parse(text.text(), "small.igs");

  EXPECT_THAT(file.warnings, IsEmpty());
  EXPECT_THAT(file.start, ElementsAre("Made for a test"));
  EXPECT_EQ(file.global.product, "Part");
  EXPECT_EQ(file.global.unit, "mm");
  EXPECT_EQ(file.global.unit_in_millimetres, 1.0);
  EXPECT_EQ(file.global.author, "Me");
  EXPECT_EQ(file.global.organisation, "Here");
  EXPECT_EQ(file.global.resolution, 1e-6);
  EXPECT_EQ(file.global.largest_coordinate, 10.0);
  EXPECT_EQ(file.global.version_flag, 11);
  ASSERT_EQ(file.entities.size(), 3U);
  const Entity& line = file.entities[0];
  EXPECT_EQ(line.sequence, 1);
  EXPECT_EQ(line.transformation, 3);
  EXPECT_EQ(line.blank, 0);
  EXPECT_EQ(line.subordinate, 1);
  EXPECT_EQ(line.use, 5);
  EXPECT_EQ(line.colour, -5);
  EXPECT_EQ(line.level, 7);
  EXPECT_EQ(line.label, "Edge");
  EXPECT_EQ(Parameters(file, line).reals(6), (std::vector<double>{1.5, -2.0, 3.0, 40.0, 0.5, 6.0}));
  EXPECT_EQ(file.find(3)->type, 124);
  EXPECT_EQ(file.find(3)->first_line, 2);
  EXPECT_EQ(Parameters(file, *file.find(3)).reals(12).back(), 2.5);
  for (const int number : {-1, 0, 2, 7, 2147483647}) EXPECT_EQ(file.find(number), nullptr) << number;
}

TEST(IgesFile, TokensOutliveCopiesAndMoves) {
  File file = parse(sample().text(), "sample.igs");
  const File copy = file;
  const File moved = std::move(file);
  file = File{};
  expect_sample(copy);
  expect_sample(moved);
}

TEST(IgesFile, EndsOfLinesMayBeAny) {
  const std::vector<std::string> lines = lines_of(sample().text());
  expect_clean_sample(joined(lines, "\n"));
  expect_clean_sample(joined(lines, "\r\n"));
  expect_clean_sample(joined(lines, "\r"));
  expect_clean_sample(joined(lines, "\r\r\n"));
  // Records of 80 bytes, as on tapes.
  expect_clean_sample(joined(lines, ""));
  // The last line may end without.
  const std::string text = joined(lines);
  expect_clean_sample(text.substr(0, text.size() - 1));
}

TEST(IgesFile, BlanksAtTheEndsOfLinesMayBeMissing) {
  expect_clean_sample(changed([](std::string& line) { line = right_stripped(line); }));
  expect_clean_sample(changed([](std::string& line) { line += "          "; }));
}

TEST(IgesFile, BlankLinesAndMarksAreNothing) {
  const std::string text = sample().text();
  expect_clean_sample("\n   \n" + text);
  expect_clean_sample(joined(lines_of(text), "\n\n"));
  expect_clean_sample(text + "\n\n\x1A\n");
  expect_clean_sample("\xEF\xBB\xBF" + text);
}

TEST(IgesFile, WhatFollowsTheLastLineIsLeftOut) {
  expect_sample_with(sample().text() + "garbage\n", "goes on after the T line");
  expect_sample_with(sample().text() + sample().text(), "goes on after the T line");
}

TEST(IgesFile, TheLastLineMayBeMissing) {
  std::vector<std::string> lines = lines_of(sample().text());
  lines.pop_back();
  expect_sample_with(joined(lines), "T line that ends a file is missing");
}

TEST(IgesFile, TheCountsOfTheLastLineAreChecked) {
  std::vector<std::string> lines = lines_of(sample().text());
  lines.back().replace(16, 8, "D      8");
  expect_sample_with(joined(lines), "it counts 8 lines in section D, but there are 6");
}

TEST(IgesFile, TextBehindColumn80IsLeftOut) {
  expect_sample_with(changed([](std::string& line) { line += " more"; }),
                     "text behind column 80 was left out (15 times)");
}

TEST(IgesFile, TabsStandForBlanks) {
  expect_sample_with(changed([](std::string& line) {
                       if (line[72] == 'P') line = line.substr(0, 40) + "\t\t\t" + line.substr(64);
                     }),
                     "tabs were taken for blanks");
}

TEST(IgesFile, LinesThatLostBlanksArePutRight) {
  const auto squeeze = [](std::string& line) {
    if (line[72] != 'P' && line[72] != 'G') return;
    const std::size_t end = line.find_last_not_of(' ', 63);
    line = line.substr(0, end + 1) + " " + line.substr(line.find_first_not_of(' ', 64));
  };
  expect_sample_with(changed(squeeze), "the line has lost blanks");
}

TEST(IgesFile, NumbersOfLinesMayBeMissing) {
  expect_sample_with(changed([](std::string& line) { line.resize(73); }), "no proper number");
  expect_sample_with(changed([](std::string& line) { line.replace(73, 7, "      9"); }), "lines were counted instead");
}

TEST(IgesFile, NumbersOfParameterLinesMayBeginAnywhere) {
  const auto add_seven = [](std::string& line, std::size_t last_column) {
    line.replace(last_column - 7, 8, fmt::format("{:8}", std::stoi(line.substr(last_column - 6, 7)) + 7));
  };
  expect_sample_with(changed([&](std::string& line) {
                       const char section = line[72];
                       if (section == 'D' && (line[79] - '0') % 2 == 1) add_seven(line, 15);
                       if (section == 'P') add_seven(line, 79);
                       line[72] = section;
                     }),
                     "numbers of lines are left out; they were taken as written");
}

TEST(IgesFile, DirectoryEntriesMayStandInAnyOrder) {
  std::vector<std::string> lines = lines_of(sample().text());
  const auto first = std::find_if(lines.begin(), lines.end(), [](const auto& line) { return line[72] == 'D'; });
  std::rotate(first, first + 2, first + 6);
  expect_sample_with(joined(lines), "were taken as written");
}

TEST(IgesFile, TwoEntriesWithOneNumberAreRefused) {
  std::vector<std::string> lines = lines_of(sample().text());
  for (auto& line : lines) {
    if (line[72] == 'D' && line[79] > '4') line[79] = static_cast<char>(line[79] - 4);
  }
  EXPECT_THAT(refusal(joined(lines)), HasSubstr("two directory entries have the number D1"));
}

TEST(IgesFile, HalfADirectoryEntryIsRefused) {
  std::vector<std::string> lines = lines_of(sample().text());
  lines.erase(std::find_if(lines.begin(), lines.end(), [](const auto& line) { return line[72] == 'D'; }));
  EXPECT_THAT(refusal(joined(lines)), HasSubstr("5 lines, expected two for each entity"));
}

TEST(IgesFile, PointersToParametersMayLie) {
  const std::string wrong_pointers = changed([](std::string& line) {
    if (line[72] == 'D' && (line[79] - '0') % 2 == 1) line.replace(8, 8, "       1");
  });
  expect_sample_with(wrong_pointers, "the lines that point back to the entity were taken");
  const std::string far_pointers = changed([](std::string& line) {
    if (line[72] == 'D' && (line[79] - '0') % 2 == 1) line.replace(8, 8, " 9999999");
  });
  expect_sample_with(far_pointers, "the lines that point back to the entity were taken");
}

TEST(IgesFile, BackPointersMayBeMissingOrAllTheSame) {
  for (const char* back_pointer : {"       ", "      1", "      0", "     99"}) {
    expect_sample_with(changed([&](std::string& line) {
                         if (line[72] == 'P') line.replace(65, 7, back_pointer);
                       }),
                       "do not point back");
  }
}

TEST(IgesFile, CountsOfParameterLinesMayLie) {
  for (const char* count : {"       0", "     100", "      -1", "        "}) {
    expect_sample_with(changed([&](std::string& line) {
                         if (line[72] == 'D' && (line[79] - '0') % 2 == 0) line.replace(24, 8, count);
                       }),
                       "another number of parameter lines");
  }
}

TEST(IgesFile, AnEntityWithoutParametersSaysSo) {
  std::vector<std::string> lines = lines_of(sample().text());
  lines.erase(lines.end() - 2);
  const File file = parse(joined(lines), "cut.igs");
  EXPECT_THAT(file.entities[2].complaint, HasSubstr("not where its directory entry points (line P4)"));
  EXPECT_THROW(Parameters(file, file.entities[2]), InputError);
}

TEST(IgesFile, ParametersOfAnotherTypeAreRefused) {
  FileText text = sample();
  text.entities[1].parameters = {"100,0.,0.,0.,1.,0.,1.,0.;"};
  const File file = parse(text.text(), "bad.igs");
  EXPECT_THAT(file.entities[1].complaint, HasSubstr("begin with '100', expected its type number 110"));
}

TEST(IgesFile, NullEntitiesNeedNoParameters) {
  FileText text = sample();
  text.entities.push_back({0, {}});
  const File file = parse(text.text(), "null.igs");
  EXPECT_EQ(file.entities[3].complaint, "");
  EXPECT_THAT(file.entities[3].tokens, IsEmpty());
}

TEST(IgesFile, RecordDelimitersMayBeMissing) {
  FileText text = sample();
  text.entities[0].parameters = {"110,0.,0.,0.,1.,0.,0.,0,1,5"};
  expect_sample_with(text.text(), "110 at D1: the record delimiter ';'");
}

TEST(IgesFile, CommentsMayFollowTheRecord) {
  FileText text = sample();
  text.entities[0].parameters = {"110,0.,0.,0.,1.,0.,0.,0,1,5; the first edge, 99H;", "and its end; 110,"};
  expect_clean_sample(text.text());
}

TEST(IgesFile, ValuesMayEndInTheLastColumnAndStringsMayCrossLines) {
  const std::string numbers = "110,0.,0.,0.,1.,0.,";
  FileText text = sample();
  text.entities[0].parameters = {numbers + std::string(63 - numbers.size(), ' ') + "0", ",0,1,5;"};
  text.entities[1].parameters = {"110,1.,0.,0.,1.,2.,0. " + std::string(41, ' ') + ",", "0,0;"};
  const std::string head = "406,1,70H";
  const std::string content = "A string that crosses; the end of the line, with both delimiters in it";
  text.entities[2].parameters = {head + content.substr(0, 64 - head.size()), content.substr(64 - head.size()) + ";"};
  const File file = parse(text.text(), "strings.igs");
  EXPECT_THAT(file.warnings, IsEmpty());
  EXPECT_EQ(Parameters(file, file.entities[0]).reals(6).back(), 0.0);
  EXPECT_EQ(file.entities[0].tokens.size(), 9U);
  Parameters name(file, file.entities[2]);
  name.skip();
  EXPECT_EQ(name.text(), content);
}

TEST(IgesFile, BlanksInStringsAtTheEndsOfLinesSurviveTheirLoss) {
  FileText text = sample();
  const std::string head = "406,1,64H";
  text.entities[2].parameters = {head + std::string("left") + std::string(60 - head.size(), ' '), "     right;"};
  std::vector<std::string> lines = lines_of(text.text());
  const File whole = parse(joined(lines), "strings.igs");
  Parameters name(whole, whole.entities[2]);
  name.skip();
  EXPECT_EQ(name.text(), "left" + std::string(56, ' ') + "right");
}

TEST(IgesFile, DelimitersMayBeRedefined) {
  FileText text = sample();
  text.global = {"1H//1H#/4HPart/8Hpart.igs/6Hisorim/3H0.1/32/38/6/308/15//1./2/2HMM/",
                 "1/0.01/15H20260101.000000/1E-6/10./2HMe/4HHere/11/0/#"};
  text.entities[0].parameters = {"110/0./0./0./1./0./0./0/1/5#"};
  text.entities[1].parameters = {"110/1./0./0./", "1./2./0.#"};
  text.entities[2].parameters = {"406/1/5HEdge1#"};
  expect_clean_sample(text.text());
}

TEST(IgesFile, OneDelimiterMayBeRedefined) {
  FileText text = sample();
  text.global = {"1H||,8Hpart.igs,|||||||||||2#"};
  EXPECT_THAT(refusal(text.text()), HasSubstr("expected the delimiter '|'"));
  text.global = {"1H||||||||||||||2;"};
  text.entities.clear();
  const File bar = parse(text.text(), "bar.igs");
  EXPECT_EQ(bar.global.delimiters.parameter, '|');
  EXPECT_EQ(bar.global.delimiters.record, ';');
  EXPECT_EQ(bar.global.unit, "mm");
  text.global = {",1H#,,,,,,,,,,,,2#"};
  const File hash = parse(text.text(), "hash.igs");
  EXPECT_EQ(hash.global.delimiters.parameter, ',');
  EXPECT_EQ(hash.global.delimiters.record, '#');
  EXPECT_EQ(hash.global.unit, "mm");
}

TEST(IgesFile, ImpossibleDelimitersAreRefused) {
  FileText text = sample();
  for (const char* global : {"1H11", "1HEE", "1H++", "1H..", "1HHH", "1H  "}) {
    text.global = {global};
    EXPECT_THAT(refusal(text.text()), HasSubstr("delimiter is '")) << global;
  }
  text.global = {"1H,,1H,,4HPart;"};
  EXPECT_THAT(refusal(text.text()), HasSubstr("',' is to delimit both"));
  text.global = {"4HPart,"};
  EXPECT_THAT(refusal(text.text()), HasSubstr("found '4HPart, ', expected the delimiter ','"));
}

TEST(IgesFile, EmptyGlobalsTakeTheStandardsDefaults) {
  FileText text;
  for (const char* global : {",,;", ";", ",;", "1H,,1H;;", "1H,,1H;,;", ",,,,,,,,,,,,,,,,,,,,,,,,,;"}) {
    text.global = {global};
    const File file = parse(text.text(), "defaults.igs");
    EXPECT_THAT(file.warnings, IsEmpty()) << global;
    EXPECT_EQ(file.global.unit, "in") << global;
    EXPECT_EQ(file.global.unit_in_millimetres, 25.4);
    EXPECT_EQ(file.global.scale, 1.0);
    EXPECT_EQ(file.global.version_flag, 3);
    EXPECT_EQ(file.global.product, "");
  }
}

TEST(IgesFile, GlobalStringsMayCrossLines) {
  FileText text = sample();
  const std::string name = "a/very/long/path, with; both/delimiters/and/so/long/that/it/needs/more/than/one/line.igs";
  const std::string head = "1H,,1H;,,88H";
  text.global = {head + name.substr(0, 72 - head.size()), name.substr(72 - head.size()) + ",,,,,,,,,1.,2;"};
  const File file = parse(text.text(), "sample.igs");
  ASSERT_EQ(name.size(), 88U);
  EXPECT_EQ(file.global.file_name, name);
  EXPECT_EQ(file.global.unit, "mm");
  EXPECT_THAT(file.warnings, IsEmpty());
}

TEST(IgesFile, UnitsAreThoseOfTheFlagOrOfTheNameForFlagThree) {
  struct Case {
    const char* flag;
    const char* name;
    const char* unit;
    double millimetres;
  };
  const Case cases[] = {{"1", "", "in", 25.4},      {"2", "2HMM", "mm", 1.0},       {"4", "", "ft", 304.8},
                        {"5", "", "mi", 1609344.0}, {"6", "1HM", "m", 1000.0},      {"7", "", "km", 1e6},
                        {"8", "", "mil", 0.0254},   {"9", "", "um", 1e-3},          {"10", "2HCM", "cm", 10.0},
                        {"11", "", "uin", 2.54e-5}, {"3", "1HM", "m", 1000.0},      {"3", "4HINCH", "in", 25.4},
                        {"3", "2Hcm", "cm", 10.0},  {"3", "6HMETRES", "m", 1000.0}, {"2.0", "", "mm", 1.0},
                        {"", "", "in", 25.4},       {"2", "3HMM ", "mm", 1.0}};
  FileText text;
  for (const Case& c : cases) {
    text.global = {std::string(",,,,,,,,,,,,,") + c.flag + "," + c.name + ";"};
    const File file = parse(text.text(), "units.igs");
    EXPECT_EQ(file.global.unit, c.unit) << text.global[0];
    EXPECT_EQ(file.global.unit_in_millimetres, c.millimetres) << text.global[0];
    EXPECT_THAT(file.warnings, IsEmpty()) << text.global[0];
  }
}

TEST(IgesFile, DoubtfulUnitsAreTold) {
  FileText text;
  const auto with_unit = [&](const std::string& flag_and_name) {
    text.global = {",,,,,,,,,,,,," + flag_and_name + ";"};
    return parse(text.text(), "units.igs");
  };
  const File contradiction = with_unit("2,4HINCH");
  EXPECT_EQ(contradiction.global.unit, "mm");
  EXPECT_THAT(contradiction.warnings, Contains(HasSubstr("flag 2 means mm, but the unit's name is 'INCH'")));
  const File furlong = with_unit("3,7HFURLONG");
  EXPECT_EQ(furlong.global.unit, "FURLONG");
  EXPECT_EQ(furlong.global.unit_in_millimetres, 0.0);
  EXPECT_THAT(furlong.warnings, Contains(HasSubstr("lengths cannot be converted")));
  const File flag_only = with_unit("17,2HMM");
  EXPECT_EQ(flag_only.global.unit, "mm");
  EXPECT_THAT(flag_only.warnings, Contains(HasSubstr("unit flag 17 is unknown")));
  EXPECT_EQ(with_unit("3,").global.unit, "?");
}

TEST(IgesFile, DoubtfulGlobalValuesAreTold) {
  FileText text;
  text.global = {",,4HPart,,,,,,,,,,-2.,2,,,,,abc;"};
  const File file = parse(text.text(), "globals.igs");
  EXPECT_EQ(file.global.scale, 1.0);
  EXPECT_EQ(file.global.resolution, 0.0);
  EXPECT_THAT(file.warnings, AllOf(Contains(HasSubstr("model space scale is -2")),
                                   Contains(HasSubstr("value 19 is 'abc', expected a number; taken as 0"))));
}

TEST(IgesFile, OtherFormsAndFormatsAreNamed) {
  EXPECT_THAT(refusal(""), HasSubstr("bad.igs: the file is empty"));
  EXPECT_THAT(refusal("  \n\n"), HasSubstr("empty"));
  EXPECT_THAT(refusal("ISO-10303-21;\nHEADER;\n"), HasSubstr("a STEP file"));
  EXPECT_THAT(refusal("solid cube\n facet normal 0 0 1\n"), HasSubstr("an STL file"));
  EXPECT_THAT(refusal("title = \"a case\"\n[geometry]\n"), HasSubstr("no line has the letter of a section"));
  EXPECT_THAT(refusal(section_line("", 'C', 1) + "D1"), HasSubstr("compressed form"));
  EXPECT_THAT(refusal(std::string("B\0\0\0\x4e", 5) + std::string(100, '\0')), HasSubstr("binary form"));
  EXPECT_THAT(refusal(std::string("\x7f"
                                  "ELF\0\0\0",
                                  7)),
              HasSubstr("it is binary"));
  EXPECT_THAT(refusal(std::string("\xFF\xFES\0", 4)), HasSubstr("UTF-16"));
}

TEST(IgesFile, ALineOfNoSectionIsRefused) {
  std::vector<std::string> lines = lines_of(sample().text());
  lines.insert(lines.end() - 2, "this line is too short");
  EXPECT_THAT(refusal(joined(lines)), HasSubstr("line 14 belongs to no section: it has 22 columns only"));
  lines[lines.size() - 3] = std::string(72, 'x') + "Q     12";
  EXPECT_THAT(refusal(joined(lines)), HasSubstr("columns 73 to 80 hold 'Q     12'"));
}

TEST(IgesFile, ProseWithoutTheLetterOfItsSectionIsProse) {
  expect_sample_with("Exported by hand\n" + sample().text(), "taken for prose");
}

TEST(IgesFile, ADirectoryEntryWithoutATypeIsRefused) {
  EXPECT_THAT(refusal(changed([](std::string& line) {
                if (line[72] == 'D' && line[79] == '3') line.replace(0, 8, "     abc");
              })),
              HasSubstr("line 7: found 'abc' in columns 1 to 8 of a directory entry, expected a type number"));
}

TEST(IgesFile, FieldsThatHoldNoNumberAreTold) {
  const auto with_field = [](std::size_t column, const char* value) {
    return parse(changed([&](std::string& line) {
                   if (line[72] == 'D' && line[79] == '3') line.replace(column, 8, value);
                 }),
                 "fields.igs");
  };
  EXPECT_THAT(with_field(48, "     abc").entities[1].complaint,
              HasSubstr("field 'transformation' of its directory entry (line 7) holds 'abc'"));
  const File level = with_field(32, "     abc");
  EXPECT_EQ(level.entities[1].complaint, "");
  EXPECT_THAT(level.warnings, Contains(HasSubstr("field 'level'")));
  EXPECT_THAT(with_field(64, "0x010000").warnings, Contains(HasSubstr("status")));
  EXPECT_EQ(with_field(64, "   10501").entities[1].subordinate, 1);
  EXPECT_EQ(with_field(64, "   10501").entities[1].use, 5);
}

TEST(IgesFile, CharactersOfSeveralBytesTakeOneColumnOrSeveral) {
  std::vector<std::string> lines = lines_of(sample().text());
  const std::string prose = "Fl\xC3\xBCgel";
  lines[0] = prose + std::string(72 - prose.size(), ' ') + "S      1";
  expect_clean_sample(joined(lines));
  lines[0].insert(prose.size(), " ");
  expect_sample_with(joined(lines), "counted as one column");
}

TEST(IgesFile, MissingFilesAndFoldersAreNamed) {
  const auto message = [](const std::filesystem::path& path) -> std::string {
    try {
      read_file(path);
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing was thrown";
  };
  EXPECT_THAT(message("no_such_file.igs"), HasSubstr("cannot open 'no_such_file.igs'"));
  EXPECT_THAT(message(std::filesystem::temp_directory_path()), HasSubstr("folder"));
}

TEST(IgesFile, ReadsFromDisk) {
  const auto path = std::filesystem::path(::testing::TempDir()) / "isorim_sample.igs";
  std::ofstream(path, std::ios::binary) << sample().text();
  expect_sample(read_file(path));
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace isorim::io::iges
