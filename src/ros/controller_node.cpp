#include "fmbpc/ros/controller_node.hpp"

#include "fmbpc/base/text.hpp"
#include "fmbpc/fuzzy/model_match.hpp"
#include "fmbpc/loop/factory.hpp"
#include "fmbpc/ros/conversions.hpp"
#include "fmbpc/ros/topics.hpp"

namespace fpc {
namespace {

constexpr double kRestorePatience = 1.0;  // [s] of wall time

const char* actionTopic(const LoopFile& loop, const ros::NodeHandle& private_node) {
  const bool answers_plant = private_node.param("final_action", !loop.has_clp);
  return answers_plant ? topics::kControlAction : topics::kBaseAction;
}

}  // namespace

ControllerNode::ControllerNode(ros::NodeHandle node, ros::NodeHandle private_node,
                               const LoopFile& loop)
    : loop_(loop),
      session_(makeControllerSession(loop)),
      ready_(node),
      signals_(node),
      plant_(loop.plant_info),
      base_(node.advertise<fmbpc::ControlAction>(actionTopic(loop, private_node),
                                                 topics::kRingQueue)),
      prediction_(
          node.advertise<fmbpc::PredictiveAction>(topics::kPredictiveAction, topics::kRingQueue)),
      tracking_(node.advertise<fmbpc::Tracking>(topics::kTracking, topics::kRingQueue)),
      effect_(node.advertise<fmbpc::CommandEffect>(topics::kSetpointEffect, topics::kRingQueue)),
      listeners_({base_, prediction_, tracking_, effect_}),
      plant_subscriber_(subscribe(node, topics::kPlantInfo, 1, &ControllerNode::onPlantInfo, this)),
      model_subscriber_(subscribe(node, topics::kFuzzyModel, 1, &ControllerNode::onModel, this)),
      measurement_subscriber_(subscribe(node, topics::kMeasurement, topics::kRingQueue,
                                        &ControllerNode::onMeasurement, this)),
      setpoint_subscriber_(subscribe(node, topics::kSetpoint, topics::kViewQueue,
                                     &ControllerNode::onSetpoint, this)),
      setpoint_active_subscriber_(subscribe(node, topics::kSetpointActive, topics::kViewQueue,
                                            &ControllerNode::onSetpointActive, this)),
      manual_(private_node.advertiseService(topics::kManual, &ControllerNode::onManual, this)),
      manual_input_(private_node.advertiseService(topics::kManualInput,
                                                  &ControllerNode::onManualInput, this)),
      hold_(private_node.advertiseService(topics::kHold, &ControllerNode::onHold, this)),
      adapt_(private_node.advertiseService(topics::kAdapt, &ControllerNode::onAdapt, this)),
      settings_(
          private_node, loop.controllerType().settings,
          [this] { return session_.controller().settings(); },
          [this](const Settings& settings) { session_.retune(settings); }),
      diagnostics_(node, private_node, "controller", loop.name,
                   [this](Diagnostics::Status& status) { report(status); }) {
  if (!session_.controller().followsSetpoint()) return;
  for (const SignalInfo& output : loop.plant_info.outputs) signals_.add(output.name + "_setpoint");
  for (const SignalInfo& output : loop.plant_info.outputs) signals_.add(output.name + "_reference");
}

void ControllerNode::onPlantInfo(const fmbpc::PlantInfo::ConstPtr& msg) {
  guarded(topics::kPlantInfo, [&] {
    if (plant_.introduce(fromMsg(*msg))) announceIfReady();
  });
}

void ControllerNode::onModel(const fmbpc::FuzzyModel::ConstPtr& msg) {
  if (!session_.controller().needsModel()) return;
  try {
    session_.setModel(matchToPlant(fromMsg(*msg), loop_.plant_info));
    model_ = msg->name;
    model_problem_.clear();
    ROS_INFO("%s: model %s from the next sample on", ros::this_node::getName().c_str(),
             model_.c_str());
    announceIfReady();
  } catch (const InputError& error) {
    model_problem_ = error.what();
    refuse(topics::kFuzzyModel, error.what());
  }
}

void ControllerNode::announceIfReady() {
  if (plant_.open() && session_.ready()) ready_.announce();
}

void ControllerNode::onMeasurement(const fmbpc::Measurement::ConstPtr& msg) {
  guarded(topics::kMeasurement, [&] {
    const Measurement measurement = fromMsg(*msg);
    if (!plant_.admits(measurement.header.run_id, ros::WallTime::now())) return;
    if (!plant_.open() || mustAwaitSetpoints(measurement) || !listeners_.open())
      return;  // the plant will send it again
    switch (session_.receive(measurement)) {
      case Receipt::kAnswered:
        return publish(false);
      case Receipt::kRepeated:
        return publish(true);
      case Receipt::kDropped:
      case Receipt::kNotReady:
        return;
    }
  });
}

// A controller that joins in the middle of a run first hears from the recorder what people have
// asked until now; if there is no recorder it does not wait long.
bool ControllerNode::mustAwaitSetpoints(const Measurement& measurement) {
  if (setpoints_restored_ || session_.counts().accepted > 0 || measurement.header.step == 0)
    return false;
  const ros::WallTime now = ros::WallTime::now();
  if (restore_deadline_.isZero()) restore_deadline_ = now + ros::WallDuration(kRestorePatience);
  return now < restore_deadline_;
}

void ControllerNode::onSetpoint(const fmbpc::Setpoint::ConstPtr& msg) {
  guarded(topics::kSetpoint, [&] {
    const Command command = fromMsg(*msg);
    const std::uint32_t step = session_.command(command);
    ROS_INFO("%s: setpoint of %s from sample %u on", ros::this_node::getName().c_str(),
             join(command.name).c_str(), step);
  });
}

void ControllerNode::onSetpointActive(const fmbpc::Setpoint::ConstPtr& msg) {
  setpoints_restored_ = true;
  if (msg->name.empty()) return;  // nothing stands
  guarded(topics::kSetpointActive, [&] {
    const Command command = fromMsg(*msg);
    if (session_.restore(command))
      ROS_INFO("%s: setpoint of %s restored", ros::this_node::getName().c_str(),
               join(command.name).c_str());
  });
}

bool ControllerNode::onManual(std_srvs::SetBool::Request& request,
                              std_srvs::SetBool::Response& response) {
  session_.manual(request.data != 0);
  response.success = true;
  response.message = session_.isManual() ? "manual" : "auto";
  return true;
}

bool ControllerNode::onAdapt(std_srvs::SetBool::Request& request,
                             std_srvs::SetBool::Response& response) {
  response.success = session_.adapt(request.data != 0);
  response.message = !response.success   ? "this controller does not adapt"
                     : request.data != 0 ? "adapting"
                                         : "frozen";
  return true;
}

bool ControllerNode::onManualInput(fmbpc::ManualInput::Request& request,
                                   fmbpc::ManualInput::Response& response) {
  try {
    session_.manualInput(Eigen::Map<const Vector>(request.input.data(),
                                                  static_cast<Eigen::Index>(request.input.size())));
    response.success = true;
  } catch (const InputError& error) {
    response.message = error.what();
  }
  return true;
}

bool ControllerNode::onHold(std_srvs::SetBool::Request& request,
                            std_srvs::SetBool::Response& response) {
  session_.holdRecipe(request.data != 0);
  response.success = true;
  response.message = session_.setpoint().held() ? "recipe held" : "recipe running";
  ROS_INFO("%s: %s", ros::this_node::getName().c_str(), response.message.c_str());
  return true;
}

void ControllerNode::publish(bool repeated) {
  const ControllerAnswer& answer = session_.answer();
  if (answer.has_prediction && prediction_.getNumSubscribers() > 0)
    prediction_.publish(toMsg(answer.prediction));
  if (answer.has_action) base_.publish(toMsg(answer.base));
  if (tracking_.getNumSubscribers() > 0) tracking_.publish(toMsg(answer.tracking));
  if (repeated) return;
  for (const CommandEffect& effect : answer.effects) effect_.publish(toMsg(effect));
  publishSignals();
  if (!session_.resetReason().empty())
    ROS_INFO("%s: reset: %s", ros::this_node::getName().c_str(), session_.resetReason().c_str());
  const bool held = answer.has_action && answer.base.source == ActionSource::kHeld;
  const bool remarkable = *session_.output().remark != '\0';
  if ((held || remarkable) && log_.pass())
    ROS_WARN("%s: sample %u: %s", ros::this_node::getName().c_str(), answer.tracking.header.step,
             session_.output().remark);
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

void ControllerNode::reportWords(Diagnostics::Status& status) const {
  using diagnostic_msgs::DiagnosticStatus;
  if (!plant_.problem().empty())
    status.summary(DiagnosticStatus::ERROR, plant_.problem());
  else if (!plant_.open())
    status.summary(DiagnosticStatus::WARN, "waiting for plant_info");
  else if (!session_.ready())
    status.summary(DiagnosticStatus::WARN, "waiting for fuzzy_model");
  else if (session_.isManual())
    status.summary(DiagnosticStatus::WARN, "manual");
  else if (session_.counts().accepted == 0)
    status.summary(DiagnosticStatus::OK, "waiting for the first measurement");
  else if (*session_.output().remark != '\0' ||
           session_.answer().base.source == ActionSource::kHeld)
    status.summary(DiagnosticStatus::WARN, session_.output().remark);
  else if (!model_problem_.empty())
    status.summary(DiagnosticStatus::WARN, "controlling; refused: " + model_problem_);
  else
    status.summary(DiagnosticStatus::OK, "controlling");
}

void ControllerNode::report(Diagnostics::Status& status) const {
  reportWords(status);
  status.add("mode", session_.isManual() ? "manual" : "auto");
  status.add("recipe", session_.setpoint().held() ? "held" : "running");
  status.add("step", session_.answer().tracking.header.step);
  addCounts(status, session_.counts());
  status.add("dropped: run not announced", plant_.foreign());
  if (session_.controller().needsModel()) {
    status.add("model", model_);
    status.add("models taken", session_.models());
  }
  addRefused(status, refused());
}

}  // namespace fpc
