// What a model foresees one sample ahead, how far that is from what came, and what each input had
// to do with it.
#pragma once

#include <vector>

#include "fmbpc/base/exchange.hpp"
#include "fmbpc/model/local_model.hpp"

namespace fpc {

/// Of y(k) out of sample k - 1: the model's error, and for each input that part of the forecast
/// that comes from its distance to where it was first seen, also as if it had acted some samples
/// later or earlier. No allocation in look() after the first sample.
class ForecastParts {
 public:
  /// `model` is matched to the plant. `shifts`: samples by which an input acts later (earlier where
  /// negative) than the model says.
  explicit ForecastParts(const TsModel& model, std::vector<int> shifts = {0});
  /// Forgets everything.
  void reset() { known_ = started_ = false; }
  /// A sample was lost or not accepted: goes on with the next one.
  void interrupt() { known_ = false; }
  /// Sample k; its input_applied is u(k-1). False if there was no forecast of it.
  bool look(const Measurement& now);
  const Vector& error() const { return error_; }  ///< n_y
  /// n_y n_u, the inputs one below the other; `shift` counts the shifts.
  const Vector& effect(std::size_t shift = 0) const { return effects_[shift]; }
  const LocalModel& local() const { return local_; }
  const Vector& state() const { return state_; }  ///< of the sample looked at last
  int firstLag(Eigen::Index input) const { return first_lag_[at(input)]; }  ///< of a regressor
  int lastLag(Eigen::Index input) const { return last_lag_[at(input)]; }    ///< of any variable
  bool knows(Eigen::Index input) const { return known_input_[at(input)]; }

 private:
  static std::size_t at(Eigen::Index i) { return static_cast<std::size_t>(i); }
  void findLags();
  void remember(const Vector& applied, bool all);
  void predict(const Measurement& now);
  double input(Eigen::Index i, int lag) const;

  LocalModel local_;
  std::vector<int> shifts_, first_lag_, last_lag_;
  std::vector<bool> known_input_;
  Vector state_, part_, next_, before_, reference_, output_, error_;
  std::vector<Vector> effects_;
  Matrix past_;  // n_u x samples, the newest first: u(k-1), u(k-2), ...
  bool known_{false}, started_{false};
};

}  // namespace fpc
