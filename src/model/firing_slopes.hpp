// How the weights of the rules change with what the rules ask for.
#pragma once

#include "fmbpc/model/ts_model.hpp"

namespace fpc {

/// d weight_r / d z_i at the antecedent values z (n_antecedents) whose weights are `firing`, into
/// `slopes` (n_rules x n_antecedents, its size before): w_r (s_ri - sum_q w_q s_qi), s = d log(mu)
/// / dz. Zero where no rule fired. The right-hand derivative at a corner of a set. No allocation.
void firingSlopes(const OutputModel& model, VectorRef z, const FiringResult& firing,
                  Matrix& slopes);

}  // namespace fpc
