#include "io/cad/assemble.h"

#include <algorithm>
#include <cstddef>
#include <set>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/shapes/transforms.h"
#include "io/cad/plane_curves.h"
#include "io/cad/units.h"
#include "quadrature/parallel.h"

namespace isorim::io {
namespace {

using geometry::AssembledFace;
using geometry::Boundary;
using geometry::NurbsCurve;
using geometry::Vector3;

/// How far the curves of a drawing may leave their plane, relative to its size: what makes edges meet as well.
constexpr double flatness_tolerance = 1e-6;

// --- What is in the file --------------------------------------------------------------------------------------

std::string counted(std::size_t count, const std::string& one, const std::string& many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

std::string describe_content(const CadModel& model) {
  std::vector<std::string> entities;
  for (const EntityCount& entity : model.entities) {
    entities.push_back(fmt::format("{} x {} ({})", entity.count, entity.type, entity.description));
  }
  return fmt::format("found {}, {}{} and {}{}", counted(model.faces.size(), "face", "faces"),
                     model.t_splines.empty() ? "" : counted(model.t_splines.size(), "T-spline, ", "T-splines, "),
                     counted(model.curves.size(), "curve", "curves"), counted(model.points.size(), "point", "points"),
                     entities.empty() ? "" : fmt::format("; entities: {}", fmt::join(entities, ", ")));
}

int count_solids(const CadModel& model) {
  std::set<int> solids;
  for (const CadFace& face : model.faces) {
    if (face.solid >= 0) solids.insert(face.solid);
  }
  for (const CadTSpline& t_spline : model.t_splines) {
    if (t_spline.solid >= 0) solids.insert(t_spline.solid);
  }
  return static_cast<int>(solids.size());
}

double unit_scale(const CadModel& model, const std::string& unit) {
  if (unit.empty() || unit == model.unit) return 1.0;
  if (model.unit.empty())
    throw InputError(
        fmt::format("{} files know no units; \"units\" cannot convert them into {}: scale them by a "
                    "transform",
                    model.format, unit));
  const std::optional<double> millimetres = unit_in_millimetres(unit);
  if (!millimetres) throw InputError(fmt::format("found the unit \"{}\"; expected one that is known", unit));
  return model.unit_in_millimetres / *millimetres;
}

CadFacts facts_of(const CadModel& model, const AssemblyOptions& options) {
  CadFacts facts;
  facts.format = model.format;
  facts.reader = model.reader;
  facts.author = model.author;
  facts.file_unit = model.unit;
  facts.unit = options.unit.empty() ? model.unit : options.unit;
  facts.scale = unit_scale(model, options.unit);
  facts.faces = static_cast<int>(model.faces.size() + model.t_splines.size());
  facts.solids = count_solids(model);
  facts.curves = static_cast<int>(model.curves.size());
  facts.points = static_cast<int>(model.points.size());
  facts.entities = model.entities;
  facts.approximations = model.approximations;
  for (Approximation& approximation : facts.approximations) {
    approximation.tolerance *= facts.scale;
    approximation.deviation *= facts.scale;
  }
  facts.warnings = model.warnings;
  return facts;
}

// --- Selection and names --------------------------------------------------------------------------------------

bool is_selected(const CadOrigin& origin, const AssemblyOptions& options) {
  const auto is_in = [](const auto& list, const auto& item) {
    return list.empty() || std::find(list.begin(), list.end(), item) != list.end();
  };
  return is_in(options.names, origin.name) && is_in(options.levels, origin.level);
}

/// The indices of the faces or curves that are asked for.
template <class Item>
std::vector<std::size_t> selected(const std::vector<Item>& items, const AssemblyOptions& options) {
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (is_selected(items[i].origin, options)) indices.push_back(i);
  }
  return indices;
}

/// The names and levels that there are, for whoever has asked for others.
template <class Item>
std::string describe_choice(const std::vector<Item>& items) {
  std::set<std::string> names;
  std::set<int> levels;
  for (const Item& item : items) {
    if (!item.origin.name.empty()) names.insert('"' + item.origin.name + '"');
    levels.insert(item.origin.level);
  }
  return fmt::format("the names are {}, the levels {}",
                     names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", ")), fmt::join(levels, ", "));
}

class UniqueNames {
 public:
  std::string make(const std::string& wanted) {
    std::string name = wanted;
    for (int k = 2; !taken_.insert(name).second; ++k) name = fmt::format("{}_{}", wanted, k);
    return name;
  }

 private:
  std::unordered_set<std::string> taken_;
};

std::string wanted_name(const CadOrigin& origin, const char* kind, std::size_t index) {
  return origin.name.empty() ? fmt::format("{}_{}", kind, index + 1) : origin.name;
}

// --- Faces ----------------------------------------------------------------------------------------------------

void scale_lengths(geometry::FaceRepairs& repairs, double factor) {
  for (double* length : {&repairs.largest_deviation, &repairs.largest_disagreement, &repairs.largest_bridge}) {
    *length *= factor;
  }
}

/// A face of the model, or why it is none.
struct FaceOutcome {
  std::string name;
  const CadFace* source = nullptr;
  std::optional<AssembledFace> face;
  std::string refusal;
};

std::vector<FaceOutcome> assemble_faces(const CadModel& model, const std::vector<std::size_t>& which, double scale,
                                        int threads, UniqueNames& names) {
  std::vector<FaceOutcome> outcomes(which.size());
  for (std::size_t i = 0; i < which.size(); ++i) {
    outcomes[i].source = &model.faces[which[i]];
    outcomes[i].name = names.make(wanted_name(outcomes[i].source->origin, "face", which[i]));
  }
  const geometry::AffineMap<3> to_unit = geometry::scaling<3>(Vector3::Constant(scale));
  quadrature::parallel_for(which.size(), threads, [&](std::size_t i, int) {
    try {
      outcomes[i].face = geometry::assemble_face(outcomes[i].source->face);
      if (scale == 1.0) return;
      outcomes[i].face->shape = geometry::transform(outcomes[i].face->shape, to_unit);
      scale_lengths(outcomes[i].face->repairs, scale);
    } catch (const GeometryError& error) {
      outcomes[i].refusal = error.what();
    }
  });
  return outcomes;
}

void refuse(const FaceOutcome& outcome, const std::string& reason, CadFacts& facts) {
  facts.refused.push_back({outcome.name, outcome.source->origin.entity, reason});
}

PatchOrigin origin_of(const FaceOutcome& outcome) {
  return {outcome.source->origin, outcome.source->solid, outcome.face->repairs, outcome.face->edges};
}

bool has_faces(const CadModel& model) {
  return !model.faces.empty() || !model.t_splines.empty();
}

void append_t_spline(const CadModel& model, std::size_t index, UniqueNames& names, Boundary<3>& boundary,
                     CadFacts& facts) {
  const CadTSpline& t_spline = model.t_splines[index];
  const std::string wanted = t_spline.origin.name.empty() && model.t_splines.size() == 1
                                 ? "t_spline"
                                 : wanted_name(t_spline.origin, "t_spline", index);
  const geometry::AffineMap<3> to_unit = geometry::scaling<3>(Vector3::Constant(facts.scale));
  boundary.patches.push_back(
      {names.make(wanted), facts.scale == 1.0 ? t_spline.surface : transform(t_spline.surface, to_unit)});
  facts.patches.push_back({t_spline.origin, t_spline.solid, {}, {}});
}

AssembledModel solid_boundary(const CadModel& model, const AssemblyOptions& options, CadFacts facts) {
  Boundary<3> boundary;
  if (!has_faces(model)) {
    throw InputError(fmt::format("{}; expected faces to make a boundary in space of", describe_content(model)));
  }
  const std::vector<std::size_t> which = selected(model.faces, options);
  const std::vector<std::size_t> t_splines = selected(model.t_splines, options);
  if (which.empty() && t_splines.empty())
    throw InputError(fmt::format("no face is selected; {}", model.faces.empty() ? describe_choice(model.t_splines)
                                                                                : describe_choice(model.faces)));
  UniqueNames names;
  for (FaceOutcome& outcome : assemble_faces(model, which, facts.scale, options.threads, names)) {
    if (!outcome.face) {
      refuse(outcome, outcome.refusal, facts);
      continue;
    }
    facts.patches.push_back(origin_of(outcome));
    boundary.patches.push_back({outcome.name, std::move(outcome.face->shape)});
  }
  for (const std::size_t index : t_splines) append_t_spline(model, index, names, boundary, facts);
  if (is_flat(boundary, flatness_tolerance)) {
    facts.warnings.emplace_back("all faces lie in one plane: with dimension = 2 they are a region of the plane");
  }
  if (!model.curves.empty()) {
    facts.warnings.push_back(
        fmt::format("{} that no face uses: not part of the boundary", counted(model.curves.size(), "curve", "curves")));
  }
  return {std::move(boundary), std::move(facts)};
}

// --- Drawings -------------------------------------------------------------------------------------------------

/// Curves in space that are to become plane patches.
struct Drawing {
  std::vector<std::string> names;
  std::vector<NurbsCurve<3>> curves;
  std::vector<PatchOrigin> origins;

  void add(std::string name, NurbsCurve<3> curve, PatchOrigin origin) {
    names.push_back(std::move(name));
    curves.push_back(std::move(curve));
    origins.push_back(std::move(origin));
  }
};

/// The edges of flat faces; one edge takes the name of its face.
Drawing face_edges(const CadModel& model, const std::vector<std::size_t>& which, const AssemblyOptions& options,
                   CadFacts& facts) {
  Drawing drawing;
  UniqueNames names;
  for (const FaceOutcome& outcome : assemble_faces(model, which, facts.scale, options.threads, names)) {
    try {
      if (!outcome.face) throw GeometryError(outcome.refusal);
      std::vector<NurbsCurve<3>> edges = flat_face_edges(outcome.face->shape);
      PatchOrigin origin = origin_of(outcome);
      for (std::size_t k = 0; k < edges.size(); ++k) {
        drawing.add(edges.size() == 1 ? outcome.name : fmt::format("{}_edge_{}", outcome.name, k + 1),
                    std::move(edges[k]), origin);
        // Told once a face.
        origin.repairs = {};
      }
    } catch (const GeometryError& error) {
      refuse(outcome, error.what(), facts);
    }
  }
  return drawing;
}

Drawing loose_curves(const CadModel& model, const std::vector<std::size_t>& which, double scale) {
  Drawing drawing;
  UniqueNames names;
  const geometry::AffineMap<3> to_unit = geometry::scaling<3>(Vector3::Constant(scale));
  for (const std::size_t i : which) {
    const CadCurve& curve = model.curves[i];
    drawing.add(names.make(wanted_name(curve.origin, "curve", i)),
                scale == 1.0 ? curve.curve : geometry::transform(curve.curve, to_unit), {curve.origin, -1, {}, {}});
  }
  return drawing;
}

Drawing drawing_of(const CadModel& model, const AssemblyOptions& options, CadFacts& facts) {
  if (model.faces.empty()) {
    if (model.curves.empty()) {
      throw InputError(fmt::format("{}; expected curves to make a boundary in the plane of", describe_content(model)));
    }
    const std::vector<std::size_t> which = selected(model.curves, options);
    if (which.empty()) throw InputError(fmt::format("no curve is selected; {}", describe_choice(model.curves)));
    return loose_curves(model, which, facts.scale);
  }
  const std::vector<std::size_t> which = selected(model.faces, options);
  if (which.empty()) throw InputError(fmt::format("no face is selected; {}", describe_choice(model.faces)));
  return face_edges(model, which, options, facts);
}

std::string point_text(const Vector3& point) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", point.x(), point.y(), point.z());
}

void tell_plane(const DrawingPlane& plane, CadFacts& facts) {
  if (plane.x_axis != Vector3::UnitX() || plane.y_axis != Vector3::UnitY()) {
    facts.warnings.push_back(fmt::format("the drawing's x runs along {} and its y along {} of the file, from {}",
                                         point_text(plane.x_axis), point_text(plane.y_axis), point_text(plane.origin)));
  }
  if (plane.deviation > 1e-9 * plane.size) {
    facts.warnings.push_back(
        fmt::format("the curves leave their plane by up to {:.2g}; they are projected onto it", plane.deviation));
  }
}

AssembledModel plane_boundary(const CadModel& model, const AssemblyOptions& options, CadFacts facts) {
  Drawing drawing = drawing_of(model, options, facts);
  Boundary<2> boundary;
  if (drawing.curves.empty()) return {std::move(boundary), std::move(facts)};
  DrawingPlane plane;
  try {
    plane = drawing_plane(drawing.curves, flatness_tolerance);
  } catch (GeometryError& error) {
    throw InputError(fmt::format("{}; {}", describe_content(model), error.what()));
  }
  for (std::size_t i = 0; i < drawing.curves.size(); ++i) {
    boundary.patches.push_back({drawing.names[i], project(drawing.curves[i], plane)});
  }
  tell_plane(plane, facts);
  facts.patches = std::move(drawing.origins);
  return {std::move(boundary), std::move(facts)};
}

}  // namespace

AssembledModel assemble(const CadModel& model, const AssemblyOptions& options) {
  if (!has_faces(model) && model.curves.empty()) {
    throw InputError(fmt::format("{}; expected surfaces or curves", describe_content(model)));
  }
  const int dimension = options.dimension.value_or(has_faces(model) ? 3 : 2);
  CadFacts facts = facts_of(model, options);
  return dimension == 2 ? plane_boundary(model, options, std::move(facts))
                        : solid_boundary(model, options, std::move(facts));
}

}  // namespace isorim::io
