// A model behind an input that is filtered: by a drive before the process, an instrument behind it.
#pragma once

#include "fmbpc/model/ts_model.hpp"

namespace fpc {

/// Replaces, in the consequents of one output, an input or measured disturbance v(k - lag) by
/// sum_j response_j v(k - lag - j). What filters the output filters its inputs: an instrument of
/// unit gain behind the process is carried in the same way (exactly where the rules do not change).
/// Antecedents stay.
void filterRegressor(OutputModel& model, SignalKind kind, int index, VectorRef response);

}  // namespace fpc
