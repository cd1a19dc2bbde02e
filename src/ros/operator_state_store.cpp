#include "ros/operator_state_store.hpp"

#include <algorithm>
#include <utility>

#include "ros/topics.hpp"

namespace fpc {
namespace {

constexpr double kKeptPatience = 2.0;  // [s] for the word of a controller that may be there

}  // namespace

OperatorStateStore::OperatorStateStore(ros::NodeHandle node, const LoopFile& loop, std::string name)
    : Node(node, loop, std::move(name)),
      goes_on_(loop.gateway.enabled()),
      kept_(node.advertise<fmbpc::OperatorState>(topics::kOperatorKept, 1, true)),
      model_kept_(node.advertise<fmbpc::FuzzyModel>(topics::kModelKept, 1, true)),
      subscriber_(subscribe(node, topics::kOperatorState, 10, &OperatorStateStore::onState, this)) {
  if (loop.has_identify || loop.has_model)
    model_subscriber_ = subscribe(node, topics::kFuzzyModel, 1, &OperatorStateStore::onModel, this);
}

void OperatorStateStore::beginRun(std::uint64_t run_id) {
  run_id_ = run_id;
  model_kept_.publish(fmbpc::FuzzyModel());
}

// An empty message (of no node) says that nothing was asked yet, so that nobody waits for more.
void OperatorStateStore::start() {
  fmbpc::OperatorState stands;
  if (standing_) {
    stands = *standing_;
    ROS_WARN("%s: came back: the plant went on; setpoints and schedule of %s stand", name().c_str(),
             stands.node.c_str());
  }
  stands.run_id = run_id_;
  kept_.publish(stands);
  standing_.reset();
  begun_ = true;
}

void OperatorStateStore::onState(const fmbpc::OperatorState::ConstPtr& msg) {
  if (msg->run_id == run_id_)
    kept_.publish(*msg);
  else if (goes_on_ && !begun_)
    standing_ = *msg;
}

void OperatorStateStore::hear(const fmbpc::LoopState& state) {
  const auto& controllers = authority().publishersOf(topics::kTracking);
  if (std::find(controllers.begin(), controllers.end(), state.node) == controllers.end()) return;
  heard_ = true;
  was_in_run_ = state.run_id != 0 && state.run_id != run_id_;
}

bool OperatorStateStore::knowsWhatStands(double now_s) {
  if (!goes_on_ || begun_ || standing_ || (heard_ && !was_in_run_)) return true;
  if (since_s_ < 0) since_s_ = now_s;
  return now_s - since_s_ > kKeptPatience;
}

void OperatorStateStore::onModel(const fmbpc::FuzzyModel::ConstPtr& msg) {
  if (msg->run_id == run_id_) model_kept_.publish(*msg);
}

}  // namespace fpc
