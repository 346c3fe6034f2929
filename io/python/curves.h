#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include <pybind11/numpy.h>

#include "geometry/nurbs/curve.h"

namespace isorim::python {

/// A copy, a row for each column.
inline pybind11::array_t<double> rows_of(const Eigen::Ref<const Eigen::MatrixXd>& columns) {
  pybind11::array_t<double> rows({pybind11::ssize_t{columns.cols()}, pybind11::ssize_t{columns.rows()}});
  std::copy(columns.data(), columns.data() + columns.size(), rows.mutable_data());
  return rows;
}

inline pybind11::array_t<double> array_of(const std::vector<double>& values) {
  return pybind11::array_t<double>(static_cast<pybind11::ssize_t>(values.size()), values.data());
}

/// degree, knots, points (n x Dim), weights: a curve as case files have it.
template <int Dim>
pybind11::dict curve_dict(const geometry::NurbsCurve<Dim>& curve) {
  pybind11::dict result;
  result["type"] = "nurbs";
  result["degree"] = curve.degree();
  const std::span<const double> knots = curve.knots().knots();
  result["knots"] = array_of({knots.begin(), knots.end()});
  result["points"] = rows_of(Eigen::MatrixXd(curve.control_points()));
  const Eigen::VectorXd weights = curve.weights();
  result["weights"] = array_of({weights.begin(), weights.end()});
  return result;
}

}  // namespace isorim::python
