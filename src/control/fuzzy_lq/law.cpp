// The fuzzy optimal predictive law. Source: taieb2017, eqs. 7-14, with the
// disturbance estimate, horizons and move weights that make it free of offset.
#include "control/fuzzy_lq/law.hpp"

#include <memory>
#include <utility>

#include "control/fuzzy_lq/core.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/model/model_match.hpp"

namespace fpc {
namespace {

const FuzzyOptimalParams& valid(const FuzzyOptimalParams& params, const PlantInfo& plant) {
  params.validate(countOf(plant.outputs), countOf(plant.inputs));
  return params;
}

}  // namespace

FuzzyOptimalLaw::FuzzyOptimalLaw(const FuzzyOptimalParams& params, const InputLimits& limits,
                                 const PlantInfo& plant)
    : PredictiveLaw(valid(params, plant), limits, plant, {"error"}), params_(params) {}

void FuzzyOptimalLaw::setModel(const TsModel& model) {
  TsModel matched = matchToPlant(model, plant());
  auto core = std::make_unique<FuzzyOptimalCore>(matched, params_);
  model_ = std::move(matched);
  takeOver(std::move(core));
}

void FuzzyOptimalLaw::check(const FuzzyOptimalParams& params, const TsModel& model) {
  FuzzyOptimalCore(model, params);
}

void FuzzyOptimalLaw::retune(FuzzyOptimalTuning tuning) {
  FuzzyOptimalParams params = params_;
  params.tuning = std::move(tuning);
  retuneTo(std::move(params));
}

void FuzzyOptimalLaw::retuneTo(FuzzyOptimalParams params) {
  valid(params, plant());
  std::unique_ptr<LawCore> core;
  if (model_) core = std::make_unique<FuzzyOptimalCore>(*model_, params);
  params_ = std::move(params);
  if (core) takeOver(std::move(core));
}

}  // namespace fpc
