// The closed loop as vallejo2021a reduces it, to be compared with the printed tables. Private: no
// controller and no user needs it.
#pragma once

#include "analysis/closed_loop.hpp"

namespace fpc {

/// The paper's analysis, which takes u(k-1) for an input of its own:
///   M = A^(H-1) B + (sum_{i<=H-2} A^i) B [1 0; 1 0],   A_CL = A - B M^-1 C A^H, C = I.
/// M is never inverted: with A = [a b; 0 f], B = [m n; p 0] its second row is [m2 0], so that
///   u = -f^H x2 / m2,   n a^(H-1) u' = -(A^H x)_1 - m1 u.
/// Source: vallejo2021a, eqs. 41-48.
/// @throws InputError unless A and B have that shape, p != 0, n != 0, and horizon >= 1.
Matrix paperReducedLoop(MatrixRef A, MatrixRef B, int horizon);
/// Eigenvalue 2 of the paper, eq. 59: f sum_{i<=H-2} f^i / sum_{i<=H-1} f^i.
double paperSecondEigenvalue(double f, int horizon);
/// The true loop of the same matrices, u(k-1) as a state: eigenvalues {0, a, eig2}.
LinearModel paperModel(MatrixRef A, MatrixRef B);

}  // namespace fpc
