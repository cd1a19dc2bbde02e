#include "runtime/loop_exchange.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "fmbpc/base/input_error.hpp"
#include "runtime/factory.hpp"
#include "runtime/plan.hpp"
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

const LoopFile& thatEnds(const LoopFile& loop) {
  require(loop.simulation.samples > 0, loop.name + ": sampling.duration_h",
          "a time > 0: a run in one process must end");
  return loop;
}

}  // namespace

LoopExchange::LoopExchange(const LoopFile& loop, const RunOptions& options,
                           const std::vector<LoopLink>& links)
    : loop_(thatEnds(loop)),
      options_(options),
      made_(std::make_unique<SimulatedProcess>(makeSimulation(loop))),
      simulation_(made_->simulation()),
      plant_(std::move(made_), lockstepPolicy(loop)),
      controller_(loop, {options.identified, options.said}),
      player_(options.commands, simulation_.clock()),
      record_(recordLayout(loop).emptyRecord()),
      recorder_(
          recordLayout(loop),
          [this](std::uint32_t, const SampleRecord& sample) { record_.samples.push_back(sample); }),
      targets_{simulation_, controller_.session(),
               [this](int window) { controller_.identify(window); },
               [this](const std::string& why) { controller_.say(EventCode::kCommandRefused, why); },
               controller_.layer()},
      feeds_(links, LinkInbox::Of::kPlant, true),
      asks_(links, LinkInbox::Of::kController, true) {
  plant_.begin(kRunId);
  recorder_.announce(kRunId);
  player_.begin(targets_);
  plant_.start(0.0);
}

void LoopExchange::takeFromOthers(const Measurement& now) {
  if (asks_.empty()) return;
  if (const auto command = asks_.command(now.header.time_ns))
    controller_.session().command(*command);
  takePlans(asks_, now.header, loop_.plant_info, controller_.session());
}

void LoopExchange::answer() {
  const Measurement& now = measurement();
  const std::uint32_t step = now.header.step;
  controller_.turnTo(step);
  player_.advance(step, targets_);
  takeFromOthers(now);
  recorder_.receive(now);
  recorder_.receive(
      simulation_.state(),
      joined(simulation_.events(), delayEvents(loop_, loop_.simulation.output_delay_s, step)));
  double taken = secondsOf([&] { controller_.receive(now); });
  const ControllerAnswer& answer = controller_.answer();
  recorder_.receive(answer.tracking, joined(answer.events, controller_.takeEvents()));
  if (now.final) return;
  recorder_.receiveBase(answer.base);
  taken += secondsOf([&] { controller_.optimize(); });
  record_.slowest_step_s = std::max(record_.slowest_step_s, taken);
  if (!controller_.hasOptimizer()) return;
  recorder_.receiveAction(controller_.sent());
  recorder_.receive(controller_.report());
}

bool LoopExchange::advance() {
  const Measurement now = measurement();
  if (!now.final && feeds_.empty()) {
    plant_.receive(controller_.sent());
    plant_.advance(0.0);
  } else if (!now.final) {
    ControlAction action = controller_.sent();
    if (const auto command = feeds_.command(now.header.time_ns)) simulation_.command(*command);
    feeds_.replaceInputs(now.header.time_ns, simulation_.info().inputs, action.input);
    plant_.receive(action);
    plant_.advance(0.0);
  }
  controller_.learn(now);
  return !now.final;
}

void LoopExchange::hear(const std::string& from, LoopLink::Of of, const StepHeader& sample,
                        const Eigen::Ref<const Matrix>& values, bool planned) {
  feeds_.hear(from, of, sample, values, planned);
  asks_.hear(from, of, sample, values, planned);
}

RunRecord LoopExchange::take() {
  recorder_.close();
  conclude(record_, recorder_.complete());
  record_.events = controller_.takeEvents();  // of the very end
  const std::string unplayed = player_.unplayed();
  if (!unplayed.empty()) record_.events.push_back(eventOf(EventCode::kCommandsUnplayed, unplayed));
  return std::move(record_);
}

}  // namespace fpc
