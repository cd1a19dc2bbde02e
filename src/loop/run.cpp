#include "fmbpc/loop/run.hpp"

#include <optional>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/loop/factory.hpp"

namespace fpc {
namespace {

constexpr std::uint64_t kRunId = 1;

/// The members of the ring, called in the order in which messages would travel.
class Ring {
 public:
  explicit Ring(const LoopFile& loop)
      : simulation_(makeSimulation(loop)),
        controller_(makeControllerSession(loop)),
        recorder_(makeRecorder(loop)) {
    if (loop.has_clp) optimizer_.emplace(makeOptimizerSession(loop));
    if (loop.has_model && controller_.controller().needsModel()) controller_.setModel(loop.model);
    simulation_.reset(kRunId);
  }

  /// Answers the present sample; false after the final one.
  bool step() {
    const Measurement& now = simulation_.measurement();
    recorder_.add(now);
    recorder_.add(simulation_.state());
    controller_.receive(now);
    const ControllerAnswer& answer = controller_.answer();
    recorder_.add(answer.tracking);
    if (now.final) return false;
    recorder_.addBase(answer.base);
    simulation_.advance(optimizer_ ? optimize(answer) : answer.base.input);
    return true;
  }

  RunRecord take() { return recorder_.take(); }

 private:
  Recorder makeRecorder(const LoopFile& loop) const {
    std::vector<std::string> names, units;
    for (const auto& state : simulation_.description().states) {
      names.push_back(state.name);
      units.push_back(state.unit);
    }
    Recorder recorder(loop.name, simulation_.info(), loop.has_clp, true, names, units);
    recorder.leaveOut(loop.report.without_setpoint);
    return recorder;
  }

  const Vector& optimize(const ControllerAnswer& answer) {
    if (answer.has_prediction) optimizer_->receive(answer.prediction);
    optimizer_->receive(answer.base);
    recorder_.addAction(optimizer_->action());
    recorder_.add(optimizer_->report());
    return optimizer_->action().input;
  }

  Simulation simulation_;
  ControllerSession controller_;
  std::optional<OptimizerSession> optimizer_;
  Recorder recorder_;
};

}  // namespace

RunRecord runLoop(const LoopFile& loop, const RunOptions& options) {
  const std::uint32_t samples = loop.simulation.samples;
  require(samples > 0, loop.name + ": sampling.duration_h",
          "a time > 0: a run in one process must end");
  const ControllerType& controller = loop.controllerType();
  require(loop.has_model || !controller.needs_model, loop.name + ": model.file",
          "a model for controller " + controller.name);
  Ring ring(loop);
  for (std::uint32_t step = 0; ring.step(); ++step) {
    if (options.progress) options.progress(step + 1, samples);
    if (options.stop && options.stop()) break;
  }
  return ring.take();
}

}  // namespace fpc
