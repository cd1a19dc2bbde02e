#include "runtime/run_plant.hpp"

#include <memory>

#include "runtime/loop_exchange.hpp"
#include "runtime/plan.hpp"

namespace fpc {
namespace {

/// One loop, and how far it is.
struct TurningLoop {
  const PlantLoop* of;
  std::unique_ptr<LoopExchange> exchange;
  bool answered{false}, over{false};
  bool tells_plan{false};  // another one expects what it plans
};

void tell(const TurningLoop& loop, const std::vector<TurningLoop*>& listeners) {
  const Measurement& now = loop.exchange->measurement();
  for (TurningLoop* other : listeners)
    other->exchange->hear(loop.of->name, LoopLink::Of::kOutputs, now.header, now.outputs);
}

void tellAnswer(const TurningLoop& loop, const std::vector<TurningLoop*>& listeners) {
  if (listeners.empty() || loop.exchange->measurement().final) return;
  const ControlAction& sent = loop.exchange->sent();
  const ControllerAnswer& answer = loop.exchange->answered();
  const Matrix plan =
      loop.tells_plan && answer.has_prediction ? planOf(answer.prediction) : Matrix();
  for (TurningLoop* other : listeners) {
    other->exchange->hear(loop.of->name, LoopLink::Of::kInputs, sent.header, sent.input,
                          isLawsOwn(sent.source));
    if (loop.tells_plan)
      other->exchange->hear(loop.of->name, LoopLink::Of::kPlan, sent.header, plan);
  }
}

/// True: the loop has got on by half a sample.
bool turn(TurningLoop& loop, const std::vector<TurningLoop*>& listeners) {
  if (loop.over) return false;
  LoopExchange& exchange = *loop.exchange;
  if (!loop.answered) {
    if (!exchange.mayAnswer()) return false;
    exchange.answer();
    tellAnswer(loop, listeners);
    return loop.answered = true;
  }
  if (!exchange.measurement().final && !exchange.mayAdvance()) return false;
  loop.over = !exchange.advance();
  loop.answered = false;
  if (loop.over) return true;
  tell(loop, listeners);
  return true;
}

std::vector<TurningLoop*> listenersOf(TurningLoop& loop, std::vector<TurningLoop>& all) {
  std::vector<TurningLoop*> listeners;
  for (TurningLoop& other : all)
    for (const LoopLink& link : other.of->links) {
      if (link.from != loop.of->name) continue;
      loop.tells_plan = loop.tells_plan || link.of == LoopLink::Of::kPlan;
      if (listeners.empty() || listeners.back() != &other) listeners.push_back(&other);
    }
  return listeners;
}

}  // namespace

// Every link looks back in time, or from a measurement to an action of the same time: of the loops
// that are behind, one can always go on.
std::vector<RunRecord> runPlant(const PlantLoops& plant, const RunOptions& options) {
  std::vector<TurningLoop> loops;
  for (const PlantLoop& one : plant.loops)
    loops.push_back({&one, std::make_unique<LoopExchange>(one.loop, options, one.links)});
  std::vector<std::vector<TurningLoop*>> listeners;
  for (TurningLoop& loop : loops) listeners.push_back(listenersOf(loop, loops));
  for (std::size_t i = 0; i < loops.size(); ++i) tell(loops[i], listeners[i]);
  for (bool any = true; any && !(options.stop && options.stop());) {
    any = false;
    for (std::size_t i = 0; i < loops.size(); ++i) any = turn(loops[i], listeners[i]) || any;
  }
  std::vector<RunRecord> records;
  for (TurningLoop& loop : loops) records.push_back(loop.exchange->take());
  return records;
}

}  // namespace fpc
