// Row-by-row tables as Eigen matrices; for the encoders' sources only, never for a public header.
#pragma once

#include <Eigen/Dense>
#include <vector>

namespace lobelia {

using RowMatrixView = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;

[[nodiscard]] inline RowMatrixView as_matrix(const std::vector<double>& values, std::size_t columns) {
    return {values.data(), static_cast<Eigen::Index>(values.size() / columns), static_cast<Eigen::Index>(columns)};
}

}  // namespace lobelia
