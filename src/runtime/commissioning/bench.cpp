#include "runtime/commissioning/bench.hpp"

#include "fmbpc/base/input_error.hpp"
#include "runtime/factory.hpp"

namespace fpc {

LoopFile Bench::prepared(const CommissioningBrief& brief) {
  LoopFile loop = brief.loop;
  loop.setpoint.initial = brief.hold;
  loop.setpoint.schedule.clear();
  loop.setpoint.commands.clear();
  loop.simulation.samples = brief.samples() + 1;
  loop.simulation.noise_seed += brief.seed;
  return loop;
}

Bench::Bench(const CommissioningBrief& brief)
    : loop_(prepared(brief)),
      closed_(brief.closed),
      simulation_(makeSimulation(loop_)),
      controller_(makeControllerSession(loop_)) {
  sample_.present = loop_.simulation.actuator.initial;
  if (loop_.has_clp) optimizer_.emplace(makeOptimizerSession(loop_));
  if (controller_.controller().needsModel()) {
    require(loop_.has_model, brief.file + ": loop", "a model for the present controller");
    controller_.setModel(loop_.model);
  }
  simulation_.reset(1);
  controller_.announce(1);
  if (optimizer_) optimizer_->announce(1);
}

const StagedPlant::Sample& Bench::next() {
  sample_.now = simulation_.measurement();
  sample_.sent.resize(0);
  true_outputs_ = simulation_.state().outputs;
  if (!closed_) return sample_;
  controller_.receive(sample_.now);
  const ControllerAnswer& answer = controller_.answer();
  if (optimizer_) {
    if (answer.has_prediction) optimizer_->receive(answer.prediction);
    optimizer_->receive(answer.base);
  }
  sample_.present = optimizer_ ? optimizer_->action().input : answer.base.input;
  return sample_;
}

const Vector& Bench::send(VectorRef input) {
  simulation_.advance(input);
  const std::string& trouble = simulation_.state().trouble;
  require(trouble.empty(), loop_.name + ": plant", "a plant that moves: " + trouble);
  sample_.sent = input;
  return sample_.sent;
}

}  // namespace fpc
