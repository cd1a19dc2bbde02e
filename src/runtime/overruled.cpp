#include "runtime/overruled.hpp"

#include <algorithm>
#include <cmath>

#include "fmbpc/base/text.hpp"
#include "fmbpc/plant/plant.hpp"

namespace fpc {
namespace {

using Eigen::Index;

bool givenByPattern(const LoopFile& loop, const std::string& name) {
  const auto& channels = loop.disturbance.pattern.channels;
  return loop.disturbance.source == DisturbanceSource::kPattern &&
         std::any_of(channels.begin(), channels.end(),
                     [&](const PatternChannel& channel) { return channel.name == name; });
}

void addNominal(const LoopFile& loop, std::vector<RunRemark>& remarks) {
  if (loop.external_plant) return;
  std::vector<std::string> names;
  const auto all = makePlant(loop.simulation)->description().disturbances;
  const Vector& told = loop.simulation.disturbance_nominal;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (told[static_cast<Index>(i)] != all[i].nominal && givenByPattern(loop, all[i].name))
      names.push_back(all[i].name);
  if (!names.empty())
    remarks.push_back(
        {"disturbance.nominal of " + join(names) + ": in the run the pattern gives the values", 0,
         0});
}

/// The setpoint of the schedule that is farthest beyond the data, NaN if none is.
double beyondData(const LoopFile& loop, Index output, const SignalInfo& data) {
  double worst = std::nan(""), most = 0.0;
  const auto look = [&](double asked) {
    const double beyond = std::max(data.lower - asked, asked - data.upper);
    if (!(beyond > most)) return;
    most = beyond;
    worst = asked;
  };
  look(loop.setpoint.initial[output]);
  for (const SetpointStep& step : loop.setpoint.schedule)
    if (output < step.value.size()) look(step.value[output]);
  return worst;
}

void addSetpoints(const LoopFile& loop, std::vector<RunRemark>& remarks) {
  if (!loop.has_model || !loop.controller || !loop.controllerType().needs_model) return;
  for (const Index i : loop.controller->signalUse(controllerContext(loop)).followed) {
    if (i >= static_cast<Index>(loop.model.outputs.size())) continue;
    const SignalInfo& data = loop.model.outputs[static_cast<std::size_t>(i)];
    if (!std::isfinite(data.lower) || !std::isfinite(data.upper)) continue;
    const double asked = beyondData(loop, i, data);
    if (std::isfinite(asked))
      remarks.push_back({data.name + " is asked to be " + shortText(asked) +
                             ", where the model has no data (" + shortText(data.lower) + " to " +
                             shortText(data.upper) + ")",
                         0, 0});
  }
}

}  // namespace

std::vector<RunRemark> overruledIn(const LoopFile& loop) {
  std::vector<RunRemark> remarks;
  addNominal(loop, remarks);
  addSetpoints(loop, remarks);
  return remarks;
}

}  // namespace fpc
