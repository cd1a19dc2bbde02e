// A plant under its present control as the stages of a commissioning see it: simulated beside them,
// or alive behind a loop over topics.
#pragma once

#include "fmbpc/base/exchange.hpp"

namespace fpc {

class StagedPlant {
 public:
  struct Sample {
    Measurement now;
    Vector present;  ///< what the control in charge asks; of an open loop the start input
    Vector sent;     ///< what went out without waiting for send(); empty: send() is waited for
  };

  virtual ~StagedPlant() = default;
  /// The next sample, in order. @throws InputError saying why none comes any more.
  virtual const Sample& next() = 0;
  /// Answers the sample that next() gave. Returns what really went out.
  virtual const Vector& send(VectorRef input) = 0;
  /// No more samples are asked for: the control in charge goes on by itself.
  virtual void release() {}
  /// Outputs without noise, of that sample, where somebody can know them: for judges only.
  virtual const Vector& trueOutputs() const = 0;
};

}  // namespace fpc
