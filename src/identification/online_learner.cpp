#include "identification/online_learner.hpp"

#include <cmath>
#include <utility>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

void fillRanges(std::vector<SignalInfo>& model, const std::vector<SignalInfo>& plant) {
  for (std::size_t i = 0; i < model.size() && i < plant.size(); ++i) {
    const bool known = std::isfinite(model[i].lower) && std::isfinite(model[i].upper);
    const bool told = std::isfinite(plant[i].lower) && std::isfinite(plant[i].upper);
    if (known || !told || plant[i].lower >= plant[i].upper) continue;
    model[i].lower = plant[i].lower;
    model[i].upper = plant[i].upper;
  }
}

TsModel withRanges(TsModel model, const PlantInfo& plant) {
  fillRanges(model.outputs, plant.outputs);
  fillRanges(model.inputs, plant.inputs);
  fillRanges(model.disturbances, plant.disturbances);
  return model;
}

}  // namespace

void OnlineParams::validate() const {
  require(every >= 1, "every", "a number of samples >= 1");
  rls.validate();
}

OnlineLearner::OnlineLearner(TsModel model, const PlantInfo& plant, const OnlineParams& params)
    : every_(static_cast<std::uint32_t>(params.every)),
      consequents_(withRanges(std::move(model), plant), params.rls) {
  params.validate();
}

bool OnlineLearner::take(const Measurement& m, Arrival arrival) {
  if (needsReset(arrival)) consequents_.forgetPast();
  consequents_.take(m.outputs, m.input_applied, m.disturbances);
  const bool due = m.header.step > 0 && m.header.step % every_ == 0 && samples() > handed_over_;
  if (due) handed_over_ = samples();
  return due;
}

TsModel OnlineLearner::model() const {
  TsModel model = consequents_.model();
  model.source += " Consequents learned online from " + std::to_string(samples()) + " samples.";
  return model;
}

}  // namespace fpc
