#include "runtime/forced_inputs.hpp"

#include <algorithm>
#include <cmath>

#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

constexpr char kOfInputs[] = "input/";

std::string rangeOf(const SignalInfo& input) {
  return exactText(input.lower) + ".." + exactText(input.upper) +
         (input.unit.empty() ? "" : " [" + input.unit + "]");
}

}  // namespace

ForcedInputs::ForcedInputs(const PlantInfo& info)
    : inputs_(info.inputs), lines_(info.inputs.size()) {}

void ForcedInputs::look(std::uint32_t step, const std::vector<CommandEffect>& effects) {
  if (step == 0) lines_.assign(inputs_.size(), "");
  for (const CommandEffect& effect : effects) take(effect.command);
  if (step == 0 || !effects.empty()) {
    words_.clear();
    for (const std::string& line : lines_)
      if (!line.empty()) words_ += (words_.empty() ? "" : "\n") + line;
  }
  if (!words_.empty()) ++samples_;
}

void ForcedInputs::take(const Command& command) {
  for (std::size_t i = 0; i < command.name.size(); ++i)
    for (std::size_t j = 0; j < inputs_.size(); ++j) {
      if (command.name[i] != kOfInputs + inputs_[j].name) continue;
      const bool released = command.mode == CommandMode::kRelease || i >= command.value.size();
      lines_[j] = released ? "" : judge(inputs_[j], command.mode, command.value[i]);
    }
}

std::string ForcedInputs::judge(const SignalInfo& input, CommandMode mode, double value) const {
  const std::string name = kOfInputs + input.name;
  if (mode == CommandMode::kOffset)
    return std::abs(value) <= input.upper - input.lower
               ? ""
               : name + " was asked to be off by " + exactText(value) + ", more than its limits, " +
                     rangeOf(input) + ", are apart, and clamped";
  return value >= input.lower && value <= input.upper
             ? ""
             : name + " was asked to be " + exactText(value) + ", beyond its limits, " +
                   rangeOf(input) + ", and clamped";
}

}  // namespace fpc
