#include "runtime/link_inbox.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

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
  for (const Source& source : sources_) {
    all.insert({source.link.from, source.link.of});
    if (source.link.of == LoopLink::Of::kPlan)
      all.insert({source.link.from, LoopLink::Of::kInputs});
  }
  return all;
}

/// Empty: of no use.
Vector LinkInbox::rowOf(const LoopLink& link, const Eigen::Ref<const Matrix>& values) const {
  if (link.index >= values.rows() || values.cols() == 0) return {};
  const Vector row = (link.gain * values.row(link.index).array() + link.offset).transpose();
  if (!row.allFinite()) return {};
  return row.cwiseMax(link.lower).cwiseMin(link.upper);
}

/// The item of a sample whose plan and action come in any order.
LinkInbox::Item& LinkInbox::itemOf(Source& source, const StepHeader& sample) {
  auto& items = source.items;
  if (source.run_id != sample.run_id) items.clear();
  source.run_id = sample.run_id;
  auto at = std::find_if(items.begin(), items.end(),
                         [&](const Item& one) { return one.time_ns >= sample.time_ns; });
  if (at == items.end() || at->time_ns != sample.time_ns)
    at = items.insert(at, {sample.time_ns, {}});
  if (lockstep_) return *at;
  // The latest whole one, and what came after it, are enough. The others stay where they are.
  const auto whole =
      std::find_if(items.rbegin(), items.rend(), [](const Item& one) { return one.whole(); });
  if (whole != items.rend() && whole.base() <= at)
    items.erase(items.begin(), std::prev(whole.base()));
  return *at;
}

void LinkInbox::hearPlan(Source& source, LoopLink::Of of, const StepHeader& sample,
                         const Eigen::Ref<const Matrix>& values, bool planned) {
  if (of == LoopLink::Of::kOutputs) return;
  Item& item = itemOf(source, sample);
  if (of == LoopLink::Of::kInputs) {
    item.asked = true;
    item.planned = planned;
    return;
  }
  item.values = rowOf(source.link, values);
  // A plan that is of no use is none.
  if (item.values.size() == 0)
    item.values = Vector::Constant(1, std::numeric_limits<double>::quiet_NaN());
}

void LinkInbox::hear(const std::string& from, LoopLink::Of of, const StepHeader& sample,
                     const Eigen::Ref<const Matrix>& values, bool planned) {
  for (Source& source : sources_) {
    const LoopLink& link = source.link;
    if (link.from != from || sample.time_ns > link.last_ns) continue;
    if (link.to == LoopLink::To::kForecast) {
      hearPlan(source, of, sample, values, planned);
      continue;
    }
    if (link.of != of || link.index >= values.rows()) continue;
    const bool anew = !source.heard || source.run_id != sample.run_id;
    if (!anew && sample.time_ns <= source.newest_ns) continue;  // sent again
    if (anew) source.items.clear();
    source.gap =
        anew ? sample.step != 0 : source.gap || sample.time_ns - source.newest_ns > link.every_ns;
    source.run_id = sample.run_id;
    source.newest_ns = sample.time_ns;
    source.heard = true;
    Vector row = rowOf(link, values);
    if (row.size() == 0) continue;
    if (!lockstep_) source.items.clear();
    source.items.push_back({sample.time_ns, std::move(row)});
  }
}

bool LinkInbox::has(const Source& source, std::int64_t time_ns) const {
  if (!lockstep_) return true;
  if (source.link.to == LoopLink::To::kForecast) {
    const std::int64_t made_ns = time_ns - source.link.every_ns;
    return made_ns < source.link.first_ns || made_ns > source.link.last_ns ||
           std::any_of(source.items.begin(), source.items.end(),
                       [&](const Item& item) { return item.time_ns == made_ns && item.whole(); });
  }
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
    const auto latest = std::find_if(
        source.items.rbegin(), source.items.rend(),
        [&](const Item& item) { return item.whole() && (!lockstep_ || item.time_ns == made_ns); });
    if (latest != source.items.rend() && latest->planned && latest->values.allFinite())
      take(link.name, latest->values);
    // In lockstep the sample may be asked for again.
    source.items.erase(source.items.begin(),
                       lockstep_
                           ? std::find_if(source.items.begin(), source.items.end(),
                                          [&](const Item& item) { return item.time_ns >= made_ns; })
                           : latest.base());
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
