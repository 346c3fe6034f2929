#include "io/iges/t_splines.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/tspline/iga.h"

namespace isorim::io::iges {

using geometry::ExtractedSurface;
using geometry::NurbsSurface;
using geometry::Points;

namespace {

constexpr std::string_view property_name = "T-spline";
constexpr std::string_view format_tag = "isorim T-spline 1";
constexpr int generic_data = 27;
/// Of the values of a 406 form 27.
constexpr int string_type = 3;

std::string digest_text(std::string_view text) {
  return fmt::format("fnv1a64 {:016x}", digest_of(text));
}

/// The lines without their ends.
std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

/// The property of a group that holds a T-spline; nullptr if there is none.
const Entity* t_spline_property_of(const EntityReader& reader, const TrailingPointers& trailing) {
  for (const int pointer : trailing.properties) {
    const Entity* property = reader.file().find(pointer);
    if (property == nullptr || property->type != 406 || property->form != generic_data) continue;
    if (!property->complaint.empty() || property->tokens.size() < 3) continue;
    Parameters p(reader.file(), *property);
    p.skip();
    if (p.text(std::string()) == property_name) return property;
  }
  return nullptr;
}

/// The strings of the property: those behind its name.
std::vector<std::string> strings_of(EntityReader& reader, const Entity& property) {
  std::size_t bytes = 0;
  for (const std::string_view token : property.tokens) bytes += token.size();
  // Many groups may point to the same property.
  reader.charge(property, bytes / 2);
  Parameters p(reader.file(), property);
  p.skip(2);
  const int count = p.count(2);
  std::vector<std::string> strings;
  for (int i = 0; i < count; ++i) {
    if (p.integer() != string_type) p.refuse("a value that is no string (type 3)");
    strings.push_back(p.text());
  }
  return strings;
}

/// Throws InputError if it is damaged, or none.
ExtractedSurface surface_of(EntityReader& reader, const Entity& property) {
  const std::vector<std::string> strings = strings_of(reader, property);
  if (strings.size() < 2 || strings[0] != format_tag)
    throw InputError(fmt::format("found the format \"{}\"; expected \"{}\"",
                                 strings.empty() ? std::string() : strings[0].substr(0, 40), format_tag));
  std::string text;
  for (std::size_t i = 2; i < strings.size(); ++i) text += strings[i] + '\n';
  if (strings[1] != digest_text(text))
    throw InputError(fmt::format("its digest is {}, but {} stands there", digest_text(text), strings[1].substr(0, 40)));
  tspline::ExtractionData data = tspline::parse_iga(text);
  return {std::move(data.points), std::move(data.elements)};
}

bool is_bezier(const geometry::KnotVector& knots) {
  return knots.is_clamped() && knots.basis_count() == knots.degree() + 1;
}

/// The surface has the control points and, but for a common factor, the weights of the other one.
bool is_same(const NurbsSurface<3>& surface, const NurbsSurface<3>& wanted, double tolerance) {
  for (const geometry::Direction direction : {geometry::Direction::u, geometry::Direction::v})
    if (!is_bezier(surface.knots(direction)) || surface.knots(direction).degree() != wanted.knots(direction).degree())
      return false;
  constexpr double weight_tolerance = 1e-8;
  const Eigen::VectorXd weights = surface.weights() / surface.weights()[0];
  const Eigen::VectorXd wanted_weights = wanted.weights() / wanted.weights()[0];
  return (surface.control_points() - wanted.control_points()).colwise().norm().maxCoeff() <= tolerance &&
         ((weights - wanted_weights).array().abs() <= weight_tolerance * wanted_weights.array()).all();
}

double size_of(const ExtractedSurface& surface) {
  const Points<3> points = surface.homogeneous().topRows<3>().array().rowwise() / surface.homogeneous().row(3).array();
  return (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).norm();
}

/// Why the group's surfaces are not the elements; empty if they are.
std::string difference(EntityReader& reader, FaceReader& faces, const std::vector<const Entity*>& members,
                       const ExtractedSurface& surface) {
  if (members.size() != surface.elements().size())
    return fmt::format("{} surfaces instead of {}", members.size(), surface.elements().size());
  const double size = size_of(surface);
  const double tolerance = std::clamp(reader.file().global.resolution, 1e-12 * size, 1e-6 * size);
  for (std::size_t e = 0; e < members.size(); ++e) {
    const CadFace face = faces.face(*members[e]);
    if (!face.face.loops.empty() ||
        !is_same(face.face.surface, bezier_surface(surface, static_cast<int>(e)), tolerance))
      return fmt::format("{} is not element {}", entity_text(*members[e]), e);
  }
  return {};
}

}  // namespace

std::uint64_t digest_of(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char c : text) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001b3U;
  }
  return hash;
}

Record t_spline_property(const ExtractedSurface& surface) {
  const std::string text = tspline::iga_text(surface);
  const std::vector<std::string_view> lines = lines_of(text);
  const auto count = static_cast<long>(lines.size()) + 2;
  Record record = EntityList::parameters(406);
  // The number of values: name, number of pairs, and the pairs.
  record.integer(2 + 2 * count).text(property_name).integer(count);
  record.integer(string_type).text(format_tag).integer(string_type).text(digest_text(text));
  for (const std::string_view line : lines) record.integer(string_type).text(line);
  return record;
}

std::optional<TSplineGroup> t_spline_group(EntityReader& reader, FaceReader& faces, const Entity& group) {
  const bool is_group = group.form == 1 || group.form == 7 || group.form == 14 || group.form == 15;
  if (group.type != 402 || !is_group || !group.complaint.empty()) return std::nullopt;
  try {
    Parameters p(reader.file(), group);
    std::vector<const Entity*> members;
    const int count = p.count();
    for (int i = 0; i < count; ++i) {
      const Entity* member = reader.file().find(p.pointer());
      if (member != nullptr) members.push_back(member);
    }
    Parameters after = p;
    const Entity* property = t_spline_property_of(reader, after.trailing_pointers());
    if (property == nullptr) return std::nullopt;
    ExtractedSurface surface = surface_of(reader, *property);
    const std::string edited = difference(reader, faces, members, surface);
    if (!edited.empty()) {
      reader.remark(
          fmt::format("holds a T-spline whose surfaces have been edited since ({}): they are read as they are", edited),
          group);
      return std::nullopt;
    }
    TSplineGroup result{{std::move(surface),
                         {.entity = entity_text(group),
                          .name = reader.name(p),
                          .colour = reader.colour(*members.front()),
                          .level = reader.level(*members.front())},
                         -1},
                        {}};
    for (const Entity* member : members) result.members.push_back(member->sequence);
    return result;
  } catch (const Error& error) {
    reader.remark(fmt::format("holds a damaged T-spline ({}): its surfaces are read instead", error.what()), group);
    return std::nullopt;
  }
}

}  // namespace isorim::io::iges
