#pragma once

#include "FactorSet.h"

#include <Eigen/Core>

namespace viwo
{
/** The information matrix of the blocks of a prepared set that are not eliminated, in the order of their columns, from the normal equations
 *  (Schur complement of the landmarks, Cholesky for the rest): fast, with half the digits of a triangular factorisation of the Jacobian.
 *  @return false where the normal equations are singular.
 */
bool marginalInformation(FactorSet& factors, Eigen::MatrixXd& information);
}  // namespace viwo
