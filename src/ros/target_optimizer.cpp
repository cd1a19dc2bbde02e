#include "ros/target_optimizer.hpp"

#include <utility>

#include "ros/conversions.hpp"
#include "ros/queues.hpp"
#include "ros/topics.hpp"
#include "runtime/factory.hpp"

namespace fpc {
namespace {

constexpr double kLookAtParked = 0.01;  // [s]
constexpr double kNoSample = 1.0;       // [s] without a measurement that is due

}  // namespace

std::string TargetOptimizer::idleReason(const LoopFile& loop) {
  return loop.targets.enabled ? "" : loop.name + " has no section targets";
}

TargetOptimizer::TargetOptimizer(ros::NodeHandle node, const ros::NodeHandle& private_node,
                                 const LoopFile& loop)
    : Node(node, loop, private_node.getNamespace()),
      loop_(loop),
      session_(makeTargetSession(loop)),
      inbox_(loop.has_identify && loop.exchange.pace == Pace::kLockstep),
      ready_(node, loop, name(),
             [this] { return plant_.open() && session_.ready() && listeners_.connected(); }),
      signals_(node),
      plant_(loop),
      targets_(node, topics::kTargets, comeback_, audienceOf(node, authority())),
      listeners_({targets_.publisher()}),
      plant_subscriber_(
          subscribe(node, topics::kPlantInfo, 1, &TargetOptimizer::onPlantInfo, this)),
      model_subscriber_(subscribe(node, topics::kFuzzyModel, 1, &TargetOptimizer::onModel, this)),
      identified_subscriber_(subscribe(node, topics::kIdentified, queueOf(ListenerKind::kPeer),
                                       &TargetOptimizer::onIdentified, this)),
      measurement_subscriber_(subscribeLaw(node, topics::kMeasurement, loop.exchange.pace,
                                           &TargetOptimizer::onMeasurement, this)),
      setpoint_subscriber_(subscribe(node, topics::kSetpoint, queueOf(ListenerKind::kViewer),
                                     &TargetOptimizer::onSetpoint, this)),
      parked_timer_(guardedTimer(node, kLookAtParked, "parked", [this] { answerParked(); })),
      summary_(node, loop, name()),
      health_(node, private_node, "targets", loop.name, false,
              {[this](double now_s) { return health(now_s); },
               [this] { return session_.answer().header; },
               [this](Diagnostics::Status& status) { report(status); }}) {
  for (const auto* list : {&loop.plant_info.outputs, &loop.plant_info.inputs})
    for (const SignalInfo& signal : *list) signals_.add(signal.name + "_target");
  for (const char* name : {"targets_cost", "targets_moved", "targets_travel"}) signals_.add(name);
}

void TargetOptimizer::onPlantInfo(const fmbpc::PlantInfo::ConstPtr& msg) {
  guarded(topics::kPlantInfo, [&] {
    if (!plant_.introduce(*msg)) return;
    session_.announce(plant_.runId());
    inbox_.announce(plant_.runId());
    answerParked();
  });
}

void TargetOptimizer::onModel(const fmbpc::FuzzyModel::ConstPtr& msg) {
  guarded(topics::kFuzzyModel, [&] {
    inbox_.put(matchToLoop(fromMsg(*msg), loop_), headerOf(*msg));
    StepHeader next = session_.answer().header;
    ++next.step;
    useModels(session_.counts().accepted > 0 ? next : StepHeader{});
    answerParked();
  });
}

void TargetOptimizer::onIdentified(const fmbpc::Identified::ConstPtr& msg) {
  guarded(topics::kIdentified, [&] {
    inbox_.hear(fromMsg(*msg));
    answerParked();
  });
}

void TargetOptimizer::useModels(const StepHeader& next) {
  for (const TsModel& model : inbox_.take(next)) session_.setModel(model);
}

void TargetOptimizer::onSetpoint(const fmbpc::Setpoint::ConstPtr& msg) {
  guarded(topics::kSetpoint, [&] { session_.command(fromMsg(*msg)); });
}

bool TargetOptimizer::mayAnswer(const Measurement& measurement) {
  return plant_.open() && plant_.runId() == measurement.header.run_id && session_.ready() &&
         listeners_.open() && inbox_.complete(measurement.header);
}

void TargetOptimizer::onMeasurement(const fmbpc::Measurement::ConstPtr& msg) {
  guarded(topics::kMeasurement, [&] {
    Measurement measurement = fromMsg(*msg);
    if (plant_.open() && !plant_.admits(measurement.header.run_id)) return;
    parked_ = std::move(measurement);
    answerParked();
  });
}

// The plant does not send a sample again that somebody has answered: it is kept until it can be.
void TargetOptimizer::answerParked() {
  if (!parked_) return parked_timer_.stop();
  if (plant_.open() && plant_.runId() != parked_->header.run_id) return parked_.reset();
  if (!mayAnswer(*parked_)) return parked_timer_.start();
  const Measurement measurement = std::move(*std::exchange(parked_, std::nullopt));
  heard_s_ = steadyNow();
  useModels(measurement.header);
  const Receipt receipt = session_.receive(measurement);
  if (receipt == Receipt::kDropped || receipt == Receipt::kNotReady) return;
  comeback_.answered(measurement.header, heard_s_);
  publish(receipt == Receipt::kRepeated);
}

void TargetOptimizer::publish(bool repeated) {
  const Targets& answer = session_.answer();
  fmbpc::Targets msg = toMsg(answer);
  msg.events = toMsg(session_.events());
  targets_.publish(std::move(msg), repeated);
  if (repeated) return;
  inbox_.takeEvents(answer.header);  // the controller says them
  health_.say(session_.events());
  std::size_t index = 0;
  const auto signal = [&](double value) {
    signals_.publish(index++, answer.header.time_ns, value);
  };
  for (const Vector* list : {&answer.outputs, &answer.inputs})
    for (Eigen::Index i = 0; i < list->size(); ++i) signal((*list)[i]);
  signal(answer.cost);
  signal(static_cast<double>(session_.moves().moved));
  signal(session_.moves().travel);
}

Health TargetOptimizer::health(double now_s) const {
  if (!plant_.problem().empty())
    return {LoopMode::kFailed, EventCode::kPlantDiffers, plant_.problem(), {}};
  if (!plant_.open())
    return {
        LoopMode::kStarting, EventCode::kWaiting, "waiting for plant_info", {"plant_simulator"}};
  if (!session_.ready())
    return {LoopMode::kStarting, EventCode::kWaiting, "waiting for a model", {"fuzzy_identifier"}};
  if (session_.counts().accepted == 0)
    return {LoopMode::kStarting, EventCode::kWaiting, "waiting for the first measurement", {}};
  if (const auto rest = summary_.rest()) return *rest;
  const double period_s = loop_.exchange.pace == Pace::kLockstep
                              ? 0.0
                              : loop_.plant_info.sample_time_s / loop_.exchange.speedup;
  if (now_s - heard_s_ > period_s + kNoSample)
    return {LoopMode::kStalled,
            EventCode::kNoMeasurement,
            "no measurement since sample " + std::to_string(session_.answer().header.step),
            {}};
  const Event worst = worstOf(session_.events());
  if (worst.severity() == Severity::kWarning)
    return {LoopMode::kDegraded, worst.code, textOf(session_.events()), {}};
  return {LoopMode::kAutomatic, EventCode::kNone, withRefusal("targets found", now_s), {}};
}

void TargetOptimizer::report(Diagnostics::Status& status) const {
  status.add("step", session_.answer().header.step);
  status.add("cost", session_.answer().cost);
  status.add("targets moved [samples]", session_.moves().moved);
  status.add("time [us]", session_.seconds() * 1e6);
  addCounts(status, session_.counts());
  status.add("dropped: run not announced", plant_.foreign());
  addRefused(status, refused());
  addRefused(status, authority().refused());
}

template int runNode<TargetOptimizer>(int, char**, const std::string&);

}  // namespace fpc
