// What a plant says of itself in the diagnostics.
#include "ros/plant_node.hpp"

namespace fpc {

void PlantNode::sayLast() {
  health_.sayLast("the plant is shut down at sample " +
                  std::to_string(session_.process().measurement().header.step));
}

void PlantNode::report(Diagnostics::Status& status) const {
  const ActionCounts& counts = session_.counts();
  status.add("run_id", run_id_);
  status.add("step", session_.process().measurement().header.step);
  status.add("actions accepted", counts.accepted);
  status.add("actions dropped: repeated", counts.repeated);
  status.add("actions dropped: old step", counts.old);
  status.add("actions dropped: later step", counts.later);
  status.add("actions dropped: other run", counts.other_run);
  status.add("actions dropped: wrong size", counts.wrong_size);
  status.add("actions dropped: not finite", counts.not_finite);
  status.add("measurements sent again", publishers_.resent());
  status.add("inputs missing", session_.missingInputs());
  status.add("realtime slips", session_.pacer().slips());
  addValues(status);
  addRefused(status, refused());
  addRefused(status, authority().refused());
  addRefused(status, ready_.authority().refused());
  addRefused(status, keeper_.authority().refused());
}

}  // namespace fpc
