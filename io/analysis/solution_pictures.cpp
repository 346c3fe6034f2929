#include "io/analysis/solution_pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "geometry/bezier/element_jet.h"
#include "io/analysis/solution_cells.h"
#include "io/atomic_file.h"
#include "io/vtk/bezier_writer.h"
#include "io/vtk/field_writer.h"
#include "io/vtk/region_triangles.h"
#include "quadrature/parallel.h"
#include "solver/bem/evaluation.h"
#include "solver/bem/stress.h"

namespace isorim::io {
namespace {

struct FieldNames {
  const char* value;
  const char* flux;
};

FieldNames field_names(bool elastic) {
  return elastic ? FieldNames{"displacement", "traction"} : FieldNames{"potential", "flux"};
}

bool is_elastic(const AnalysisReport& report) {
  return report.equation == "elasticity";
}

/// What ParaView calls the entries.
std::vector<std::string> stress_components() {
  return {"xx", "yy", "zz", "xy", "yz", "xz"};
}
std::vector<std::string> principal_components() {
  return {"first", "second", "third"};
}

/// Vectors of the plane get a third component, 0.
Eigen::MatrixXd padded(const Eigen::MatrixXd& vectors) {
  if (vectors.rows() != 2) return vectors;
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(3, vectors.cols());
  result.topRows(2) = vectors;
  return result;
}

/// xx, yy, zz, xy, yz, xz from the four of the plane or the six of space.
Eigen::MatrixXd tensor_rows(const Eigen::MatrixXd& stress) {
  if (stress.rows() != 4) return stress;
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(6, stress.cols());
  result.topRows(4) = stress;
  return result;
}

/// Gradients as VTK takes them: 3 for each component, row by row.
Eigen::MatrixXd padded_gradients(const Eigen::MatrixXd& gradient, Eigen::Index dim) {
  if (dim == 3) return gradient;
  const Eigen::Index components = gradient.rows() / dim;
  const Eigen::Index rows = components == 1 ? 3 : 9;
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(rows, gradient.cols());
  for (Eigen::Index c = 0; c < components; ++c) {
    for (Eigen::Index k = 0; k < dim; ++k) result.row(3 * c + k) = gradient.row(c * dim + k);
  }
  return result;
}

std::vector<PointArray> point_arrays(const FieldSamples& samples) {
  const FieldNames names = field_names(samples.is_elastic());
  Eigen::MatrixXd location(1, samples.points.cols());
  for (std::size_t i = 0; i < samples.location.size(); ++i) {
    location(0, static_cast<Eigen::Index>(i)) = samples.location[i];
  }
  std::vector<PointArray> arrays{{names.value, padded(samples.value)},
                                 {"gradient", padded_gradients(samples.gradient, samples.points.rows())},
                                 {"location", location}};
  if (!samples.is_elastic()) return arrays;
  arrays.push_back({"stress", tensor_rows(samples.stress), stress_components()});
  arrays.push_back({"von_mises", samples.von_mises.transpose()});
  arrays.push_back({"principal", samples.principal, principal_components()});
  return arrays;
}

// --- Facets -----------------------------------------------------------------------------------------------------

/// The facets of one element: places of its cell, and vertices in each facet.
template <int Dim>
struct ElementFacets {
  std::vector<geometry::Point<Dim - 1>> places;
  std::vector<std::array<std::int64_t, 4>> facets;
};

/// By how much the normal or a tangent turns over an element (a flat one may have curved edges), from some of its
/// places; radians.
template <int Dim>
double turning(const geometry::ElementTable<Dim>& table, const geometry::BezierElement<Dim>& element) {
  const auto directions_at = [&](double s, double t) {
    geometry::Point<Dim - 1> place = geometry::Point<Dim - 1>::Constant(s);
    if constexpr (Dim == 3) place[1] = t;
    const geometry::ElementJet<Dim> jet = geometry::evaluate_jet(table, element, place);
    Eigen::Matrix<double, Dim, Dim> directions;
    directions << jet.normal(), jet.tangents.colwise().normalized();
    return directions;
  };
  const Eigen::Matrix<double, Dim, Dim> middle = directions_at(0.5, 0.5);
  double least = 1.0;
  for (const double s : {0.1, 0.9}) {
    for (const double t : {0.1, 0.9}) {
      least = std::min(least, middle.cwiseProduct(directions_at(s, t)).colwise().sum().minCoeff());
    }
  }
  return 2.0 * std::acos(std::clamp(least, -1.0, 1.0));
}

/// Twice as many pieces in each direction as the fields' degree, and one for every five degrees of turning.
template <int Dim>
int subdivisions(const solver::FieldSpace<Dim>& space, std::size_t element) {
  int degree = 1;
  for (const std::int8_t p : space.elements[element].degree) degree = std::max<int>(degree, p);
  const double angle = turning(space.table, space.table.elements[element]);
  const int pieces = static_cast<int>(std::ceil(angle * 36.0 / std::numbers::pi));
  return std::clamp(std::max(2 * degree, pieces), 2, 24);
}

ElementFacets<2> facets_of(const solver::FieldSpace<2>& space, std::size_t element, double /*chord_tolerance*/) {
  const int n = subdivisions(space, element);
  ElementFacets<2> result;
  for (int i = 0; i <= n; ++i) result.places.push_back(geometry::Point<1>(static_cast<double>(i) / n));
  for (int i = 0; i < n; ++i) result.facets.push_back({i, i + 1, -1, -1});
  return result;
}

ElementFacets<3> facets_of(const solver::FieldSpace<3>& space, std::size_t index, double chord_tolerance) {
  const geometry::BezierElement<3>& element = space.table.elements[index];
  const bool turned = element.orientation < 0;
  ElementFacets<3> result;
  if (element.is_cut()) {
    const RegionTriangles region = triangulate_region(space.table, element, chord_tolerance);
    for (Eigen::Index i = 0; i < region.parameters.cols(); ++i) result.places.push_back(region.parameters.col(i));
    for (const std::array<int, 3>& triangle : region.triangles) {
      const auto [a, b, c] = triangle;
      result.facets.push_back({a, turned ? c : b, turned ? b : c, -1});
    }
    return result;
  }
  const int n = subdivisions(space, index);
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) result.places.push_back({static_cast<double>(i) / n, static_cast<double>(j) / n});
  }
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const std::int64_t first = i + std::int64_t{j} * (n + 1);
      std::array<std::int64_t, 4> quad{first, first + 1, first + n + 2, first + n + 1};
      if (turned) std::swap(quad[1], quad[3]);
      result.facets.push_back(quad);
    }
  }
  return result;
}

/// Everything at the vertices of one element's facets.
template <int Dim>
struct ElementValues {
  ElementFacets<Dim> facets;
  Eigen::Matrix3Xd points;
  FieldSamples fields;
  Eigen::MatrixXd flux;
};

template <int Dim>
ElementValues<Dim> element_values(const Analysis<Dim>& analysis, solver::BoundaryFields<Dim>& fields,
                                  std::size_t element, double chord_tolerance) {
  const solver::FieldSpace<Dim>& space = analysis.setting.space;
  const bool elastic = is_elastic(analysis.report);
  ElementValues<Dim> values;
  values.facets = facets_of(space, element, chord_tolerance);
  const auto count = static_cast<Eigen::Index>(values.facets.places.size());
  const Eigen::Index components = analysis.report.components;
  values.points = Eigen::Matrix3Xd::Zero(3, count);
  values.fields.value.resize(components, count);
  values.fields.gradient.resize(components * Dim, count);
  values.fields.stress.resize(elastic ? 6 : 0, count);
  values.fields.von_mises.resize(elastic ? count : 0);
  values.fields.principal.resize(3, elastic ? count : 0);
  values.flux.resize(components, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const geometry::Point<Dim - 1>& place = values.facets.places[static_cast<std::size_t>(i)];
    const solver::BoundaryValue<Dim> found = fields(static_cast<int>(element), place);
    values.points.col(i).template head<Dim>() = found.position;
    values.fields.value.col(i) = found.field.value;
    values.flux.col(i) = found.flux;
    for (Eigen::Index c = 0; c < components; ++c) {
      values.fields.gradient.col(i).segment(c * Dim, Dim) = found.field.gradient.row(c).transpose();
    }
    if (!elastic) continue;
    const Eigen::Matrix3d s = full_stress(found.field);
    values.fields.stress.col(i) << s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2);
    values.fields.von_mises[i] = solver::von_mises(s);
    values.fields.principal.col(i) = solver::principal_stresses(s).reverse();
  }
  return values;
}

/// Side by side.
Eigen::MatrixXd joined(const std::vector<Eigen::MatrixXd>& parts) {
  Eigen::Index columns = 0;
  for (const Eigen::MatrixXd& part : parts) columns += part.cols();
  Eigen::MatrixXd result(parts.empty() ? 0 : parts.front().rows(), columns);
  Eigen::Index column = 0;
  for (const Eigen::MatrixXd& part : parts) {
    result.middleCols(column, part.cols()) = part;
    column += part.cols();
  }
  return result;
}

template <int Dim>
FacetMesh facet_mesh(const Analysis<Dim>& analysis, int threads) {
  const auto& elements = analysis.setting.space.table.elements;
  const double chord_tolerance = 2e-4 * geometry::bounding_box(analysis.setting.space.table).diagonal();
  std::vector<ElementValues<Dim>> all(elements.size());
  std::vector<std::unique_ptr<solver::BoundaryFields<Dim>>> fields(
      static_cast<std::size_t>(quadrature::thread_count(threads)));
  quadrature::parallel_for(elements.size(), threads, [&](std::size_t e, int thread) {
    auto& own = fields[static_cast<std::size_t>(thread)];
    if (!own) {
      own = std::make_unique<solver::BoundaryFields<Dim>>(analysis.setting.problem, analysis.setting.space,
                                                          analysis.solution);
    }
    all[e] = element_values(analysis, *own, e, chord_tolerance);
  });
  const auto gather = [&](const auto& member) {
    std::vector<Eigen::MatrixXd> parts;
    for (const ElementValues<Dim>& values : all) parts.push_back(member(values));
    return joined(parts);
  };
  using Values = ElementValues<Dim>;
  const bool elastic = is_elastic(analysis.report);
  const FieldNames names = field_names(elastic);
  FacetMesh mesh;
  mesh.points = gather([](const Values& v) { return v.points; });
  mesh.point_arrays = {{names.value, padded(gather([](const Values& v) { return v.fields.value; }))},
                       {names.flux, padded(gather([](const Values& v) { return v.flux; }))},
                       {"gradient", padded_gradients(gather([](const Values& v) { return v.fields.gradient; }), Dim)}};
  if (elastic) {
    mesh.point_arrays.push_back(
        {"stress", gather([](const Values& v) { return v.fields.stress; }), stress_components()});
    mesh.point_arrays.push_back({"von_mises", gather([](const Values& v) { return v.fields.von_mises.transpose(); })});
    mesh.point_arrays.push_back(
        {"principal", gather([](const Values& v) { return v.fields.principal; }), principal_components()});
  }
  std::vector<double> patch;
  std::vector<double> element;
  std::int64_t first = 0;
  for (std::size_t e = 0; e < all.size(); ++e) {
    for (std::array<std::int64_t, 4> facet : all[e].facets.facets) {
      for (std::int64_t& vertex : facet) vertex = vertex < 0 ? vertex : vertex + first;
      mesh.facets.push_back(facet);
      patch.push_back(elements[e].patch);
      element.push_back(static_cast<double>(e));
    }
    first += static_cast<std::int64_t>(all[e].facets.places.size());
  }
  const auto row = [](const std::vector<double>& values) {
    return Eigen::MatrixXd(
        Eigen::Map<const Eigen::RowVectorXd>(values.data(), static_cast<Eigen::Index>(values.size())));
  };
  mesh.cell_arrays = {{"patch", row(patch)}, {"element", row(element)}};
  return mesh;
}

// --- Tables -----------------------------------------------------------------------------------------------------

/// The heading of each column of a probe's table.
std::vector<std::string> column_names(const FieldSamples& samples) {
  constexpr std::array<const char*, 3> axes{"x", "y", "z"};
  const auto dim = static_cast<std::size_t>(samples.points.rows());
  std::vector<std::string> names(axes.begin(), axes.begin() + static_cast<std::ptrdiff_t>(dim));
  names.emplace_back("location");
  const bool elastic = samples.is_elastic();
  for (std::size_t c = 0; c < static_cast<std::size_t>(samples.value.rows()); ++c) {
    names.push_back(elastic ? std::string("u") + axes[c] : "u");
  }
  for (std::size_t c = 0; c < static_cast<std::size_t>(samples.value.rows()); ++c) {
    for (std::size_t k = 0; k < dim; ++k) {
      names.push_back(elastic ? fmt::format("du{}_d{}", axes[c], axes[k]) : fmt::format("du_d{}", axes[k]));
    }
  }
  if (!elastic) return names;
  const std::vector<std::string> stress = samples.stress.rows() == 4
                                              ? std::vector<std::string>{"xx", "yy", "zz", "xy"}
                                              : std::vector<std::string>{"xx", "yy", "zz", "xy", "yz", "xz"};
  for (const std::string& entry : stress) names.push_back("stress_" + entry);
  names.insert(names.end(), {"von_mises", "principal_1", "principal_2", "principal_3"});
  return names;
}

std::string csv_text(const FieldSamples& samples) {
  std::string text = fmt::format("{}\n", fmt::join(column_names(samples), ","));
  for (Eigen::Index i = 0; i < samples.points.cols(); ++i) {
    const auto append = [&](const Eigen::VectorXd& values) {
      for (const double x : values) text += fmt::format("{:.17g},", x);
    };
    append(samples.points.col(i));
    text += fmt::format("{},", samples.location[static_cast<std::size_t>(i)]);
    append(samples.value.col(i));
    append(samples.gradient.col(i));
    if (samples.is_elastic()) {
      append(samples.stress.col(i));
      text += fmt::format("{:.17g},", samples.von_mises[i]);
      append(samples.principal.col(i));
    }
    text.back() = '\n';
  }
  return text;
}

}  // namespace

void write_solution_vtu(const std::filesystem::path& path, const AnyModel& model, const AnyAnalysis& analysis) {
  std::vector<std::string> names;
  std::visit(
      [&](const auto& known) {
        for (const auto& patch : known.oriented.boundary.patches) names.push_back(patch.name);
      },
      model);
  std::visit(
      [&](const auto& known) {
        const auto cells = solution_cells(known.setting.space, known.solution);
        const FieldNames fields = field_names(is_elastic(known.report));
        const auto three = [&](const std::vector<double>& values) {
          const Eigen::Map<const Eigen::MatrixXd> matrix(values.data(), cells.components,
                                                         static_cast<Eigen::Index>(values.size()) / cells.components);
          return padded(matrix);
        };
        const Eigen::MatrixXd value = three(cells.potential);
        const Eigen::MatrixXd flux = three(cells.flux);
        const std::vector<double> conditions = [&] {
          std::vector<double> list;
          for (const std::int32_t condition : known.setting.problem.condition_of) {
            list.push_back(known.setting.case_condition[static_cast<std::size_t>(condition)]);
          }
          return list;
        }();
        const auto span_of = [](const Eigen::MatrixXd& matrix) {
          return std::span<const double>(matrix.data(), static_cast<std::size_t>(matrix.size()));
        };
        VtuContent content;
        content.patch_names = names;
        content.point_fields = {{fields.value, static_cast<int>(value.rows()), span_of(value)},
                                {fields.flux, static_cast<int>(flux.rows()), span_of(flux)}};
        content.cell_fields = {{"condition", 1, conditions}};
        write_vtu(path, cells.table, content);
      },
      analysis.known);
}

void write_fields_vtu(const std::filesystem::path& path, const AnyAnalysis& analysis, int threads) {
  write_facets_vtu(path, std::visit([&](const auto& known) { return facet_mesh(known, threads); }, analysis.known));
}

void write_samples(const std::filesystem::path& folder, const AnalysisReport& report) {
  for (const FieldSamples& samples : report.probes) {
    Eigen::Matrix3Xd points = Eigen::Matrix3Xd::Zero(3, samples.points.cols());
    points.topRows(samples.points.rows()) = samples.points;
    write_points_vtp(folder / probe_file_name(samples, ".vtp"), points,
                     samples.is_line ? PointForm::line : PointForm::points, point_arrays(samples));
    write_file(folder / probe_file_name(samples, ".csv"), csv_text(samples));
  }
  for (const FieldSamples& samples : report.grids) {
    std::vector<char> hidden;
    for (const signed char location : samples.location) hidden.push_back(location < 0 ? 1 : 0);
    write_image_vti(folder / grid_file_name(samples), *samples.image, point_arrays(samples), hidden);
  }
}

}  // namespace isorim::io
