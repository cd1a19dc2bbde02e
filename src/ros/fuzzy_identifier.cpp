#include "fmbpc/ros/fuzzy_identifier.hpp"
#include "fmbpc/config/structure_file.hpp"

#include <filesystem>
#include <fstream>
#include <utility>

#include "fmbpc/base/text.hpp"
#include "fmbpc/config/model_file.hpp"
#include "fmbpc/fuzzy/model_check.hpp"
#include "fmbpc/fuzzy/model_match.hpp"
#include "fmbpc/ros/conversions.hpp"
#include "fmbpc/ros/identify_messages.hpp"
#include "fmbpc/ros/topics.hpp"

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

double shareOf(const fmbpc::IdentifyModelGoal& goal, const LoopFile& loop) {
  if (goal.validation_share == 0.0) return loop.identify.validation_share;
  if (goal.validation_share == -1.0) return 0.0;
  require(goal.validation_share > 0.0 && goal.validation_share < 1.0, "validation_share",
          "a share > 0 and < 1, 0 (as in the loop file) or -1 (none)");
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
    : loop_(loop),
      out_(private_node.param<std::string>("out", "")),
      ready_(node),
      plant_(loop.plant_info),
      collector_(loop.plant_info, static_cast<std::size_t>(loop.identify.window)),
      model_publisher_(node.advertise<fmbpc::FuzzyModel>(topics::kFuzzyModel, 1, true)),
      plant_subscriber_(
          subscribe(node, topics::kPlantInfo, 1, &FuzzyIdentifier::onPlantInfo, this)),
      server_(
          withoutTimer(private_node), topics::kIdentify,
          [this](Server::GoalHandle goal) { onGoal(std::move(goal)); },
          [this](Server::GoalHandle goal) { onCancel(std::move(goal)); }, false),
      poll_timer_(node.createWallTimer(ros::WallDuration(kPollPeriod),
                                       [this](const ros::WallTimerEvent&) { poll(); })),
      diagnostics_(node, private_node, "model", loop.name,
                   [this](Diagnostics::Status& status) { report(status); }) {
  if (loop.has_identify)  // otherwise nobody needs the samples
    measurement_subscriber_ = subscribe(node, topics::kMeasurement, topics::kRingQueue,
                                        &FuzzyIdentifier::onMeasurement, this);
  server_.start();
}

void FuzzyIdentifier::onPlantInfo(const fmbpc::PlantInfo::ConstPtr& msg) {
  guarded(topics::kPlantInfo, [&] {
    if (!plant_.introduce(fromMsg(*msg))) return;
    if (loop_.has_model && published_ == 0) publishStartModel();
    announceIfReady();
    for (const auto& measurement : std::exchange(unannounced_, {})) onMeasurement(measurement);
  });
}

void FuzzyIdentifier::publishStartModel() {
  try {
    publish(matchToPlant(loop_.model, loop_.plant_info));
    problem_.clear();
  } catch (const InputError& error) {
    problem_ = error.what();
    ROS_ERROR("fuzzy_identifier: the model does not fit the plant: %s", problem_.c_str());
  }
}

void FuzzyIdentifier::announceIfReady() {
  const bool has_model = published_ > 0 || !loop_.has_model;
  const bool listens = !loop_.has_identify || measurement_subscriber_.getNumPublishers() > 0;
  if (plant_.open() && has_model && listens) ready_.announce();
}

void FuzzyIdentifier::onMeasurement(const fmbpc::Measurement::ConstPtr& msg) {
  guarded(topics::kMeasurement, [&] {
    const Measurement measurement = fromMsg(*msg);
    if (!plant_.admits(measurement.header.run_id, ros::WallTime::now())) {
      if (unannounced_.size() < kMostUnannounced) unannounced_.push_back(msg);
      return;
    }
    const Arrival arrival = collector_.take(measurement);
    if (!isNew(arrival)) return;
    learn(measurement, arrival);
    const auto after = static_cast<std::uint64_t>(loop_.identify.after);
    if (after == 0 || done_by_itself_ || collector_.counts().samples < after || worker_.busy())
      return;
    done_by_itself_ = true;
    begin(loop_.identify.structure, 0, loop_.identify.validation_share, true);
  });
}

void FuzzyIdentifier::learn(const Measurement& measurement, Arrival arrival) {
  if (!learner_ || !learner_->take(measurement, arrival)) return;
  try {
    offer(learner_->model());
  } catch (const InputError& error) {
    ROS_WARN("fuzzy_identifier: sample %u: the model learned online is not published: %s",
             measurement.header.step, error.what());
  }
}

void FuzzyIdentifier::offer(const TsModel& model) {
  try {
    const TsModel matched = matchToPlant(model, loop_.plant_info);
    if (collector_.present().outputs.size() > 0)
      requireStable(matched, collector_.present(), loop_.max_pole);
    publish(matched);
  } catch (const InputError& error) {
    ++models_refused_;
    last_refusal_ = error.what();
    throw;
  }
}

void FuzzyIdentifier::publish(const TsModel& matched) {
  remarks_ = reportModel(matched);
  model_publisher_.publish(toMsg(matched));
  model_ = matched;
  if (published_++ == 0) {
    for (const RuleRemark& remark : remarks_)
      ROS_INFO("fuzzy_identifier: %s, output %s, rule %zu: %s", matched.name.c_str(),
               remark.output.c_str(), remark.rule, remark.text.c_str());
    if (loop_.identify.online.enabled)
      learner_.emplace(matched, loop_.plant_info, loop_.identify.online);
  }
}

void FuzzyIdentifier::write(const TsModel& model) const {
  if (out_.empty()) return;
  std::filesystem::create_directories(out_);
  const auto file = std::filesystem::path(out_) / "model.yaml";
  std::ofstream stream(file);
  stream << writeModel(model);
  if (!stream.good()) ROS_WARN("fuzzy_identifier: %s could not be written", file.c_str());
}

void FuzzyIdentifier::begin(Structure structure, std::size_t newest, double share, bool publish) {
  IdentificationWorker::Job job;
  job.values = collector_.rows(structure, newest);
  job.structure = std::move(structure);
  const CollectorCounts& counts = collector_.counts();
  job.source = "the running plant " + loop_.plant_info.name + ", samples up to " +
               std::to_string(collector_.present().header.step) + " (" +
               std::to_string(counts.missing) + " missing, " + std::to_string(counts.incomplete) +
               " incomplete, " + std::to_string(counts.runs) + " runs)";
  job.share = share;
  publish_ = publish;
  ROS_INFO("fuzzy_identifier: identifies %s from %zu rows", job.structure.name.c_str(),
           static_cast<std::size_t>(job.values.rows()));
  worker_.start(std::move(job));
}

void FuzzyIdentifier::onGoal(Server::GoalHandle goal) {
  const auto& wish = *goal.getGoal();
  fmbpc::IdentifyModelResult result;
  try {
    require(loop_.has_identify, "model.identify",
            "that section in the loop file: nothing is collected");
    require(!worker_.busy(), "identify", "one goal at a time: another identification is running");
    require(collector_.size() > 0, "identify", "samples: none have come yet");
    begin(structureOf(wish, loop_), wish.window, shareOf(wish, loop_), wish.publish != 0);
  } catch (const InputError& error) {
    result.message = error.what();
    ROS_WARN("fuzzy_identifier: goal rejected: %s", error.what());
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
  if (!ready_.announced()) announceIfReady();
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
    return;
  }
  result = toResult(outcome.result);
  const TsModel& model = outcome.result.found.model;
  result.message = model.name + " identified from " + std::to_string(result.rows) + " rows" +
                   (publish_ ? " and published" : ", not published");
  result.ok = 1;
  if (!publish_) return;
  try {
    offer(model);
    if (loop_.identify.online.enabled)  // goes on learning from here
      learner_.emplace(model_, loop_.plant_info, loop_.identify.online);
    write(model_);
  } catch (const InputError& error) {
    result.ok = 0;
    result.message = std::string("identified, but refused: ") + error.what();
  }
}

void FuzzyIdentifier::reportWords(Diagnostics::Status& status) const {
  using diagnostic_msgs::DiagnosticStatus;
  const std::string& problem = plant_.problem().empty() ? problem_ : plant_.problem();
  if (!problem.empty())
    status.summary(DiagnosticStatus::ERROR, problem);
  else if (!plant_.open())
    status.summary(DiagnosticStatus::WARN, "waiting for plant_info");
  else if (worker_.busy())
    status.summary(DiagnosticStatus::OK, "identifying: " + progress_);
  else if (!last_refusal_.empty())
    status.summary(DiagnosticStatus::WARN, "refused: " + last_refusal_);
  else if (published_ == 0)
    status.summary(DiagnosticStatus::OK, "collecting, no model yet");
  else
    status.summary(DiagnosticStatus::OK, "published " + model_.name);
}

void FuzzyIdentifier::report(Diagnostics::Status& status) const {
  reportWords(status);
  const CollectorCounts& counts = collector_.counts();
  status.add("source", model_.source);
  status.add("models published", published_);
  status.add("models refused", models_refused_);
  status.add("last identification", last_identification_);
  status.add("samples collected", counts.samples);
  status.add("samples missing", counts.missing);
  status.add("samples incomplete", counts.incomplete);
  status.add("runs", counts.runs);
  status.add("rows in the window", collector_.size());
  if (learner_) status.add("samples learned online", learner_->samples());
  for (const RuleRemark& remark : remarks_)
    status.add(remark.output + ", rule " + std::to_string(remark.rule), remark.text);
  addRefused(status, refused());
}

}  // namespace fpc
