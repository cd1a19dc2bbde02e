#include "ros/operator_keeper.hpp"

#include <utility>

#include "ros/topics.hpp"

namespace fpc {

OperatorKeeper::OperatorKeeper(ros::NodeHandle node, const LoopFile& loop, std::string name)
    : Node(node, loop, std::move(name)),
      kept_(node.advertise<fmbpc::OperatorState>(topics::kOperatorKept, 1, true)),
      model_kept_(node.advertise<fmbpc::FuzzyModel>(topics::kModelKept, 1, true)),
      subscriber_(subscribe(node, topics::kOperatorState, 10, &OperatorKeeper::onState, this)) {
  if (loop.has_identify || loop.has_model)
    model_subscriber_ = subscribe(node, topics::kFuzzyModel, 1, &OperatorKeeper::onModel, this);
}

// An empty message says that nothing was asked yet, so that nobody waits for more.
void OperatorKeeper::beginRun(std::uint64_t run_id) {
  run_id_ = run_id;
  fmbpc::OperatorState nothing;
  nothing.run_id = run_id;
  kept_.publish(nothing);
  model_kept_.publish(fmbpc::FuzzyModel());
}

void OperatorKeeper::onState(const fmbpc::OperatorState::ConstPtr& msg) {
  if (msg->run_id == run_id_) kept_.publish(*msg);
}

void OperatorKeeper::onModel(const fmbpc::FuzzyModel::ConstPtr& msg) {
  if (msg->run_id == run_id_) model_kept_.publish(*msg);
}

}  // namespace fpc
