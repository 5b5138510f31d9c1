// The irradiance half of the joint norm, for a basis of which nothing is known but its values: irradiance is diagonal
// in spherical harmonics, E_lm = A_l L_lm (Ramamoorthi and Hanrahan 2001). For the encoders' sources only (Eigen).
#pragma once

#include <Eigen/Dense>

#include "core/math/harmonics.h"

namespace lobelia {

/// Degree to which irradiance is followed: A_l^2 beyond it is below 7e-5 of A_0^2.
inline constexpr std::size_t k_irradiance_degree = 6;

struct IrradianceNorm {
    Eigen::MatrixXd gram;            ///< <E_i, E_j> over all normals, E_i the irradiance of function i
    Eigen::MatrixXd functions;       ///< row i: A_l^2 times the harmonic coefficients of B_i
    Eigen::VectorXd constant;        ///< harmonic coefficients of the constant 1 on the domain
    Eigen::VectorXd squared_cosine;  ///< A_l^2 for each harmonic

    explicit IrradianceNorm(const LinearBasis& basis);
};

}  // namespace lobelia
