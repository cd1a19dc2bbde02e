#include "runtime/replay.hpp"

#include <algorithm>
#include <cstring>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "runtime/factory.hpp"

namespace fpc {
namespace {

bool sameBits(const Vector& a, const Vector& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(double)) == 0;
}

bool same(const ControlAction& a, const ControlAction& b) {
  return a.source == b.source && sameBits(a.input, b.input);
}

std::string textOf(const ControlAction& action) {
  std::vector<std::string> numbers;
  for (Eigen::Index i = 0; i < action.input.size(); ++i)
    numbers.push_back(exactText(action.input[i]));
  return "[" + join(numbers) + "]";
}

void compare(const ControlAction& here, const ControlAction& recorded, ReplayedActions& actions) {
  ++actions.compared;
  if (same(here, recorded)) {
    ++actions.equal;
  } else if (actions.first_difference.empty()) {
    actions.first_difference = "sample " + std::to_string(recorded.header.step) + ": recorded " +
                               textOf(recorded) + ", here " + textOf(here);
    if (here.source != recorded.source) actions.first_difference += ", and of another source";
  }
}

constexpr std::size_t kMostMissing = 20;  // lines

/// What belongs to a sample of the loop and is not recorded. Of a record that ends early the last
/// sample may lack its actions.
std::string missingOf(const LoopFile& loop, const RecordedRun& run, std::uint32_t step) {
  const auto measured = run.measurements.find(step);
  std::vector<std::string> missing;
  if (measured == run.measurements.end()) missing.emplace_back("measurement");
  const bool last = step == run.measurements.rbegin()->first;
  if (!last && loop.has_clp && run.base.count(step) == 0) missing.emplace_back("base_action");
  if (!last && run.control.count(step) == 0) missing.emplace_back("control_action");
  return join(missing);
}

std::string wordsOf(std::uint32_t first, std::uint32_t last, const std::string& what) {
  return (first == last ? "sample " + std::to_string(first)
                        : "samples " + std::to_string(first) + " to " + std::to_string(last)) +
         ": no " + what;
}

/// Samples in a row that lack the same make one line.
void findMissing(const LoopFile& loop, const RecordedRun& run, ReplayResult& result) {
  const std::uint32_t last = run.measurements.rbegin()->first;
  std::string before;
  std::uint32_t first = 0;
  for (std::uint32_t step = 0; step <= last + 1; ++step) {
    const std::string what = step <= last ? missingOf(loop, run, step) : "";
    result.missing_samples += what.empty() ? 0 : 1;
    if (what == before) continue;
    if (!before.empty() && result.missing.size() < kMostMissing)
      result.missing.push_back(wordsOf(first, step - 1, before));
    before = what;
    first = step;
  }
  result.ended = run.measurements.rbegin()->second.final;
}

class Replay {
 public:
  Replay(const LoopFile& loop, const RecordedRun& run)
      : run_(run), controller_(makeControllerSession(loop)) {
    if (loop.targets.enabled) layer_.emplace(makeTargetSession(loop));
    if (loop.has_clp) optimizer_.emplace(makeOptimizerSession(loop));
    findMissing(loop, run, result_);
  }

  ReplayResult all() {
    for (const auto& [step, measurement] : run_.measurements) {
      if (step != result_.measurements) break;
      prepare(step);
      require(controller_.ready(), "the record",
              "the model that the controller worked with (fuzzy_model)" +
                  (result_.refused.empty() ? "" : "; " + result_.refused.front()));
      if (layer_ && layer_->receive(measurement) == Receipt::kAnswered)
        controller_.aim(layer_->answer());
      const Receipt receipt = controller_.receive(measurement);
      require(receipt != Receipt::kDropped, "measurement " + std::to_string(step),
              "the sizes of the loop");
      ++result_.measurements;
      if (receipt != Receipt::kAnswered) continue;
      if (controller_.answer().has_action) check(step);
    }
    return std::move(result_);
  }

 private:
  /// What acts from this sample on, in the order in which a node would have heard of it.
  void prepare(std::uint32_t step) {
    upTo(run_.models, model_, step, [this](const TsModel& model) {
      if (layer_) layer_->setModel(model);
      controller_.setModel(model);
    });
    upTo(run_.operator_state, wish_, step,
         [this](const OperatorState& operator_state) { ask(operator_state); });
    upTo(run_.setpoints, setpoint_, step, [this](const Command& command) {
      if (layer_) layer_->command(command);
      controller_.command(command);
    });
  }

  template <typename Map, typename Use>
  void upTo(const Map& items, typename Map::const_iterator& at, std::uint32_t step, Use use) {
    for (; at != items.end() && at->first <= step; ++at) {
      try {
        use(at->second);
      } catch (const InputError& error) {
        result_.refused.push_back("sample " + std::to_string(step) + ": " + error.what());
      }
    }
  }

  /// Only what differs from what was asked before. Setpoints come by their own effects.
  void ask(const OperatorState& operator_state) {
    const OperatorState before = controller_.operator_state();
    if (operator_state.manual != before.manual) controller_.manual(operator_state.manual);
    const bool same_input =
        before.manual_given && sameBits(before.manual_input, operator_state.manual_input);
    if (operator_state.manual && operator_state.manual_given && !same_input)
      controller_.manualInput(operator_state.manual_input);
    if (operator_state.recipe.held != before.recipe.held)
      controller_.holdRecipe(operator_state.recipe.held);
    if (operator_state.adapt && operator_state.adapt != before.adapt)
      controller_.adapt(*operator_state.adapt);
    if (!operator_state.settings.empty() && operator_state.settings != before.settings)
      controller_.retune(operator_state.settings);
  }

  void check(std::uint32_t step) {
    const ControllerAnswer& answer = controller_.answer();
    if (!optimizer_) {
      const auto recorded = run_.control.find(step);
      if (recorded != run_.control.end()) compare(answer.base, recorded->second, result_.control);
      return;
    }
    const auto recorded = run_.base.find(step);
    if (recorded != run_.base.end()) compare(answer.base, recorded->second, result_.base);
    if (answer.has_prediction) optimizer_->receive(answer.prediction);
    optimizer_->receive(answer.base);
    checkOptimizer(step, answer.base);
  }

  /// Where the controller stood in, both actions are there, or the base action alone.
  void checkOptimizer(std::uint32_t step, const ControlAction& base) {
    const auto [first, last] = run_.control.equal_range(step);
    if (first == last) return;
    const auto of = [first = first, last = last](const ControlAction& action) {
      return std::find_if(first, last, [&](const auto& r) { return same(action, r.second); });
    };
    const ControlAction& here = optimizer_->action();
    const auto equal = of(here);
    const bool base_too = of(base) != last && !same(base, here);
    if (base_too) ++result_.stood_in;
    if (equal == last && base_too && std::next(first) == last) return;  // the optimizer was silent
    compare(here, equal == last ? first->second : equal->second, result_.control);
  }

  const RecordedRun& run_;
  ControllerSession controller_;
  std::optional<TargetSession> layer_;
  std::optional<OptimizerSession> optimizer_;
  ReplayResult result_;
  decltype(RecordedRun::models)::const_iterator model_{run_.models.begin()};
  decltype(RecordedRun::operator_state)::const_iterator wish_{run_.operator_state.begin()};
  decltype(RecordedRun::setpoints)::const_iterator setpoint_{run_.setpoints.begin()};
};

}  // namespace

bool ReplayResult::equal() const {
  return missing_samples == 0 && base.equal == base.compared && control.equal == control.compared &&
         control.compared > 0;
}

ReplayResult replay(const LoopFile& loop, const RecordedRun& run) {
  require(!run.measurements.empty(), "the record", "at least one measurement");
  return Replay(loop, run).all();
}

}  // namespace fpc
