#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/vocabulary.h"
#include "io/cad/cad_model.h"
#include "io/iges/analytic_surfaces.h"
#include "io/iges/curves.h"
#include "io/iges/file.h"
#include "io/iges/parameters.h"
#include "io/iges/reader.h"
#include "io/iges/surfaces.h"

namespace isorim::io::iges {

/// A surface with ends, or one whose ends only the loops on it tell.
using AnySurface = std::variant<ParametrisedSurface, AnalyticSurface>;

/// Curves, surfaces, placements and attributes from the entities of one file.
///
/// Pointers may run in circles and the same entity may be used again and again: every conversion is guarded against
/// meeting itself, and all together against making more than IgesOptions::largest_size numbers. Every function throws
/// InputError that names file and entity.
class EntityReader {
 public:
  /// The file must outlive the reader.
  EntityReader(const File& file, const IgesOptions& options);

  const File& file() const { return file_; }
  const IgesOptions& options() const { return options_; }

  /// A curve entity, placed by its own transformation.
  ParametrisedCurve curve(const Entity& entity);
  /// The curves that a composite curve (102) consists of, however deep; otherwise the curve itself. Without points.
  std::vector<ParametrisedCurve> curve_pieces(const Entity& entity);
  AnySurface surface(const Entity& entity);
  /// The entity's transformation (124) and those that it refers to in turn.
  geometry::AffineMap<3> placement(const Entity& entity);
  /// 116.
  geometry::Point3 point(const Entity& entity);
  /// 123: as written.
  geometry::Vector3 direction(const Entity& entity);
  /// The points of copious data (106).
  geometry::Points<3> copious_points(const Entity& entity);

  std::optional<Colour> colour(const Entity& entity);
  int level(const Entity& entity);
  /// Of a 406 form 15 among the properties.
  std::string name(Parameters& parameters);
  /// Of a B-spline curve or surface (126, 128); empty for others.
  std::string spline_name(const Entity& entity);

  /// An entity is being converted; throws if it already is, or if the nesting is too deep.
  class Visit {
   public:
    Visit(EntityReader& reader, const Entity& entity);
    ~Visit();
    Visit(const Visit&) = delete;
    Visit& operator=(const Visit&) = delete;

   private:
    EntityReader& reader_;
    int sequence_;
  };

  /// Counts numbers that are about to be made, and what an entity takes besides.
  void charge(const Entity& entity, std::size_t numbers);

  /// A flaw that does no harm, told once for all entities that have it: "PROP3 contradicts the weights".
  void remark(const std::string& kind, const Entity& entity);
  void approximation(const Entity& entity, const std::string& description, double tolerance, double deviation);
  /// Curves in parameter space that had to be fitted (map_pcurve()); the distances are in space.
  void fitted_pcurves(const Entity& entity, int count, double tolerance, double deviation);
  /// The remarks as sentences.
  std::vector<std::string> warnings() const;
  /// All fitted curves in parameter space are one entry, with the worst of them.
  std::vector<Approximation> approximations() const;

  /// "file: 142 at D35".
  std::string place(const Entity& entity) const { return fmt::format("{}: {}", file_.name, entity_text(entity)); }
  [[noreturn]] void refuse(const Entity& entity, const std::string& message) const {
    throw InputError(fmt::format("{}: {}", place(entity), message));
  }
  /// Runs a conversion of numbers and lets its GeometryError name the entity.
  template <class Function>
  auto named(const Entity& entity, const Function& function) const {
    try {
      return function();
    } catch (const GeometryError& error) {
      refuse(entity, error.what());
    }
  }

  /// How far an approximation of this size may be off.
  double tolerance_for(double size) const { return options_.tolerance * size; }

 private:
  ParametrisedCurve unplaced_curve(const Entity& entity);
  ParametrisedCurve read_arc(const Entity& entity);
  ParametrisedCurve read_conic(const Entity& entity);
  ParametrisedCurve read_line(const Entity& entity);
  ParametrisedCurve read_parametric_spline(const Entity& entity);
  ParametrisedCurve read_b_spline(const Entity& entity);
  ParametrisedCurve read_offset_curve(const Entity& entity);
  AnySurface unplaced_surface(const Entity& entity);
  AnySurface read_plane(const Entity& entity);
  AnySurface read_parametric_spline_surface(const Entity& entity);
  AnySurface read_ruled_surface(const Entity& entity);
  AnySurface read_surface_of_revolution(const Entity& entity);
  AnySurface read_tabulated_cylinder(const Entity& entity);
  AnySurface read_b_spline_surface(const Entity& entity);
  AnySurface read_offset_surface(const Entity& entity);
  AnySurface read_analytic_surface(const Entity& entity);
  geometry::Axis axis(const Entity& entity);

  const File& file_;
  const IgesOptions& options_;
  std::set<int> active_;
  std::size_t charged_ = 0;
  std::size_t largest_size_ = 0;
  struct Occurrences {
    int count = 0;
    std::string first;
  };
  std::map<std::string, Occurrences> remarks_;
  std::vector<Approximation> approximations_;
  int fitted_pcurves_ = 0;
  Approximation worst_pcurve_;
};

/// Diagonal of the box around points.
double extent(const geometry::Points<3>& points);

}  // namespace isorim::io::iges
