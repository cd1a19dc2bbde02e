// What one model may hand over to another. Private to the core.
#pragma once

#include "fmbpc/model/ts_model.hpp"

namespace fpc {

/// States of both mean the same: the same lags of every signal.
bool sameLags(const TsModel& a, const TsModel& b);
/// Only the consequents differ, as those of a model that learns.
bool sameRules(const TsModel& a, const TsModel& b);
/// Both outputs have the same rules' sets on the same variables: one set of weights.
bool sameWeights(const OutputModel& a, const OutputModel& b);

}  // namespace fpc
