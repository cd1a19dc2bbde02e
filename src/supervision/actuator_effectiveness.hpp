// Do the outputs react to the inputs as the model says? Finds an input that does not move although
// nothing is read back of it, and one that pushes the other way.
#pragma once

#include <string>
#include <vector>

#include "fmbpc/base/event.hpp"
#include "fmbpc/base/exchange.hpp"
#include "supervision/forecast_parts.hpp"

namespace fpc {

/// For output o and input i, with e(k) the model's error one sample ahead and phi(k) that part of
/// its forecast that comes from input i, least squares over the last `samples` samples give
///   e(k) = a + (c - 1) phi(k):
/// c is the share of the forecast reaction that was seen, 1 if the model is right, 0 if the input
/// stands still, below 0 if it pushes the other way. Of the outputs the one with the smallest
/// standard error s of c counts; residuals and phi that follow each other widen it by
/// sqrt((1 + r) / (1 - r)), r the product of their autocorrelations at lag one. An input does not
/// react once c + 2 s < kLeast for a quarter of the window, s below kSure; it does again once
/// c - 2 s is larger. Without moves nothing is judged.
/// Symbols:  c, s per input;  a, e, phi per output [of the output]
class ActuatorEffectiveness {
 public:
  static constexpr double kLeast = 0.35, kSure = 0.15;

  /// `model` is matched to the plant. @throws InputError unless samples >= 8.
  ActuatorEffectiveness(const TsModel& model, int samples);
  /// Forgets everything.
  void reset();
  /// A sample was lost or not accepted: goes on with the next one.
  void interrupt() { parts_.interrupt(); }
  /// Sample k; its input_applied is what was told, or what was read back. No allocation.
  void look(const Measurement& now);
  /// "the outputs do not react to input q_r as the model says"; kNone if they do, or nobody knows.
  const Notice& notice() const { return notice_; }
  double share(Eigen::Index input) const { return share_[input]; }  ///< c; NaN: not known

 private:
  void keep();
  void judge();
  void estimate(Eigen::Index output, Eigen::Index input, double& share, double& error) const;

  ForecastParts parts_;
  std::vector<std::string> names_;  // of the inputs
  Matrix errors_, phi_;             // n_y N; n_y n_u, N
  Vector share_;                    // n_u
  std::vector<int> away_;           // samples in a row
  std::vector<bool> dead_;
  Eigen::Index filled_{}, place_{};
  std::vector<std::string> texts_;  // by input
  Notice notice_;
};

}  // namespace fpc
