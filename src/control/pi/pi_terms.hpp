// What a PI may take besides its error: feed-forward, derivative, setpoint preview and lead, the
// steady input of the setpoint. Private state per loop; all terms are off by default.
#pragma once

#include <string>
#include <vector>

#include "fmbpc/base/exchange.hpp"
#include "fmbpc/control/setpoint_source.hpp"

namespace fpc {

/// u += gain / (1 + lag s) (d - nominal), of a measured disturbance or the product of two (a load:
/// concentration times flow).
struct PiFeedforward {
  int disturbance{};  ///< index into the measured ones
  double gain{};      ///< input per unit of the disturbance, or of the product
  double nominal{};   ///< where it adds nothing
  double lag_h{};
  int times{-1};  ///< index of the other factor; -1: none
  double valueOf(const Vector& disturbances) const;
};

/// A point of a curve: increasing in `at`, linear between points, held outside.
struct CurvePoint {
  double at{}, value{};
};

/// `empty` for a curve without points.
double valueOf(const std::vector<CurvePoint>& curve, double at, double empty);
/// @throws InputError naming `key`.
void validateCurve(const std::vector<CurvePoint>& curve, const std::string& key);

struct PiTerms {
  double kd_h{};              ///< input per output, times h; acts on -dy/dt, not scheduled
  double derivative_lag_h{};  ///< of the filter on the derivative; 0: a difference over one sample
  double preview_h{};         ///< the setpoint is that of so much later in the schedule
  double setpoint_pole{};     ///< per sample, of a first-order path that e takes for the setpoint
  double setpoint_lead_h{};   ///< e takes r + lead dr/dt
  std::vector<CurvePoint> static_input;  ///< steady input of r, in the place of the bias
  std::vector<PiFeedforward> feedforward;
  bool any() const;  ///< whether a term is on
  /// @throws InputError naming `key`....
  void validate(const std::string& key, Eigen::Index n_d) const;
};

/// The terms of one loop with their memory. Works without allocation after construction.
class PiTermState {
 public:
  PiTermState(const PiTerms& terms, int output, Eigen::Index n_y, double sample_time_s);
  void reset();
  /// What e is taken from: setpoint ahead, on its path, with its lead. Once per sample.
  double aim(const Measurement& now, const SetpointSource& setpoint);
  /// Steady input, derivative (times `gain`: its sign, -1 in a reverse loop) and feed-forward, in
  /// units of the input.
  /// After aim(), once a sample.
  double sum(const Measurement& now, double gain);

 private:
  double derivative(double output);
  double feedforward(const Measurement& now);

  PiTerms terms_;
  int output_;
  double sample_time_h_;
  std::uint32_t preview_samples_;
  Vector ahead_, lagged_;  // setpoints of later; states of the feed-forward lags
  double path_{}, path_before_{}, output_before_{}, slope_{};
  bool fresh_{true};
};

}  // namespace fpc
