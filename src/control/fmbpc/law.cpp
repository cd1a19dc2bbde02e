// The fuzzy model-based predictive law. Source: vallejo2019, eqs. 19-37; the prediction form is
// vallejo2021b, eqs. 1-10.
#include "control/fmbpc/law.hpp"

#include <memory>

#include "control/fmbpc/core.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/model/model_match.hpp"

namespace fpc {
namespace {

FmbpcParams valid(FmbpcParams params, const PlantInfo& plant) {
  const Eigen::Index n_u = countOf(plant.inputs);
  params.validate(countOf(plant.outputs), n_u);
  if (params.weight_input.size() == 0)
    params.weight_input = params.input_target = Vector::Zero(n_u);
  return params;
}

std::vector<std::string> outputSignals(const FmbpcParams& params) {
  if (params.delay_steps == 0) return {"model", "correction"};
  return {"model", "correction", "undelayed"};
}

}  // namespace

FmbpcLaw::FmbpcLaw(const FmbpcParams& params, const InputLimits& limits, const PlantInfo& plant)
    : PredictiveLaw((params.validate(countOf(plant.outputs), countOf(plant.inputs)), params),
                    limits, plant, outputSignals(params), namesOf(params.observer.estimated)),
      params_(valid(params, plant)),
      forecast_(countOf(plant.disturbances), params.horizon_steps, params.forecast_period_steps,
                params.forecast_pole, params.forecast_memory_steps) {}

void FmbpcLaw::reset(const Measurement& start) {
  PredictiveLaw::reset(start);
  forecast_.forget();
}

bool FmbpcLaw::expect(std::uint32_t k, Eigen::Index disturbance, VectorRef ahead) {
  if (params_.law != FmbpcForm::kIterated) return false;
  forecast_.expect(k, disturbance, ahead);
  return true;
}

void FmbpcLaw::note(const LawSample& sample) {
  forecast_.add(sample.now.header.step, sample.disturbances);
}

void FmbpcLaw::setModel(const TsModel& model) {
  takeOver(
      std::make_unique<FmbpcCore>(matchToPlant(model, plant(), namesOf(params_.observer.estimated)),
                                  params_, limits(), forecast_));
}

Settings FmbpcLaw::settings() const {
  return fmbpcSettings().show(params_, {plant().outputs, plant().inputs});
}

/// A key that the law does not heed may come along as it is.
void FmbpcLaw::requireHeeded(const Settings& asked, const FmbpcParams& next) const {
  for (const auto& setting : asked) {
    const char* instead = lawsInsteadOf(params_.law, setting.first);
    if (instead == nullptr) continue;
    const SettingSignals signals{plant().outputs, plant().inputs};
    const Settings before = fmbpcSettings().show(params_, signals),
                   after = fmbpcSettings().show(next, signals);
    const auto same = [&](std::size_t i) {
      return after[i].first != setting.first || after[i].second == before[i].second;
    };
    for (std::size_t i = 0; i < after.size(); ++i)
      require(same(i), "controller." + setting.first, instead);
  }
}

bool FmbpcLaw::retune(const Settings& settings) {
  FmbpcParams next = params_;
  const SettingSignals signals{plant().outputs, plant().inputs};
  fmbpcSettings().take(settings, signals, next);
  requireHeeded(settings, next);
  params_ = valid(std::move(next), plant());
  if (LawCore* core = newest()) static_cast<FmbpcCore*>(core)->prepareTuning(params_);
  tuningPrepared(params_.reference_pole);
  return true;
}

}  // namespace fpc
