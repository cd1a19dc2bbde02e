// Messages of the action IdentifyModel from the core's structs.
#pragma once

#include <fmbpc/IdentifyModelFeedback.h>
#include <fmbpc/IdentifyModelResult.h>

#include "identification/record_identification.hpp"

namespace fpc {

fmbpc::IdentifyModelFeedback toFeedback(const RecordProgress& progress);
/// All but `ok` and `message`. The remarks of reportModel() are among the remarks.
fmbpc::IdentifyModelResult toResult(const RecordIdentification& identification);

}  // namespace fpc
