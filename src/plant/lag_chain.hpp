// Equal first-order lags in a row, moved exactly: how analysers and drives follow what they see.
#pragma once

#include <vector>

namespace fpc {

/// n lags with one time constant. Memory: the position of each.
class LagChain {
 public:
  /// @throws InputError unless 1 <= order <= 20 and time_constant_s > 0.
  LagChain(int order, double time_constant_s);
  void reset(double value);
  /// Moves over `seconds` while the input goes in a straight line from `from` to `to`; returns the
  /// mean of the output over that time.
  double advance(double from, double to, double seconds);
  double output() const { return x_.back(); }

 private:
  double tau_;
  std::vector<double> x_, gap_, weight_;
};

/// T90, the time to 90 % of a step, of `order` equal lags of unit time constant; for 2 and 8 lags
/// the benchmark's own figures, 3.89 and 11.7724.
double lagsToNinety(int order);

}  // namespace fpc
