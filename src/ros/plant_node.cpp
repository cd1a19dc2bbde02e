#include "ros/plant_node.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "fmbpc/base/text.hpp"
#include "ros/conversions.hpp"
#include "ros/queues.hpp"
#include "ros/topics.hpp"

namespace fpc {
namespace {
constexpr double kPoll = 0.05;           // [s] of wall time
constexpr double kLookForStart = 0.01;   // [s] of wall time, at who is there
constexpr double kIntroduceAgain = 1;    // [s], while nobody answers (in realtime samples go on)
constexpr double kActionPatience = 1.0;  // [s] without an action before that is said
constexpr double kPlantLastWords = 0.3;  // [s] between run_end and the end of this process
constexpr char kRecorder[] = "loop_recorder";

std::vector<std::string> namesToWaitFor(const LoopFile& loop, const ros::NodeHandle& private_node) {
  std::vector<std::string> names = loop.exchange.wait_for;
  std::istringstream also(private_node.param<std::string>("also_wait_for", ""));
  for (std::string name; also >> name;) names.push_back(name);
  return names;
}

/// The nodes of ours that beat.
std::vector<std::string> namesToWatch(const LoopFile& loop, const ros::NodeHandle& node) {
  std::vector<std::string> names = loop.exchange.members;
  for (std::string& name : names) name = node.resolveName(name);
  return names;
}

}  // namespace

PlantNode::PlantNode(ros::NodeHandle node, ros::NodeHandle private_node, const LoopFile& loop,
                     std::unique_ptr<Process> process, const std::vector<std::string>& disturbances)
    : Node(node, loop, private_node.getNamespace()),
      loop_(loop),
      session_(std::move(process), ringPolicy(loop)),
      publishers_(node, loop, session_.process().info(), disturbances),
      keeper_(node, loop, name()),
      ready_(node, loop, name(), namesToWaitFor(loop, private_node)),
      members_(namesToWatch(loop, node)),
      watch_(members_),
      begun_s_(steadyNow()),
      end_(node),
      node_(node),
      action_subscriber_(subscribe(node, topics::kControlAction, queueOf(ListenerKind::kPeer),
                                   &PlantNode::onAction, this)),
      state_subscriber_(subscribe(node, topics::kLoopState, queueOf(ListenerKind::kPeer),
                                  &PlantNode::onLoopState, this)),
      recorded_subscriber_(subscribe(node, topics::kSampleRecorded, queueOf(ListenerKind::kPeer),
                                     &PlantNode::onRecorded, this)),
      pause_(serve(private_node, topics::kPause, &PlantNode::onPause, this)),
      step_(serve(private_node, topics::kStep, &PlantNode::onStep, this)),
      reset_(serve(private_node, topics::kReset, &PlantNode::onReset, this)),
      poll_timer_(guardedTimer(node, kPoll, "poll", [this] { onPoll(); }).started()),
      start_timer_(
          guardedTimer(node, kLookForStart, "start", [this] { waitForOthers(); }).started()),
      pace_timer_(guardedTimer(
          node, kPoll, "pace", [this] { tryAdvance(); }, SteadyTimer::Kind::kOnce)),
      health_(node, private_node, "plant", loop.name, true,
              {[this](double now_s) { return health(now_s); },
               [this] { return session_.process().measurement().header; },
               [this](Diagnostics::Status& status) { report(status); }}) {}

void PlantNode::begin() {
  std::vector<ros::Publisher> recorded = publishers_.recorded();
  for (const ros::Publisher& own : alsoRecorded()) recorded.push_back(own);
  listeners_.emplace(std::move(recorded));
  beginRun();
  frames_.broadcast(node_, loop_.tf, session_.process().info().header.time_ns);
}

// A number that no run had before, also of an earlier process; which one counts is said by
// plant_info, not by its size.
void PlantNode::beginRun() {
  run_id_ = std::max(run_id_ + 1, ros::WallTime::now().toNSec());
  session_.begin(run_id_);
  keeper_.beginRun(run_id_);
  parked_.reset();
  publishers_.begin(session_.process());
  introduced_s_ = steadyNow();
  tracking_subscriber_.shutdown();
  recorded_ = false;
  commanded_step_ = 0;
}

void PlantNode::start() {
  start_timer_.stop();
  keeper_.start();
  watch_.begin(steadyNow());
  session_.start(steadyNow());
  ROS_INFO("%s: run %lu of %s starts", name().c_str(), run_id_, loop_.name.c_str());
  publishSample();
}

void PlantNode::onPoll() {
  exchange();
  if (session_.awaitsRecorder()) tryAdvance();  // for so long only
  const double now_s = steadyNow();
  if (!session_.mustResend(now_s)) return;
  session_.resent(now_s);
  publishers_.resend();
  afterResend();
  if (now_s - answered_s_ < kIntroduceAgain || now_s - introduced_s_ < kIntroduceAgain) return;
  introduced_s_ = now_s;  // somebody may have been told of another run
  publishers_.introduce(session_.process());
}

void PlantNode::waitForOthers() {
  if (failed_s_ >= 0) {
    if (steadyNow() - failed_s_ > kPlantLastWords) fail(failure_);
    return;
  }
  missing_ = ready_.missing();
  const std::vector<std::string> own = plantMissing();
  missing_.insert(missing_.end(), own.begin(), own.end());
  if (missing_.empty() && keeper_.knowsWhatStands(steadyNow()) && listeners_->open())
    return start();
  if (missing_.empty()) return;
  if (steadyNow() - begun_s_ < loop_.exchange.ready_timeout_s) return;
  failure_ =
      "not ready within loop.ready_timeout_s = " + exactText(loop_.exchange.ready_timeout_s) +
      " s: " + ready_.named(missing_);
  failed_s_ = steadyNow();
  end_.say(failure_);
  health_.look();
}

// Where anyone may command the plant (loop.publishers), nobody takes it from the one that does: a
// node that is no member of the loop counts once a sample has gone by without an action, or waits.
bool PlantNode::commands(const std::string& publisher, std::uint32_t step) const {
  const StepHeader& now = session_.process().measurement().header;
  return step != now.step || commander_.empty() || publisher == commander_ ||
         std::find(members_.begin(), members_.end(), publisher) != members_.end() ||
         now.step > commanded_step_ + 1 || session_.unansweredFor(steadyNow()) > kActionPatience;
}

void PlantNode::onAction(const fmbpc::ControlAction::ConstPtr& msg, const std::string& publisher) {
  guarded(topics::kControlAction, [&] {
    exchange();
    require(commands(publisher, msg->step), "control_action of " + publisher,
            "one of " + commander_ + ", which commands the plant");
    if (!take(fromMsg(*msg))) return;
    commander_ = publisher;
    commanded_step_ = msg->step;
  });
}

/// False if it is no answer to the present sample.
bool PlantNode::take(ControlAction action) {
  const bool awaited = !session_.hasAction() && session_.process().answers(action.header) &&
                       session_.phase() == PlantPhase::kRunning &&
                       action.input.size() == session_.process().measurement().input_applied.size();
  if (awaited && !prepare(action)) {
    parked_ = std::move(action);
    return true;
  }
  parked_.reset();
  if (!session_.receive(action)) return false;
  answered_s_ = steadyNow();
  exchange();
  tryAdvance();
  return true;
}

void PlantNode::takeParked() {
  if (parked_) take(*std::exchange(parked_, std::nullopt));
}

void PlantNode::onTracking(const fmbpc::Tracking::ConstPtr& msg) {
  const StepHeader& now = session_.process().measurement().header;
  if (session_.phase() == PlantPhase::kFinished && msg->run_id == now.run_id &&
      msg->step == now.step)
    session_.finish();
}

void PlantNode::onRecorded(const fmbpc::Recorded::ConstPtr& msg) {
  const StepHeader sample{fromStamp(msg->header.stamp), msg->run_id, msg->step};
  guarded(topics::kSampleRecorded, [&] {
    if (session_.recorded(sample)) tryAdvance();
  });
}

void PlantNode::onLoopState(const fmbpc::LoopState::ConstPtr& msg, const std::string& publisher) {
  if (!speaksFor(topics::kLoopState, publisher, msg->node)) return;
  keeper_.hear(*msg);
  watch_.hear(msg->node,
              {static_cast<LoopMode>(msg->mode), eventCodeOr(msg->code, EventCode::kNone),
               msg->reason, msg->missing},
              steadyNow());
  const bool wrote = msg->mode == static_cast<std::uint8_t>(LoopMode::kFinished);
  if (wrote && msg->node == node_.resolveName(kRecorder)) recorded_ = true;
}

void PlantNode::tryAdvance() {
  exchange();
  const std::uint64_t missed = session_.missingInputs();
  try {
    if (!session_.advance(steadyNow())) return armTimer();
  } catch (const std::exception& error) {  // of a user's plant: nothing would move any more
    failure_ = std::string("the plant cannot go on: ") + error.what();
    end_.say(failure_);
    return fail(failure_);
  }
  if (session_.missingInputs() > missed && trouble_log_.pass())
    ROS_WARN("%s: no action in time (%lu so far)", name().c_str(), session_.missingInputs());
  publishSample();
  exchange();
}

void PlantNode::publishSample() {
  const Process& process = session_.process();
  publishers_.sample(process, shownDisturbances(),
                     [this](fmbpc::Measurement& measurement) { mark(measurement); });
  afterSample();
  if (!process.trouble().empty() && trouble_log_.pass())
    ROS_WARN("%s: %s", name().c_str(), process.trouble().c_str());
  if (session_.phase() == PlantPhase::kFinished) {
    ROS_INFO("%s: final sample %u sent", name().c_str(), process.measurement().header.step);
    tracking_subscriber_ = subscribe(node_, topics::kTracking, queueOf(ListenerKind::kPeer),
                                     &PlantNode::onTracking, this);
  } else {
    armTimer();
  }
}

void PlantNode::armTimer() {
  if (!session_.pacer().timed()) return;
  const double due_s = session_.nextDue();
  if (std::isfinite(due_s))
    pace_timer_.startIn(due_s - steadyNow());
  else
    pace_timer_.stop();
}

bool PlantNode::onPause(std_srvs::SetBool::Request& request,
                        std_srvs::SetBool::Response& response) {
  session_.pause(request.data != 0, steadyNow());
  if (!session_.paused()) tryAdvance();
  response.success = true;
  response.message = session_.paused() ? "paused" : "running";
  health_.look();
  return true;
}

bool PlantNode::onStep(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  response.success = session_.step();
  response.message = response.success     ? "one sample"
                     : !session_.paused() ? "pause first"
                                          : "there is no run under way";
  if (response.success) tryAdvance();
  return true;
}

bool PlantNode::onReset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  response.success = session_.phase() != PlantPhase::kWaiting;
  response.message = response.success ? "sample 0 of a new run" : "the first run has not begun";
  if (response.success) {
    beginRun();
    start();
  }
  return true;
}

Health PlantNode::health(double now_s) const {
  if (!failure_.empty()) return {LoopMode::kFailed, EventCode::kCannotStart, failure_, missing_};
  if (session_.phase() == PlantPhase::kWaiting)
    return {LoopMode::kStarting, EventCode::kWaiting, "waiting for " + ready_.named(missing_),
            missing_};
  if (!session_.process().trouble().empty())
    return {LoopMode::kFailed, EventCode::kPlantFailed, session_.process().trouble(), {}};
  if (session_.phase() == PlantPhase::kFinished) return finishedHealth(now_s);
  if (session_.paused()) return {LoopMode::kHeld, EventCode::kPaused, "paused", {}};
  return runningHealth(now_s);
}

// A run that nobody has recorded is over, but not in order.
Health PlantNode::finishedHealth(double now_s) const {
  const std::vector<std::string> silent = watch_.silent(now_s);
  const std::string recorder = node_.resolveName(kRecorder);
  if (!recorded_ && std::find(silent.begin(), silent.end(), recorder) != silent.end())
    return {LoopMode::kDegraded, EventCode::kNotRecorded,
            "finished, not recorded yet: no word from " + recorder, silent};
  const Health others = watch_.worst(now_s);
  if (others.mode == LoopMode::kFailed)
    return {LoopMode::kDegraded, EventCode::kNodeDegraded, "finished; " + others.words,
            others.missing};
  if (session_.acknowledged()) return {LoopMode::kFinished, EventCode::kNone, "finished", {}};
  return {LoopMode::kFinished, EventCode::kNone,
          "finished; the final sample is sent again until it is tracked", silent};
}

// Nothing that stands still is "running".
Health PlantNode::runningHealth(double now_s) const {
  const std::vector<std::string> silent = watch_.silent(now_s);
  const Health others = watch_.worst(now_s);
  std::string who = silent.empty() ? "" : "; no word from " + join(silent);
  if (who.empty() && !others.words.empty()) who = "; " + others.words;
  const std::string step = std::to_string(session_.process().measurement().header.step);
  if (session_.unrecordedFor(now_s) > kActionPatience)
    return {LoopMode::kStalled,
            EventCode::kNotRecorded,
            "sample " + step + " is not recorded" + who,
            {node_.resolveName(kRecorder)}};
  const Actuator& actuator = session_.process().actuator();
  if (actuator.missing()) {
    const bool fallback = actuator.fellBack();
    return {fallback ? LoopMode::kFallback : LoopMode::kHeld, EventCode::kNoAction,
            std::string("no actions: the input is ") +
                (fallback ? "the configured fallback" : "held") + " at sample " + step + who,
            silent};
  }
  const Health plant = plantHealth();
  const bool its_own_hand = plant.mode == LoopMode::kManual;
  const bool late =
      session_.unansweredFor(now_s) > kActionPatience && loop_.exchange.pace != Pace::kRealtime;
  const LoopMode worst = late ? std::max(others.mode, LoopMode::kStalled) : others.mode;
  if (its_own_hand || (plant.mode != LoopMode::kAutomatic && plant.mode >= worst)) return plant;
  if (late)
    return {LoopMode::kStalled, EventCode::kNoAction, "no action for sample " + step + who, silent};
  if (!silent.empty())
    return {LoopMode::kDegraded, EventCode::kNodeSilent, "no word from " + join(silent), silent};
  const LoopMode stuck = session_.holdsAll() ? LoopMode::kHeld : LoopMode::kDegraded;
  if (!session_.stuck().empty()) return {stuck, EventCode::kInputStuck, session_.stuck(), {}};
  if (others.mode == LoopMode::kAutomatic)
    return {LoopMode::kAutomatic, EventCode::kNone, withRefusal("running", now_s), {}};
  if (others.mode == LoopMode::kManual)
    return {LoopMode::kManual, EventCode::kNone, others.words, {}};
  const bool as_it_is = others.mode == LoopMode::kHeld || others.mode == LoopMode::kFallback;
  return {as_it_is ? others.mode : LoopMode::kDegraded, others.code, others.words, others.missing};
}

}  // namespace fpc
