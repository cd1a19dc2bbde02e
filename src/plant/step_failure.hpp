// What a stepper that approximates equations says of its last step. Private to the room.
#pragma once

#include <string>
#include <vector>

#include "fmbpc/plant/plant.hpp"

namespace fpc {

/// Implemented besides PlantStepper where steps of a fixed length can fail.
class StepFailure {
 public:
  virtual ~StepFailure() = default;
  /// Why the state after the last advance() is none of the plant's; empty if it is one.
  virtual const std::string& failure() const = 0;
};

/// The first of these states that has left its range by more than `tolerance`, in words; empty if
/// none has.
std::string outsideRange(const std::vector<Quantity>& states, Eigen::Index count, VectorRef x,
                         double tolerance);

}  // namespace fpc
