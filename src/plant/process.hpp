// What stands behind the plant's end of the exchange: a simulation, or a gateway to a plant that is
// not ours.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "fmbpc/base/exchange.hpp"
#include "plant/actuator.hpp"
#include "plant/simulation.hpp"

namespace fpc {

/// Sample k is on the table until advance() or advanceWithoutAction() puts the next one there.
class Process {
 public:
  virtual ~Process() = default;
  virtual const PlantInfo& info() const = 0;
  virtual const Measurement& measurement() const = 0;
  virtual const Actuator& actuator() const = 0;
  /// Sample 0 of a new run.
  virtual const Measurement& reset(std::uint64_t run_id) = 0;
  /// u(k) has come: a plant that lives on its own gets it now, a simulated one with advance().
  virtual void take(VectorRef input);
  /// Moves to sample k+1 with u(k); does nothing at the final sample.
  virtual const Measurement& advance(VectorRef input) = 0;
  /// Moves on without an action: hold, then fallback.
  virtual const Measurement& advanceWithoutAction() = 0;
  /// False: its own hand has the inputs, or its link is lost.
  virtual bool takesActions() const { return true; }
  /// The last command is still on its way.
  virtual bool underWay() const { return false; }
  /// Where the inputs are as far as anybody can see; NaN: nobody can. A plant that reads nothing
  /// back is where it was told.
  virtual const Vector& positions() const { return measurement().input_applied; }
  /// Why the plant did not move as asked, empty if it did.
  virtual const std::string& trouble() const = 0;
  /// True if the action answers the present sample; anything else must be dropped (and counted) by
  /// the caller.
  bool answers(const StepHeader& header) const;
};

class SimulatedProcess final : public Process {
 public:
  explicit SimulatedProcess(Simulation simulation) : simulation_(std::move(simulation)) {}
  const PlantInfo& info() const override { return simulation_.info(); }
  const Measurement& measurement() const override { return simulation_.measurement(); }
  const Actuator& actuator() const override { return simulation_.actuator(); }
  const Measurement& reset(std::uint64_t run_id) override { return simulation_.reset(run_id); }
  const Measurement& advance(VectorRef input) override { return simulation_.advance(input); }
  const Measurement& advanceWithoutAction() override { return simulation_.advanceWithoutAction(); }
  const std::string& trouble() const override { return simulation_.trouble(); }
  Simulation& simulation() { return simulation_; }

 private:
  Simulation simulation_;
};

}  // namespace fpc
