#include "io/stl/stl_writer.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/io/cli/program_test.h"

namespace isorim::testing {
namespace {

using ::testing::HasSubstr;

using Corner = std::array<float, 3>;

struct StlFile {
  std::string header;
  std::vector<std::array<Corner, 3>> triangles;
};

StlFile read_stl(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  StlFile file{bytes.substr(0, 80), {}};
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, 4);
  EXPECT_EQ(bytes.size(), 84 + 50 * std::size_t(count));
  for (std::size_t k = 0; k < count; ++k) {
    std::array<Corner, 3>& triangle = file.triangles.emplace_back();
    std::memcpy(&triangle, bytes.data() + 84 + 50 * k + 12, 36);
  }
  return file;
}

/// By coordinates: every edge is run through as often one way as the other.
bool is_watertight(const StlFile& file) {
  std::map<std::array<Corner, 2>, int> balance;
  for (const auto& triangle : file.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Corner& a = triangle[i];
      const Corner& b = triangle[(i + 1) % 3];
      if (a < b)
        ++balance[{a, b}];
      else
        --balance[{b, a}];
    }
  }
  return !balance.empty() && std::ranges::all_of(balance, [](const auto& edge) { return edge.second == 0; });
}

double volume(const StlFile& file) {
  double sum = 0.0;
  for (const auto& t : file.triangles) {
    const auto x = [&](std::size_t k, std::size_t i) { return static_cast<double>(t[k][i]); };
    for (std::size_t i = 0; i < 3; ++i)
      sum += x(0, i) * (x(1, (i + 1) % 3) * x(2, (i + 2) % 3) - x(1, (i + 2) % 3) * x(2, (i + 1) % 3));
  }
  return sum / 6.0;
}

class Stl : public ProgramTest {
 protected:
  /// The exact volume and area of a case, and its mesh, by the key of [output].
  void expect_mesh_of(const std::string& file, double chord) const {
    const ProgramResult result =
        run({"run", file, "-o", path("out"), "--set", "output.stl=true", "--set",
             "output.stl_tolerance=" + std::to_string(chord), "--set", "properties.tolerance=1e-6"});
    ASSERT_NE(result.status, 2) << file << result.err;
    const nlohmann::json results = nlohmann::json::parse(read_file(folder() / "out/results.json"));
    const StlFile mesh = read_stl(folder() / "out/boundary.stl");
    EXPECT_TRUE(is_watertight(mesh)) << file;
    const double exact = results["properties"]["volume"]["value"];
    const double area = results["properties"]["area"]["value"];
    EXPECT_NEAR(volume(mesh), exact, area * chord + 1e-5 * exact) << file;
  }
};

TEST_F(Stl, IsWatertightForEveryTrimmedCase) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(ISORIM_SOURCE_DIR "/cases/trimmed")) {
    if (entry.path().extension() != ".toml") continue;
    expect_mesh_of(entry.path().string(), 2e-3);
    ++count;
  }
  EXPECT_GE(count, 3);
}

TEST_F(Stl, IsWatertightForPropellers) {
  expect_mesh_of(ISORIM_SOURCE_DIR "/cases/propeller/kaplan.toml", 0.3);
  expect_mesh_of(ISORIM_SOURCE_DIR "/cases/propeller/b_troost.toml", 0.3);
}

TEST_F(Stl, IsWrittenByConvert) {
  const std::string input = write("ball.toml", "title = 'solid ball'\n[geometry]\ntype = 'sphere'\nradius = 2\n");
  const ProgramResult result = run({"convert", input, path("ball.stl"), "--set", "output.stl_tolerance=0.01"});
  ASSERT_EQ(result.status, 0) << result.err;
  const StlFile mesh = read_stl(folder() / "ball.stl");
  EXPECT_TRUE(mesh.header.starts_with("isorim: solid ball "));
  EXPECT_THAT(result.out, HasSubstr(std::to_string(mesh.triangles.size()) + " triangles"));
  EXPECT_TRUE(is_watertight(mesh));
  EXPECT_NEAR(volume(mesh), 33.510321638291124, 0.5);
}

TEST_F(Stl, IsThatOfSolids) {
  const std::string disc = write("disc.toml", "[geometry]\ntype = 'circle'\nradius = 2\n[output]\nstl = true\n");
  EXPECT_THAT(run({"run", disc, "-o", path("out")}).err, HasSubstr("disc.toml:4: output: found stl = true"));
  EXPECT_THAT(run({"convert", disc, path("disc.stl"), "--set", "output.stl=false"}).err,
              HasSubstr("this is a shape of the plane"));
}

}  // namespace
}  // namespace isorim::testing
