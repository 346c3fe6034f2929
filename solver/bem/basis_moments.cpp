#include "solver/bem/basis_moments.h"

#include <algorithm>

#include "solver/linear/small_products.h"

namespace isorim::solver {

namespace {

using quadrature::NodeView;

/// Nodes that are taken together, so that what belongs to them stays in the cache.
constexpr int node_block = 128;

/// Bernstein polynomials at `places` into rows of `step` numbers, one row for each place.
void fill_rows(int degree, std::span<const double> places, int step, std::vector<double>& rows,
               std::vector<double>& room) {
  const auto count = static_cast<int>(places.size());
  room.resize(static_cast<std::size_t>(degree + 1) * places.size());
  bernstein_values(degree, count, places.data(), room.data(), count);
  rows.assign(places.size() * static_cast<std::size_t>(step), 0.0);
  for (int i = 0; i <= degree; ++i) {
    const double* source = room.data() + static_cast<std::ptrdiff_t>(i) * count;
    double* target = rows.data() + i;
    for (int q = 0; q < count; ++q) target[static_cast<std::ptrdiff_t>(q) * step] = source[q];
  }
}

/// Bernstein moments of a curve's element: moments[f * (p + 1) + i].
void bernstein_moments(const NodeBasis<2>& basis, int p, const double* integrands, int count, MomentScratch& scratch) {
  const int step = basis.step[0];
  scratch.padded_moments.assign(static_cast<std::size_t>(count * step), 0.0);
  add_product(count, step, basis.nodes, {integrands, basis.nodes, 1}, basis.values[0].data(), step,
              scratch.padded_moments.data(), step);
  for (int f = 0; f < count; ++f)
    std::copy_n(scratch.padded_moments.data() + f * step, p + 1, scratch.moments.data() + f * (p + 1));
}

/// On a grid: lines of constant t first.
void grid_moments(const NodeBasis<3>& basis, int q, const double* integrands, int count, MomentScratch& scratch) {
  const int width = basis.counts[0];
  const int height = basis.counts[1];
  const int step = basis.step[0];
  scratch.lines.assign(static_cast<std::size_t>(count * height * step), 0.0);
  add_product(count * height, step, width, {integrands, width, 1}, basis.values[0].data(), step, scratch.lines.data(),
              step);
  for (int f = 0; f < count; ++f) {
    add_product(q + 1, step, height, {basis.values[1].data(), 1, basis.step[1]},
                scratch.lines.data() + static_cast<std::ptrdiff_t>(f) * height * step, step,
                scratch.padded_moments.data() + static_cast<std::ptrdiff_t>(f) * (q + 1) * step, step);
  }
}

/// At scattered nodes: integrand times the second direction's polynomial, against the first direction's.
void scattered_moments(const NodeBasis<3>& basis, int q, const double* integrands, int count, MomentScratch& scratch) {
  const int step = basis.step[0];
  scratch.left.resize(static_cast<std::size_t>(count * (q + 1)) * node_block);
  for (int begin = 0; begin < basis.nodes; begin += node_block) {
    const int n = std::min(node_block, basis.nodes - begin);
    const double* t_values = basis.values[1].data() + static_cast<std::ptrdiff_t>(begin) * basis.step[1];
    for (int f = 0; f < count; ++f) {
      const double* source = integrands + static_cast<std::ptrdiff_t>(f) * basis.nodes + begin;
      for (int k = 0; k <= q; ++k) {
        double* target = scratch.left.data() + static_cast<std::ptrdiff_t>(f * (q + 1) + k) * node_block;
        for (int i = 0; i < n; ++i)
          target[i] = source[i] * t_values[static_cast<std::ptrdiff_t>(i) * basis.step[1] + k];
      }
    }
    add_product(count * (q + 1), step, n, {scratch.left.data(), node_block, 1},
                basis.values[0].data() + static_cast<std::ptrdiff_t>(begin) * step, step, scratch.padded_moments.data(),
                step);
  }
}

/// Bernstein moments of a surface's element: moments[(f * (q + 1) + k) * (p + 1) + i].
void bernstein_moments(const NodeBasis<3>& basis, int p, int q, const double* integrands, int count,
                       MomentScratch& scratch) {
  const int step = basis.step[0];
  scratch.padded_moments.assign(static_cast<std::size_t>(count * (q + 1) * step), 0.0);
  if (basis.scattered) {
    scattered_moments(basis, q, integrands, count, scratch);
  } else {
    grid_moments(basis, q, integrands, count, scratch);
  }
  for (int row = 0; row < count * (q + 1); ++row) {
    std::copy_n(scratch.padded_moments.data() + static_cast<std::ptrdiff_t>(row) * step, p + 1,
                scratch.moments.data() + static_cast<std::ptrdiff_t>(row) * (p + 1));
  }
}

}  // namespace

void fill_reciprocal_weights(const geometry::ElementTable<2>& table, const geometry::BezierElement<2>& element,
                             const NodeView<2>& nodes, std::vector<double>& result, std::vector<double>& room) {
  const int p = element.degree[0];
  const std::size_t n = nodes.size();
  const std::span<const double> net = table.net(element);
  room.resize(static_cast<std::size_t>(p + 1) * n);
  bernstein_values(p, static_cast<int>(n), nodes.place[0].data(), room.data(), static_cast<std::ptrdiff_t>(n));
  result.assign(n, 0.0);
  for (int i = 0; i <= p; ++i) {
    const double weight = net[static_cast<std::size_t>(3 * i + 2)];
    const double* values = room.data() + static_cast<std::size_t>(i) * n;
    for (std::size_t q = 0; q < n; ++q) result[q] += weight * values[q];
  }
  for (double& w : result) w = 1.0 / w;
}

void fill_reciprocal_weights(const geometry::ElementTable<3>& table, const geometry::BezierElement<3>& element,
                             const NodeView<3>& nodes, std::vector<double>& result, std::vector<double>& room) {
  const int p = element.degree[0];
  const int r = element.degree[1];
  const std::size_t n = nodes.size();
  const auto step = static_cast<std::ptrdiff_t>(n);
  const std::span<const double> net = table.net(element);
  room.resize(static_cast<std::size_t>(p + r + 3) * n);
  double* s_values = room.data();
  double* t_values = s_values + static_cast<std::size_t>(p + 1) * n;
  double* row = t_values + static_cast<std::size_t>(r + 1) * n;
  bernstein_values(p, static_cast<int>(n), nodes.place[0].data(), s_values, step);
  bernstein_values(r, static_cast<int>(n), nodes.place[1].data(), t_values, step);
  result.assign(n, 0.0);
  for (int j = 0; j <= r; ++j) {
    std::fill(row, row + n, 0.0);
    for (int i = 0; i <= p; ++i) {
      const double weight = net[static_cast<std::size_t>(4 * (j * (p + 1) + i) + 3)];
      for (std::size_t q = 0; q < n; ++q) row[q] += weight * s_values[static_cast<std::size_t>(i) * n + q];
    }
    for (std::size_t q = 0; q < n; ++q) result[q] += row[q] * t_values[static_cast<std::size_t>(j) * n + q];
  }
  for (double& w : result) w = 1.0 / w;
}

template <int Dim>
void fill_node_basis(const FieldSpace<Dim>& space, int element, const NodeView<Dim>& nodes, NodeBasis<Dim>& basis,
                     MomentScratch& scratch) {
  const auto index = static_cast<std::size_t>(element);
  const FieldElement<Dim>& field = space.elements[index];
  basis.nodes = static_cast<int>(nodes.size());
  basis.counts.fill(1);
  basis.counts[0] = basis.nodes;
  basis.scattered = true;
  if constexpr (Dim == 3) {
    if (nodes.is_tensor()) {
      basis.scattered = false;
      basis.counts = nodes.orders;
    }
  }
  for (std::size_t d = 0; d < Dim - 1; ++d) {
    basis.step[d] = padded(field.degree[d] + 1);
    std::span<const double> places = nodes.place[d];
    if (!basis.scattered) {
      scratch.places.clear();
      const std::size_t stride = d == 0 ? 1 : static_cast<std::size_t>(basis.counts[0]);
      for (int i = 0; i < basis.counts[d]; ++i) scratch.places.push_back(places[static_cast<std::size_t>(i) * stride]);
      places = scratch.places;
    }
    fill_rows(field.degree[d], places, basis.step[d], basis.values[d], scratch.bernstein);
  }
  basis.reciprocal_weight.clear();
  const geometry::BezierElement<Dim>& bezier = space.table.elements[index];
  if (field.rational && !bezier.polynomial)
    fill_reciprocal_weights(space.table, bezier, nodes, basis.reciprocal_weight, scratch.bernstein);
}

template <int Dim>
void add_moments(const FieldSpace<Dim>& space, int element, const NodeBasis<Dim>& basis, std::span<double> integrands,
                 int integrand_count, MomentScratch& scratch, std::span<double> result) {
  const FieldElement<Dim>& field = space.elements[static_cast<std::size_t>(element)];
  const int bernstein_count = field.bernstein_count();
  if (!basis.reciprocal_weight.empty()) {
    const auto n = static_cast<std::size_t>(basis.nodes);
    for (std::size_t f = 0; f < static_cast<std::size_t>(integrand_count); ++f) {
      for (std::size_t q = 0; q < n; ++q) integrands[f * n + q] *= basis.reciprocal_weight[q];
    }
  }
  scratch.moments.resize(static_cast<std::size_t>(integrand_count * bernstein_count));
  if constexpr (Dim == 2) {
    bernstein_moments(basis, field.degree[0], integrands.data(), integrand_count, scratch);
  } else {
    bernstein_moments(basis, field.degree[0], field.degree[1], integrands.data(), integrand_count, scratch);
  }
  add_product_transposed(integrand_count, field.count, bernstein_count, scratch.moments.data(), bernstein_count,
                         space.rows.data() + field.row, bernstein_count, result.data(), field.count);
}

template <int Dim>
void multiply_by_function(const NodeBasis<Dim>& basis, const std::array<std::int8_t, Dim - 1>& degree,
                          std::span<const double> coefficients, std::span<double> values) {
  const auto row_of = [&](std::size_t d, std::size_t q) {
    return basis.values[d].data() + q * static_cast<std::size_t>(basis.step[d]);
  };
  const auto rows = coefficients.size() / static_cast<std::size_t>(degree[0] + 1);
  for (std::size_t q = 0; q < static_cast<std::size_t>(basis.nodes); ++q) {
    const auto width = static_cast<std::size_t>(basis.counts[0]);
    const double* along = row_of(0, basis.scattered ? q : q % width);
    double sum = 0.0;
    for (std::size_t k = 0; k < rows; ++k) {
      double line = 0.0;
      for (int i = 0; i <= degree[0]; ++i)
        line += along[i] * coefficients[k * static_cast<std::size_t>(degree[0] + 1) + static_cast<std::size_t>(i)];
      if constexpr (Dim == 3) line *= row_of(1, basis.scattered ? q : q / width)[k];
      sum += line;
    }
    values[q] *= basis.reciprocal_weight.empty() ? sum : sum * basis.reciprocal_weight[q];
  }
}

template void multiply_by_function<2>(const NodeBasis<2>&, const std::array<std::int8_t, 1>&, std::span<const double>,
                                      std::span<double>);
template void multiply_by_function<3>(const NodeBasis<3>&, const std::array<std::int8_t, 2>&, std::span<const double>,
                                      std::span<double>);
template void fill_node_basis<2>(const FieldSpace<2>&, int, const NodeView<2>&, NodeBasis<2>&, MomentScratch&);
template void fill_node_basis<3>(const FieldSpace<3>&, int, const NodeView<3>&, NodeBasis<3>&, MomentScratch&);
template void add_moments<2>(const FieldSpace<2>&, int, const NodeBasis<2>&, std::span<double>, int, MomentScratch&,
                             std::span<double>);
template void add_moments<3>(const FieldSpace<3>&, int, const NodeBasis<3>&, std::span<double>, int, MomentScratch&,
                             std::span<double>);

}  // namespace isorim::solver
