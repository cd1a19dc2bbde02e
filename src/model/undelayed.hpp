// Models of processes with a transport delay, taken apart into the delay and what is left.
#pragma once

#include "fmbpc/model/ts_model.hpp"

namespace fpc {

/// The delay that all of the model shares: the smallest lag of an input or a disturbance in any
/// antecedent or consequent [samples]; 0 if there is none.
int transportDelay(const TsModel& model);

/// The longest dead time from an input to an output [samples]: the largest, over these pairs, of
/// the smallest lag of the input in the consequents; 0 if no input acts.
int longestDeadTime(const TsModel& model);

/// The same model with all lags of inputs and disturbances shorter by `samples`: its output is what
/// the delayed one shows `samples` later. @throws InputError naming delay_steps unless
/// 0 <= samples <= transportDelay(model).
TsModel withoutDelay(TsModel model, int samples);

}  // namespace fpc
