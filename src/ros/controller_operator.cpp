// What people ask of a controller over topics and services.
#include "fmbpc/base/text.hpp"
#include "ros/controller_node.hpp"
#include "ros/conversions.hpp"
#include "ros/topics.hpp"
#include "runtime/factory.hpp"

namespace fpc {
void ControllerNode::onSetpoint(const fmbpc::Setpoint::ConstPtr& msg) {
  if (!commands_.pass(steadyNow())) return;
  const auto take = [&] {
    const Command command = fromMsg(*msg);
    links_.inbox().refuseLinked(command);
    const std::uint32_t step = session_.command(command);
    ROS_INFO("%s: setpoint of %s from sample %u on", name().c_str(), join(command.name).c_str(),
             step);
    tell();
  };
  const auto refused = [&](const std::string& why) {
    effect_.publish(refusalOf(msg->header.stamp, session_.answer().tracking.header, why), true);
  };
  guardedCommand(topics::kSetpoint, take, refused);
}

bool ControllerNode::onManual(std_srvs::SetBool::Request& request,
                              std_srvs::SetBool::Response& response) {
  session_.manual(request.data != 0);
  tell();
  response.success = true;
  response.message = session_.isManual() ? "manual" : "auto";
  return true;
}

bool ControllerNode::onCandidate(fmbpc::Candidate::Request& request,
                                 fmbpc::Candidate::Response& response) {
  using Request = fmbpc::Candidate::Request;
  try {
    if (request.order == Request::WATCH) {
      const std::shared_ptr<const LoopFile> other =
          request.loop.empty() ? loop_.candidate.loop : readCandidateLoop(request.loop, loop_);
      require(other != nullptr, topics::kCandidate,
              "a loop file, or candidate.loop in the loop's own");
      session_.watch(makeCandidate(*other, loop_.candidate.params));
    } else if (request.order == Request::HAND_OVER || request.order == Request::BACK) {
      session_.handOver(request.order == Request::HAND_OVER);
    } else {
      require(request.order == Request::REPORT, topics::kCandidate, "order 1, 2, 3 or 4");
      require(session_.watched() != nullptr, topics::kCandidate,
              "one that is watched; there is none");
    }
    response.message = session_.watched()->report();
    response.success = true;
  } catch (const InputError& error) {
    response.message = error.what();
    refuse(topics::kCandidate, error.what());
  }
  return true;
}

bool ControllerNode::onAdapt(std_srvs::SetBool::Request& request,
                             std_srvs::SetBool::Response& response) {
  response.success = session_.adapt(request.data != 0);
  tell();
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
    response.message = session_.manualClamped();
    tell();
    response.success = true;
  } catch (const InputError& error) {
    response.message = error.what();
    refuse(topics::kManualInput, error.what());
  }
  return true;
}

bool ControllerNode::onHold(std_srvs::SetBool::Request& request,
                            std_srvs::SetBool::Response& response) {
  session_.holdRecipe(request.data != 0);
  tell();
  response.success = true;
  response.message = session_.setpoint().held() ? "recipe held" : "recipe running";
  ROS_INFO("%s: %s", name().c_str(), response.message.c_str());
  return true;
}

void ControllerNode::tell() {
  desk_.changed();
  desk_.tell(session_.answer().tracking.header);
}

}  // namespace fpc
