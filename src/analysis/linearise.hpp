// Linear behaviour near a point: Jacobians by central differences, and what a process does from
// sample to sample when its input is held and a local loop acts inside it.
#pragma once

#include <functional>

#include "fmbpc/base/types.hpp"

namespace fpc {

/// Writes m values of a vector of n; may throw.
using VectorFunction = std::function<void(VectorRef x, Eigen::Ref<Vector> value)>;

/// m n, by central differences; size: n typical sizes > 0 that set the steps. Not finite where the
/// function is not. @throws InputError on sizes; whatever the function throws.
Matrix jacobian(const VectorFunction& function, VectorRef x, Eigen::Index m, VectorRef size);

/// x(k+1) = A_d x(k) + B_d u(k) of dx/dt = A x + B u with u held over one sample, both by one
/// matrix exponential. Symbols: A n_x n_x, B n_x n_u; sample_time in the time unit of A.
struct SampledMatrices {
  Matrix A, B;
};
/// @throws InputError on sizes or unless sample_time > 0.
SampledMatrices sampleAndHold(MatrixRef A, MatrixRef B, double sample_time);

/// The same with a local loop that adds L_now x(k) + L_before x(k-1) to the input, held over the
/// sample: the matrix of (x(k), x(k-1)). Source: blazic2007, eq. 10, is
/// L_now = K e_T', L_before = -K e_T'. It is a map: stability is the unit circle, and the loop
/// acts on a difference one sample old, which no derivative in continuous time reproduces.
Matrix sampledLocalLoop(MatrixRef A, MatrixRef B, double sample_time, MatrixRef L_now,
                        MatrixRef L_before);

}  // namespace fpc
