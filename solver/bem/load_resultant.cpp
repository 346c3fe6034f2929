#include <array>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "quadrature/rim.h"
#include "solver/bem/domain_load.h"

namespace isorim::solver {

namespace {

/// density (z_i - point_i).
template <int Dim>
quadrature::IntegrandFactory<Dim> moment_density(const quadrature::IntegrandFactory<Dim>& density,
                                                 const geometry::Point<Dim>& point, int i) {
  return [=] {
    return [=, b = density()](const Eigen::Ref<const geometry::Points<Dim>>& points,
                              const Eigen::Ref<const geometry::Points<Dim>>& normals, std::span<double> values) {
      b(points, normals, values);
      for (std::size_t q = 0; q < values.size(); ++q) values[q] *= points(i, static_cast<Eigen::Index>(q)) - point[i];
    };
  };
}

}  // namespace

template <int Dim>
LoadResultant load_resultant(const Loads<Dim>& loads, const geometry::ElementTable<Dim>& table,
                             const geometry::Point<Dim>& point, double tolerance, int threads) {
  quadrature::Options options;
  options.tolerance = tolerance;
  options.threads = threads;
  const int components = loads.empty() ? 0 : loads.front()->components();
  // One axis in the plane; in space those normal to (y, z), (z, x), (x, y).
  std::vector<std::pair<int, int>> axes;
  if (components == Dim && Dim == 2) axes = {{0, 1}};
  if (components == Dim && Dim == 3) axes = {{1, 2}, {2, 0}, {0, 1}};
  LoadResultant resultant{Eigen::VectorXd::Zero(components),
                          Eigen::VectorXd::Zero(static_cast<Eigen::Index>(axes.size()))};
  const geometry::Point<Dim> pole = quadrature::default_pole(table);
  const auto integral = [&](const quadrature::IntegrandFactory<Dim>& density) {
    return quadrature::integrate_over_domain<Dim>(table, density, pole, options).integral.value;
  };
  for (const auto& load : loads) {
    const std::vector<quadrature::IntegrandFactory<Dim>> density = load->density();
    for (std::size_t c = 0; c < density.size(); ++c)
      resultant.force[static_cast<Eigen::Index>(c)] += integral(density[c]);
    // The two parts apart: their difference may vanish everywhere but for rounding, which cannot be integrated to a
    // relative tolerance.
    for (std::size_t a = 0; a < axes.size(); ++a) {
      const auto [i, j] = axes[a];
      resultant.moment[static_cast<Eigen::Index>(a)] +=
          integral(moment_density<Dim>(density[static_cast<std::size_t>(j)], point, i)) -
          integral(moment_density<Dim>(density[static_cast<std::size_t>(i)], point, j));
    }
  }
  return resultant;
}

template LoadResultant load_resultant(const Loads<2>&, const geometry::ElementTable<2>&, const geometry::Point<2>&,
                                      double, int);
template LoadResultant load_resultant(const Loads<3>&, const geometry::ElementTable<3>&, const geometry::Point<3>&,
                                      double, int);

}  // namespace isorim::solver
