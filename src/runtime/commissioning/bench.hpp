// A simulated plant under its present control, sample by sample, with somebody's hand between the
// control and the plant.
#pragma once

#include <optional>

#include "plant/simulation.hpp"
#include "runtime/commissioning/brief.hpp"
#include "runtime/session.hpp"

namespace fpc {

/// The plant of a brief from its start on: setpoints are the brief's, disturbances and noise those
/// of the loop file. The same inputs give the same bits, so that a stage that was stopped is played
/// again.
class Bench {
 public:
  explicit Bench(const CommissioningBrief& brief);
  const Measurement& now() const { return simulation_.measurement(); }
  /// What the present control asks at this sample; of an open loop the start input.
  const Vector& present();
  /// What goes to the plant; moves on. @throws InputError if the plant cannot be moved.
  void send(VectorRef input);
  /// Outputs without noise, of this sample: for judges only.
  const Vector& trueOutputs() const { return simulation_.state().outputs; }

 private:
  static LoopFile prepared(const CommissioningBrief& brief);

  LoopFile loop_;
  bool closed_;
  Simulation simulation_;
  ControllerSession controller_;
  std::optional<OptimizerSession> optimizer_;
  Vector present_;
};

}  // namespace fpc
