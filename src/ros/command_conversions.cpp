// Setpoints, disturbances and their effects: three messages, one struct.
#include "conversion_parts.hpp"

namespace fpc {
namespace {

template <typename Msg>
Msg fillCommand(const Command& command) {
  Msg msg;
  msg.header.stamp = toStamp(command.time_ns);
  msg.name = command.name;
  msg.value = command.value;
  msg.mode = conversion::number(command.mode);
  return msg;
}

template <typename Msg>
Command readCommand(const Msg& msg, const ros::Time& stamp) {
  const CommandMode mode =
      conversion::enumeration(msg.mode, CommandMode::kOverride, CommandMode::kRelease, "mode");
  const bool bare_release = mode == CommandMode::kRelease && msg.value.empty();
  require(bare_release || msg.value.size() == msg.name.size(), "value", "as many values as names");
  return {fromStamp(stamp), msg.name, msg.value, mode};
}

}  // namespace

fmbpc::Setpoint toSetpointMsg(const Command& command) {
  return fillCommand<fmbpc::Setpoint>(command);
}

fmbpc::Disturbance toDisturbanceMsg(const Command& command) {
  return fillCommand<fmbpc::Disturbance>(command);
}

Command fromMsg(const fmbpc::Setpoint& msg) { return readCommand(msg, msg.header.stamp); }

Command fromMsg(const fmbpc::Disturbance& msg) { return readCommand(msg, msg.header.stamp); }

fmbpc::CommandEffect toMsg(const CommandEffect& effect) {
  fmbpc::CommandEffect msg;
  conversion::fillHeader(msg, effect.header);
  msg.asked = toStamp(effect.command.time_ns);
  msg.name = effect.command.name;
  msg.value = effect.command.value;
  msg.mode = conversion::number(effect.command.mode);
  return msg;
}

fmbpc::CommandEffect refusalOf(const ros::Time& asked, const StepHeader& latest,
                               const std::string& why) {
  fmbpc::CommandEffect msg;
  conversion::fillHeader(msg, latest);
  msg.asked = asked;
  msg.refused = why;
  return msg;
}

CommandEffect fromMsg(const fmbpc::CommandEffect& msg) {
  return {conversion::stepHeader(msg), readCommand(msg, msg.asked)};
}

}  // namespace fpc
