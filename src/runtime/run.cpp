#include "runtime/run.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <utility>

#include "fmbpc/base/input_error.hpp"
#include "runtime/command_player.hpp"
#include "runtime/factory.hpp"
#include "runtime/identifier_session.hpp"
#include "runtime/plant_session.hpp"
#include "runtime/recorder_session.hpp"
#include "runtime/run_events.hpp"

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
        controller_(makeControllerSession(loop)),
        player_(options.commands, simulation_.clock()),
        record_(recordLayout(loop).emptyRecord()),
        recorder_(recordLayout(loop),
                  [this](const SampleRecord& sample) { record_.samples.push_back(sample); }),
        targets_{simulation_, controller_, [this](int window) { identifyAsked(window); },
                 [this](const std::string& why) { say(EventCode::kCommandRefused, why); }} {
    if (loop.has_clp) optimizer_.emplace(makeOptimizerSession(loop));
    if (loop.has_model || loop.has_identify) identifier_.emplace(loop);
    plant_.begin(kRunId);
    recorder_.announce(kRunId);
    if (identifier_) begin(identifier_->start());
    require(controller_.ready(), loop.name + ": model.file",
            "a model for controller " + loop.controllerType().name);
    player_.begin(targets_);
    plant_.start(0.0);
  }

  /// Answers the present sample; false after the final one.
  bool step() {
    const Measurement now = simulation_.measurement();
    present_ = now.header.step;
    player_.advance(present_, targets_);
    recorder_.receive(now);
    recorder_.receive(simulation_.state(),
                      joined(simulation_.events(),
                             delayEvents(loop_, loop_.simulation.output_delay_s, present_)));
    const auto asked = std::chrono::steady_clock::now();
    controller_.receive(now);
    const ControllerAnswer& answer = controller_.answer();
    for (Event& event : pending_) event.first = event.last = present_;
    recorder_.receive(answer.tracking, joined(answer.events, std::exchange(pending_, {})));
    if (!now.final) {
      recorder_.receiveBase(answer.base);
      const ControlAction& action = optimizer_ ? optimize(answer) : answer.base;
      const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - asked;
      record_.slowest_step_s = std::max(record_.slowest_step_s, taken.count());
      plant_.receive(action);
      plant_.advance(0.0);
    }
    if (loop_.has_identify) learn(now);
    return !now.final;
  }

  RunRecord take() {
    recorder_.close();
    conclude(record_, recorder_.complete());
    record_.events = std::move(pending_);  // of the very end
    const std::string unplayed = player_.unplayed();
    if (!unplayed.empty())
      record_.events.push_back(eventOf(EventCode::kCommandsUnplayed, unplayed));
    return std::move(record_);
  }

 private:
  const ControlAction& optimize(const ControllerAnswer& answer) {
    if (answer.has_prediction) optimizer_->receive(answer.prediction);
    optimizer_->receive(answer.base);
    recorder_.receiveAction(optimizer_->action());
    recorder_.receive(optimizer_->report());
    return optimizer_->action();
  }

  void learn(const Measurement& now) {
    const IdentifierSession::Due due = identifier_->take(now);
    if (!due.refusal.empty()) say(due.refused, due.refusal);
    use(due.model);
    if (due.job) identify(*due.job);
  }

  void identifyAsked(int window) {
    require(identifier_ && loop_.has_identify, "identify", "a loop with model.identify");
    identify(identifier_->job(loop_.identify.structure, static_cast<std::size_t>(window),
                              loop_.identify.validation_share));
  }

  void identify(const IdentificationJob& job) {
    try {
      const RecordIdentification result =
          identifyRecord(job.values, job.structure, job.source, job.share);
      const TsModel& model = identifier_->accept(result.found.model);
      if (options_.identified) options_.identified(model);
      use(&model);
    } catch (const InputError& error) {
      say(EventCode::kIdentificationFailed, error.what());
    }
  }

  void use(const TsModel* model) {
    if (model == nullptr || !controller_.controller().needsModel()) return;
    try {
      controller_.setModel(*model);
    } catch (const InputError& error) {
      say(EventCode::kModelRefused, error.what());
    }
  }

  /// Without the model that the loop file names there is no run.
  void begin(const TsModel* model) {
    if (model == nullptr || !controller_.controller().needsModel()) return;
    try {
      controller_.setModel(*model);
    } catch (const InputError& error) {
      throw InputError(loop_.name + ": controller: " + error.what());
    }
  }

  /// What an operator asked in vain, or a model that could not be had or used: told at once,
  /// recorded with the sample that is answered next, from which on it was to be used.
  void say(EventCode code, const std::string& text) {
    pending_.push_back(eventOf({code, text.c_str()}, present_));
    if (options_.said) options_.said(pending_.back());
  }

  const LoopFile& loop_;
  const RunOptions& options_;
  std::vector<Event> pending_;              // since the sample answered last
  std::uint32_t present_{};                 // the sample that is answered
  std::unique_ptr<SimulatedProcess> made_;  // until it is the session's
  Simulation& simulation_;
  PlantSession plant_;
  ControllerSession controller_;
  std::optional<OptimizerSession> optimizer_;
  std::optional<IdentifierSession> identifier_;
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
