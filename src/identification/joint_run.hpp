// Free runs of several outputs together, each from the others' simulated values.
#pragma once

#include "identification/auto_candidate.hpp"

namespace fpc {

/// A fitted model of the measured past of one output, and what acts on it (scaled, see
/// recurrentData()).
struct JointMember {
  const Fitted* fitted{};
  const RecurrentData* record{};
};

/// One member per output, in their order. `measured` (rows x n_y, scaled) starts the runs. Rows x
/// n_y in scaled units; NaN before the start and in gaps of the inputs, after which runs start
/// anew.
Matrix jointFreeRun(const std::vector<JointMember>& members, const Matrix& measured,
                    Stretch stretch);

}  // namespace fpc
