#include "ros/optimizer_standin.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ros/conversions.hpp"
#include "ros/queues.hpp"
#include "ros/topics.hpp"

namespace fpc {

OptimizerStandin::OptimizerStandin(ros::NodeHandle node, const LoopFile& loop, std::string name,
                                   const Comeback& comeback)
    : Node(node, loop, std::move(name)),
      watch_(loop.exchange.pace, loop.plant_info.sample_time_s / loop.exchange.speedup,
             loop.exchange.optimizer_timeout_s),
      optimizer_(node.resolveName("clp_optimizer")),
      action_(node, topics::kControlAction, comeback, audienceOf(node, authority())),
      report_(node, topics::kSolverReport, comeback, audienceOf(node, authority())),
      subscriber_(subscribe(node, topics::kControlAction, queueOf(ListenerKind::kPeer),
                            &OptimizerStandin::onAction, this)),
      timer_(guardedTimer(
          node, 1.0, "standin", [this] { onTimer(); }, SteadyTimer::Kind::kOnce)) {}

void OptimizerStandin::asked(const ControllerAnswer& answer, bool repeated) {
  if (!answer.has_action) return;
  if (repeated) {
    if (sent_) send(true);  // the plant has missed it
    return;
  }
  base_ = answer.base;
  sent_ = false;
  unheard_ = 0;
  if (watch_.asked(base_.header, steadyNow()))
    takeOver();
  else
    arm();
}

void OptimizerStandin::onAction(const fmbpc::ControlAction::ConstPtr& msg,
                                const std::string& publisher) {
  if (isOwn(*msg, publisher)) return;
  guarded(topics::kControlAction, [&] { watch_.answered(fromMsg(*msg).header); });
}

// What this node has sent comes back to it. An optimizer without anything to constrain answers the
// very same, so only the publisher tells; in a nodelet manager all have one name, and whatever
// comes more often than it was sent is the optimizer's.
bool OptimizerStandin::isOwn(const fmbpc::ControlAction& msg, const std::string& publisher) {
  if (publisher != ros::this_node::getName() || unheard_ == 0) return false;
  const bool same = msg.run_id == base_.header.run_id && msg.step == base_.header.step &&
                    msg.source == static_cast<std::uint8_t>(base_.source) &&
                    std::equal(msg.input.begin(), msg.input.end(), base_.input.data(),
                               base_.input.data() + base_.input.size());
  if (same) --unheard_;
  return same;
}

void OptimizerStandin::send(bool repeated) {
  ++unheard_;
  action_.publish(toMsg(base_), repeated);
}

void OptimizerStandin::arm() {
  const double due_s = watch_.deadline();
  if (std::isfinite(due_s)) timer_.startIn(due_s - steadyNow());
}

void OptimizerStandin::onTimer() {
  if (watch_.mustTakeOver(steadyNow()))
    takeOver();
  else
    arm();
}

void OptimizerStandin::takeOver() {
  sent_ = true;
  send(false);
  SolverReport report;
  report.header = base_.header;
  report.perturbation = Vector::Zero(base_.input.size());
  report.status = SolveStatus::kNotRun;
  report_.publish(toMsg(report), false);
  if (log_.pass())
    ROS_WARN("%s: sample %u: no answer of %s, the base action goes to the plant", name().c_str(),
             base_.header.step, optimizer_.c_str());
}

}  // namespace fpc
