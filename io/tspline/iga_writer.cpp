#include <algorithm>
#include <cstddef>
#include <iterator>

#include <fmt/format.h>

#include "io/atomic_file.h"
#include "io/iges/nurbs_records.h"
#include "io/tspline/iga.h"

namespace isorim::io::tspline {

using geometry::ExtractedSurface;
using geometry::ExtractionElement;

namespace {

bool is_unit(const geometry::Interval& side) {
  return side.first == 0.0 && side.last == 1.0;
}

using Buffer = std::back_insert_iterator<fmt::memory_buffer>;

void write_comment(Buffer out, std::string_view comment) {
  for (std::size_t at = 0; at < comment.size();) {
    const std::size_t end = std::min(comment.find('\n', at), comment.size());
    fmt::format_to(out, "# {}\n", comment.substr(at, end - at));
    at = end + 1;
  }
}

void write_node(Buffer out, const Eigen::Vector4d& point, Eigen::Index number) {
  Eigen::Vector3d products;
  fmt::format_to(out, "node");
  for (int d = 0; d < 3; ++d) {
    const double x = iges::cartesian_coordinate(point[d], point[3]);
    products[d] = point[3] * x;
    fmt::format_to(out, " {}", x);
  }
  fmt::format_to(out, " {}\n", point[3]);
  if (products != point.head<3>())
    fmt::format_to(out, "#isorim point {} {} {} {}\n", number, point[0], point[1], point[2]);
}

void write_element(Buffer out, const ExtractionElement& element, std::size_t number) {
  fmt::format_to(out, "belem {} {} {}\n{}\n", element.functions.size(), element.degree[0], element.degree[1],
                 fmt::join(element.functions, " "));
  for (Eigen::Index k = 0; k < element.rows.rows(); ++k) {
    for (Eigen::Index j = 0; j < element.rows.cols(); ++j)
      fmt::format_to(out, "{}{}", j == 0 ? "" : " ", element.rows(k, j));
    fmt::format_to(out, "\n");
  }
  const auto& [s, t] = element.domain;
  if (!is_unit(s) || !is_unit(t))
    fmt::format_to(out, "#isorim cell {} {} {} {} {}\n", number, s.first, s.last, t.first, t.last);
}

}  // namespace

std::string iga_text(const ExtractedSurface& surface, std::string_view comment) {
  fmt::memory_buffer text;
  const Buffer out(text);
  write_comment(out, comment);
  fmt::format_to(out, "type surface\nnodeN {}\nelemN {}\n", surface.function_count(), surface.elements().size());
  for (Eigen::Index i = 0; i < surface.function_count(); ++i) write_node(out, surface.homogeneous().col(i), i);
  for (std::size_t e = 0; e < surface.elements().size(); ++e) write_element(out, surface.elements()[e], e);
  return fmt::to_string(text);
}

void write_iga(const std::filesystem::path& path, const ExtractedSurface& surface, std::string_view comment) {
  write_file(path, iga_text(surface, comment));
}

}  // namespace isorim::io::tspline
