#include "io/iges/reader.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "geometry/shapes/transforms.h"
#include "io/iges/entity_reader.h"
#include "io/iges/entity_types.h"
#include "io/iges/faces.h"
#include "io/iges/t_splines.h"

namespace isorim::io {
namespace {

using geometry::AffineMap;
using geometry::Point3;
using geometry::Points;
using iges::Entity;
using iges::Role;

/// So many bad entities are told of before the rest is only counted.
constexpr std::size_t most_complaints = 20;

class Reading {
 public:
  Reading(const iges::File& file, const IgesOptions& options)
      : file_(file), options_(options), reader_(file, options), faces_(reader_) {}

  CadModel run() {
    describe();
    find_parts();
    AffineMap<3> real_size;
    if (file_.global.scale != 1.0) {
      real_size.linear /= file_.global.scale;
      model_.warnings.push_back(
          fmt::format("the file is drawn at a scale of {}; its coordinates are divided by it", file_.global.scale));
    }
    for (const Entity& entity : file_.entities)
      if (entity.type == 402) add_t_spline(entity, real_size);
    for (const Entity& entity : file_.entities)
      if (stands_for_itself(entity)) attempt(entity, real_size);
    refuse_if_bad();
    finish();
    return std::move(model_);
  }

 private:
  void describe();
  void find_parts();
  void find_holes(const Entity& entity);
  void add_t_spline(const Entity& group, const AffineMap<3>& map);
  bool stands_for_itself(const Entity& entity);
  void attempt(const Entity& entity, const AffineMap<3>& map);
  void add(const Entity& entity, const AffineMap<3>& map);
  void add_faces(std::vector<CadFace> faces, const AffineMap<3>& map, int solid);
  void add_solid(const Entity& entity, const AffineMap<3>& map);
  void add_surface(const Entity& entity, const AffineMap<3>& map);
  void add_curve(const Entity& entity, const AffineMap<3>& map);
  void add_points(const Entity& entity, const AffineMap<3>& map);
  void add_instance(const Entity& entity, const AffineMap<3>& map);
  void refuse_if_bad() const;
  void finish();

  const iges::File& file_;
  const IgesOptions& options_;
  iges::EntityReader reader_;
  iges::FaceReader faces_;
  CadModel model_;
  /// D numbers of what others are made of.
  std::set<int> parts_;
  /// Of bounded planes, by the D number of the plane.
  std::map<int, std::vector<const Entity*>> holes_;
  int solids_ = 0;
  std::vector<std::string> bad_;
};

std::string version_of(int flag) {
  static const std::map<int, std::string> names{
      {1, "1.0"}, {2, "ANSI Y14.26M-1981"}, {3, "2.0"}, {4, "3.0"}, {5, "ASME/ANSI Y14.26M-1987"},
      {6, "4.0"}, {7, "ASME Y14.26M-1989"}, {8, "5.0"}, {9, "5.1"}, {10, "5.2"},
      {11, "5.3"}};
  const auto found = names.find(flag);
  return found == names.end() ? "IGES" : "IGES " + found->second;
}

void Reading::describe() {
  model_.format = version_of(file_.global.version_flag);
  model_.reader = "isorim";
  model_.unit = file_.global.unit;
  model_.unit_in_millimetres = file_.global.unit_in_millimetres;
  model_.author = !file_.global.native_system.empty() ? file_.global.native_system : file_.global.preprocessor_version;
  model_.warnings = file_.warnings;
}

void Reading::find_parts() {
  std::map<int, EntityCount> counts;
  for (const Entity& entity : file_.entities) {
    EntityCount& count = counts[entity.type];
    ++count.count;
    if (iges::role_of(entity) == Role::unknown) ++count.unsupported;
    for (const int part : iges::parts_of(file_, entity)) parts_.insert(part);
    if (entity.type == 402 && entity.form == 9) find_holes(entity);
  }
  for (auto& [type, count] : counts) {
    count.type = std::to_string(type);
    count.description = iges::description_of(type);
    if (count.description.empty()) count.description = "not in the standard";
    if (count.unsupported > 0)
      model_.warnings.push_back(
          fmt::format("{} entities of type {} ({}) are not read", count.unsupported, type, count.description));
    model_.entities.push_back(std::move(count));
  }
}

void Reading::find_holes(const Entity& entity) {
  if (!entity.complaint.empty()) return;
  try {
    iges::Parameters p(file_, entity);
    p.skip();
    const int count = p.count();
    const Entity& parent = p.target();
    for (int i = 0; i < count; ++i) {
      const Entity& child = p.target();
      if (parent.type == 108 && child.type == 108 && child.form != 0) holes_[parent.sequence].push_back(&child);
    }
  } catch (const InputError& error) {
    bad_.emplace_back(error.what());
  }
}

/// If the group stands for one; its surfaces are parts of it then.
void Reading::add_t_spline(const Entity& group, const AffineMap<3>& map) {
  if (group.blank != 0 && !options_.include_blanked) return;
  std::optional<iges::TSplineGroup> found = iges::t_spline_group(reader_, faces_, group);
  if (!found) return;
  if (map.linear != AffineMap<3>().linear) found->t_spline.surface = transform(found->t_spline.surface, map);
  parts_.insert(found->members.begin(), found->members.end());
  model_.t_splines.push_back(std::move(found->t_spline));
}

bool Reading::stands_for_itself(const Entity& entity) {
  const Role role = iges::role_of(entity);
  if (role == Role::note || role == Role::unknown || parts_.contains(entity.sequence)) return false;
  if (role == Role::part) {
    if (entity.type == 141 || entity.type == 142 || entity.type == 508)
      reader_.remark("bounds no face; it is left out", entity);
    if (entity.type == 308) reader_.remark("is a subfigure that is nowhere placed; it is left out", entity);
    return false;
  }
  if (entity.blank != 0 && !options_.include_blanked) {
    reader_.remark("is blanked (invisible) and left out", entity);
    return false;
  }
  if (entity.subordinate == 1 || entity.subordinate == 3) {
    reader_.remark("depends on another entity, but none refers to it; it is left out", entity);
    return false;
  }
  const bool is_geometry = entity.use == 0 || entity.use == 3;
  if (!is_geometry && (role == Role::surface || role == Role::curve || role == Role::point)) {
    reader_.remark(
        "is no geometry of the part by its use flag (annotation, definition, logical, in parameter space or "
        "construction) and left out",
        entity);
    return false;
  }
  return true;
}

void Reading::attempt(const Entity& entity, const AffineMap<3>& map) {
  try {
    add(entity, map);
  } catch (const InputError& error) {
    bad_.emplace_back(error.what());
  }
}

void Reading::add(const Entity& entity, const AffineMap<3>& map) {
  switch (iges::role_of(entity)) {
    case Role::solid:
      return add_solid(entity, map);
    case Role::shell:
      return add_faces(faces_.shell(entity), map, -1);
    case Role::face: {
      std::vector<CadFace> one;
      one.push_back(faces_.face(entity));
      return add_faces(std::move(one), map, -1);
    }
    case Role::surface:
      return add_surface(entity, map);
    case Role::curve:
      return add_curve(entity, map);
    case Role::point:
      return add_points(entity, map);
    case Role::instance:
      return add_instance(entity, map);
    default:
      return;
  }
}

void Reading::add_faces(std::vector<CadFace> faces, const AffineMap<3>& map, int solid) {
  for (CadFace& face : faces) {
    face.face = iges::transform(face.face, map);
    face.solid = solid;
    model_.faces.push_back(std::move(face));
  }
}

void Reading::add_solid(const Entity& entity, const AffineMap<3>& map) {
  if (entity.type == 186) {
    // Copies of a solid have edges of their own.
    faces_.forget_edges();
    add_faces(faces_.solid(entity), map, solids_);
    ++solids_;
    return;
  }
  const iges::EntityReader::Visit visit(reader_, entity);
  iges::Parameters p(file_, entity);
  const Entity& original = p.target();
  if (iges::role_of(original) != Role::solid) {
    reader_.remark(fmt::format("is a copy of {}, which this program does not read", entity_text(original)), entity);
    return;
  }
  add_solid(original, geometry::compose(map, reader_.placement(entity)));
}

void Reading::add_surface(const Entity& entity, const AffineMap<3>& map) {
  const bool endless =
      (entity.type == 108 && entity.form == 0) || entity.type == 190 || entity.type == 192 || entity.type == 194;
  if (endless) {
    reader_.remark("is a surface without ends that no face uses; it is left out", entity);
    return;
  }
  if (entity.type == 108 && entity.form == -1) {
    reader_.remark("is a hole of no plane; it is left out", entity);
    return;
  }
  const auto holes = holes_.find(entity.sequence);
  std::vector<CadFace> one;
  one.push_back(holes == holes_.end() ? faces_.face(entity) : faces_.plane_with_holes(entity, holes->second));
  add_faces(std::move(one), map, -1);
}

void Reading::add_curve(const Entity& entity, const AffineMap<3>& map) {
  if (entity.type == 110 && entity.form != 0) {
    reader_.remark("is a line without ends; it is left out", entity);
    return;
  }
  CadOrigin origin{.entity = entity_text(entity),
                   .name = reader_.spline_name(entity),
                   .colour = reader_.colour(entity),
                   .level = reader_.level(entity)};
  for (iges::ParametrisedCurve& piece : reader_.curve_pieces(entity))
    model_.curves.push_back({geometry::transform(piece.curve, map), origin});
}

void Reading::add_points(const Entity& entity, const AffineMap<3>& map) {
  if (entity.type == 116) {
    model_.points.push_back(map(reader_.point(entity)));
    return;
  }
  const AffineMap<3> own = geometry::compose(map, reader_.placement(entity));
  const Points<3> points = reader_.copious_points(entity);
  for (Eigen::Index i = 0; i < points.cols(); ++i) model_.points.push_back(own(Point3(points.col(i))));
}

void Reading::add_instance(const Entity& entity, const AffineMap<3>& map) {
  const iges::EntityReader::Visit visit(reader_, entity);
  reader_.charge(entity, entity.tokens.size());
  iges::Parameters p(file_, entity);
  const Entity& definition = p.target();
  if (definition.type != 308) reader_.refuse(entity, "a subfigure definition (308) is expected here");
  AffineMap<3> shift;
  for (double& coordinate : shift.translation) coordinate = p.real(0.0);
  AffineMap<3> scale;
  const double factor = p.real(1.0);
  if (!(factor != 0.0)) p.refuse("the scale is 0");
  scale.linear *= factor;
  // Scaled in the figure's own space, turned by the instance's matrix, then moved in the space around it.
  const AffineMap<3> placed = geometry::compose(shift, geometry::compose(reader_.placement(entity), scale));
  const AffineMap<3> whole = geometry::compose(map, geometry::compose(placed, reader_.placement(definition)));
  iges::Parameters members(file_, definition);
  members.skip(2);
  const int count = members.count();
  reader_.charge(definition, definition.tokens.size());
  for (int i = 0; i < count; ++i) {
    const Entity& member = members.target();
    if (member.blank != 0 && !options_.include_blanked) {
      reader_.remark("is blanked (invisible) and left out", member);
      continue;
    }
    add(member, whole);
  }
}

void Reading::refuse_if_bad() const {
  if (bad_.empty() || options_.skip_bad_entities) return;
  if (bad_.size() == 1) throw InputError(bad_.front());
  std::string message = fmt::format("{}: {} entities cannot be read", file_.name, bad_.size());
  for (std::size_t i = 0; i < std::min(bad_.size(), most_complaints); ++i) message += "\n  " + bad_[i];
  if (bad_.size() > most_complaints) message += fmt::format("\n  and {} more", bad_.size() - most_complaints);
  throw InputError(message);
}

void Reading::finish() {
  for (const std::string& complaint : bad_) model_.warnings.push_back("left out: " + complaint);
  for (std::string& warning : reader_.warnings()) model_.warnings.push_back(std::move(warning));
  model_.approximations = reader_.approximations();
  if (model_.faces.empty() && model_.t_splines.empty() && model_.curves.empty())
    model_.warnings.push_back(model_.points.empty() ? "the file holds no face, no curve and no point"
                                                    : "the file holds points, but no face and no curve");
}

}  // namespace

CadModel read_iges(const iges::File& file, const IgesOptions& options) {
  return Reading(file, options).run();
}

CadModel read_iges(const std::filesystem::path& path, const IgesOptions& options) {
  return read_iges(iges::read_file(path), options);
}

}  // namespace isorim::io
