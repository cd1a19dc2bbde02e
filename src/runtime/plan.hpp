// The inputs that a law plans, and who else takes them for what it expects.
#pragma once

#include "control/controller_around.hpp"
#include "fmbpc/base/exchange.hpp"
#include "runtime/link_inbox.hpp"
#include "runtime/session.hpp"

namespace fpc {

/// n_u n_c, column i is u(k+i) of the law's own model and feedback: what an optimizer changes is
/// not in it.
Matrix planOf(const PredictiveAction& action);

/// Plans that other loops made, as what the law expects of its disturbances at `sample`.
void takePlans(LinkInbox& inbox, const StepHeader& sample, const PlantInfo& plant,
               ControllerSession& session);

}  // namespace fpc
