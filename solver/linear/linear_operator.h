#pragma once

#include <cstddef>

#include <Eigen/Core>

namespace isorim::solver {

/// A matrix by what it does to vectors: dense, compressed, the inverse of a factorisation, or one that another library
/// holds.
class LinearOperator {
 public:
  virtual ~LinearOperator() = default;
  virtual Eigen::Index rows() const = 0;
  virtual Eigen::Index cols() const = 0;
  /// result += A x (x of cols(), result of rows() entries; they do not overlap).
  virtual void add_product(const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::Ref<Eigen::VectorXd> result) const = 0;
  /// Bytes that the matrix takes.
  virtual std::size_t memory() const = 0;

  /// A x.
  Eigen::VectorXd product(const Eigen::Ref<const Eigen::VectorXd>& x) const {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(rows());
    add_product(x, result);
    return result;
  }
};

}  // namespace isorim::solver
