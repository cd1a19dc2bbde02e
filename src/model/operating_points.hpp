// What an engineer asks of a model: gains, time constants, poles, dead times and step responses,
// at several rests.
#pragma once

#include <complex>
#include <string>
#include <vector>

#include "fmbpc/model/ts_model.hpp"

namespace fpc {

/// A model linearised at a rest, the slopes of its rules' weights included.
struct OperatingPoint {
  std::string name;                         ///< "middle", "q low", "q high"
  Vector outputs, inputs, disturbances;     ///< there
  bool rests{};                             ///< false: no rest was reached; outputs are mid-range
  std::vector<std::complex<double>> poles;  ///< of all outputs together, the largest first
  std::vector<double> time_constants_s;  ///< of real poles in (0, 1) and pairs, the longest first
  Matrix gains;                          ///< n_y x n_u, at rest; infinite with a pole at 1
  std::vector<Matrix> steps;  ///< per input: samples x n_y, answers to a step of one unit
};

/// At the middle of all inputs' ranges, and with each input in turn at a tenth and nine tenths of
/// its range; disturbances at their middle. Empty if a range is not known. `samples` of each step
/// response; 0: five of the longest time constants, 20 to 2000.
/// @throws InputError as TsModel::validate().
std::vector<OperatingPoint> operatingPoints(const TsModel& model, int samples = 0);

/// Samples between a change of an input and the first answer of an output, by the rules' lags; -1:
/// it does not depend on it. n_y x n_u, through other outputs too.
Eigen::MatrixXi deadTimes(const TsModel& model);

}  // namespace fpc
