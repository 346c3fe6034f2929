#include "io/results/fit_text.h"

#include <string>
#include <vector>

#include <fmt/format.h>

#include "io/results/table.h"

namespace isorim::io {
namespace {

/// "20000 points, reduced to 812, of which 797 were fitted to; dropped: 15 outlier".
std::string points_line(const FitFacts& facts, const FitSummary& all) {
  std::string line = fmt::format("{} points", facts.points_read);
  if (facts.points_reduced != facts.points_read) line += fmt::format(", reduced to {}", facts.points_reduced);
  if (all.points != facts.points_reduced) line += fmt::format(", fitted to {}", all.points);
  if (facts.thinned) line += ", led along the middle line of their noise";
  std::vector<std::string> dropped;
  for (const auto& [reason, count] : facts.dropped) dropped.push_back(fmt::format("{} {}", count, reason));
  if (!dropped.empty()) line += fmt::format("; dropped: {}", fmt::join(dropped, ", "));
  return line;
}

std::string body_line(const FittedBody& body) {
  std::string line = fmt::format("{} sections, {} x {} control points", body.sections, body.control_points_along,
                                 body.control_points_across);
  if (body.knots_inserted > 0 || body.knots_removed > 0) {
    line += fmt::format("; {} knots inserted and {} removed, which moved points by at most {:.2e}", body.knots_inserted,
                        body.knots_removed, body.uniformisation_error);
  }
  return line;
}

}  // namespace

std::string fit_text(const FitFacts& facts) {
  const FitSummary all = summarise(facts);
  std::string text = fmt::format("  {}\n", points_line(facts, all));
  if (facts.is_body()) text += fmt::format("  {}\n", body_line(facts.body));
  TextTable table({{"curve"},
                   {"points", Align::right},
                   {"control points", Align::right},
                   {"max distance", Align::right},
                   {"rms distance", Align::right},
                   {"worst point", Align::right},
                   {"at"}});
  for (const FittedCurve& curve : facts.curves) {
    const geometry::FitQuality<2>& quality = curve.fit.quality;
    const geometry::Point3 place = curve.plane.place(curve.points.col(quality.worst_point));
    table.add_row({curve.name, fmt::format("{}", curve.points.cols()), fmt::format("{}", curve.fit.control_points),
                   fmt::format("{:.4g}", quality.max_distance), fmt::format("{:.4g}", quality.rms_distance),
                   fmt::format("{}", quality.worst_point + 1),
                   fmt::format("({:.6g}, {:.6g}, {:.6g})", place.x(), place.y(), place.z())});
  }
  return text + "\n" + table.text(2);
}

}  // namespace isorim::io
