#include "io/fit/fit_pictures.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <vector>

#include <fmt/format.h>

#include "io/atomic_file.h"
#include "io/svg/drawing.h"

namespace isorim::io {
namespace {

using geometry::CurveJet;
using geometry::Point2;
using geometry::Points;
using geometry::Vector2;

constexpr std::size_t most_detailed_curves = 3;

/// The signed curvature along a curve.
struct CurvatureSamples {
  Points<2> places;
  Points<2> normals;
  std::vector<double> curvatures;
};

CurvatureSamples curvature_samples(const geometry::NurbsCurve<2>& curve) {
  const std::vector<double> ends = curve.knots().breakpoints();
  const int spans = static_cast<int>(ends.size()) - 1;
  const int per_span = std::clamp(400 / spans, 4, 24);
  CurvatureSamples samples;
  samples.places.resize(2, spans * per_span);
  samples.normals.resize(2, spans * per_span);
  for (int i = 0; i < spans * per_span; ++i) {
    const auto span = static_cast<std::size_t>(i / per_span);
    const double u = std::lerp(ends[span], ends[span + 1], (i % per_span + 0.5) / per_span);
    const CurveJet<2> jet = evaluate_jet(curve, u);
    const double speed = jet.du.norm();
    samples.places.col(i) = jet.point;
    samples.normals.col(i) = speed > 0.0 ? Vector2(jet.du.y() / speed, -jet.du.x() / speed) : Vector2::Zero();
    const double cross = jet.du.x() * jet.duu.y() - jet.du.y() * jet.duu.x();
    samples.curvatures.push_back(speed > 0.0 ? cross / (speed * speed * speed) : 0.0);
  }
  return samples;
}

double quantile(std::vector<double> values, double part) {
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, place);
  return *place;
}

svg::Comb comb_of(const FittedCurve& curve, double usual_length) {
  const CurvatureSamples samples = curvature_samples(curve.fit.curve);
  std::vector<double> sizes;
  std::ranges::transform(samples.curvatures, std::back_inserter(sizes), [](double k) { return std::abs(k); });
  const double usual = quantile(sizes, 0.95);
  svg::Comb comb{samples.places, samples.places};
  if (!(usual > 0.0)) return comb;
  for (Eigen::Index i = 0; i < comb.feet.cols(); ++i) {
    const double part = std::clamp(samples.curvatures[static_cast<std::size_t>(i)] / usual, -2.0, 2.0);
    // The natural normal points away from the left, so outward of what is convex and runs counter-clockwise.
    comb.tips.col(i) += part * usual_length * samples.normals.col(i);
  }
  if (!curve.closed) return comb;
  // The envelope closes too.
  const Eigen::Index count = comb.feet.cols();
  comb.feet.conservativeResize(Eigen::NoChange, count + 1);
  comb.tips.conservativeResize(Eigen::NoChange, count + 1);
  comb.feet.col(count) = comb.feet.col(0);
  comb.tips.col(count) = comb.tips.col(0);
  return comb;
}

double picture_size(const FitFacts& facts) {
  Point2 lower = facts.curves.front().points.rowwise().minCoeff();
  Point2 upper = facts.curves.front().points.rowwise().maxCoeff();
  for (const FittedCurve& curve : facts.curves) {
    lower = lower.cwiseMin(curve.points.rowwise().minCoeff());
    upper = upper.cwiseMax(curve.points.rowwise().maxCoeff());
  }
  return (upper - lower).norm();
}

}  // namespace

void write_fit_svg(const std::filesystem::path& path, const std::string& title, const FitFacts& facts) {
  if (facts.curves.empty()) return;
  svg::Drawing drawing;
  drawing.title = title;
  drawing.fill = false;
  drawing.show_control_net = facts.curves.size() <= most_detailed_curves;
  const double usual_length = picture_size(facts) / 8.0;
  for (const FittedCurve& curve : facts.curves) {
    drawing.chains.push_back({curve.fit.curve});
    drawing.marks.push_back(curve.points);
    if (drawing.show_control_net) drawing.combs.push_back(comb_of(curve, usual_length));
  }
  svg::write_svg(path, drawing);
}

void write_fit_points(const std::filesystem::path& path, const FitFacts& facts) {
  std::string text = "curve,x,y,z,distance,parameter\n";
  for (std::size_t k = 0; k < facts.curves.size(); ++k) {
    const FittedCurve& curve = facts.curves[k];
    for (Eigen::Index i = 0; i < curve.points.cols(); ++i) {
      const geometry::Point3 place = curve.plane.place(curve.points.col(i));
      const auto at = static_cast<std::size_t>(i);
      fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{}\n", k + 1, place.x(), place.y(), place.z(),
                     curve.fit.distances[at], curve.fit.parameters[at]);
    }
  }
  write_file(path, text);
}

}  // namespace isorim::io
