#include "loop/operator_notes.hpp"

#include <algorithm>

#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

constexpr std::size_t kMostRefused = 20;

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

void count(RunRemark& remark, std::uint32_t step) {
  if (remark.samples++ == 0) remark.first = step;
}

}  // namespace

OperatorNotes::OperatorNotes(const LoopFile& loop)
    : limits_(loop.setpoint),
      outputs_(loop.plant_info.outputs),
      schedule_(scheduleOf(loop)),
      asked_(schedule_.present()) {
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    clamped_.push_back({"a setpoint of " + outputs_[i].name + " was asked beyond its limits, " +
                            exactText(limits_.lower[k]) + ".." + exactText(limits_.upper[k]) +
                            (outputs_[i].unit.empty() ? "" : " [" + outputs_[i].unit + "]") +
                            ", and clamped",
                        0, 0});
  }
}

void OperatorNotes::refused(std::uint32_t step, const std::string& words) {
  const std::string remark = "command refused: " + words;
  const auto known = std::find_if(refused_.begin(), refused_.end(),
                                  [&](const RunRemark& r) { return r.words == remark; });
  if (known != refused_.end())
    ++known->samples;
  else if (refused_.size() < kMostRefused)
    refused_.push_back({remark, 1, step});
  else
    ++more_;
}

void OperatorNotes::look(const SetpointSource& setpoint, std::uint32_t step) {
  clamped_now_.reset();
  const auto& active = setpoint.table().active();
  const bool any = std::any_of(active.begin(), active.end(),
                               [](const ActiveCommand& command) { return command.active; });
  if (!any) return;
  schedule_.restore(setpoint.recipe());
  schedule_.scheduled(step, asked_);
  for (std::size_t i = 0; i < active.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const double asked = setpoint.table().apply(i, asked_[k]);
    if (asked >= limits_.lower[k] && asked <= limits_.upper[k]) continue;
    count(clamped_[i], step);
    if (!clamped_now_) clamped_now_ = i;
  }
}

const std::string& OperatorNotes::clamped() const {
  static const std::string nothing;
  return clamped_now_ ? clamped_[*clamped_now_].words : nothing;
}

std::vector<RunRemark> OperatorNotes::remarks() const {
  std::vector<RunRemark> all = refused_;
  if (more_ > 0) all.push_back({std::to_string(more_) + " more commands refused", 0, 0});
  std::copy_if(clamped_.begin(), clamped_.end(), std::back_inserter(all),
               [](const RunRemark& remark) { return remark.samples > 0; });
  return all;
}

}  // namespace fpc
