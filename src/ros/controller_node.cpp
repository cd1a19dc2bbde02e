#include "ros/controller_node.hpp"

#include <algorithm>
#include <utility>

#include "base/same_sample.hpp"
#include "ros/conversions.hpp"
#include "ros/queues.hpp"
#include "ros/topics.hpp"
#include "runtime/factory.hpp"
#include "runtime/plan.hpp"

namespace fpc {
namespace {

constexpr double kBurst = 200;         // commands at once
constexpr double kLookAgain = 0.01;    // [s] at what a parked sample waits for
constexpr double kCommissioned = 0.1;  // [s] of wall time: feedback, end of a goal

const char* actionTopic(const LoopFile& loop, const ros::NodeHandle& private_node) {
  const bool answers_plant = private_node.param("final_action", !loop.has_clp);
  return answers_plant ? topics::kControlAction : topics::kBaseAction;
}

}  // namespace

ControllerNode::ControllerNode(ros::NodeHandle node, ros::NodeHandle private_node,
                               const LoopFile& loop)
    : Node(node, loop, private_node.getNamespace()),
      loop_(loop),
      session_(makeControllerSession(loop)),
      inbox_(loop.has_identify && loop.exchange.pace == Pace::kLockstep),
      desk_(node, loop, name(), session_, [this] { answerParked(); }),
      ready_(node, loop, name(),
             [this] {
               return plant_.open() && session_.ready() && links_.missing().empty() &&
                      listeners_.connected();
             }),
      signals_(node),
      plant_(loop),
      base_(node, actionTopic(loop, private_node), comeback_, audienceOf(node, authority())),
      prediction_(node, topics::kPredictiveAction, comeback_, audienceOf(node, authority())),
      tracking_(node, topics::kTracking, comeback_, audienceOf(node, authority())),
      effect_(node, topics::kSetpointEffect, comeback_, audienceOf(node, authority())),
      listeners_(
          {base_.publisher(), prediction_.publisher(), tracking_.publisher(), effect_.publisher()}),
      links_(node, private_node, loop.exchange.pace, LinkInbox::Of::kController,
             [this] { guarded(topics::kControlAction, [this] { answerParked(); }); }),
      plant_subscriber_(subscribe(node, topics::kPlantInfo, 1, &ControllerNode::onPlantInfo, this)),
      model_subscriber_(subscribe(node, topics::kFuzzyModel, 1, &ControllerNode::onModel, this)),
      measurement_subscriber_(subscribeLaw(node, topics::kMeasurement, loop.exchange.pace,
                                           &ControllerNode::onMeasurement, this)),
      identified_subscriber_(subscribe(node, topics::kIdentified, queueOf(ListenerKind::kPeer),
                                       &ControllerNode::onIdentified, this)),
      setpoint_subscriber_(subscribe(node, topics::kSetpoint, queueOf(ListenerKind::kViewer),
                                     &ControllerNode::onSetpoint, this)),
      targets_subscriber_(subscribe(node, topics::kTargets, queueOf(ListenerKind::kPeer),
                                    &ControllerNode::onTargets, this)),
      manual_(serve(private_node, topics::kManual, &ControllerNode::onManual, this)),
      manual_input_(
          serve(private_node, topics::kManualInput, &ControllerNode::onManualInput, this)),
      hold_(serve(private_node, topics::kHold, &ControllerNode::onHold, this)),
      adapt_(serve(private_node, topics::kAdapt, &ControllerNode::onAdapt, this)),
      candidate_(serve(private_node, topics::kCandidate, &ControllerNode::onCandidate, this)),
      parked_timer_(guardedTimer(node, kLookAgain, "parked", [this] { answerParked(); })),
      settings_(
          private_node, loop.controllerType().settings,
          [this] { return session_.controller().settings(); },
          [this](const Settings& settings) {
            session_.retune(settings);
            tell();
          },
          [this](const std::string& why) { refuse(topics::kSettings, why); },
          [this](const std::string& caller) { return mayPass(topics::kServices, caller); }),
      summary_(node, loop, name()),
      commands_(loop.exchange.commands_per_s, kBurst),
      health_(node, private_node, "controller", loop.name, false,
              {[this](double now_s) { return health(now_s); },
               [this] { return session_.answer().tracking.header; },
               [this](Diagnostics::Status& status) { report(status); }}),
      commission_timer_(
          guardedTimer(node, kCommissioned, topics::kCommission, [this] { commission_.poll(); })
              .started()),
      commission_(private_node, loop_,
                  {[this](std::shared_ptr<PlantTap> tap) { session_.test(std::move(tap)); },
                   [this](const Command& command) {
                     session_.command(command);
                     tell();
                   }}) {
  if (loop.has_clp) {
    standin_.emplace(node, loop, name(), comeback_);
    listeners_.alsoHear(standin_->hearing());
  }
  advertiseSignals();
}

// Early, so that whoever listens misses nothing; what depends on a model follows with it.
void ControllerNode::advertiseSignals() {
  const Controller& controller = session_.controller();
  if (controller.followsSetpoint())
    for (const char* of : {"_setpoint", "_reference"})
      for (const SignalInfo& output : loop_.plant_info.outputs) signals_.add(output.name + of);
  if (controller.needsModel()) return;
  for (const auto& signal : controller.signals()) signals_.add(signal.first);
}

void ControllerNode::onPlantInfo(const fmbpc::PlantInfo::ConstPtr& msg) {
  guarded(topics::kPlantInfo, [&] {
    if (!plant_.introduce(*msg)) return;
    session_.announce(plant_.runId());
    inbox_.announce(plant_.runId());
    answerParked();
  });
}

void ControllerNode::onModel(const fmbpc::FuzzyModel::ConstPtr& msg) {
  guarded(topics::kFuzzyModel, [&] {
    const bool needed = session_.controller().needsModel();
    try {
      inbox_.put(needed ? matchToLoop(fromMsg(*msg), loop_) : TsModel(), headerOf(*msg));
    } catch (const InputError& error) {
      return refuseModel(error.what());
    }
    useModels(nextSample());
    answerParked();
  });
}

void ControllerNode::onTargets(const fmbpc::Targets::ConstPtr& msg) {
  guarded(topics::kTargets, [&] {
    const Targets targets = fromMsg(*msg);
    if (!loop_.targets.enabled || isSameSample(targets.header, aimed_)) return;
    if (plant_.open() && plant_.runId() != targets.header.run_id) return;
    if (targets.header.run_id == aimed_.run_id && targets.header.step < aimed_.step) return;
    session_.aim(targets);
    aimed_ = targets.header;
    target_events_ = fromMsg(msg->events);
    answerParked();
  });
}

// Lockstep waits for those of the sample; otherwise the law goes on with older ones when they stay
// away, and says so.
bool ControllerNode::hasTargets(const StepHeader& sample) {
  if (!loop_.targets.enabled || isSameSample(sample, aimed_)) return true;
  if (loop_.exchange.pace == Pace::kLockstep || !parked_ || !isSameSample(parked_->header, sample))
    return false;
  double patience_s = loop_.exchange.optimizer_timeout_s;
  if (loop_.exchange.pace == Pace::kRealtime)
    patience_s =
        std::min(patience_s, 0.25 * loop_.plant_info.sample_time_s / loop_.exchange.speedup);
  if (steadyNow() - parked_since_s_ < patience_s) return false;
  target_events_.assign(1, eventOf({EventCode::kTargetsLate}, sample.step));
  return true;
}

// The one after the sample answered last; of no run before the first.
StepHeader ControllerNode::nextSample() const {
  StepHeader next = session_.answer().tracking.header;
  ++next.step;
  return session_.counts().accepted > 0 ? next : StepHeader{};
}

void ControllerNode::onIdentified(const fmbpc::Identified::ConstPtr& msg) {
  guarded(topics::kIdentified, [&] {
    inbox_.hear(fromMsg(*msg));
    answerParked();
  });
}

void ControllerNode::useModels(const StepHeader& next) {
  for (const TsModel& model : inbox_.take(next)) {
    if (!session_.controller().needsModel()) continue;
    try {
      session_.setModel(model);
      model_ = model.name;
      model_source_ = model.source;
      model_problem_.clear();
      ROS_INFO("%s: model %s from the next sample on", name().c_str(), model_.c_str());
    } catch (const InputError& error) {
      models_refused_.push_back(eventOf({EventCode::kModelRefused, error.what()}, next.step));
      refuseModel(error.what());
    }
  }
}

void ControllerNode::refuseModel(const std::string& why) {
  model_problem_ = why;
  model_refused_s_ = steadyNow();
  refuse(topics::kFuzzyModel, why);
}

void ControllerNode::onMeasurement(const fmbpc::Measurement::ConstPtr& msg) {
  guarded(topics::kMeasurement, [&] {
    const Measurement measurement = fromMsg(*msg);
    if (plant_.open() && !plant_.admits(measurement.header.run_id)) return;
    session_.plantTakesActions(!msg->local);
    if (!mayAnswer(measurement)) return park(measurement);
    parked_.reset();
    answer(measurement);
  });
}

bool ControllerNode::mayAnswer(const Measurement& measurement) {
  return plant_.open() && plant_.runId() == measurement.header.run_id && session_.ready() &&
         listeners_.open() && inbox_.complete(measurement.header) && desk_.mayStart(measurement) &&
         hasTargets(measurement.header) && links_.inbox().ready(measurement.header.time_ns);
}

// Kept, since the plant does not send a sample again that somebody has answered: a controller that
// comes back would have nothing to do until the next one.
void ControllerNode::park(const Measurement& measurement) {
  const bool known = parked_ && isSameSample(parked_->header, measurement.header);
  if (!known) parked_since_s_ = steadyNow();
  parked_ = measurement;
  parked_timer_.start();
}

// What the sample waited for may have come.
void ControllerNode::answerParked() {
  if (!parked_) return parked_timer_.stop();
  if (plant_.open() && plant_.runId() != parked_->header.run_id) return parked_.reset();
  if (!mayAnswer(*parked_)) return;
  const Measurement measurement = std::move(*std::exchange(parked_, std::nullopt));
  guarded(topics::kMeasurement, [&] { answer(measurement); });
}

// Once for each sample: a repeated one is not commanded for again.
void ControllerNode::takeFromOthers(const StepHeader& sample) {
  if (links_.inbox().empty() || isSameSample(linked_, sample)) return;
  linked_ = sample;
  if (const auto command = links_.inbox().command(sample.time_ns)) session_.command(*command);
  takePlans(links_.inbox(), sample, loop_.plant_info, session_);
}

void ControllerNode::answer(const Measurement& measurement) {
  heard_s_ = steadyNow();
  useModels(measurement.header);
  takeFromOthers(measurement.header);
  const bool first = session_.counts().accepted == 0;
  switch (session_.receive(measurement)) {
    case Receipt::kAnswered:
      if (first) settings_.publish();  // those that were restored
      comeback_.answered(measurement.header, heard_s_);
      gatherEvents();
      return publish(false);
    case Receipt::kRepeated:
      return publish(true);
    case Receipt::kDropped:
    case Receipt::kNotReady:
      return;
  }
}

void ControllerNode::gatherEvents() {
  const StepHeader& now = session_.answer().tracking.header;
  events_ = joined(session_.answer().events, inbox_.takeEvents(now));
  events_ = joined(events_, std::exchange(target_events_, {}));
  events_ =
      joined(joined(events_, std::exchange(models_refused_, {})), takeRefusedCommands(now.step));
  health_.say(events_);
}

void ControllerNode::publish(bool repeated) {
  const ControllerAnswer& answer = session_.answer();
  if (answer.has_prediction && prediction_.needed())
    prediction_.publish(toMsg(answer.prediction), repeated);
  if (answer.has_action) base_.publish(toMsg(answer.base), repeated);
  if (standin_) standin_->asked(answer, repeated);
  publishTracking(repeated);
  if (repeated) return;
  for (const CommandEffect& effect : answer.effects) effect_.publish(toMsg(effect), false);
  if (!answer.effects.empty() || answer.tracking.header.step == 0) desk_.changed();
  desk_.tell(answer.tracking.header);
  publishSignals();
  if (!session_.resetReason().empty())
    ROS_INFO("%s: reset: %s", name().c_str(), session_.resetReason().c_str());
}

void ControllerNode::publishTracking(bool repeated) {
  if (!tracking_.needed()) return;
  fmbpc::Tracking tracking = toMsg(session_.answer().tracking);
  tracking.events = toMsg(events_);
  tracking_.publish(std::move(tracking), repeated);
}

void ControllerNode::publishSignals() {
  const Tracking& tracking = session_.answer().tracking;
  std::size_t index = 0;
  if (session_.controller().followsSetpoint()) {
    for (const double value : tracking.setpoint)
      signals_.publish(index++, tracking.header.time_ns, value);
    for (const double value : tracking.reference)
      signals_.publish(index++, tracking.header.time_ns, value);
  }
  for (const auto& [name, value] : session_.controller().signals()) {
    if (index == signals_.size()) signals_.add(name);
    signals_.publish(index++, tracking.header.time_ns, value);
  }
}

template int runNode<ControllerNode>(int, char**, const std::string&);

}  // namespace fpc
