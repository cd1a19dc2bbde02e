// Bytes as one message: what no struct can mean is refused in words, anything else comes back as it
// was.
#include <stdexcept>

#include "config/loop_file.hpp"
#include "fmbpc/model/model_match.hpp"
#include "fuzz/message_mutator.hpp"
#include "fuzz/targets.hpp"
#include "fuzz/tolerant.hpp"
#include "ros/conversions.hpp"
#include "ros/plant_check.hpp"

namespace fpc::fuzz {
namespace {

const LoopFile& exampleLoop() {
  static const LoopFile loop = readLoop("asp_case1_clp");
  return loop;
}

/// There and back and there again: the second message is the first, bit for bit.
template <typename Message, typename Back>
void comesBack(const Message& message, Back back) {
  tolerant([&] {
    const auto first = back(fromMsg(message));
    const auto second = back(fromMsg(first));
    if (wireOf(first) != wireOf(second))
      throw std::logic_error("a message that changes when it is read and written");
  });
}

template <typename Message>
void any(Message message, Bytes& bytes) {
  comesBack(mutated(std::move(message), bytes), [](const auto& read) { return toMsg(read); });
}

void model(Bytes& bytes) {
  const fmbpc::FuzzyModel message = mutated(toMsg(exampleLoop().model), bytes);
  comesBack(message, [](const TsModel& read) { return toMsg(read); });
  tolerant([&] { matchToPlant(fromMsg(message), exampleLoop().plant_info); });
}

void plantInfo(Bytes& bytes) {
  const fmbpc::PlantInfo message = mutated(toMsg(exampleLoop().plant_info), bytes);
  comesBack(message, [](const PlantInfo& read) { return toMsg(read); });
  tolerant([&] { plantMismatch(exampleLoop().plant_info, fromMsg(message)); });
}

}  // namespace

void message(const std::string& text) {
  Bytes bytes(text);
  switch (bytes.below(13)) {
    case 0:
      return any(fmbpc::Measurement(), bytes);
    case 1:
      return any(fmbpc::ControlAction(), bytes);
    case 2:
      return any(fmbpc::PredictiveAction(), bytes);
    case 3:
      return any(fmbpc::SolverReport(), bytes);
    case 4:
      return any(fmbpc::Tracking(), bytes);
    case 5:
      return any(fmbpc::PlantState(), bytes);
    case 6:
      return any(fmbpc::CommandEffect(), bytes);
    case 7:
      return any(fmbpc::Matrix(), bytes);
    case 8:
      return any(fmbpc::Identified(), bytes);
    case 9:
      return comesBack(mutated(fmbpc::Setpoint(), bytes), toSetpointMsg);
    case 10:
      return comesBack(mutated(fmbpc::Disturbance(), bytes), toDisturbanceMsg);
    case 11:
      return plantInfo(bytes);
    default:
      return model(bytes);
  }
}

}  // namespace fpc::fuzz
