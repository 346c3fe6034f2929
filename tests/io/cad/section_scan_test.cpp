#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "io/results/compute.h"
#include "solver/plane_sections.h"
#include "solver/properties.h"
#include "tests/io/cad/real_cases.h"

/// Every solid of the case folders, and of files by other people's CAD where they are, cut by planes of any direction.
namespace isorim::io {
namespace {

namespace fs = std::filesystem;
using geometry::PlaneFrame;
using geometry::Vector3;

constexpr int single_planes = 10;
constexpr int family_planes = 24;

/// Case files and CAD files of a folder, in alphabetical order; of the variants of one file with other digits and
/// other entities (_p17, _solid) none.
std::vector<fs::path> files_of(const fs::path& folder) {
  std::vector<fs::path> files;
  if (!fs::is_directory(folder)) return files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string extension = entry.path().extension().string();
    const std::string stem = entry.path().stem().string();
    const bool is_shape = extension == ".toml" || ((extension == ".igs" || extension == ".be" || extension == ".iga") &&
                                                   !fs::exists(fs::path(entry.path()).replace_extension(".toml")));
    const bool is_variant = stem.ends_with("_p17") || stem.ends_with("_solid");
    if (is_shape && !is_variant) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

Vector3 random_direction(std::mt19937_64& random) {
  const auto real = [&] { return 2.0 * (static_cast<double>(random() >> 11) * 0x1p-53) - 1.0; };
  while (true) {
    const Vector3 v(real(), real(), real());
    if (v.norm() <= 1.0 && v.norm() > 0.1) return v.normalized();
  }
}

/// The solid of a file; nothing if it is plane or open.
struct Solid {
  geometry::Boundary<3> boundary;
  geometry::BoundingBox<3> box;
  double volume = 0.0;
  double largest_gap = 0.0;

  PlaneFrame plane(const Vector3& normal, double share) const {
    const double half = 0.5 * (box.upper - box.lower).dot(normal.cwiseAbs());
    return geometry::plane_frame((normal.dot(box.middle()) + (2.0 * share - 1.0) * half) * normal, normal);
  }
  double extent(const Vector3& normal) const { return (box.upper - box.lower).dot(normal.cwiseAbs()); }
};

std::optional<Solid> read_solid(const fs::path& path) {
  const CaseFile file = read_case_or_cad(path, {});
  const AnyModel any = build_model(file);
  const auto* model = std::get_if<Model<3>>(&any);
  if (!model || !model->oriented.topology.closed) return std::nullopt;
  solver::PropertyOptions<3> how;
  how.integration.tolerance = 1e-8;
  const auto properties = solver::geometric_properties<3>(model->table, how);
  return Solid{model->oriented.boundary, geometry::bounding_box(model->table), properties.domain->measure.value,
               model->oriented.topology.largest_gap};
}

void expect_sound(const solver::MeasuredSection& measured, const Solid& solid, double widest_gap) {
  ASSERT_TRUE(measured.section) << measured.failure;
  EXPECT_TRUE(measured.section->chains.empty());
  EXPECT_LE(measured.section->largest_gap, widest_gap);
  const double size = solid.box.diagonal();
  EXPECT_TRUE(std::isfinite(measured.area.value) && std::isfinite(measured.perimeter.value));
  EXPECT_GE(measured.area.value, -1e-12 * size * size);
  EXPECT_LE(measured.area.value, size * size);
  // No region has less boundary than the disc of its area.
  EXPECT_GE(measured.perimeter.value * measured.perimeter.value,
            (1.0 - 1e-8) * 4.0 * std::acos(-1.0) * measured.area.value);
}

/// Planes of any direction through any place, and a family of parallel ones whose areas, times their distance, add up
/// to the volume: the second-order rule's error is bounded by a few per cent on bodies with steps.
void scan(const fs::path& path, std::mt19937_64& random) {
  SCOPED_TRACE(path.filename().string());
  const std::optional<Solid> solid = read_solid(path);
  if (!solid) return;
  geometry::SectionOptions options;
  options.gap_tolerance = std::max(1e-6, 2.0 * solid->largest_gap / geometry::PlaneCutter(solid->boundary).size());
  const geometry::PlaneCutter cutter(solid->boundary, options);
  std::vector<PlaneFrame> planes;
  for (int k = 0; k < single_planes; ++k) {
    const Vector3 normal = random_direction(random);
    planes.push_back(solid->plane(normal, static_cast<double>(random() >> 11) * 0x1p-53));
  }
  const Vector3 normal = random_direction(random);
  for (int k = 0; k < family_planes; ++k) planes.push_back(solid->plane(normal, (k + 0.5) / family_planes));
  const std::vector<solver::MeasuredSection> sections =
      solver::measure_sections(cutter, planes, {.tolerance = 1e-8, .fit_tolerance = 0.0});
  double sum = 0.0;
  for (std::size_t k = 0; k < planes.size(); ++k) {
    SCOPED_TRACE("plane " + std::to_string(k));
    expect_sound(sections[k], *solid, 100.0 * options.gap_tolerance * cutter.size());
    if (k >= single_planes) sum += sections[k].area.value * solid->extent(normal) / family_planes;
  }
  EXPECT_NEAR(sum, solid->volume, 0.02 * solid->volume);
}

TEST(SectionScan, OfTheCaseFolders) {
  std::mt19937_64 random(20260722);
  const fs::path cases = fs::path(ISORIM_SOURCE_DIR) / "cases";
  int files = 0;
  for (const char* folder : {"cad", "trimmed", "tspline", "sections", "verification"})
    for (const fs::path& path : files_of(cases / folder)) {
      scan(path, random);
      ++files;
    }
  EXPECT_GT(files, 60);
}

TEST(SectionScan, OfFilesByOtherPrograms) {
  const fs::path shared = real_cases().parent_path();
  if (!fs::is_directory(shared / "real"))
    GTEST_SKIP() << shared / "real"
                 << " is not there";
  std::mt19937_64 random(47);
  for (const char* folder : {"real", "tspline"})
    for (const fs::path& path : files_of(shared / folder)) {
      // Two of them hold no boundary that is closed, which other tests are about.
      try {
        scan(path, random);
      } catch (const InputError&) {
      }
    }
}

}  // namespace
}  // namespace isorim::io
