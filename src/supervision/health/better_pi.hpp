// What a PI tuned for a loop's own response would have made of its record.
#pragma once

#include <vector>

#include "supervision/health/step_response.hpp"

namespace fpc {

struct RecordedLoop {
  double sample_time_s{};
  std::vector<double> error;   ///< y - setpoint; NaN where unknown or not in automatic
  std::vector<double> judged;  ///< finite where the standard deviations are taken
  std::vector<double> u;       ///< in force from its sample on
  double u_lower{-kInfinity}, u_upper{kInfinity};
};

/// Standard deviation of the error under that PI (simc) over that of the record: the output that
/// was measured plus what the other moves would have changed. Loads and noise are those of the
/// record, whatever their colour. NaN where one of the responses is not known or too little is
/// there.
/// @param response  of the process, at the samples of `tuned_for`
/// Source: skogestad2003
double errorUnderPi(const RecordedLoop& loop, const StepResponse& tuned_for,
                    const StepResponse& response);

}  // namespace fpc
