// Bytes as the fate of the messages of one short run: each message of the exchange is delivered,
// lost, repeated, kept for later or changed on its way. Whatever happens, inputs stay finite and
// inside their limits, nothing but an InputError is thrown, and once the messages arrive unharmed
// again the run goes on to its end.
#include <fmbpc/FuzzyModel.h>

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/model/model_match.hpp"
#include "fuzz/message_mutator.hpp"
#include "fuzz/targets.hpp"
#include "fuzz/tolerant.hpp"
#include "ros/conversions.hpp"
#include "runtime/factory.hpp"
#include "runtime/identifier_session.hpp"
#include "runtime/plant_session.hpp"
#include "runtime/recorder_session.hpp"

namespace fpc::fuzz {
namespace {

constexpr std::uint64_t kRun = 7;
constexpr int kMostTries = 400;  // beyond one per sample

/// Short runs of shipped loops with all kinds of members; read once.
const LoopFile& loopNumber(int number) {
  static const std::vector<LoopFile> loops = [] {
    const std::vector<std::pair<const char*, const char*>> named{
        {"asp_case1_clp", "2.4"},       {"asp_case1_pi_x", "2.4"},    {"linear_2x2_clp", "0.01"},
        {"surge_tank_steps_clp", ".1"}, {"column_clp_tracking", "1"}, {"asp_identify", "2.4"}};
    std::vector<LoopFile> read;
    for (const auto& [name, hours] : named)
      read.push_back(readLoop(name, {{"sampling.duration_h", hours}}));
    return read;
  }();
  return loops[static_cast<std::size_t>(number) % loops.size()];
}

class FuzzedExchange {
 public:
  FuzzedExchange(const LoopFile& loop, Bytes& bytes)
      : loop_(loop),
        bytes_(bytes),
        simulated_(new SimulatedProcess(makeSimulation(loop))),
        plant_(std::unique_ptr<Process>(simulated_), PlantPolicy{}),
        controller_(makeControllerSession(loop)),
        recorder_(recordLayout(loop), [](std::uint32_t, const SampleRecord&) {}) {
    if (loop.has_clp) optimizer_.emplace(makeOptimizerSession(loop));
    if (loop.has_model || loop.has_identify) identifier_.emplace(loop);
    plant_.begin(kRun);
    controller_.announce(kRun);
    recorder_.announce(kRun);
    if (optimizer_) optimizer_->announce(kRun);
    if (identifier_) identifier_->announce(kRun);
    if (const TsModel* model = identifier_ ? identifier_->start() : nullptr)
      controller_.setModel(*model);
    plant_.start(0.0);
  }

  void run() {
    const int most = static_cast<int>(loop_.simulation.samples) + kMostTries;
    for (int tries = 0; !finished_; ++tries) {
      if (tries > most) throw std::logic_error("the run stands still at sample " + where());
      checkInput(now().input_applied, "applied");
      command();
      recorder_.receive(now());
      send<Measurement>(now(), [this](const auto& m) { measured(m); });
      if (plant_.phase() == PlantPhase::kRunning) plant_.advance(tries);
    }
  }

 private:
  const Measurement& now() const { return plant_.process().measurement(); }
  std::string where() const { return std::to_string(now().header.step); }

  /// A message on its way, as Node::guarded() takes it in.
  template <typename Struct>
  void send(const Struct& sent, const std::function<void(const Struct&)>& handle) {
    const auto clean = toMsg(sent);
    const auto arrives = [handle](const auto& msg) { tolerant([&] { handle(fromMsg(msg)); }); };
    const int fate = bytes_.below(8);
    if (fate == 2) arrives(clean);
    if (fate == 3 || fate == 4) arrives(mutated(clean, bytes_));
    if (fate == 5) late_.push_back([arrives, msg = mutated(clean, bytes_)] { arrives(msg); });
    if (fate == 6) late_.push_back([arrives, clean] { arrives(clean); });
    if (fate != 1 && fate != 4 && fate != 6) arrives(clean);
    if (fate == 7 && !late_.empty()) {
      const auto delayed = late_.front();
      late_.pop_front();
      delayed();
    }
  }

  void measured(const Measurement& m) {
    if (identifier_) tolerant([&] { identifier_->take(m); });
    const Receipt receipt = controller_.receive(m);
    if (receipt != Receipt::kAnswered && receipt != Receipt::kRepeated) return;
    const ControllerAnswer& answer = controller_.answer();
    if (now().final && !answer.has_action && answer.tracking.header.step == now().header.step)
      finished_ = true;
    recorder_.receive(answer.tracking);
    if (!answer.has_action) return;
    checkInput(answer.base.input, "base");
    recorder_.receiveBase(answer.base);
    if (!optimizer_) return send<ControlAction>(answer.base, [this](const auto& a) { act(a); });
    const ControllerAnswer copy = answer;
    if (copy.has_prediction)
      send<PredictiveAction>(copy.prediction,
                             [this](const auto& p) { optimized(optimizer_->receive(p)); });
    send<ControlAction>(copy.base, [this](const auto& a) { optimized(optimizer_->receive(a)); });
  }

  void optimized(bool answered) {
    if (!answered) return;
    checkInput(optimizer_->action().input, "constrained");
    send<ControlAction>(optimizer_->action(), [this](const auto& a) { act(a); });
    send<SolverReport>(optimizer_->report(), [this](const auto& r) { recorder_.receive(r); });
  }

  void act(const ControlAction& action) {
    recorder_.receiveAction(action);
    plant_.receive(action);
  }

  /// What people and identifiers send.
  void command() {
    const int who = bytes_.below(16);
    if (who == 1) {
      fmbpc::Setpoint msg;
      for (const auto& output : loop_.plant_info.outputs) {
        msg.name.push_back(output.name);
        msg.value.push_back(output.lower);
      }
      tolerant([&] { controller_.command(fromMsg(mutated(msg, bytes_))); });
    }
    if (who == 2) {
      fmbpc::Disturbance msg;
      msg.name = simulated_->simulation().commandNames();
      msg.value.assign(msg.name.size(), 1.0);
      tolerant([&] { simulated_->simulation().command(fromMsg(mutated(msg, bytes_))); });
    }
    if (who == 3 && identifier_) {
      const auto msg = mutated(toMsg(identifier_->model()), bytes_);
      tolerant([&] { controller_.setModel(matchToPlant(fromMsg(msg), loop_.plant_info)); });
    }
    if (who == 4) controller_.manual(!controller_.isManual());
    if (who == 5)
      tolerant(
          [&] { controller_.manualInput(Vector::Constant(bytes_.below(4), bytes_.number())); });
  }

  void checkInput(const Vector& input, const char* which) const {
    const InputLimits& limits = loop_.simulation.actuator.limits;
    const Vector slack = 1e-9 * (limits.upper - limits.lower);
    if (input.size() != limits.upper.size() || !input.allFinite() ||
        ((input - limits.upper - slack).array() > 0.0).any() ||
        ((limits.lower - slack - input).array() > 0.0).any())
      throw std::logic_error(std::string("an input beyond its limits (") + which + ") at sample " +
                             where());
  }

  const LoopFile& loop_;
  Bytes& bytes_;
  SimulatedProcess* simulated_;
  PlantSession plant_;
  ControllerSession controller_;
  std::optional<OptimizerSession> optimizer_;
  std::optional<IdentifierSession> identifier_;
  RecorderSession recorder_;
  std::deque<std::function<void()>> late_;
  bool finished_{false};
};

}  // namespace

void exchange(const std::string& text) {
  Bytes bytes(text);
  const LoopFile& loop = loopNumber(bytes.next());
  FuzzedExchange(loop, bytes).run();
}

}  // namespace fpc::fuzz
