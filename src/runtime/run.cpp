#include "runtime/run.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "fmbpc/base/input_error.hpp"
#include "runtime/command_player.hpp"
#include "runtime/cut_offsets.hpp"
#include "runtime/factory.hpp"
#include "runtime/forced_inputs.hpp"
#include "runtime/late_lines.hpp"
#include "runtime/loop_controller.hpp"
#include "runtime/operator_notes.hpp"
#include "runtime/plant_session.hpp"
#include "runtime/recorder_session.hpp"
#include "runtime/remark_lines.hpp"
#include "runtime/sample_remarks.hpp"

namespace fpc {
namespace {

constexpr std::uint64_t kRunId = 1;

/// The members of the ring, called in the order in which messages would travel.
class Ring {
 public:
  Ring(const LoopFile& loop, const RunOptions& options)
      : loop_(loop),
        options_(options),
        made_(std::make_unique<SimulatedProcess>(makeSimulation(loop))),
        simulation_(made_->simulation()),
        plant_(std::move(made_), lockstepPolicy(loop)),
        controller_(loop, {options.identified,
                           [this](const std::string& words) { tell(present_, words); }}),
        player_(options.commands, simulation_.clock()),
        record_(recordLayout(loop).emptyRecord()),
        recorder_(recordLayout(loop),
                  [this](const SampleRecord& sample) { record_.samples.push_back(sample); }),
        remarks_(loop),
        forced_(simulation_.info()),
        cut_(simulation_.description().disturbances),
        targets_{simulation_, controller_.session(),
                 [this](int window) { controller_.identify(window); },
                 [this](std::uint32_t step, const std::string& words) { refuse(step, words); }} {
    plant_.begin(kRunId);
    recorder_.announce(kRunId);
    player_.begin(targets_);
    plant_.start(0.0);
  }

  /// Answers the present sample; false after the final one.
  bool step() {
    const Measurement now = simulation_.measurement();
    present_ = now.header.step;
    player_.advance(present_, targets_);
    recorder_.receive(now);
    forced_.look(now.header.step, simulation_.effects());
    cut_.look(simulation_);
    recorder_.receive(simulation_.state(),
                      joinedLines(late(), joinedLines(forced_.lines(), cut_.lines())));
    controller_.receive(now);
    const ControllerAnswer& answer = controller_.answer();
    recorder_.receive(answer.tracking, joinedLines(remarks_.look(controller_.session()),
                                                   controller_.takeFailures()));
    if (!now.final) {
      recorder_.receiveBase(answer.base);
      plant_.receive(optimize());
      plant_.advance(0.0);
    }
    controller_.learn(now);
    return !now.final;
  }

  RunRecord take() {
    recorder_.close();
    conclude(record_, recorder_.complete());
    const std::string missed = controller_.takeFailures();
    if (!missed.empty()) notes_.failed(present_, inOneLine(missed));  // at the very end
    for (RunRemark& note : notes_.remarks()) record_.remarks.push_back(std::move(note));
    const std::string unplayed = player_.unplayed();
    if (!unplayed.empty()) record_.remarks.push_back({unplayed, 0, 0});
    return std::move(record_);
  }

 private:
  std::string late() const {
    return present_ == 0 ? lateLines(loop_, loop_.simulation.output_delay_s) : "";
  }

  const ControlAction& optimize() {
    const ControlAction& action = controller_.optimize();
    if (controller_.hasOptimizer()) {
      recorder_.receiveAction(action);
      recorder_.receive(controller_.report());
    }
    return action;
  }

  void tell(std::uint32_t step, const std::string& words) const {
    remark("sample " + std::to_string(step) + ": " + words);
  }

  /// What an operator asked in vain is told at once and kept.
  void refuse(std::uint32_t step, const std::string& words) {
    notes_.refused(step, words);
    tell(step, words);
  }

  void remark(const std::string& words) const {
    if (options_.remark) options_.remark(words);
  }

  const LoopFile& loop_;
  const RunOptions& options_;
  std::uint32_t present_{};                 // the sample that is answered
  std::unique_ptr<SimulatedProcess> made_;  // until it is the session's
  Simulation& simulation_;
  PlantSession plant_;
  LoopController controller_;
  CommandPlayer player_;
  RunRecord record_;
  RecorderSession recorder_;
  SampleRemarks remarks_;
  ForcedInputs forced_;
  CutOffsets cut_;
  OperatorNotes notes_;
  CommandTargets targets_;
};

}  // namespace

RunRecord runLoop(const LoopFile& loop, const RunOptions& options) {
  const std::uint32_t samples = loop.simulation.samples;
  require(samples > 0, loop.name + ": sampling.duration_h",
          "a time > 0: a run in one process must end");
  Ring ring(loop, options);
  for (std::uint32_t step = 0; ring.step(); ++step) {
    if (options.progress) options.progress(step + 1, samples);
    if (options.stop && options.stop()) break;
  }
  return ring.take();
}

}  // namespace fpc
