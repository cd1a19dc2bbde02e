// A lag with dead time, K exp(-theta s) / (tau s + 1), and what it becomes between samples whose
// input is held: exact for dead times that are no whole number of samples.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc {

/// Times in minutes, gain in output units per input unit.
struct Fopdt {
  double gain{};           ///< K
  double time_constant{};  ///< tau > 0
  double dead_time{};      ///< theta >= 0
  /// @throws InputError naming `key` + gain, time_constant_min or dead_time_min.
  void validate(const std::string& key) const;
};

/// Two outputs from two inputs: [output][input].
using FopdtMatrix = std::array<std::array<Fopdt, 2>, 2>;

/// y(k+1) = a y(k) + K (near u(k-d) + far u(k-d-1)); near + far = 1 - a.
struct SampledFopdt {
  double a{}, near{}, far{};
  int delay{};  ///< d, whole samples
};
/// theta within 1e-9 samples of whole samples is taken as whole. @throws InputError for more than
/// 1e6 samples of dead time.
SampledFopdt sampled(const Fopdt& element, double sample_time_min);

/// The unit-gain answer of an element to the inputs it has been given, sample by sample.
class LagResponse {
 public:
  LagResponse(const Fopdt& element, double sample_time_min);
  void rest(double input);  ///< the input has always been this: the response is the same
  /// Takes u(k), returns the response at k+1. No allocation.
  double advance(double input);
  double value() const { return value_; }

 private:
  SampledFopdt lag_;
  std::vector<double> past_;
  std::size_t next_{};
  double value_{};
};

}  // namespace fpc
