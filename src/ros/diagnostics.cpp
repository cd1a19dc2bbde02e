#include "ros/diagnostics.hpp"

#include <utility>

#include "ros/guard.hpp"

namespace fpc {

Diagnostics::Diagnostics(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                         const std::string& title, const std::string& hardware_id,
                         std::function<void(Status&)> report)
    : updater_(node, private_node) {
  updater_.setHardwareID(hardware_id);
  updater_.add(title, [report = std::move(report)](Status& status) { report(status); });
  timer_ = SteadyTimer(node, 1.0, [this] {
             const auto say = [this](const char* what) {
               if (log_.pass()) ROS_ERROR("diagnostics: %s", what);
             };
             callGuarded([this] { updater_.force_update(); }, say, say);
           }).started();
}

void addCounts(Diagnostics::Status& status, const ArrivalCounts& counts) {
  status.add("accepted", counts.accepted);
  status.add("repeated", counts.repeated);
  status.add("gaps", counts.gaps);
  status.add("new runs", counts.new_runs);
  status.add("back to the plant's step", counts.resyncs);
  status.add("dropped: old step", counts.old);
  status.add("dropped: step too far ahead", counts.suspect);
  status.add("dropped: other run", counts.other_run);
  status.add("dropped: wrong size", counts.wrong_size);
  status.add("not finite", counts.not_finite);
}

void addRefused(Diagnostics::Status& status, const std::map<std::string, std::uint64_t>& refused) {
  for (const auto& [topic, count] : refused) status.add("refused: " + topic, count);
}

}  // namespace fpc
