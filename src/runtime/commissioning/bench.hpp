// A simulated plant under its present control, sample by sample, with somebody's hand between the
// control and the plant.
#pragma once

#include <optional>

#include "plant/simulation.hpp"
#include "runtime/commissioning/brief.hpp"
#include "runtime/commissioning/staged_plant.hpp"
#include "runtime/session.hpp"

namespace fpc {

/// The plant of a brief from its start on: setpoints are the brief's, disturbances and noise those
/// of the loop file. The same inputs give the same bits, so that a stage that was stopped is played
/// again.
class Bench final : public StagedPlant {
 public:
  explicit Bench(const CommissioningBrief& brief);
  const Sample& next() override;
  /// @throws InputError if the plant cannot be moved.
  const Vector& send(VectorRef input) override;
  const Vector& trueOutputs() const override { return true_outputs_; }

 private:
  static LoopFile prepared(const CommissioningBrief& brief);

  LoopFile loop_;
  bool closed_;
  Simulation simulation_;
  ControllerSession controller_;
  std::optional<OptimizerSession> optimizer_;
  Sample sample_;
  Vector true_outputs_;
};

}  // namespace fpc
