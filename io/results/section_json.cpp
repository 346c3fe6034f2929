#include "io/results/section_json.h"

#include <cstddef>
#include <optional>

namespace isorim::io {
namespace {

using geometry::PlaneSection;
using geometry::SectionCurve;
using geometry::SectionSpline;

template <class Point>
Json point_json(const Point& point) {
  Json list = Json::array();
  for (const double x : point) list.push_back(number(x));
  return list;
}

Json estimate_json(const quadrature::Estimate& estimate) {
  return {{"value", number(estimate.value)}, {"error", number(estimate.error)}};
}

const std::string& name_of(const SectionFamily& family, int patch) {
  return family.patch_names[static_cast<std::size_t>(patch)];
}

/// What all kinds of curves have.
Json curve_json(const SectionFamily& family, const SectionCurve& curve, const std::optional<SectionSpline>& spline) {
  Json patches = Json::array();
  for (const geometry::SectionPiece& piece : curve.pieces) {
    const std::string& name = name_of(family, piece.patch);
    if (patches.empty() || patches.back() != name) patches.push_back(name);
  }
  Json json;
  json["length"] = spline ? number(spline->length) : Json(nullptr);
  json["closed"] = curve.is_closed;
  json["patches"] = std::move(patches);
  json["largest_gap"] = number(curve.largest_gap);
  json["spline"] = nullptr;
  if (spline)
    json["spline"] = {{"degree", spline->curve.degree()},
                      {"control_points", spline->curve.knots().basis_count()},
                      {"periodic", spline->is_periodic},
                      {"corners", spline->corners.size()},
                      {"error", number(spline->error)}};
  return json;
}

Json curves_json(const SectionFamily& family, const std::vector<SectionCurve>& curves,
                 const std::vector<std::optional<SectionSpline>>& splines) {
  Json list = Json::array();
  for (std::size_t i = 0; i < curves.size(); ++i) {
    Json json = curve_json(family, curves[i], splines[i]);
    json["from"] = point_json(evaluate_jet(curves[i].pieces.front(), 0.0).place.point);
    json["to"] = point_json(evaluate_jet(curves[i].pieces.back(), 1.0).place.point);
    list.push_back(std::move(json));
  }
  return list;
}

Json points_json(const SectionFamily& family, const std::vector<geometry::SectionPoint>& points) {
  Json list = Json::array();
  for (const geometry::SectionPoint& point : points)
    list.push_back({{"point", point_json(point.point)},
                    {"patch", name_of(family, point.patch)},
                    {"parameters", point_json(point.uv)}});
  return list;
}

Json loops_json(const SectionFamily& family, const solver::MeasuredSection& measured) {
  Json list = Json::array();
  for (std::size_t i = 0; i < measured.section->loops.size(); ++i) {
    const geometry::SectionLoop& loop = measured.section->loops[i];
    Json json = curve_json(family, loop.curve, measured.loops[i]);
    json["hole"] = loop.is_hole;
    json["parent"] = loop.parent < 0 ? Json(nullptr) : Json(loop.parent);
    list.push_back(std::move(json));
  }
  return list;
}

const char* status_of(const solver::MeasuredSection& measured) {
  if (!measured.section) return measured.touches_within ? "touching" : "failed";
  return measured.section->is_empty() ? "empty" : "ok";
}

Json plane_json(const SectionFamily& family, std::size_t index) {
  const solver::MeasuredSection& measured = family.sections[index];
  Json json;
  json["offset"] = number(family.offsets[index]);
  json["status"] = status_of(measured);
  const geometry::PlaneFrame& frame = family.planes[index];
  json["origin"] = point_json(frame.origin);
  if (!measured.section) {
    json["messages"] = Json::array({measured.failure});
    return json;
  }
  const PlaneSection& section = *measured.section;
  json["area"] = estimate_json(measured.area);
  json["perimeter"] = estimate_json(measured.perimeter);
  json["centroid"] = measured.centroid ? point_json(*measured.centroid) : Json(nullptr);
  json["loops"] = loops_json(family, measured);
  json["chains"] = curves_json(family, section.chains, measured.chains);
  json["touching"] = curves_json(family, section.touching, measured.touching);
  json["isolated"] = points_json(family, section.isolated);
  json["double_points"] = points_json(family, section.double_points);
  Json coplanar = Json::array();
  for (const geometry::CoplanarFace& face : section.coplanar) coplanar.push_back(name_of(family, face.patch));
  json["coplanar_patches"] = std::move(coplanar);
  json["largest_gap"] = number(section.largest_gap);
  json["messages"] = section.messages;
  return json;
}

}  // namespace

Json sections_json(const std::vector<SectionFamily>& families) {
  Json json = Json::object();
  for (const SectionFamily& family : families) {
    Json table;
    if (!family.planes.empty()) {
      table["normal"] = point_json(family.planes.front().normal);
      table["axis_x"] = point_json(family.planes.front().axis_x);
      table["axis_y"] = point_json(family.planes.front().axis_y);
    }
    Json planes = Json::array();
    for (std::size_t i = 0; i < family.sections.size(); ++i) planes.push_back(plane_json(family, i));
    table["planes"] = std::move(planes);
    json[family.name] = std::move(table);
  }
  return json;
}

}  // namespace isorim::io
