#include "ros/fuzzy_identifier.hpp"

#include <filesystem>
#include <fstream>
#include <utility>

#include "config/model_file.hpp"
#include "config/structure_file.hpp"
#include "fmbpc/base/text.hpp"
#include "ros/conversions.hpp"
#include "ros/identify_messages.hpp"
#include "ros/queues.hpp"
#include "ros/topics.hpp"

namespace fpc {
namespace {

constexpr double kPollPeriod = 0.05;  // [s] of wall time: feedback, end of a job
constexpr std::size_t kMostUnannounced = 1000;

/// A status is sent when something changes; the timer of actionlib, which goes by simulated time,
/// stays off.
ros::NodeHandle withoutTimer(const ros::NodeHandle& private_node) {
  private_node.setParam("identify/actionlib_status_frequency", 0.0);
  return private_node;
}

double shareOf(const fmbpc::IdentifyModelGoal& goal) {
  if (goal.validation_share == 0.0) return IdentifyParams::kValidationShare;
  if (goal.validation_share == -1.0) return 0.0;
  require(goal.validation_share > 0.0 && goal.validation_share < 1.0, "validation_share",
          "a share > 0 and < 1, 0 (0.3) or -1 (none)");
  return goal.validation_share;
}

Structure structureOf(const fmbpc::IdentifyModelGoal& goal, const LoopFile& loop) {
  if (!goal.structure.empty()) return parseStructure(goal.structure, "goal.structure");
  require(!loop.identify.structure_file.empty(), "goal.structure",
          "the text of a structure file, since the loop file has no model.identify.structure");
  return loop.identify.structure;
}

}  // namespace

std::string FuzzyIdentifier::idleReason(const LoopFile& loop) {
  return loop.has_model || loop.has_identify ? "" : loop.name + " names no model";
}

FuzzyIdentifier::FuzzyIdentifier(ros::NodeHandle node, const ros::NodeHandle& private_node,
                                 const LoopFile& loop)
    : Node(node, loop, private_node.getNamespace()),
      loop_(loop),
      out_(private_node.param<std::string>("out", "")),
      ready_(node, loop, name(), [this] { return isReady(); }),
      plant_(loop),
      session_(loop),
      duty_(loop.exchange.pace == Pace::kLockstep),
      model_publisher_(node.advertise<fmbpc::FuzzyModel>(topics::kFuzzyModel, 1, true)),
      identified_(node.advertise<fmbpc::Identified>(topics::kIdentified,
                                                    queueOf(ListenerKind::kPeer), true)),
      plant_subscriber_(
          subscribe(node, topics::kPlantInfo, 1, &FuzzyIdentifier::onPlantInfo, this)),
      kept_subscriber_(subscribe(node, topics::kModelKept, 1, &FuzzyIdentifier::onModelKept, this)),
      server_(
          withoutTimer(private_node), topics::kIdentify,
          [this](Server::GoalHandle goal) { onGoal(std::move(goal)); },
          [this](Server::GoalHandle goal) { onCancel(std::move(goal)); }, false),
      poll_timer_(guardedTimer(node, kPollPeriod, "poll", [this] { poll(); }).started()),
      health_(
          node, private_node, "model", loop.name, false,
          {[this](double now_s) { return health(now_s); }, [this] { return session_.present(); },
           [this](Diagnostics::Status& status) { report(status); }}) {
  if (loop.has_identify)  // otherwise nobody needs the samples
    measurement_subscriber_ = subscribe(node, topics::kMeasurement, queueOf(ListenerKind::kRecord),
                                        &FuzzyIdentifier::onMeasurement, this);
  server_.start();
}

void FuzzyIdentifier::onPlantInfo(const fmbpc::PlantInfo::ConstPtr& msg) {
  guarded(topics::kPlantInfo, [&] {
    if (!plant_.introduce(*msg)) return;
    session_.announce(plant_.runId(), steadyNow());
    publishStartModel();
    for (const auto& measurement : std::exchange(unannounced_, {})) onMeasurement(measurement);
  });
}

// The plant says at once whether it has kept a model of this run; without such a plant nobody does.
void FuzzyIdentifier::onModelKept(const fmbpc::FuzzyModel::ConstPtr& msg) {
  guarded(topics::kModelKept, [&] {
    if (session_.hearKept(headerOf(*msg))) {
      publish(session_.restore(fromMsg(*msg)), headerOf(*msg));
      ROS_INFO("fuzzy_identifier: model %s of this run restored", msg->name.c_str());
    }
    publishStartModel();
  });
}

void FuzzyIdentifier::publishStartModel() {
  if (!plant_.open() || !session_.startDue(steadyNow())) return;
  try {
    if (const TsModel* model = session_.start()) publish(*model, {});
    problem_.clear();
  } catch (const InputError& error) {
    if (problem_ == error.what()) return;  // said, and tried again at every poll
    problem_ = error.what();
    ROS_ERROR("fuzzy_identifier: the model does not fit the plant: %s", problem_.c_str());
  }
}

bool FuzzyIdentifier::isReady() const {
  const bool has_model = session_.published() > 0 || !loop_.has_model;
  const bool listens = !loop_.has_identify || measurement_subscriber_.getNumPublishers() > 0;
  return plant_.open() && has_model && listens;
}

void FuzzyIdentifier::onMeasurement(const fmbpc::Measurement::ConstPtr& msg) {
  guarded(topics::kMeasurement, [&] {
    const Measurement measurement = fromMsg(*msg);
    if (!plant_.admits(measurement.header.run_id)) {
      if (unannounced_.size() < kMostUnannounced) unannounced_.push_back(msg);
      return;
    }
    IdentifierSession::Due due = session_.take(measurement);
    if (due.arrival == Arrival::kRepeat) return say(duty_.again());
    if (!isNew(due.arrival)) return;
    duty_.take(measurement.header, std::move(due.job));
    if (due.model != nullptr) failure_.clear();
    if (!due.refusal.empty()) hadNoModel(due.refused, due.refusal, measurement.header);
    if (due.model != nullptr) publish(*due.model, measurement.header);
    if (auto job = duty_.next()) begin(std::move(*job), true);
    say(duty_.settle());
  });
}

// In lockstep the next sample is answered only when this has been heard.
void FuzzyIdentifier::say(const IdentifierDuty::Words& words) {
  for (const IdentifierWord& word : words) identified_.publish(toMsg(word));
}

void FuzzyIdentifier::publish(const TsModel& matched, const StepHeader& made_from) {
  model_publisher_.publish(toMsg(matched, made_from));
  duty_.handOver(made_from);
  if (session_.published() > 1) return;
  for (const RuleRemark& remark : reportModel(matched))
    ROS_INFO("fuzzy_identifier: %s, output %s, rule %zu: %s", matched.name.c_str(),
             remark.output.c_str(), remark.rule, remark.text.c_str());
}

void FuzzyIdentifier::write(const TsModel& model) const {
  if (out_.empty()) return;
  std::error_code error;  // then the stream is not good either
  std::filesystem::create_directories(out_, error);
  const auto file = std::filesystem::path(out_) / "model.yaml";
  std::ofstream stream(file);
  stream << writeModel(model);
  if (!stream.good()) ROS_WARN("fuzzy_identifier: %s could not be written", file.c_str());
}

void FuzzyIdentifier::begin(IdentificationJob job, bool publish) {
  publish_ = publish;
  ROS_INFO("fuzzy_identifier: identifies %s from %zu rows", job.structure.name.c_str(),
           static_cast<std::size_t>(job.values.rows()));
  worker_.start(std::move(job));
  duty_.begin();  // it is at work only now
}

void FuzzyIdentifier::onGoal(Server::GoalHandle goal) {
  const auto& wish = *goal.getGoal();
  fmbpc::IdentifyModelResult result;
  try {
    require(!worker_.busy(), "identify", "one goal at a time: another identification is running");
    require(loop_.has_identify, "model.identify",
            "that section in the loop file: nothing is collected");
    begin(session_.job(structureOf(wish, loop_), wish.window, shareOf(wish)), wish.publish != 0);
  } catch (const std::exception& error) {
    result.message = error.what();
    ROS_WARN("fuzzy_identifier: goal rejected: %s", error.what());
    StepHeader of = session_.present();
    if (of.run_id != plant_.runId()) of = {0, plant_.runId(), 0};  // nothing is collected
    say({EventCode::kCommandRefused, error.what()}, of);
    goal.setRejected(result, error.what());
    return;
  }
  goal_ = goal;
  has_goal_ = true;
  goal_.setAccepted();
}

void FuzzyIdentifier::onCancel(Server::GoalHandle goal) {
  if (has_goal_ && goal == goal_) worker_.cancel();
}

void FuzzyIdentifier::poll() {
  publishStartModel();
  if (!worker_.busy()) return;
  // The end first, so that the last progress is not told after it.
  const auto outcome = worker_.outcome();
  if (const auto progress = worker_.progress()) {
    progress_ = progress->identify.output + " " + progress->identify.stage + ", " +
                std::to_string(static_cast<int>(100.0 * progress->identify.share)) + " %";
    if (has_goal_) goal_.publishFeedback(toFeedback(*progress));
  }
  if (outcome) finishJob(*outcome);
}

void FuzzyIdentifier::finishJob(const IdentificationWorker::Outcome& outcome) {
  fmbpc::IdentifyModelResult result;
  conclude(outcome, result);
  last_identification_ = result.message;
  say(duty_.finish());
  ROS_INFO("fuzzy_identifier: %s", result.message.c_str());
  if (!has_goal_) return;
  has_goal_ = false;
  if (outcome.cancelled)
    goal_.setCanceled(result, result.message);
  else if (outcome.error.empty())
    goal_.setSucceeded(result, result.message);
  else
    goal_.setAborted(result, result.message);
  goal_ = {};
}

void FuzzyIdentifier::conclude(const IdentificationWorker::Outcome& outcome,
                               fmbpc::IdentifyModelResult& result) {
  if (outcome.cancelled) {
    result.message = "cancelled";
    return;
  }
  if (!outcome.error.empty()) {
    result.message = outcome.error;
    hadNoModel(EventCode::kIdentificationFailed, outcome.error, duty_.jobFrom());
    return;
  }
  result = toResult(outcome.result);
  const TsModel& model = outcome.result.found.model;
  result.message = model.name + " identified from " + std::to_string(result.rows) + " rows" +
                   (publish_ ? " and published" : ", not published");
  result.ok = 1;
  failure_.clear();
  if (!publish_) return;
  try {
    publish(session_.accept(model), duty_.jobFrom());
    write(session_.model());
  } catch (const std::exception& error) {
    result.ok = 0;
    result.message = std::string("identified, but refused: ") + error.what();
    hadNoModel(EventCode::kIdentificationFailed, error.what(), duty_.jobFrom());
  }
}

// The loop goes on with the model it has: that is news for a while, no state.
void FuzzyIdentifier::hadNoModel(EventCode code, const std::string& why,
                                 const StepHeader& made_from) {
  failure_ = why;
  failure_code_ = code;
  failed_s_ = steadyNow();
  say({code, why.c_str()}, made_from);
}

// The record tells it with the next sample that the controller answers. The one at which a job
// began may be over by now.
void FuzzyIdentifier::say(const Notice& notice, const StepHeader& of) {
  const std::vector<Event> events{eventOf(notice, of.step)};
  identified_.publish(toMsg(IdentifierWord{of, false, events}));
  health_.say(events);
}

template int runNode<FuzzyIdentifier>(int, char**, const std::string&);

}  // namespace fpc
