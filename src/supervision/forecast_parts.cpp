#include "supervision/forecast_parts.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "fmbpc/base/signals.hpp"

namespace fpc {

using Eigen::Index;

ForecastParts::ForecastParts(const TsModel& model, std::vector<int> shifts)
    : local_(model),
      shifts_(std::move(shifts)),
      state_(Vector::Zero(local_.stateSize())),
      part_(state_),
      next_(state_),
      before_(Vector::Zero(countOf(model.disturbances))),
      reference_(Vector::Zero(countOf(model.inputs))),
      output_(Vector::Zero(countOf(model.outputs))),
      error_(output_) {
  findLags();
  const Index n_u = countOf(model.inputs);
  int longest = 0, latest = 0;
  for (Index i = 0; i < n_u; ++i) longest = std::max(longest, lastLag(i));
  for (const int shift : shifts_) latest = std::max(latest, shift);
  past_ = Matrix::Zero(n_u, longest + latest + 1);
  effects_.assign(shifts_.size(), Vector::Zero(output_.size() * n_u));
}

void ForecastParts::findLags() {
  const TsModel& model = local_.model();
  for (Index i = 0; i < countOf(model.inputs); ++i) {
    int first = std::numeric_limits<int>::max(), last = 1;
    for (const OutputModel& submodel : model.submodels)
      for (const auto* list : {&submodel.antecedents, &submodel.regressors})
        for (const Regressor& regressor : *list) {
          if (regressor.kind != SignalKind::kInput || regressor.index != i) continue;
          last = std::max(last, regressor.lag);
          if (list == &submodel.regressors) first = std::min(first, regressor.lag);
        }
    known_input_.push_back(first != std::numeric_limits<int>::max());
    first_lag_.push_back(known_input_.back() ? first : 0);
    last_lag_.push_back(last);
  }
}

void ForecastParts::remember(const Vector& applied, bool all) {
  for (Index c = past_.cols() - 1; c > 0; --c) past_.col(c) = past_.col(c - 1);
  past_.col(0) = applied;
  if (all) past_.colwise() = applied;
}

bool ForecastParts::look(const Measurement& now) {
  if (!started_) reference_ = now.input_applied;
  started_ = true;
  const bool foreseen = known_;
  remember(now.input_applied, !known_);
  if (known_) {
    predict(now);
    local_.shiftState(now.outputs, now.input_applied, before_, state_);
  } else {
    local_.restState(now.outputs, now.input_applied, now.disturbances, state_);
    known_ = true;
  }
  before_ = now.disturbances;
  return foreseen;
}

/// u(k-1-lag), in distance to where the input was first seen; 0 for one that has yet to come.
double ForecastParts::input(Index i, int lag) const {
  if (lag < 0) return 0.0;
  return past_(i, std::min<Index>(lag, past_.cols() - 1)) - reference_[i];
}

void ForecastParts::predict(const Measurement& now) {
  local_.advance(state_, now.input_applied, before_, next_);
  const AffineModel& affine = local_.affine();
  error_ = now.outputs;
  error_.noalias() -= affine.C * next_;
  const Index n_y = error_.size();
  for (std::size_t s = 0; s < shifts_.size(); ++s)
    for (Index i = 0; i < reference_.size(); ++i) {
      const Index first = local_.inputState(i, 1);
      part_.setZero();
      for (int lag = 1; lag <= lastLag(i); ++lag)
        part_[first + lag - 1] = input(i, lag + shifts_[s]);
      next_.noalias() = affine.A * part_;
      next_ += input(i, shifts_[s]) * affine.B.col(i);
      output_.noalias() = affine.C * next_;
      effects_[s].segment(i * n_y, n_y) = output_;
    }
}

}  // namespace fpc
