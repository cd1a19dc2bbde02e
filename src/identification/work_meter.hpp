// How much a search has done, counted the same way on every machine.
#pragma once

namespace fpc {

/// Work in multiply-adds of the fits' inner loops. A limit in work ends a search at the same fit
/// everywhere; one in seconds does not.
struct WorkMeter {
  /// Of a unit, which takes about a second on one core of 2020.
  static constexpr double kPerUnit = 2.0e9;

  double limit{};  ///< no new fit is begun once so much is spent
  double spent{};
  bool isSpent() const { return !(spent < limit); }
};

}  // namespace fpc
