// A model that learns from the samples of a running plant and says when it is time to hand it over.
#pragma once

#include <cstdint>

#include "base/step_gate.hpp"
#include "fmbpc/base/exchange.hpp"
#include "identification/online_consequents.hpp"

namespace fpc {

/// Section `model.identify.online`.
struct OnlineParams {
  bool enabled{false};
  int every{50};  ///< a model is due at the samples whose step is a multiple of it
  RlsParams rls{0.999, 1.0, 100.0};
  /// @throws InputError naming the field.
  void validate() const;
};

/// When models are due depends on the steps of the samples only: the same run gives the same
/// models.
class OnlineLearner {
 public:
  /// `model` must be matched to the plant. Regressors whose range the model does not tell are
  /// scaled by the plant's.
  /// @throws InputError naming the field.
  OnlineLearner(TsModel model, const PlantInfo& plant, const OnlineParams& params);

  /// Takes a new sample; `arrival` as SampleCollector::take() said: after a gap or in a new run the
  /// past is forgotten, not what was learned. @return true if a model is due.
  bool take(const Measurement& measurement, Arrival arrival);
  /// As learned so far; its source says from how many samples.
  TsModel model() const;
  std::uint64_t samples() const { return consequents_.samples(); }

 private:
  std::uint32_t every_;
  OnlineConsequents consequents_;
  std::uint64_t handed_over_{};
};

}  // namespace fpc
