#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <numbers>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "solver/linear/cross_approximation.h"
#include "solver/linear/hierarchical_matrix.h"

/// Matrices of kernels between points, for the tests of solver/linear/.
namespace isorim::solver::testing {

using Eigen::Index;
using Eigen::Matrix3Xd;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// Entries of the C x C block of a target i and a node j.
using Kernel = std::function<void(Index i, Index j, Eigen::Ref<MatrixXd> block)>;

/// C components a point, targets and nodes numbered alike.
struct KernelMatrix final : MatrixSource {
  Kernel kernel;
  int components = 1;
  std::vector<std::int32_t> groups;

  KernelMatrix(Kernel k, int c = 1) : kernel(std::move(k)), components(c) {}

  void dense_block(std::span<const std::int32_t> rows, std::span<const std::int32_t> columns, int /*thread*/,
                   Eigen::Ref<MatrixXd> block) const override {
    for (std::size_t j = 0; j < columns.size(); ++j)
      for (std::size_t i = 0; i < rows.size(); ++i)
        kernel(rows[i], columns[j],
               block.block(static_cast<Index>(i) * components, static_cast<Index>(j) * components, components,
                           components));
  }

  LowRank low_rank_block(std::span<const std::int32_t> rows, std::span<const std::int32_t> columns,
                         const Accuracy& accuracy, int /*thread*/) const override;

  MatrixXd dense(Index targets, Index nodes) const {
    MatrixXd result(targets * components, nodes * components);
    for (Index j = 0; j < nodes; ++j)
      for (Index i = 0; i < targets; ++i)
        kernel(i, j, result.block(i * components, j * components, components, components));
    return result;
  }
};

/// A block of a KernelMatrix that tells rows and columns, and counts them.
struct KernelBlock final : CrossSource {
  const KernelMatrix& matrix;
  std::span<const std::int32_t> row_indices;
  std::span<const std::int32_t> column_indices;
  Index evaluations = 0;

  KernelBlock(const KernelMatrix& m, std::span<const std::int32_t> r, std::span<const std::int32_t> c)
      : matrix(m), row_indices(r), column_indices(c) {}

  Index targets() const override { return std::ssize(row_indices); }
  Index nodes() const override { return std::ssize(column_indices); }
  int row_components() const override { return matrix.components; }
  int column_components() const override { return matrix.components; }
  void row(Index target, Eigen::Ref<MatrixXd> values) override {
    const Index c = matrix.components;
    MatrixXd block(c, c);
    for (Index j = 0; j < nodes(); ++j) {
      matrix.kernel(row_indices[static_cast<std::size_t>(target)], column_indices[static_cast<std::size_t>(j)], block);
      values.middleRows(j * c, c) = block.transpose();
    }
    evaluations += nodes();
  }
  void column(Index node, Eigen::Ref<MatrixXd> values) override {
    const Index c = matrix.components;
    for (Index i = 0; i < targets(); ++i)
      matrix.kernel(row_indices[static_cast<std::size_t>(i)], column_indices[static_cast<std::size_t>(node)],
                    values.middleRows(i * c, c));
    evaluations += targets();
  }
  std::int32_t group_of(std::span<const std::int32_t> indices, Index k) const {
    if (matrix.groups.empty()) return 0;
    return matrix.groups[static_cast<std::size_t>(indices[static_cast<std::size_t>(k)])];
  }
  std::int32_t target_group(Index target) const override { return group_of(row_indices, target); }
  std::int32_t node_group(Index node) const override { return group_of(column_indices, node); }
};

inline LowRank KernelMatrix::low_rank_block(std::span<const std::int32_t> rows, std::span<const std::int32_t> columns,
                                            const Accuracy& accuracy, int /*thread*/) const {
  KernelBlock block(*this, rows, columns);
  return cross_approximation(block, accuracy);
}

/// n points on the unit sphere, spread evenly along a spiral (Swinbank & Purser 2006).
inline Matrix3Xd sphere_points(Index n) {
  Matrix3Xd points(3, n);
  const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
  for (Index i = 0; i < n; ++i) {
    const double z = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / static_cast<double>(n);
    const double radius = std::sqrt(1.0 - z * z);
    const double angle = golden * static_cast<double>(i);
    points.col(i) << radius * std::cos(angle), radius * std::sin(angle), z;
  }
  return points;
}

/// n x n points on each face of the unit cube, with the faces' outward normals; face f holds columns [f n^2, (f+1)
/// n^2).
struct CubePoints {
  Matrix3Xd points;
  Matrix3Xd normals;
  std::vector<std::int32_t> faces;
};
inline CubePoints cube_points(Index n) {
  CubePoints cube{Matrix3Xd(3, 6 * n * n), Matrix3Xd::Zero(3, 6 * n * n), {}};
  Index next = 0;
  for (int face = 0; face < 6; ++face) {
    const Index axis = face / 2;
    for (Index i = 0; i < n; ++i) {
      for (Index j = 0; j < n; ++j, ++next) {
        cube.points(axis, next) = face % 2;
        cube.points((axis + 1) % 3, next) = (static_cast<double>(i) + 0.5) / static_cast<double>(n);
        cube.points((axis + 2) % 3, next) = (static_cast<double>(j) + 0.5) / static_cast<double>(n);
        cube.normals(axis, next) = face % 2 == 1 ? 1.0 : -1.0;
        cube.faces.push_back(face);
      }
    }
  }
  return cube;
}

inline Matrix3Xd random_points(Index n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  Matrix3Xd points(3, n);
  for (Index i = 0; i < n; ++i) points.col(i) << unit(random), unit(random), unit(random);
  return points;
}

inline VectorXd random_vector(Index n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  return VectorXd::NullaryExpr(n, [&](Index) { return unit(random); });
}

inline IndexPlaces places(const Matrix3Xd& points, int components = 1) {
  return {points, points, points, components};
}

inline std::shared_ptr<const BlockTree> block_tree(const Matrix3Xd& points, int components = 1, int leaf_size = 32,
                                                   const BlockTreeOptions& options = {}) {
  const auto clusters = std::make_shared<const ClusterTree>(places(points, components), leaf_size);
  return std::make_shared<const BlockTree>(clusters, clusters, options);
}

/// 1 / r, on the diagonal the self-term of a disc of area 4 pi / n on the unit sphere.
inline Kernel newton(Matrix3Xd points) {
  return [points = std::move(points)](Index i, Index j, Eigen::Ref<MatrixXd> block) {
    const double n = static_cast<double>(points.cols());
    const double r = (points.col(i) - points.col(j)).norm();
    block(0, 0) = r > 0.0 ? 1.0 / r : std::sqrt(n);
  };
}

/// -ln r, 0 for coincident points.
inline Kernel logarithm(Matrix3Xd points) {
  return [points = std::move(points)](Index i, Index j, Eigen::Ref<MatrixXd> block) {
    const double r = (points.col(i) - points.col(j)).norm();
    block(0, 0) = r > 0.0 ? -std::log(r) : 0.0;
  };
}

/// Kelvin's displacement times 16 pi mu (1 - nu), nu = 0.3.
inline Kernel kelvin(Matrix3Xd points) {
  return [points = std::move(points)](Index i, Index j, Eigen::Ref<MatrixXd> block) {
    const Vector3d d = points.col(i) - points.col(j);
    const double r = d.norm();
    const double n = static_cast<double>(points.cols());
    if (r > 0.0)
      block = (1.8 * Eigen::Matrix3d::Identity() + d * d.transpose() / (r * r)) / r;
    else
      block = std::sqrt(n) * 2.2 * Eigen::Matrix3d::Identity();
  };
}

/// (y - x) . n(y) / r^3: structured, zero between points of one plane.
inline Kernel double_layer(Matrix3Xd points, Matrix3Xd normals) {
  return [points = std::move(points), normals = std::move(normals)](Index i, Index j, Eigen::Ref<MatrixXd> block) {
    const Vector3d d = points.col(j) - points.col(i);
    const double r = d.norm();
    block(0, 0) = r > 0.0 ? d.dot(normals.col(j)) / (r * r * r) : 0.0;
  };
}

/// Kelvin's traction times 8 pi (1 - nu), nu = 0.3: antisymmetric, so singular, between points of one plane.
inline Kernel kelvin_traction(Matrix3Xd points, Matrix3Xd normals) {
  return [points = std::move(points), normals = std::move(normals)](Index i, Index j, Eigen::Ref<MatrixXd> block) {
    const Vector3d d = points.col(j) - points.col(i);
    const double r = d.norm();
    block.setZero();
    if (r == 0.0) return;
    const Vector3d e = d / r;
    const Vector3d n = normals.col(j);
    block = -(e.dot(n) * (0.4 * Eigen::Matrix3d::Identity() + 3.0 * e * e.transpose()) -
              0.4 * (e * n.transpose() - n * e.transpose())) /
            (r * r);
  };
}

/// |a - b| / |b|.
inline double relative_error(const MatrixXd& a, const MatrixXd& b) {
  return (a - b).norm() / b.norm();
}

}  // namespace isorim::solver::testing
