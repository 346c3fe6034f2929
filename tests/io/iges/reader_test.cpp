#include "io/iges/reader.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/nurbs/surface.h"

namespace isorim::io {
namespace {

using geometry::Interval;
using geometry::LooseFace;
using geometry::Point3;

/// The folder with the files of the two collections, or empty.
std::filesystem::path collection(const std::string& name) {
  const char* root = std::getenv("ISORIM_CAD_FILES");
  return root == nullptr ? std::filesystem::path() : std::filesystem::path(root) / name;
}

/// The largest distance between the ends of curves in parameter space, as points of the surface, and of their partners.
double largest_end_distance(const LooseFace& face) {
  double largest = 0.0;
  for (const geometry::LooseLoop& loop : face.loops)
    for (const geometry::LoosePiece& piece : loop.pieces) {
      if (!piece.pcurve || !piece.model_curve) continue;
      const Interval flat = piece.pcurve->domain();
      const Interval curve = piece.model_curve->domain();
      const Point3 first = evaluate(face.surface, evaluate(*piece.pcurve, flat.first));
      const Point3 last = evaluate(face.surface, evaluate(*piece.pcurve, flat.last));
      largest = std::max({largest, (first - evaluate(*piece.model_curve, curve.first)).norm(),
                          (last - evaluate(*piece.model_curve, curve.last)).norm()});
    }
  return largest;
}

TEST(IgesReader, CurvesInParameterSpaceMeetThoseInSpaceInAllMadeFiles) {
  const std::filesystem::path folder = collection("iges");
  if (folder.empty()) GTEST_SKIP() << "ISORIM_CAD_FILES is not set";
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".igs") continue;
    ++files;
    const CadModel model = read_iges(entry.path());
    const bool has_all_digits = entry.path().stem().string().ends_with("_p17");
    for (const CadFace& face : model.faces)
      EXPECT_LE(largest_end_distance(face.face), has_all_digits ? 5e-14 : 2e-9) << entry.path() << face.origin.entity;
    EXPECT_EQ(model.warnings, std::vector<std::string>{}) << entry.path();
  }
  EXPECT_EQ(files, 100);
}

}  // namespace
}  // namespace isorim::io
