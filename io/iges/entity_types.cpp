#include "io/iges/entity_types.h"

#include <algorithm>
#include <array>

#include "geometry/errors.h"
#include "io/iges/parameters.h"

namespace isorim::io::iges {
namespace {

struct TypeEntry {
  int type;
  Role role;
  std::string_view description;
};

/// By rising number.
constexpr std::array types{
    TypeEntry{0, Role::note, "null"},
    TypeEntry{100, Role::curve, "circular arc"},
    TypeEntry{102, Role::curve, "composite curve"},
    TypeEntry{104, Role::curve, "conic arc"},
    TypeEntry{106, Role::curve, "copious data"},
    TypeEntry{108, Role::surface, "plane"},
    TypeEntry{110, Role::curve, "line"},
    TypeEntry{112, Role::curve, "parametric spline curve"},
    TypeEntry{114, Role::surface, "parametric spline surface"},
    TypeEntry{116, Role::point, "point"},
    TypeEntry{118, Role::surface, "ruled surface"},
    TypeEntry{120, Role::surface, "surface of revolution"},
    TypeEntry{122, Role::surface, "tabulated cylinder"},
    TypeEntry{123, Role::part, "direction"},
    TypeEntry{124, Role::part, "transformation matrix"},
    TypeEntry{125, Role::unknown, "flash"},
    TypeEntry{126, Role::curve, "rational B-spline curve"},
    TypeEntry{128, Role::surface, "rational B-spline surface"},
    TypeEntry{130, Role::curve, "offset curve"},
    TypeEntry{132, Role::note, "connect point"},
    TypeEntry{134, Role::unknown, "node"},
    TypeEntry{136, Role::unknown, "finite element"},
    TypeEntry{138, Role::unknown, "nodal displacement and rotation"},
    TypeEntry{140, Role::surface, "offset surface"},
    TypeEntry{141, Role::part, "boundary"},
    TypeEntry{142, Role::part, "curve on a parametric surface"},
    TypeEntry{143, Role::face, "bounded surface"},
    TypeEntry{144, Role::face, "trimmed parametric surface"},
    TypeEntry{146, Role::unknown, "nodal results"},
    TypeEntry{148, Role::unknown, "element results"},
    TypeEntry{150, Role::unknown, "block"},
    TypeEntry{152, Role::unknown, "right angular wedge"},
    TypeEntry{154, Role::unknown, "right circular cylinder"},
    TypeEntry{156, Role::unknown, "right circular cone frustum"},
    TypeEntry{158, Role::unknown, "sphere"},
    TypeEntry{160, Role::unknown, "torus"},
    TypeEntry{162, Role::unknown, "solid of revolution"},
    TypeEntry{164, Role::unknown, "solid of linear extrusion"},
    TypeEntry{168, Role::unknown, "ellipsoid"},
    TypeEntry{180, Role::unknown, "Boolean tree"},
    TypeEntry{182, Role::unknown, "selected component"},
    TypeEntry{184, Role::unknown, "solid assembly"},
    TypeEntry{186, Role::solid, "manifold solid B-rep object"},
    TypeEntry{190, Role::surface, "plane surface"},
    TypeEntry{192, Role::surface, "right circular cylindrical surface"},
    TypeEntry{194, Role::surface, "right circular conical surface"},
    TypeEntry{196, Role::surface, "spherical surface"},
    TypeEntry{198, Role::surface, "toroidal surface"},
    TypeEntry{202, Role::note, "angular dimension"},
    TypeEntry{204, Role::note, "curve dimension"},
    TypeEntry{206, Role::note, "diameter dimension"},
    TypeEntry{208, Role::note, "flag note"},
    TypeEntry{210, Role::note, "general label"},
    TypeEntry{212, Role::note, "general note"},
    TypeEntry{213, Role::note, "new general note"},
    TypeEntry{214, Role::note, "leader"},
    TypeEntry{216, Role::note, "linear dimension"},
    TypeEntry{218, Role::note, "ordinate dimension"},
    TypeEntry{220, Role::note, "point dimension"},
    TypeEntry{222, Role::note, "radius dimension"},
    TypeEntry{228, Role::note, "general symbol"},
    TypeEntry{230, Role::note, "sectioned area"},
    TypeEntry{302, Role::note, "associativity definition"},
    TypeEntry{304, Role::note, "line font definition"},
    TypeEntry{306, Role::note, "macro definition"},
    TypeEntry{308, Role::part, "subfigure definition"},
    TypeEntry{310, Role::note, "text font definition"},
    TypeEntry{312, Role::note, "text display template"},
    TypeEntry{314, Role::part, "colour definition"},
    TypeEntry{316, Role::note, "units data"},
    TypeEntry{320, Role::unknown, "network subfigure definition"},
    TypeEntry{322, Role::note, "attribute table definition"},
    TypeEntry{402, Role::part, "associativity instance"},
    TypeEntry{404, Role::note, "drawing"},
    TypeEntry{406, Role::part, "property"},
    TypeEntry{408, Role::instance, "singular subfigure instance"},
    TypeEntry{410, Role::note, "view"},
    TypeEntry{412, Role::unknown, "rectangular array subfigure instance"},
    TypeEntry{414, Role::unknown, "circular array subfigure instance"},
    TypeEntry{416, Role::unknown, "external reference"},
    TypeEntry{418, Role::unknown, "nodal load or constraint"},
    TypeEntry{420, Role::unknown, "network subfigure instance"},
    TypeEntry{422, Role::note, "attribute table instance"},
    TypeEntry{430, Role::solid, "solid instance"},
    TypeEntry{502, Role::part, "vertex list"},
    TypeEntry{504, Role::part, "edge list"},
    TypeEntry{508, Role::part, "loop"},
    TypeEntry{510, Role::face, "face"},
    TypeEntry{514, Role::shell, "shell"},
};

const TypeEntry* find_type(int type) {
  const auto found = std::ranges::lower_bound(types, type, {}, &TypeEntry::type);
  return found != types.end() && found->type == type ? &*found : nullptr;
}

using Parts = std::vector<int>;

void add(Parts& parts, Parameters& p) {
  parts.push_back(p.pointer());
}

void add_list(Parts& parts, Parameters& p) {
  for (const int pointer : p.pointers(p.count())) parts.push_back(pointer);
}

void add_boundary(Parts& parts, Parameters& p) {
  p.skip(3);
  const int count = p.count(3);
  for (int i = 0; i < count; ++i) {
    add(parts, p);
    p.skip();
    add_list(parts, p);
  }
}

void add_shells(Parts& parts, Parameters& p) {
  add(parts, p);
  p.skip();
  const int count = p.count(2);
  for (int i = 0; i < count; ++i) {
    add(parts, p);
    p.skip();
  }
}

void add_edges(Parts& parts, Parameters& p) {
  const int count = p.count(5);
  for (int i = 0; i < count; ++i) {
    add(parts, p);
    add(parts, p);
    p.skip();
    add(parts, p);
    p.skip();
  }
}

void add_loop(Parts& parts, Parameters& p) {
  const int count = p.count(5);
  for (int i = 0; i < count; ++i) {
    p.skip();
    add(parts, p);
    p.skip(2);
    const int pcurves = p.count(2);
    for (int k = 0; k < pcurves; ++k) {
      p.skip();
      add(parts, p);
    }
  }
}

void add_parts(Parts& parts, Parameters& p, int type) {
  switch (type) {
    case 102:
      return add_list(parts, p);
    case 108:
      p.skip(4);
      return add(parts, p);
    case 118:
    case 120:
    case 190:
      add(parts, p);
      add(parts, p);
      if (type == 190 && p.remaining() > 0) add(parts, p);
      return;
    case 122:
    case 408:
    case 430:
      return add(parts, p);
    case 130:
      add(parts, p);
      p.skip();
      return add(parts, p);
    case 140:
      p.skip(4);
      return add(parts, p);
    case 141:
      return add_boundary(parts, p);
    case 142:
      p.skip();
      for (int i = 0; i < 3; ++i) add(parts, p);
      return;
    case 143:
      p.skip();
      add(parts, p);
      return add_list(parts, p);
    case 144: {
      add(parts, p);
      p.skip();
      const int holes = p.count();
      add(parts, p);
      for (int i = 0; i < holes; ++i) add(parts, p);
      return;
    }
    case 186:
      return add_shells(parts, p);
    case 192:
    case 194:
    case 198:
      add(parts, p);
      add(parts, p);
      p.skip(type == 192 ? 1 : 2);
      if (p.remaining() > 0) add(parts, p);
      return;
    case 196:
      add(parts, p);
      p.skip();
      for (int i = 0; i < 2 && p.remaining() > 0; ++i) add(parts, p);
      return;
    case 308:
      p.skip(2);
      return add_list(parts, p);
    case 402: {
      // One parent and its children.
      p.skip();
      const int count = p.count();
      p.skip();
      for (int i = 0; i < count; ++i) add(parts, p);
      return;
    }
    case 504:
      return add_edges(parts, p);
    case 508:
      return add_loop(parts, p);
    case 510: {
      add(parts, p);
      const int count = p.count();
      p.skip();
      for (int i = 0; i < count; ++i) add(parts, p);
      return;
    }
    case 514: {
      const int count = p.count(2);
      for (int i = 0; i < count; ++i) {
        add(parts, p);
        p.skip();
      }
      return;
    }
    default:
      return;
  }
}

}  // namespace

Role role_of(const Entity& entity) {
  const TypeEntry* entry = find_type(entity.type);
  if (entry == nullptr) return Role::unknown;
  if (entity.type == 106) {
    if (entity.form >= 1 && entity.form <= 3) return Role::point;
    const bool is_path = (entity.form >= 11 && entity.form <= 13) || entity.form == 63;
    return is_path ? Role::curve : Role::note;
  }
  return entry->role;
}

std::string_view description_of(int type) {
  const TypeEntry* entry = find_type(type);
  return entry == nullptr ? std::string_view() : entry->description;
}

std::vector<int> parts_of(const File& file, const Entity& entity) {
  Parts parts;
  if (!entity.complaint.empty() || (entity.type == 402 && entity.form != 9)) return parts;
  try {
    Parameters p(file, entity);
    add_parts(parts, p, entity.type);
  } catch (const InputError&) {
    // Whoever converts the entity tells what is wrong with it.
    return parts;
  }
  return parts;
}

}  // namespace isorim::io::iges
