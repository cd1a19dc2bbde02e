#include "supervision/horizon_errors.hpp"

#include <algorithm>
#include <cmath>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"

namespace fpc {

using Eigen::Index;

HorizonErrors::HorizonErrors(const TsModel* model, int horizon, Index capacity) {
  require(horizon >= 1, "horizon", "an integer >= 1");
  require(capacity > 0, "candidate.samples", "an integer > 0");
  if (model != nullptr) local_.emplace(*model);
  for (int h = 1; h < horizon; h *= 2) horizons_.push_back(h);
  horizons_.push_back(horizon);
  runs_.resize(static_cast<std::size_t>(horizon));
  offsets_.resize(runs_.size());
  model_.assign(horizons_.size(), Matrix());
  stays_ = model_;
  for (Matrix& m : model_) m.resize(0, capacity);
}

void HorizonErrors::reset() {
  interrupt();
  kept_ = 0;
  offset_.setZero();
}

void HorizonErrors::interrupt() {
  known_ = false;
  running_ = 0;
}

void HorizonErrors::look(const Measurement& now) {
  const Index n_y = now.outputs.size(), capacity = model_[0].cols();
  if (past_.rows() != n_y) {  // the first sample
    past_ = Matrix::Zero(n_y, static_cast<Index>(runs_.size()));
    for (auto* all : {&model_, &stays_})
      for (Matrix& m : *all) m = Matrix::Constant(n_y, capacity, kNaN);
    offset_ = predicted_ = Vector::Zero(n_y);
    for (Vector& offset : offsets_) offset = offset_;
    before_ = now.disturbances;
    if (hasModel()) {
      state_ = next_ = Vector::Zero(local_->stateSize());
      for (Vector& run : runs_) run = state_;
    }
  }
  const bool room = kept_ < capacity;
  if (known_) {
    if (hasModel()) move(now);
    const std::size_t n = runs_.size();
    for (std::size_t h = 0; h < horizons_.size() && room; ++h) {
      model_[h].col(kept_).setConstant(kNaN);
      stays_[h].col(kept_).setConstant(kNaN);
      if (horizons_[h] > running_) continue;
      const std::size_t slot = (newest_ + n + 1 - static_cast<std::size_t>(horizons_[h])) % n;
      stays_[h].col(kept_) = (now.outputs - past_.col(static_cast<Index>(slot))).cwiseAbs2();
      if (!hasModel()) continue;
      for (Index o = 0; o < n_y; ++o) {
        const double error = now.outputs[o] - runs_[slot][local_->outputState(o)];
        model_[h](o, kept_) = error * error;
      }
    }
    if (room) ++kept_;
  }
  if (hasModel()) {
    if (known_)
      local_->shiftState(now.outputs, now.input_applied, before_, state_);
    else
      local_->restState(now.outputs, now.input_applied, now.disturbances, state_);
  }
  known_ = true;
  before_ = now.disturbances;
  newest_ = (newest_ + 1) % runs_.size();
  if (hasModel()) runs_[newest_] = state_;
  offsets_[newest_] = offset_;
  past_.col(static_cast<Index>(newest_)) = now.outputs;
  running_ = std::min(running_ + 1, static_cast<int>(runs_.size()));
}

/// All predictions by one sample; the newest one gives the mean error.
void HorizonErrors::move(const Measurement& now) {
  LocalModel& local = *local_;
  const std::size_t n = runs_.size();
  for (int age = 0; age < running_; ++age) {
    const std::size_t slot = (newest_ + n - static_cast<std::size_t>(age)) % n;
    local.advance(runs_[slot], now.input_applied, before_, next_);
    if (age == 0)
      for (Index o = 0; o < offset_.size(); ++o) predicted_[o] = next_[local.outputState(o)];
    for (Index o = 0; o < offset_.size(); ++o) next_[local.outputState(o)] += offsets_[slot][o];
    runs_[slot].swap(next_);
  }
  for (Index o = 0; o < offset_.size(); ++o) {
    const double error = now.outputs[o] - predicted_[o];
    if (std::isfinite(error)) offset_[o] += (error - offset_[o]) / kMemory;
  }
}

double HorizonErrors::ratio(std::size_t h) const {
  double sum = 0.0;
  int outputs = 0;
  for (Index o = 0; o < model_[h].rows(); ++o) {
    double of_model = 0.0, of_stays = 0.0;
    for (Index k = 0; k < kept_; ++k) {
      if (!std::isfinite(stays_[h](o, k))) continue;
      of_model += std::isfinite(model_[h](o, k)) ? model_[h](o, k) : kInfinity;
      of_stays += stays_[h](o, k);
    }
    if (!(of_stays > 0.0)) continue;
    sum += of_model / of_stays;
    ++outputs;
  }
  return outputs > 0 ? std::sqrt(sum / outputs) : kNaN;
}

}  // namespace fpc
