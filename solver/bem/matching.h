#pragma once

#include <vector>

#include <Eigen/Core>

namespace isorim::solver {

/// For each row of a square matrix of costs the column that it gets so that each column is given once and the sum of
/// the costs is least (the Hungarian method with potentials, O(n^3); R. Jonker & A. Volgenant, Computing 38, 1987).
std::vector<int> cheapest_matching(const Eigen::Ref<const Eigen::MatrixXd>& costs);

}  // namespace isorim::solver
