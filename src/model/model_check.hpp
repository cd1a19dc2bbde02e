// May this model take over in a running loop?
#pragma once

#include "fmbpc/base/exchange.hpp"
#include "fmbpc/model/ts_model.hpp"

namespace fpc {

/// Largest modulus of the poles of the model's free run at a sample: rules weighed as they fire
/// there, outputs coupled. The sample is taken as a state of rest, u(k) = input_applied. `model`
/// must be matched to the plant. Source: Takagi-Sugeno local linearisation with frozen weights,
/// vallejo2021a, sec. 3.
double largestPole(const TsModel& model, const Measurement& at);

/// @throws InputError naming the pole unless largestPole() <= limit (to 1e-9) and finite. An
/// infinite limit allows all.
void requireStable(const TsModel& model, const Measurement& at, double limit);

}  // namespace fpc
