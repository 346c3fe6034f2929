#include "io/iges/writer.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <limits>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/topology/shape_loops.h"
#include "geometry/trimming/lifted_curve.h"
#include "io/atomic_file.h"
#include "io/iges/free_format.h"
#include "io/iges/model_writer.h"
#include "io/iges/nurbs_records.h"
#include "io/iges/units.h"
#include "io/results/report.h"

namespace isorim::io::iges {

using geometry::Boundary;
using geometry::NurbsCurve;
using geometry::OrientedBoundary;
using geometry::Point;
using geometry::Shell;
using geometry::Topology;

namespace {

template <int Dim>
struct Box {
  Point<Dim> lower = Point<Dim>::Constant(std::numeric_limits<double>::infinity());
  Point<Dim> upper = -lower;

  template <class Net>
  void extend(const Net& points) {
    lower = lower.cwiseMin(points.rowwise().minCoeff());
    upper = upper.cwiseMax(points.rowwise().maxCoeff());
  }
  double diagonal() const { return (upper - lower).norm(); }
  double largest_coordinate() const { return std::max(lower.cwiseAbs().maxCoeff(), upper.cwiseAbs().maxCoeff()); }
};

Box<3> box_of(const Boundary<3>& boundary) {
  Box<3> box;
  for (const auto& patch : boundary.patches) {
    const geometry::ShapeLoops loops(patch.shape);
    for (const auto* surface : loops.surfaces()) box.extend(surface->control_points());
  }
  return box;
}
Box<2> box_of(const Boundary<2>& boundary) {
  Box<2> box;
  for (const auto& patch : boundary.patches) box.extend(patch.shape.control_points());
  return box;
}

std::string date_of(const WriterOptions& options) {
  if (!options.date.empty()) return options.date;
  return fmt::format("{:%Y%m%d.%H%M%S}", fmt::gmtime(std::time(nullptr)));
}

const LengthUnit& unit_of(const WriterOptions& options) {
  const std::string& name = options.unit;
  const LengthUnit* unit = unit_of_name(name.empty() || name == "?" ? "mm" : name);
  if (unit != nullptr) return *unit;
  throw InputError(fmt::format("IGES has no unit \"{}\"; expected one of {}", name, unit_symbols()));
}

/// The 26 values of the global section.
Record globals(const WriterOptions& options, double resolution, double largest_coordinate) {
  const std::string program = fmt::format("isorim {}", program_version());
  const std::string date = date_of(options);
  const LengthUnit& unit = unit_of(options);
  constexpr int iges_5_3 = 11;
  Record record = global_record();
  record.text(options.title).text(options.title).text(program).text(program);
  record.integer(32).integer(38).integer(6).integer(308).integer(15);
  record.text(options.title).real(1.0).integer(unit.flag).text(unit.names.front());
  record.integer(1).real(0.0).text(date).real(resolution).real(largest_coordinate);
  record.omitted().omitted().integer(iges_5_3).integer(0).text(date).omitted();
  return record;
}

IgesText finished(const EntityList& entities, const WriterOptions& options, const WriterReport& report,
                  double resolution, double largest_coordinate) {
  const std::string start = options.title.empty() ? "Written by isorim" : options.title + ", written by isorim";
  return {entities.file_text(to_utf8(start), globals(options, resolution, largest_coordinate)), report};
}

WriterOptions checked(WriterOptions options, std::size_t patches) {
  if (!options.looks.empty() && options.looks.size() != patches) {
    throw GeometryError(fmt::format("looks are given for {} patches, but there are {}", options.looks.size(), patches));
  }
  static_cast<void>(unit_of(options));
  return options;
}

/// Which outer shell each void lies directly in.
class VoidOwners {
 public:
  explicit VoidOwners(const OrientedBoundary<3>& oriented) : oriented_(oriented) {
    for (const auto& shell : oriented.topology.shells) boxes_.push_back(box_of(part({&shell})));
  }

  /// For each shell the voids in it; empty for voids and open shells.
  std::vector<std::vector<int>> voids() const {
    std::vector<std::vector<int>> voids(shells().size());
    for (std::size_t i = 0; i < shells().size(); ++i) {
      if (shells()[i].closed && shells()[i].is_void) voids[owner_of(i)].push_back(static_cast<int>(i));
    }
    return voids;
  }

 private:
  const std::vector<Shell<3>>& shells() const { return oriented_.topology.shells; }

  Boundary<3> part(const std::vector<const Shell<3>*>& shells) const {
    Boundary<3> boundary;
    for (const Shell<3>* shell : shells) {
      for (const int patch : shell->patches) {
        boundary.patches.push_back(oriented_.boundary.patches[static_cast<std::size_t>(patch)]);
      }
    }
    return boundary;
  }

  /// A point of the shell lies in the box of the other's control points, without which it cannot lie in it.
  bool may_lie_within(std::size_t inner, std::size_t outer) const {
    const auto& shape = oriented_.boundary.patches[static_cast<std::size_t>(shells()[inner].patches.front())].shape;
    const geometry::ShapeLoops loops(shape);
    const NurbsCurve<2>& pcurve = loops.curve(0, 0);
    const Point<3> point = lifted_point(loops.surface(0), pcurve, pcurve.domain().first);
    const Box<3>& box = boxes_[outer];
    return (box.lower.array() <= point.array()).all() && (point.array() <= box.upper.array()).all();
  }

  /// The inner one is a void where there are only the two of them.
  bool lies_within(std::size_t inner, std::size_t outer) const {
    if (!may_lie_within(inner, outer)) return false;
    const auto alone = orient(part({&shells()[outer], &shells()[inner]}));
    const int first_inner_patch = static_cast<int>(shells()[outer].patches.size());
    return std::any_of(alone.topology.shells.begin(), alone.topology.shells.end(), [&](const Shell<3>& shell) {
      return shell.is_void && shell.patches.front() >= first_inner_patch;
    });
  }

  std::size_t owner_of(std::size_t inner) const {
    std::vector<std::size_t> holders;
    for (std::size_t i = 0; i < shells().size(); ++i) {
      if (shells()[i].closed && !shells()[i].is_void && lies_within(inner, i)) holders.push_back(i);
    }
    // Of nested ones the one that lies in all the others.
    for (const std::size_t holder : holders) {
      const bool is_innermost = std::all_of(holders.begin(), holders.end(), [&](std::size_t other) {
        return other == holder || lies_within(holder, other);
      });
      if (is_innermost) return holder;
    }
    throw GeometryError(fmt::format("shell {} is a void, but no outer shell holds it", inner + 1));
  }

  const OrientedBoundary<3>& oriented_;
  std::vector<Box<3>> boxes_;
};

bool has_t_spline(const OrientedBoundary<3>& oriented, const Shell<3>& shell) {
  return std::ranges::any_of(shell.patches, [&](int patch) {
    const auto& shape = oriented.boundary.patches[static_cast<std::size_t>(patch)].shape;
    return std::holds_alternative<geometry::ExtractedSurface>(shape);
  });
}

void add_shells(ModelWriter& writer, const OrientedBoundary<3>& oriented, WriterReport& report) {
  const auto& shells = oriented.topology.shells;
  const std::vector<std::vector<int>> voids = VoidOwners(oriented).voids();
  const auto add_loose = [&](const Shell<3>& shell) {
    for (const int patch : shell.patches) report.loose_faces += writer.add_loose_faces(patch);
  };
  for (std::size_t i = 0; i < shells.size(); ++i) {
    if (!shells[i].closed) add_loose(shells[i]);
    if (!shells[i].closed || shells[i].is_void) continue;
    const auto void_at = [&](int shell) -> const Shell<3>& { return shells[static_cast<std::size_t>(shell)]; };
    const bool loose = has_t_spline(oriented, shells[i]) ||
                       std::ranges::any_of(voids[i], [&](int shell) { return has_t_spline(oriented, void_at(shell)); });
    if (loose) {
      add_loose(shells[i]);
      for (const int shell : voids[i]) add_loose(void_at(shell));
    } else {
      report.solid_faces += add_solid(writer, oriented.topology, static_cast<int>(i), voids[i]);
      ++report.solids;
    }
  }
}

}  // namespace

IgesText iges_text(const OrientedBoundary<3>& oriented, const WriterOptions& given) {
  const WriterOptions options = checked(given, oriented.boundary.patches.size());
  const Box<3> box = box_of(oriented.boundary);
  WriterReport report;
  report.curve_tolerance = options.curve_tolerance * box.diagonal();
  ModelWriter writer(oriented.boundary, options, report.curve_tolerance);
  if (options.form == Form::solids) {
    add_shells(writer, oriented, report);
  } else {
    const int patches = static_cast<int>(oriented.boundary.patches.size());
    for (int patch = 0; patch < patches; ++patch) report.loose_faces += writer.add_loose_faces(patch);
  }
  const double resolution = std::max(report.curve_tolerance, oriented.topology.largest_gap);
  return finished(writer.entities(), options, report, resolution, box.largest_coordinate());
}

namespace {

/// The loop's curves in the order in which they continue each other as they are; empty if some run against others.
std::vector<int> continuous_curves(const OrientedBoundary<2>& oriented, const Shell<2>& loop) {
  const auto orientation = [&](int patch) {
    return oriented.boundary.patches[static_cast<std::size_t>(patch)].orientation;
  };
  std::vector<int> curves = loop.patches;
  const int first = orientation(curves.front());
  if (!std::all_of(curves.begin(), curves.end(), [&](int patch) { return orientation(patch) == first; })) return {};
  const auto& start = oriented.boundary.patches[static_cast<std::size_t>(curves[0])].shape;
  const auto& next =
      oriented.boundary.patches[static_cast<std::size_t>(curves[std::min<std::size_t>(1, curves.size() - 1)])].shape;
  const Point<2> end = evaluate(start, start.domain().last);
  const bool forward =
      (evaluate(next, next.domain().first) - end).norm() <= (evaluate(next, next.domain().last) - end).norm();
  if (!forward) std::reverse(curves.begin(), curves.end());
  return curves;
}

void add_loop(EntityList& entities, const OrientedBoundary<2>& oriented, const Shell<2>& loop) {
  const std::vector<int> order = continuous_curves(oriented, loop);
  const bool is_composite = order.size() > 1;
  const int subordinate = is_composite ? 1 : 0;
  std::vector<int> curves;
  for (const int patch : is_composite ? order : loop.patches) {
    const auto& [name, curve, orientation] = oriented.boundary.patches[static_cast<std::size_t>(patch)];
    Record record = curve_record(curve);
    if (!name.empty()) {
      const Record property = EntityList::parameters(406).integer(1).text(name);
      record.integer(0).integer(1).integer(entities.add(406, property, {.form = 15, .subordinate = 1}));
    }
    curves.push_back(entities.add(126, record, {.subordinate = subordinate}));
  }
  if (!is_composite) return;
  Record record = EntityList::parameters(102);
  record.integer(static_cast<long>(curves.size()));
  for (const int curve : curves) record.integer(curve);
  entities.add(102, record);
}

}  // namespace

IgesText iges_text(const OrientedBoundary<2>& oriented, const WriterOptions& given) {
  const WriterOptions options = checked(given, oriented.boundary.patches.size());
  const Box<2> box = box_of(oriented.boundary);
  WriterReport report;
  report.curves = static_cast<int>(oriented.boundary.patches.size());
  EntityList entities;
  for (const Shell<2>& loop : oriented.topology.shells) add_loop(entities, oriented, loop);
  constexpr double rounding = 1e-15;
  const double resolution = std::max(rounding * box.diagonal(), oriented.topology.largest_gap);
  return finished(entities, options, report, resolution, box.largest_coordinate());
}

WriterReport write_iges_curves(const std::filesystem::path& path, std::span<const NurbsCurve<3>> curves,
                               std::span<const std::string> names, const WriterOptions& given) {
  const WriterOptions options = checked(given, 0);
  Box<3> box;
  WriterReport report;
  report.curves = static_cast<int>(curves.size());
  EntityList entities;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const NurbsCurve<3> curve = curves[i].knots().is_clamped() ? curves[i] : geometry::clamp(curves[i]);
    box.extend(curve.control_points());
    Record record = curve_record(curve);
    if (!names.empty()) {
      const Record property = EntityList::parameters(406).integer(1).text(names[i]);
      record.integer(0).integer(1).integer(entities.add(406, property, {.form = 15, .subordinate = 1}));
    }
    entities.add(126, record);
  }
  constexpr double rounding = 1e-15;
  write_file(path, finished(entities, options, report, rounding * box.diagonal(), box.largest_coordinate()).text);
  return report;
}

WriterReport write_iges(const std::filesystem::path& path, const OrientedBoundary<3>& oriented,
                        const WriterOptions& options) {
  const IgesText file = iges_text(oriented, options);
  write_file(path, file.text);
  return file.report;
}

WriterReport write_iges(const std::filesystem::path& path, const OrientedBoundary<2>& oriented,
                        const WriterOptions& options) {
  const IgesText file = iges_text(oriented, options);
  write_file(path, file.text);
  return file.report;
}

}  // namespace isorim::io::iges
