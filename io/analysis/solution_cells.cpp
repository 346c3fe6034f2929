#include "io/analysis/solution_cells.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

namespace isorim::io {
namespace {

using Degrees = std::array<int, 2>;

/// Functions in tensor-product Bernstein form: a row each, the first parameter fastest along the columns.
struct BernsteinForm {
  Degrees degree{};
  Eigen::MatrixXd rows;
};

double binomial(int n, int k) {
  double value = 1.0;
  for (int i = 1; i <= k; ++i) value = value * (n - k + i) / i;
  return value;
}

/// Farouki & Rajan, Comput. Aided Geom. Des. 5 (1988), eq. 44, in each direction: f times the single row of g.
BernsteinForm product(const BernsteinForm& f, const BernsteinForm& g) {
  BernsteinForm result;
  for (std::size_t d = 0; d < 2; ++d) result.degree[d] = f.degree[d] + g.degree[d];
  const auto [p, q] = result.degree;
  result.rows = Eigen::MatrixXd::Zero(f.rows.rows(), Eigen::Index{p + 1} * (q + 1));
  const auto share = [](int n, int i, int m, int j) {
    return binomial(n, i) * binomial(m, j) / binomial(n + m, i + j);
  };
  for (int j = 0; j <= f.degree[1]; ++j) {
    for (int i = 0; i <= f.degree[0]; ++i) {
      for (int l = 0; l <= g.degree[1]; ++l) {
        for (int k = 0; k <= g.degree[0]; ++k) {
          const double factor = share(f.degree[0], i, g.degree[0], k) * share(f.degree[1], j, g.degree[1], l) *
                                g.rows(0, k + l * (g.degree[0] + 1));
          result.rows.col(i + k + (j + l) * (p + 1)) += factor * f.rows.col(i + j * (f.degree[0] + 1));
        }
      }
    }
  }
  return result;
}

BernsteinForm raised(const BernsteinForm& f, const Degrees& degree) {
  const Degrees more{degree[0] - f.degree[0], degree[1] - f.degree[1]};
  if (more == Degrees{0, 0}) return f;
  return product(f, {more, Eigen::MatrixXd::Ones(1, Eigen::Index{more[0] + 1} * (more[1] + 1))});
}

template <class Element>
Degrees degrees_of(const Element& element) {
  Degrees degrees{};
  std::copy(element.degree.begin(), element.degree.end(), degrees.begin());
  return degrees;
}

/// Coefficients of a field on an element, in the Bernstein basis that its rows refer to: components x Bernstein.
template <int Dim>
Eigen::MatrixXd bernstein_coefficients(const solver::FieldSpace<Dim>& space, std::size_t element,
                                       const Eigen::MatrixXd& coefficients) {
  const solver::FieldElement<Dim>& field = space.elements[element];
  const Eigen::Index width = field.bernstein_count();
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(coefficients.cols(), width);
  const auto functions = space.functions_of(static_cast<int>(element));
  for (std::size_t a = 0; a < functions.size(); ++a) {
    const double* row = space.rows.data() + field.row + a * static_cast<std::size_t>(width);
    result += coefficients.row(functions[a]).transpose() * Eigen::Map<const Eigen::RowVectorXd>(row, width);
  }
  return result;
}

/// A field in the rational basis of the raised net.
Eigen::MatrixXd control_values(const BernsteinForm& numerators, const Eigen::RowVectorXd& weights) {
  return (numerators.rows.array().rowwise() / weights.array()).matrix();
}

template <int Dim>
class CellBuilder {
 public:
  CellBuilder(const solver::FieldSpace<Dim>& space, const solver::Solution<Dim>& solution)
      : space_(space), solution_(solution) {
    cells_.components = static_cast<int>(solution.potential.cols());
    cells_.table.regions = space.table.regions;
  }

  SolutionCells<Dim> build() {
    for (std::size_t e = 0; e < space_.elements.size(); ++e) add(e);
    return std::move(cells_);
  }

 private:
  void add(std::size_t index) {
    geometry::BezierElement<Dim> element = space_.table.elements[index];
    const solver::FieldElement<Dim>& field = space_.elements[index];
    const BernsteinForm net{degrees_of(element), space_.table.net_matrix(element)};
    // A polynomial field on a rational element is (field weights) / weights.
    const bool times_weights = !field.rational && !element.polynomial;
    Degrees degree = degrees_of(field);
    for (std::size_t d = 0; d < 2; ++d) {
      degree[d] = times_weights ? degree[d] + net.degree[d] : std::max(degree[d], net.degree[d]);
    }
    const BernsteinForm whole = raised(net, degree);
    for (std::size_t d = 0; d < element.degree.size(); ++d) element.degree[d] = static_cast<std::int8_t>(degree[d]);
    element.offset = cells_.table.nets.size();
    cells_.table.nets.insert(cells_.table.nets.end(), whole.rows.data(), whole.rows.data() + whole.rows.size());
    cells_.table.elements.push_back(element);
    const auto append = [&](const Eigen::MatrixXd& coefficients, std::vector<double>& values) {
      BernsteinForm form{degrees_of(field), bernstein_coefficients(space_, index, coefficients)};
      if (times_weights) form = product(form, {net.degree, net.rows.bottomRows(1)});
      const Eigen::MatrixXd control = control_values(raised(form, degree), whole.rows.bottomRows(1));
      values.insert(values.end(), control.data(), control.data() + control.size());
    };
    append(solution_.potential, cells_.potential);
    append(solution_.flux, cells_.flux);
  }

  const solver::FieldSpace<Dim>& space_;
  const solver::Solution<Dim>& solution_;
  SolutionCells<Dim> cells_;
};

}  // namespace

template <int Dim>
SolutionCells<Dim> solution_cells(const solver::FieldSpace<Dim>& space, const solver::Solution<Dim>& solution) {
  return CellBuilder<Dim>(space, solution).build();
}

template SolutionCells<2> solution_cells(const solver::FieldSpace<2>&, const solver::Solution<2>&);
template SolutionCells<3> solution_cells(const solver::FieldSpace<3>&, const solver::Solution<3>&);

}  // namespace isorim::io
