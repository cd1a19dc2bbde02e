#include "ros/clp_optimizer.hpp"

#include "base/same_sample.hpp"
#include "ros/conversions.hpp"
#include "ros/queues.hpp"
#include "ros/topics.hpp"
#include "runtime/factory.hpp"
#include "runtime/run_events.hpp"

namespace fpc {
namespace {

constexpr double kActionSilence = 1.0;  // [s] without a base action that is due
constexpr char kController[] = "fmbpc_controller";

}  // namespace

std::string ClpOptimizer::idleReason(const LoopFile& loop) {
  return loop.has_clp ? "" : loop.name + " has no section clp";
}

ClpOptimizer::ClpOptimizer(ros::NodeHandle node, const ros::NodeHandle& private_node,
                           const LoopFile& loop)
    : Node(node, loop, private_node.getNamespace()),
      session_(makeOptimizerSession(loop)),
      ready_(node, loop, name(), [this] { return plant_.open() && listeners_.connected(); }),
      signals_(node),
      plant_(loop),
      action_(node, topics::kControlAction, comeback_, audienceOf(node, authority())),
      report_(node, topics::kSolverReport, comeback_, audienceOf(node, authority())),
      plan_(node.advertise<fmbpc::InputPlan>(topics::kInputPlan, queueOf(ListenerKind::kViewer))),
      plan_hearers_(plan_),
      listeners_({action_.publisher(), report_.publisher()}),
      plant_subscriber_(subscribe(node, topics::kPlantInfo, 1, &ClpOptimizer::onPlantInfo, this)),
      base_subscriber_(
          subscribeLaw(node, topics::kBaseAction, loop.exchange.pace, &ClpOptimizer::onBase, this)),
      prediction_subscriber_(subscribeLaw(node, topics::kPredictiveAction, loop.exchange.pace,
                                          &ClpOptimizer::onPrediction, this)),
      summary_(node, loop, name()),
      pace_(loop.exchange.pace),
      period_s_(loop.plant_info.sample_time_s / loop.exchange.speedup),
      controller_(node.resolveName(kController)),
      health_(node, private_node, "optimizer", loop.name, false,
              {[this](double now_s) { return health(now_s); },
               [this] { return session_.report().header; },
               [this](Diagnostics::Status& status) { report(status); }}) {
  for (const SignalInfo& input : loop.plant_info.inputs) signals_.add(input.name + "_perturbation");
}

void ClpOptimizer::onPlantInfo(const fmbpc::PlantInfo::ConstPtr& msg) {
  guarded(topics::kPlantInfo, [&] {
    if (!plant_.introduce(*msg)) return;
    session_.announce(plant_.runId());
  });
}

template <typename Item>
void ClpOptimizer::receive(const Item& item) {
  if (!plant_.admits(item.header.run_id)) return;
  heard_s_ = steadyNow();
  if (listeners_.open() && session_.receive(item)) publish();  // if not, both will come again
}

void ClpOptimizer::onBase(const fmbpc::ControlAction::ConstPtr& msg) {
  guarded(topics::kBaseAction, [&] { receive(fromMsg(*msg)); });
}

void ClpOptimizer::onPrediction(const fmbpc::PredictiveAction::ConstPtr& msg) {
  guarded(topics::kPredictiveAction, [&] { receive(fromMsg(*msg)); });
}

void ClpOptimizer::publish() {
  const SolverReport& report = session_.report();
  const bool repeated = isSameSample(report.header, last_);
  comeback_.answered(report.header, heard_s_);
  action_.publish(toMsg(session_.action()), repeated);
  if (report_.needed()) report_.publish(toMsg(report), repeated);
  if (repeated) return;
  last_ = report.header;
  for (Eigen::Index i = 0; i < report.perturbation.size(); ++i)
    signals_.publish(static_cast<std::size_t>(i), report.header.time_ns, report.perturbation[i]);
  publishPlan();
  const Notice notice = noticeOf(report.status);
  if (notice.code == EventCode::kNone) return;
  health_.say({eventOf(notice, report.header.step)});
  if (*session_.trouble().c_str() != '\0' && log_.pass())
    ROS_WARN("clp_optimizer: sample %u: %s", report.header.step, session_.trouble().c_str());
}

void ClpOptimizer::publishPlan() {
  if (!plan_hearers_.any()) return;
  const StepHeader& sample = session_.report().header;
  fmbpc::InputPlan msg;
  msg.header.stamp = toStamp(sample.time_ns);
  msg.run_id = sample.run_id;
  msg.step = sample.step;
  msg.input = toMsg(session_.plan());
  plan_.publish(msg);
}

// What it can see of the loop's life: base actions.
Health ClpOptimizer::health(double now_s) const {
  const SolveStatus solve = session_.report().status;
  if (!plant_.problem().empty())
    return {LoopMode::kFailed, EventCode::kPlantDiffers, plant_.problem(), {}};
  if (!plant_.open())
    return {
        LoopMode::kStarting, EventCode::kWaiting, "waiting for plant_info", {"plant_simulator"}};
  if (session_.counts().accepted == 0)
    return {LoopMode::kStarting,
            EventCode::kWaiting,
            "waiting for the first base action",
            {controller_}};
  const double period_s = pace_ == Pace::kLockstep ? 0.0 : period_s_;
  if (const auto rest = summary_.rest()) return *rest;
  if (now_s - heard_s_ > period_s + kActionSilence)
    return {LoopMode::kStalled,
            EventCode::kNoAction,
            "no base action since sample " + std::to_string(session_.report().header.step),
            {controller_}};
  const Notice notice = noticeOf(solve);
  if (notice.code != EventCode::kNone) return {LoopMode::kDegraded, notice.code, notice.text, {}};
  return {LoopMode::kAutomatic,
          EventCode::kNone,
          solve == SolveStatus::kNotRun ? "passed through" : "solved",
          {}};
}

void ClpOptimizer::report(Diagnostics::Status& status) const {
  const SolverReport& last = session_.report();
  status.add("step", last.header.step);
  status.add("iterations", last.iterations);
  status.add("KKT residual", last.kkt_residual);
  status.add("solve time [us]", last.seconds * 1e6);
  addCounts(status, session_.counts());
  status.add("dropped: run not announced", plant_.foreign());
  addRefused(status, refused());
  addRefused(status, authority().refused());
}

template int runNode<ClpOptimizer>(int, char**, const std::string&);

}  // namespace fpc
