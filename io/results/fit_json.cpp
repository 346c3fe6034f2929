#include "io/results/fit_json.h"

#include <string>
#include <vector>

namespace isorim::io {
namespace {

Json point_json(const geometry::Point3& point) {
  return list_json(std::vector<double>(point.begin(), point.end()));
}

Json quality_json(int control_points, const geometry::FitQuality<2>& quality) {
  return {{"control_points", control_points},
          {"max_distance", number(quality.max_distance)},
          {"rms_distance", number(quality.rms_distance)},
          {"bending_energy", number(quality.bending_energy)},
          {"curvature_sign_changes", quality.curvature_sign_changes}};
}

Json curve_json(const FittedCurve& curve) {
  Json json{{"name", curve.name}, {"points", curve.points.cols()}, {"closed", curve.closed}};
  json.update(quality_json(curve.fit.control_points, curve.fit.quality));
  json["worst_point"] = point_json(curve.plane.place(curve.points.col(curve.fit.quality.worst_point)));
  json["tolerance_met"] = curve.fit.tolerance_met;
  json["corners"] = curve.fit.corners.size();
  return json;
}

Json body_json(const FittedBody& body) {
  return {{"sections", body.sections},
          {"control_points_along", body.control_points_along},
          {"control_points_across", body.control_points_across},
          {"knots_inserted", body.knots_inserted},
          {"knots_removed", body.knots_removed},
          {"uniformisation_error", number(body.uniformisation_error)},
          {"off_plane", number(body.off_plane)}};
}

}  // namespace

Json fit_json(const FitFacts& facts) {
  const FitSummary all = summarise(facts);
  geometry::FitQuality<2> quality;
  quality.max_distance = all.max_distance;
  quality.rms_distance = all.rms_distance;
  quality.bending_energy = all.bending_energy;
  quality.curvature_sign_changes = all.curvature_sign_changes;
  Json json = quality_json(all.control_points, quality);
  json["seconds"] = number(facts.seconds);
  json["tolerance_met"] = all.tolerance_met;
  json["worst_point"] = {{"curve", facts.curves[all.worst_curve].name},
                         {"point", all.worst_point + 1},
                         {"place", point_json(all.worst_place)},
                         {"distance", number(all.max_distance)}};
  json["points"] = {{"read", facts.points_read}, {"reduced", facts.points_reduced}, {"fitted", all.points}};
  json["dropped"] = Json::object();
  for (const auto& [reason, count] : facts.dropped) json["dropped"][reason] = count;
  json["thinned"] = facts.thinned;
  json["ordering_seconds"] = number(facts.ordering_seconds);
  json["curves"] = Json::array();
  for (const FittedCurve& curve : facts.curves) json["curves"].push_back(curve_json(curve));
  if (facts.is_body()) json["body"] = body_json(facts.body);
  return json;
}

}  // namespace isorim::io
