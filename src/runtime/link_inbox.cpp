#include "runtime/link_inbox.hpp"

#include <algorithm>
#include <cmath>

#include "fmbpc/base/input_error.hpp"

namespace fpc {

LinkInbox::LinkInbox(const std::vector<LoopLink>& links, Of of, bool lockstep)
    : lockstep_(lockstep) {
  for (const LoopLink& link : links)
    if ((link.to == LoopLink::To::kSetpoint || link.to == LoopLink::To::kForecast) ==
        (of == Of::kController)) {
      sources_.emplace_back();
      sources_.back().link = link;
    }
}

std::set<std::pair<std::string, LoopLink::Of>> LinkInbox::sources() const {
  std::set<std::pair<std::string, LoopLink::Of>> all;
  for (const Source& source : sources_) all.insert({source.link.from, source.link.of});
  return all;
}

void LinkInbox::hear(const std::string& from, LoopLink::Of of, const StepHeader& sample,
                     const Eigen::Ref<const Matrix>& values) {
  for (Source& source : sources_) {
    const LoopLink& link = source.link;
    if (link.from != from || link.of != of || link.index >= values.rows()) continue;
    if (sample.time_ns > link.last_ns) continue;
    const bool anew = !source.heard || source.run_id != sample.run_id;
    if (!anew && sample.time_ns <= source.newest_ns) continue;  // sent again
    if (anew) source.items.clear();
    source.gap =
        anew ? sample.step != 0 : source.gap || sample.time_ns - source.newest_ns > link.every_ns;
    source.run_id = sample.run_id;
    source.newest_ns = sample.time_ns;
    source.heard = true;
    const Vector row = (link.gain * values.row(link.index).array() + link.offset).transpose();
    if (row.size() == 0 || !row.allFinite()) continue;
    if (!lockstep_) source.items.clear();
    source.items.push_back({sample.time_ns, row.cwiseMax(link.lower).cwiseMin(link.upper)});
  }
}

bool LinkInbox::has(const Source& source, std::int64_t time_ns) const {
  if (!lockstep_) return true;
  if (source.link.to == LoopLink::To::kForecast && time_ns <= source.link.first_ns)
    return true;  // there is none before
  if (!source.heard || source.gap) return false;
  return source.newest_ns >= source.link.last_ns ||
         source.newest_ns > time_ns - source.link.reach_ns;
}

bool LinkInbox::ready(std::int64_t time_ns) {
  missing_.clear();
  for (const Source& source : sources_)
    if (!has(source, time_ns) &&
        std::find(missing_.begin(), missing_.end(), source.link.from) == missing_.end())
      missing_.push_back(source.link.from);
  return missing_.empty();
}

std::vector<std::string> LinkInbox::missing() const { return missing_; }

std::optional<double> LinkInbox::valueAt(Source& source, std::int64_t time_ns) const {
  while (source.items.size() > 1 && source.items[1].time_ns <= time_ns) source.items.pop_front();
  if (source.items.empty()) return {};
  return source.items.front().values[0];
}

std::optional<Command> LinkInbox::command(std::int64_t time_ns) {
  Command command;
  command.mode = CommandMode::kOverride;
  for (Source& source : sources_) {
    if (source.link.to != LoopLink::To::kDisturbance && source.link.to != LoopLink::To::kSetpoint)
      continue;
    const std::optional<double> value = valueAt(source, time_ns);
    if (!value) continue;
    command.name.push_back(source.link.name);
    command.value.push_back(*value);
  }
  if (command.name.empty()) return {};
  return command;
}

void LinkInbox::plans(std::int64_t time_ns,
                      const std::function<void(const std::string&, VectorRef)>& take) {
  for (Source& source : sources_) {
    const LoopLink& link = source.link;
    if (link.to != LoopLink::To::kForecast) continue;
    const std::int64_t made_ns = time_ns - link.every_ns;
    while (lockstep_ && !source.items.empty() && source.items.front().time_ns < made_ns)
      source.items.pop_front();
    if (source.items.empty()) continue;
    const Item& item = source.items.front();
    if (!lockstep_ || item.time_ns == made_ns) take(link.name, item.values);
    if (!lockstep_) source.items.clear();
  }
}

void LinkInbox::replaceInputs(std::int64_t time_ns, const std::vector<SignalInfo>& inputs,
                              Eigen::Ref<Vector> input) {
  for (Source& source : sources_) {
    if (source.link.to != LoopLink::To::kInput) continue;
    const std::optional<double> value = valueAt(source, time_ns);
    for (std::size_t i = 0; value && i < inputs.size(); ++i)
      if (inputs[i].name == source.link.name) input[static_cast<Eigen::Index>(i)] = *value;
  }
}

void LinkInbox::refuseLinked(const Command& command) const {
  for (const Source& source : sources_)
    require(
        std::find(command.name.begin(), command.name.end(), source.link.name) == command.name.end(),
        source.link.name, "a signal without a link: it comes from loop " + source.link.from);
}

}  // namespace fpc
