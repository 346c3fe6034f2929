#include "io/hydrostatics/added_mass_report.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/results/table.h"
#include "solver/hydrostatics/floating_body.h"

namespace isorim::io {
namespace {

using geometry::OrientedBoundary;
using geometry::Point3;
using geometry::Vector3;

constexpr const char* motions[] = {"surge", "sway", "heave", "roll", "pitch", "yaw"};
/// Of the body's height: how far the centre may lie from the water of a double body.
constexpr double in_the_water = 1e-9;

solver::SolveMethod method_of(SolveMethodKind kind) {
  switch (kind) {
    case SolveMethodKind::dense:
      return solver::SolveMethod::dense;
    case SolveMethodKind::compressed:
      return solver::SolveMethod::compressed;
    case SolveMethodKind::automatic:
      break;
  }
  return solver::SolveMethod::automatic;
}

solver::AddedMassOptions options_of(const AddedMassKeys& keys, int threads,
                                    const std::function<void(double)>& progress) {
  solver::AddedMassOptions options;
  options.degree = keys.degree;
  options.refine = keys.refine;
  options.edges.layers = keys.edge_layers;
  options.solve.method = method_of(keys.method);
  options.solve.tolerance = keys.tolerance;
  options.solve.threads = threads;
  options.solve.progress = progress;
  return options;
}

/// z of the water, which must cross the solid or touch its top.
double waterplane_of(const AddedMassKeys& keys, const OrientedBoundary<3>& boundary, int threads) {
  solver::FloatingBodyOptions options;
  options.threads = threads;
  const solver::FloatingBody body(boundary.boundary, options);
  const double lowest = body.lowest(Vector3::UnitZ());
  const double highest = -body.lowest(-Vector3::UnitZ());
  const double height = keys.baseline.value_or(lowest) + *keys.draught;
  const double slack = in_the_water * (highest - lowest);
  if (!(height > lowest + slack && height <= highest + slack))
    throw GeometryError(
        fmt::format("draught: the water lies at z = {:.6g}; expected it between the lowest and the highest "
                    "point of the solid, {:.6g} and {:.6g} (without a draught the solid is taken whole)",
                    height, lowest, highest));
  return height;
}

Point3 centre_of(const AddedMassKeys& keys, const std::optional<double>& waterplane, double size) {
  if (!keys.centre) return {0.0, 0.0, waterplane.value_or(0.0)};
  const Point3 centre(keys.centre->values.data());
  if (waterplane && std::abs(centre.z() - *waterplane) > in_the_water * size)
    throw GeometryError(
        fmt::format("centre: it lies at z = {:.6g}; expected it in the water of the double body, at "
                    "z = {:.6g}",
                    centre.z(), *waterplane));
  return centre;
}

Entries row_by_row(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  Entries entries{{}, static_cast<int>(matrix.rows()), static_cast<int>(matrix.cols())};
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) entries.values.push_back(matrix(i, j));
  return entries;
}

/// Of the diagonal, like AddedMass::coefficients().
Eigen::Matrix<double, 6, 1> coefficient_errors(const solver::AddedMass& result) {
  solver::AddedMass errors = result;
  errors.matrix = result.error;
  return errors.coefficients();
}

}  // namespace

AddedMassReport compute_added_mass(const AddedMassKeys& keys, const OrientedBoundary<3>& boundary, int threads,
                                   const std::function<void(double)>& progress) {
  const auto start = std::chrono::steady_clock::now();
  solver::AddedMassOptions options = options_of(keys, threads, progress);
  AddedMassReport report;
  report.water_density = keys.water_density;
  double share = keys.water_density;
  OrientedBoundary<3> body = boundary;
  if (keys.draught) {
    report.waterplane = waterplane_of(keys, boundary, threads);
    body = geometry::orient(solver::double_body(boundary.boundary, *report.waterplane));
    geometry::require_closed(body);
    share *= 0.5;
  }
  report.centre = centre_of(keys, report.waterplane, keys.draught.value_or(0.0));
  options.centre = report.centre;
  report.result = solver::added_mass(body, options);
  report.result.matrix *= share;
  report.result.error *= share;
  report.result.volume *= share;
  report.result.inertia *= share;
  report.time = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

std::vector<Quantity> expected_quantities(const AddedMassReport& report) {
  const solver::AddedMass& result = report.result;
  std::vector<Quantity> list{
      {"added_mass.matrix", row_by_row(result.matrix), row_by_row(result.error).values, {}, {}, ""},
      {"added_mass.displaced_mass", single(result.volume), {}, {}, {}, ""}};
  const auto coefficients = result.coefficients();
  const auto errors = coefficient_errors(result);
  for (int i = 0; i < 6; ++i)
    list.push_back({fmt::format("added_mass.{}", motions[i]), single(coefficients[i]), {errors[i]}, {}, {}, ""});
  return list;
}

Json added_mass_json(const AddedMassReport& report) {
  const solver::AddedMass& result = report.result;
  const auto rows = [](const solver::AddedMass::Matrix& matrix) {
    Json list = Json::array();
    for (int i = 0; i < 6; ++i) list.push_back(list_json(row_by_row(matrix.row(i)).values));
    return list;
  };
  Json json;
  json["matrix"] = rows(result.matrix);
  json["error"] = rows(result.error);
  json["coefficients"] = list_json(row_by_row(result.coefficients()).values);
  json["coefficient_errors"] = list_json(row_by_row(coefficient_errors(result)).values);
  json["displaced_mass"] = number(result.volume);
  json["water_density"] = number(report.water_density);
  json["centre"] = list_json({report.centre.x(), report.centre.y(), report.centre.z()});
  json["waterplane"] = report.waterplane ? number(*report.waterplane) : Json(nullptr);
  json["unknowns"] = result.unknowns;
  json["method"] = result.method;
  json["time"] = number(report.time);
  return json;
}

std::string added_mass_text(const AddedMassReport& report) {
  const solver::AddedMass& result = report.result;
  std::vector<TextTable::Column> columns{{"added mass"}};
  for (const char* motion : motions) columns.push_back({motion, Align::right});
  columns.push_back({"error est.", Align::right});
  columns.push_back({"over displaced", Align::right});
  TextTable table(std::move(columns));
  const auto coefficients = result.coefficients();
  // What is smaller than its error, or than rounding, is zero.
  const double rounding = 1e-13 * result.matrix.cwiseAbs().maxCoeff();
  for (int i = 0; i < 6; ++i) {
    std::vector<std::string> cells{motions[i]};
    for (int j = 0; j < 6; ++j)
      cells.push_back(std::abs(result.matrix(i, j)) <= std::max(rounding, result.error(i, j))
                          ? "0"
                          : fmt::format("{:.6g}", result.matrix(i, j)));
    cells.push_back(fmt::format("{:.1e}", result.error(i, i)));
    cells.push_back(fmt::format("{:.6g}", coefficients[i]));
    table.add_row(std::move(cells));
  }
  return fmt::format("{}  {} unknowns ({}), {:.2f} s{}\n\n", table.text(2), result.unknowns, result.method, report.time,
                     report.waterplane ? "; half of the double body" : "");
}

}  // namespace isorim::io
