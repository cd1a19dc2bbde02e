#include "runtime/run.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>

#include "fmbpc/base/input_error.hpp"
#include "runtime/command_player.hpp"
#include "runtime/factory.hpp"
#include "runtime/loop_controller.hpp"
#include "runtime/plant_session.hpp"
#include "runtime/recorder_session.hpp"
#include "runtime/run_events.hpp"

namespace fpc {
namespace {

constexpr std::uint64_t kRunId = 1;

template <class Work>
double secondsOf(Work&& work) {
  const auto begun = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
}

/// The members of the ring, called in the order in which messages would travel.
class Ring {
 public:
  Ring(const LoopFile& loop, const RunOptions& options)
      : loop_(loop),
        options_(options),
        made_(std::make_unique<SimulatedProcess>(makeSimulation(loop))),
        simulation_(made_->simulation()),
        plant_(std::move(made_), lockstepPolicy(loop)),
        controller_(loop, {options.identified, options.said}),
        player_(options.commands, simulation_.clock()),
        record_(recordLayout(loop).emptyRecord()),
        recorder_(recordLayout(loop),
                  [this](std::uint32_t, const SampleRecord& sample) {
                    record_.samples.push_back(sample);
                  }),
        targets_{
            simulation_, controller_.session(),
            [this](int window) { controller_.identify(window); },
            [this](const std::string& why) { controller_.say(EventCode::kCommandRefused, why); },
            controller_.layer()} {
    plant_.begin(kRunId);
    recorder_.announce(kRunId);
    player_.begin(targets_);
    plant_.start(0.0);
  }

  /// Answers the present sample; false after the final one.
  bool step() {
    const Measurement now = simulation_.measurement();
    present_ = now.header.step;
    controller_.turnTo(present_);
    player_.advance(present_, targets_);
    recorder_.receive(now);
    recorder_.receive(simulation_.state(),
                      joined(simulation_.events(),
                             delayEvents(loop_, loop_.simulation.output_delay_s, present_)));
    double taken = secondsOf([&] { controller_.receive(now); });
    const ControllerAnswer& answer = controller_.answer();
    recorder_.receive(answer.tracking, joined(answer.events, controller_.takeEvents()));
    if (!now.final) {
      recorder_.receiveBase(answer.base);
      taken += secondsOf([&] { controller_.optimize(); });
      record_.slowest_step_s = std::max(record_.slowest_step_s, taken);
      if (controller_.hasOptimizer()) {
        recorder_.receiveAction(controller_.sent());
        recorder_.receive(controller_.report());
      }
      plant_.receive(controller_.sent());
      plant_.advance(0.0);
    }
    controller_.learn(now);
    return !now.final;
  }

  RunRecord take() {
    recorder_.close();
    conclude(record_, recorder_.complete());
    record_.events = controller_.takeEvents();  // of the very end
    const std::string unplayed = player_.unplayed();
    if (!unplayed.empty())
      record_.events.push_back(eventOf(EventCode::kCommandsUnplayed, unplayed));
    return std::move(record_);
  }

 private:
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
