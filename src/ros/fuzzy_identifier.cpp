#include "fmbpc/ros/fuzzy_identifier.hpp"

#include "fmbpc/fuzzy/model_file.hpp"
#include "fmbpc/ros/conversions.hpp"
#include "fmbpc/ros/topics.hpp"

namespace fpc {

std::string FuzzyIdentifier::idleReason(const LoopFile& loop) {
  return loop.has_model ? "" : loop.name + " names no model";
}

FuzzyIdentifier::FuzzyIdentifier(ros::NodeHandle node, const ros::NodeHandle& private_node,
                                 const LoopFile& loop)
    : loop_(loop),
      ready_(node),
      model_(node.advertise<fmbpc::FuzzyModel>(topics::kFuzzyModel, 1, true)),
      plant_subscriber_(
          subscribe(node, topics::kPlantInfo, 1, &FuzzyIdentifier::onPlantInfo, this)),
      diagnostics_(node, private_node, "model", loop.name,
                   [this](Diagnostics::Status& status) { report(status); }) {}

void FuzzyIdentifier::onPlantInfo(const fmbpc::PlantInfo::ConstPtr& msg) {
  if (published_) return;
  guarded(topics::kPlantInfo, [&] {
    try {
      offer(matchToPlant(obtain(), fromMsg(*msg)));
      problem_.clear();
    } catch (const InputError& error) {
      problem_ = error.what();
      ROS_ERROR("fuzzy_identifier: the model does not fit the plant: %s", problem_.c_str());
    }
  });
}

void FuzzyIdentifier::offer(const TsModel& model) {
  remarks_ = reportModel(model);
  for (const RuleRemark& remark : remarks_)
    ROS_INFO("fuzzy_identifier: %s, output %s, rule %zu: %s", model.name.c_str(),
             remark.output.c_str(), remark.rule, remark.text.c_str());
  model_.publish(toMsg(model));
  published_ = true;
  ready_.announce();
}

void FuzzyIdentifier::report(Diagnostics::Status& status) const {
  using diagnostic_msgs::DiagnosticStatus;
  if (!problem_.empty())
    status.summary(DiagnosticStatus::ERROR, problem_);
  else if (!published_)
    status.summary(DiagnosticStatus::WARN, "waiting for plant_info");
  else
    status.summary(DiagnosticStatus::OK, "published " + loop_.model.name);
  status.add("source", loop_.model.source);
  for (const RuleRemark& remark : remarks_)
    status.add(remark.output + ", rule " + std::to_string(remark.rule), remark.text);
  addRefused(status, refused());
}

}  // namespace fpc
