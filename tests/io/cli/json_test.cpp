#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/io/cli/program_test.h"

namespace isorim::testing {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;

const std::string ball = "title = 'Ball'\n[geometry]\ntype = 'sphere'\nradius = 1\n";

/// Every command prints JSON alone on the standard output with --json, also when it fails.
class JsonReplies : public ProgramTest {
 protected:
  static json reply(const std::vector<std::string>& args, int status = 0) {
    const ProgramResult result = run(args);
    EXPECT_EQ(result.status, status) << result.err;
    json parsed = json::parse(result.out);
    EXPECT_THAT(parsed["isorim"].get<std::string>(), MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+"));
    return parsed;
  }
  std::string ball_file() const { return write("ball.toml", ball); }
};

TEST_F(JsonReplies, OfRunIsTheFileOfResults) {
  const ProgramResult result = run({"run", ball_file(), "-o", path("out"), "--json"});
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.out, read_file(path("out/results.json")));
  EXPECT_EQ(json::parse(result.out)["case"], "Ball");
}

TEST_F(JsonReplies, OfVerifyIsTheTable) {
  write("suite/ball.toml", ball + "[expect]\nvolume = { value = 4.1887902047863905, rtol = 1e-12 }\n");
  const json table = reply({"verify", path("suite"), "--json"});
  EXPECT_EQ(table["cases"][0]["file"], "ball");
  ProgramResult written = run({"verify", path("suite"), "--json", path("table.json")});
  EXPECT_THAT(written.out, HasSubstr("1 of 1 expectations met"));
  EXPECT_EQ(json::parse(read_file(path("table.json")))["status"], "ok");
}

TEST_F(JsonReplies, OfConvertTellWhatWasWritten) {
  const std::string file = ball_file();
  const json iges = reply({"convert", file, path("ball.igs"), "--unit", "m", "--json"});
  EXPECT_EQ(iges["format"], "iges");
  EXPECT_EQ(iges["solids"], 1);
  EXPECT_EQ(iges["unit"], "m");
  EXPECT_EQ(iges["output"], path("ball.igs"));
  EXPECT_EQ(iges["warnings"].size(), 0U);
  EXPECT_EQ(reply({"convert", file, path("ball.vtu"), "--json"})["elements"], 8);
  EXPECT_GT(reply({"convert", file, path("ball.stl"), "--json"})["triangles"], 100);
  EXPECT_EQ(reply({"convert", file, path("ball.iga"), "--json"})["elements"], 8);
}

TEST_F(JsonReplies, OfCheckAndPicture) {
  EXPECT_EQ(reply({"check", ball_file(), "--json"})["geometry"]["closed"], true);
  const json picture =
      reply({"picture", ball_file(), "-o", path("ball.png"), "--view", "all", "--size", "80x60", "--json"});
  EXPECT_EQ(picture["output"], path("ball.png"));
  EXPECT_EQ(picture["width"], 80);
  EXPECT_THAT(picture["views"], ElementsAre("iso", "front", "top", "left"));
  EXPECT_TRUE(picture["field"].is_null());
}

TEST_F(JsonReplies, OfHullsTellWhatIsInTheLibrary) {
  const std::string offsets = std::string(ISORIM_SOURCE_DIR) + "/cases/hull/wigley.csv";
  ASSERT_TRUE(std::filesystem::exists(offsets));
  const std::string library = path("hulls.h5");
  EXPECT_EQ(reply({"hulls", "import", library, offsets, "--name", "wigley", "--json"})["imported"], "wigley");
  const json list = reply({"hulls", "list", library, "--json"});
  ASSERT_EQ(list["hulls"].size(), 1U);
  EXPECT_EQ(list["hulls"][0]["name"], "wigley");
  EXPECT_EQ(list["hulls"][0]["stations"], 21);
  const json exported = reply({"hulls", "export", library, "wigley", path("again.csv"), "--json"});
  EXPECT_EQ(exported["file"], path("again.csv"));
  EXPECT_EQ(reply({"hulls", "remove", library, "wigley", "--json"})["removed"], "wigley");
  EXPECT_EQ(reply({"hulls", "list", library, "--json"})["hulls"].size(), 0U);
}

TEST_F(JsonReplies, OfHelpNameCommandsTablesAndKeys) {
  std::set<std::string> commands;
  const json help = reply({"help", "--json"});
  for (const json& command : help["commands"]) {
    commands.insert(command["name"].get<std::string>());
    bool has_json = false;
    for (const json& argument : command["arguments"]) has_json |= argument["names"].back() == "--json";
    if (command.contains("commands")) has_json = true;
    EXPECT_TRUE(has_json) << command["name"];
    for (const json& inner : command.value("commands", json::array())) {
      EXPECT_THAT(inner["arguments"].dump(), HasSubstr("--json")) << inner["name"];
    }
  }
  EXPECT_EQ(commands,
            (std::set<std::string>{"run", "sweep", "verify", "check", "convert", "picture", "hulls", "help"}));
  const json torus = reply({"help", "case", "torus", "--json"})["tables"][0];
  EXPECT_EQ(torus["name"], "torus");
  EXPECT_EQ(torus["keys"][0]["name"], "major_radius");
  EXPECT_EQ(torus["keys"][0]["required"], true);
  EXPECT_GT(reply({"help", "case", "--json"})["tables"].size(), 50U);
  EXPECT_EQ(reply({"help", "sweep", "--json"})["tables"][0]["name"], "sweep");
}

TEST_F(JsonReplies, OfFailuresHaveTheMessageAndTheStatus) {
  const auto failure = [](const std::vector<std::string>& args, int status) {
    const ProgramResult result = run(args);
    const json error = json::parse(result.out)["error"];
    EXPECT_EQ(result.status, status);
    EXPECT_EQ(error["exit_status"], status);
    EXPECT_THAT(result.err, HasSubstr(error["message"].get<std::string>()));
    return error;
  };
  EXPECT_THAT(failure({"run", path("missing.toml"), "--json"}, 2)["message"].get<std::string>(),
              HasSubstr("missing.toml"));
  EXPECT_EQ(failure({"check", write("bad.toml", "[geometry]\ntype = 'sphere'\n"), "--json"}, 2)["kind"], "input");
  EXPECT_EQ(failure({"run", ball_file(), "--nonsense", "--json"}, 2)["kind"], "input");
  EXPECT_EQ(failure({"rum", "--json"}, 2)["kind"], "input");
  EXPECT_EQ(failure({"help", "case", "tourus", "--json"}, 2)["kind"], "input");
  EXPECT_EQ(failure({"convert", ball_file(), path("ball.step"), "--json"}, 2)["kind"], "input");
  EXPECT_EQ(failure({"picture", path("none.vtu"), "-o", path("none.png"), "--json"}, 2)["kind"], "input");
  EXPECT_EQ(failure({"hulls", "list", path("none.h5"), "--json"}, 2)["kind"], "input");
  EXPECT_EQ(failure({"sweep", path("none.toml"), "--json"}, 2)["kind"], "input");
  EXPECT_EQ(failure({"verify", path("nowhere"), "--json"}, 2)["kind"], "input");
  const std::string root = ball + "[[integral]]\nname = 'root'\nintegrand = 'sqrt(x - 5)'\n";
  EXPECT_EQ(failure({"run", write("root.toml", root), "-o", path("out"), "--json"}, 3)["kind"], "numerical");
}

}  // namespace
}  // namespace isorim::testing
