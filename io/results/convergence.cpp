#include "io/results/convergence.h"

#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "io/atomic_file.h"
#include "io/svg/plot.h"

namespace isorim::io {

void write_convergence_csv(const std::filesystem::path& path, const Convergence& study) {
  std::string text = "points";
  for (const Convergence::Curve& curve : study.curves) text += "," + curve.quantity;
  text += '\n';
  for (std::size_t i = 0; i < study.points.size(); ++i) {
    text += fmt::format("{}", study.points[i]);
    for (const Convergence::Curve& curve : study.curves) text += fmt::format(",{:.17g}", curve.errors[i]);
    text += '\n';
  }
  write_file(path, text);
}

void write_convergence_svg(const std::filesystem::path& path, const std::string& title, const Convergence& study) {
  svg::Plot plot;
  plot.title = title;
  plot.x.label = "Gauss points per knot span";
  plot.y.label = "relative error";
  plot.y.scale = svg::Scale::logarithmic;
  for (const Convergence::Curve& curve : study.curves) {
    svg::Series series;
    series.name = curve.quantity;
    series.x.assign(study.points.begin(), study.points.end());
    series.y = curve.errors;
    plot.series.push_back(std::move(series));
  }
  svg::write_svg(path, plot);
}

}  // namespace isorim::io
