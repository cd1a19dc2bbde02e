#include "fmbpc/ros/fuzzy_optimal_controller.hpp"

namespace fpc {
namespace {

void fill(const Settings& settings, fmbpc::FuzzyOptimalConfig& config) {
  for (const auto& [key, text] : settings) {
    if (key == "horizon_steps") config.horizon_steps = std::stoi(text);
    if (key == "move_steps") config.move_steps = std::stoi(text);
    if (key == "weight_output") config.weight_output = text;
    if (key == "weight_move") config.weight_move = text;
    if (key == "weight_input") config.weight_input = text;
    if (key == "input_target") config.input_target = text;
  }
}

Settings settingsOf(const fmbpc::FuzzyOptimalConfig& config) {
  return {{"horizon_steps", std::to_string(config.horizon_steps)},
          {"move_steps", std::to_string(config.move_steps)},
          {"weight_output", config.weight_output},
          {"weight_move", config.weight_move},
          {"weight_input", config.weight_input},
          {"input_target", config.input_target}};
}

}  // namespace

std::string FuzzyOptimalControllerNode::idleReason(const LoopFile& loop) {
  return loop.controller == "fuzzy_optimal" ? ""
                                            : loop.name + " has controller.type " + loop.controller;
}

FuzzyOptimalControllerNode::FuzzyOptimalControllerNode(ros::NodeHandle node,
                                                       ros::NodeHandle private_node,
                                                       const LoopFile& loop)
    : ControllerNode(node, private_node, loop), server_(private_node) {
  server_.setCallback([this](fmbpc::FuzzyOptimalConfig& config, std::uint32_t /*level*/) {
    onReconfigure(config);
  });
}

void FuzzyOptimalControllerNode::onReconfigure(fmbpc::FuzzyOptimalConfig& config) {
  if (started_) {
    try {
      session().retune(settingsOf(config));
      ROS_INFO("%s: new settings from the next sample on", ros::this_node::getName().c_str());
    } catch (const InputError& error) {
      ROS_WARN("%s: settings refused: %s", ros::this_node::getName().c_str(), error.what());
    }
  }
  started_ = true;
  fill(session().controller().settings(), config);
}

}  // namespace fpc
