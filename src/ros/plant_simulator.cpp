#include "fmbpc/ros/plant_simulator.hpp"

#include <algorithm>
#include <sstream>

#include "fmbpc/base/text.hpp"
#include "fmbpc/loop/factory.hpp"
#include "fmbpc/ros/conversions.hpp"
#include "fmbpc/ros/topics.hpp"

namespace fpc {
namespace {

constexpr double kResendPeriod = 0.05;  // [s] of wall time

std::vector<std::string> namesToWaitFor(const LoopFile& loop, const ros::NodeHandle& private_node) {
  std::vector<std::string> names = loop.ring.wait_for;
  std::istringstream also(private_node.param<std::string>("also_wait_for", ""));
  for (std::string name; also >> name;) names.push_back(name);
  return names;
}

}  // namespace

std::string PlantSimulator::idleReason(const LoopFile& loop) {
  return loop.external_plant ? loop.name + " has an external plant" : "";
}

PlantSimulator::PlantSimulator(ros::NodeHandle node, ros::NodeHandle private_node,
                               const LoopFile& loop)
    : loop_(loop),
      simulation_(makeSimulation(loop)),
      publishers_(node, simulation_, loop.ring.publish_clock),
      ready_(node, namesToWaitFor(loop, private_node)),
      lines_(loop.tf.sample_lines),
      pacer_(loop.ring.pace, loop.simulation.sample_time_s / loop.ring.speedup),
      begun_(ros::WallTime::now()),
      action_subscriber_(subscribe(node, topics::kControlAction, topics::kRingQueue,
                                   &PlantSimulator::onAction, this)),
      disturbance_subscriber_(subscribe(node, topics::kDisturbance, topics::kViewQueue,
                                        &PlantSimulator::onDisturbance, this)),
      pause_(private_node.advertiseService(topics::kPause, &PlantSimulator::onPause, this)),
      step_(private_node.advertiseService(topics::kStep, &PlantSimulator::onStep, this)),
      reset_(private_node.advertiseService(topics::kReset, &PlantSimulator::onReset, this)),
      poll_timer_(node.createWallTimer(ros::WallDuration(kResendPeriod),
                                       [this](const ros::WallTimerEvent&) { onPoll(); })),
      pace_timer_(node.createWallTimer(
          ros::WallDuration(kResendPeriod), [this](const ros::WallTimerEvent&) { tryAdvance(); },
          true, false)),
      diagnostics_(node, private_node, "plant", loop.name,
                   [this](Diagnostics::Status& status) { report(status); }) {
  beginRun();
  frames_.broadcast(loop_.tf, simulation_.info().header.time_ns);
}

// A new run: larger run_id than any before, also than those of an earlier process.
void PlantSimulator::beginRun() {
  run_id_ = std::max(run_id_ + 1, ros::WallTime::now().toNSec());
  have_action_ = false;
  simulation_.reset(run_id_);
  publishers_.introduce(simulation_);
}

void PlantSimulator::start() {
  phase_ = Phase::kRunning;
  pacer_.restart(ros::WallTime::now());
  ROS_INFO("plant_simulator: run %lu of %s starts", run_id_, loop_.name.c_str());
  publishSample();
}

void PlantSimulator::onPoll() {
  if (phase_ == Phase::kWaiting) return waitForOthers();
  const bool unanswered = phase_ == Phase::kRunning && !have_action_;
  if (unanswered && ros::WallTime::now() - sent_ >= ros::WallDuration(kResendPeriod))
    publishers_.resend();
}

std::vector<std::string> PlantSimulator::missing() const {
  std::vector<std::string> names = ready_.missing();
  const std::vector<std::string> lines = lines_.missing();
  names.insert(names.end(), lines.begin(), lines.end());
  return names;
}

void PlantSimulator::waitForOthers() {
  for (const auto& [output, delay_s] : lines_.poll()) {
    const auto& outputs = simulation_.info().outputs;
    const auto found =
        std::find_if(outputs.begin(), outputs.end(),
                     [&name = output](const SignalInfo& o) { return o.name == name; });
    simulation_.setOutputDelay(static_cast<std::size_t>(found - outputs.begin()), delay_s);
  }
  const std::vector<std::string> names = missing();
  if (names.empty()) return start();
  if ((ros::WallTime::now() - begun_).toSec() < loop_.ring.ready_timeout_s) return;
  fail("not ready within loop.ready_timeout_s = " + exactText(loop_.ring.ready_timeout_s) +
       " s: " + join(names));
}

void PlantSimulator::onAction(const fmbpc::ControlAction::ConstPtr& msg) {
  guarded(topics::kControlAction, [&] {
    const ControlAction action = fromMsg(*msg);
    if (!admit(action)) return;
    action_ = action.input;
    have_action_ = true;
    tryAdvance();
  });
}

bool PlantSimulator::admit(const ControlAction& action) {
  const bool awaited = phase_ == Phase::kRunning && !have_action_;
  if (!awaited || !simulation_.answers(action.header)) {
    countStray(action.header);
    return false;
  }
  if (action.input.size() != static_cast<Eigen::Index>(simulation_.info().inputs.size())) {
    ++counts_.wrong_size;
    return false;
  }
  if (!action.input.allFinite()) {
    ++counts_.not_finite;
    return false;
  }
  ++counts_.accepted;
  return true;
}

// Dropped, each kind apart: of another run, for a later sample, the last answer again, older.
void PlantSimulator::countStray(const StepHeader& header) {
  const std::uint32_t now = simulation_.measurement().header.step;
  const std::uint32_t answered = have_action_ ? now + 1 : now;  // samples answered so far
  if (header.run_id != run_id_)
    ++counts_.other_run;
  else if (header.step >= answered)
    ++counts_.gaps;
  else if (header.step + 1 == answered)
    ++counts_.repeated;
  else
    ++counts_.old;
}

// Moves on if the run is on, not paused, the pace allows it, and there is an input (or, in
// realtime, its time is up).
void PlantSimulator::tryAdvance() {
  if (phase_ != Phase::kRunning || (paused_ && steps_allowed_ == 0)) return;
  if (!paused_ && !pacer_.due(ros::WallTime::now())) return armTimer();
  if (have_action_) {
    simulation_.advance(action_);
  } else if (pacer_.pace() == Pace::kRealtime && !paused_) {
    simulation_.advanceWithoutAction();
    ++missing_inputs_;
    if (trouble_log_.pass())
      ROS_WARN("plant_simulator: no action in time (%lu so far)", missing_inputs_);
  } else {
    return;
  }
  if (paused_) --steps_allowed_;
  pacer_.sent(ros::WallTime::now());
  publishSample();
}

void PlantSimulator::publishSample() {
  have_action_ = false;
  sent_ = ros::WallTime::now();
  publishers_.sample(simulation_);
  if (!simulation_.trouble().empty() && trouble_log_.pass())
    ROS_WARN("plant_simulator: %s", simulation_.trouble().c_str());
  if (simulation_.measurement().final) {
    phase_ = Phase::kFinished;
    ROS_INFO("plant_simulator: final sample %u sent", simulation_.measurement().header.step);
  } else if (pacer_.timed()) {
    armTimer();
  }
}

void PlantSimulator::armTimer() {
  pace_timer_.stop();
  if (paused_) return;
  pace_timer_.setPeriod(pacer_.remaining(ros::WallTime::now()));
  pace_timer_.start();
}

void PlantSimulator::onDisturbance(const fmbpc::Disturbance::ConstPtr& msg) {
  guarded(topics::kDisturbance, [&] {
    const Command command = fromMsg(*msg);
    const std::uint32_t step = simulation_.command(command);
    ROS_INFO("plant_simulator: disturbance of %s from sample %u on", join(command.name).c_str(),
             step);
  });
}

bool PlantSimulator::onPause(std_srvs::SetBool::Request& request,
                             std_srvs::SetBool::Response& response) {
  paused_ = request.data != 0;
  steps_allowed_ = 0;
  if (!paused_) {
    pacer_.restart(ros::WallTime::now());
    tryAdvance();
  }
  response.success = true;
  response.message = paused_ ? "paused" : "running";
  return true;
}

bool PlantSimulator::onStep(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  response.success = paused_ && phase_ == Phase::kRunning;
  response.message = !paused_                    ? "pause first"
                     : phase_ != Phase::kRunning ? "there is no run under way"
                                                 : "one sample";
  if (response.success) {
    ++steps_allowed_;
    tryAdvance();
  }
  return true;
}

bool PlantSimulator::onReset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  response.success = phase_ != Phase::kWaiting;
  response.message = response.success ? "sample 0 of a new run" : "the first run has not begun";
  if (response.success) {
    steps_allowed_ = 0;
    beginRun();
    start();
  }
  return true;
}

void PlantSimulator::reportWords(Diagnostics::Status& status) const {
  using diagnostic_msgs::DiagnosticStatus;
  const std::uint32_t step = simulation_.measurement().header.step;
  if (phase_ == Phase::kWaiting)
    status.summary(DiagnosticStatus::WARN, "waiting for " + join(missing()));
  else if (!simulation_.trouble().empty())
    status.summary(DiagnosticStatus::ERROR, simulation_.trouble());
  else if (phase_ == Phase::kFinished)
    status.summary(DiagnosticStatus::OK, "finished");
  else if (paused_)
    status.summary(DiagnosticStatus::OK, "paused");
  else if ((ros::WallTime::now() - sent_).toSec() > 1.0 && !pacer_.timed() && !have_action_)
    status.summary(DiagnosticStatus::WARN, "no action for sample " + std::to_string(step));
  else
    status.summary(DiagnosticStatus::OK, "running");
}

void PlantSimulator::report(Diagnostics::Status& status) const {
  reportWords(status);
  status.add("run_id", run_id_);
  status.add("step", simulation_.measurement().header.step);
  status.add("actions accepted", counts_.accepted);
  status.add("actions dropped: repeated", counts_.repeated);
  status.add("actions dropped: old step", counts_.old);
  status.add("actions dropped: later step", counts_.gaps);
  status.add("actions dropped: other run", counts_.other_run);
  status.add("actions dropped: wrong size", counts_.wrong_size);
  status.add("actions dropped: not finite", counts_.not_finite);
  status.add("measurements sent again", publishers_.resent());
  status.add("inputs missing", missing_inputs_);
  status.add("realtime slips", pacer_.slips());
  addRefused(status, refused());
}

}  // namespace fpc
