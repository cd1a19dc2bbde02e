#include "runtime/sample_remarks.hpp"

#include <algorithm>

#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

SetpointParams scheduleOnly(SetpointParams params) {
  params.lower.resize(0);
  params.upper.resize(0);
  params.rate_per_h.resize(0);
  params.commands.clear();
  return params;
}

SetpointSource scheduleOf(const LoopFile& loop) {
  return {scheduleOnly(loop.setpoint), namesOf(loop.plant_info.outputs),
          SampleClock(loop.simulation.sample_time_s, loop.simulation.start_time_s)};
}

}  // namespace

SampleRemarks::SampleRemarks(const LoopFile& loop)
    : limits_(loop.setpoint),
      schedule_(scheduleOf(loop)),
      clamped_(loop.plant_info.outputs.size()),
      were_(clamped_),
      asked_(schedule_.present()) {
  for (std::size_t i = 0; i < clamped_.size(); ++i) {
    const SignalInfo& output = loop.plant_info.outputs[i];
    const auto k = static_cast<Eigen::Index>(i);
    words_.push_back("a setpoint of " + output.name + " was asked beyond its limits, " +
                     exactText(limits_.lower[k]) + ".." + exactText(limits_.upper[k]) +
                     (output.unit.empty() ? "" : " [" + output.unit + "]") + ", and clamped");
  }
  for (const Eigen::Index i : loop.report.without_setpoint) {
    limits_.lower[i] = -kInfinity;
    limits_.upper[i] = kInfinity;
  }
}

const std::string& SampleRemarks::look(const ControllerSession& controller) {
  lines_.clear();
  newly_clamped_ = false;
  const ControllerAnswer& answer = controller.answer();
  if (!answer.has_action) return lines_;
  addLine(controller.output().remark);
  if (controller.controller().followsSetpoint())
    lookAtSetpoints(controller.setpoint(), answer.tracking.header.step);
  return lines_;
}

void SampleRemarks::lookAtSetpoints(const SetpointSource& setpoint, std::uint32_t step) {
  std::swap(clamped_, were_);
  schedule_.restore(setpoint.recipe());
  schedule_.scheduled(step, asked_);
  for (std::size_t i = 0; i < clamped_.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const double asked = setpoint.table().apply(i, asked_[k]);
    clamped_[i] = asked < limits_.lower[k] || asked > limits_.upper[k];
    if (clamped_[i]) addLine(words_[i].c_str());
    newly_clamped_ = newly_clamped_ || (clamped_[i] && !were_[i]);
  }
  if (std::find(clamped_.begin(), clamped_.end(), true) != clamped_.end()) ++clamped_samples_;
}

void SampleRemarks::addLine(const char* words) {
  if (*words == '\0') return;
  if (!lines_.empty()) lines_ += '\n';
  lines_ += words;
}

std::string SampleRemarks::sentence() const {
  std::string text = lines_;
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos;)
    text.replace(at, 1, "; ");
  return text;
}

}  // namespace fpc
