#include "runtime/loop_controller.hpp"

#include <utility>

#include "config/design_library.hpp"
#include "fmbpc/base/input_error.hpp"
#include "runtime/factory.hpp"

namespace fpc {

LoopController::LoopController(const LoopFile& loop, LoopControllerHooks hooks)
    : loop_(loop), hooks_(std::move(hooks)), session_(makeControllerSession(loop)) {
  if (loop.targets.enabled) layer_ = std::make_unique<TargetSession>(makeTargetSession(loop));
  if (loop.has_clp) optimizer_.emplace(makeOptimizerSession(loop));
  if (loop.has_identify) designLibrary(loop.name + ": model.identify");  // now, not late in a run
  if (loop.has_model || loop.has_identify) identifier_.emplace(loop);
  if (identifier_) begin(identifier_->start());
  require(!layer_ || layer_->ready(), loop.name + ": model.file", "a model for section targets");
  require(session_.ready(), loop.name + ": model.file",
          "a model for controller " + loop.controllerType().name);
}

Receipt LoopController::receive(const Measurement& now) {
  if (layer_ && layer_->receive(now) == Receipt::kAnswered) {
    session_.aim(layer_->answer());
    pending_.insert(pending_.end(), layer_->events().begin(), layer_->events().end());
  }
  return session_.receive(now);
}

const ControlAction& LoopController::optimize() {
  const ControllerAnswer& answer = session_.answer();
  if (!optimizer_) return answer.base;
  if (answer.has_prediction) optimizer_->receive(answer.prediction);
  optimizer_->receive(answer.base);
  return optimizer_->action();
}

void LoopController::learn(const Measurement& now) {
  if (!loop_.has_identify) return;
  const IdentifierSession::Due due = identifier_->take(now);
  if (!due.refusal.empty()) say(due.refused, due.refusal);
  use(due.model);
  if (due.job) run(*due.job);
}

void LoopController::identify(int window) {
  require(identifier_ && loop_.has_identify, "identify", "a loop with model.identify");
  run(identifier_->job(loop_.identify.structure, static_cast<std::size_t>(window),
                       IdentifyParams::kValidationShare));
}

void LoopController::run(const IdentificationJob& job) {
  try {
    const RecordIdentification result =
        designLibrary("model.identify")
            .identify_record(job.values, job.structure, job.source, job.share, {});
    const TsModel& model = identifier_->accept(result.found.model);
    if (hooks_.identified) hooks_.identified(model);
    use(&model);
  } catch (const InputError& error) {
    say(EventCode::kIdentificationFailed, error.what());
  }
}

void LoopController::use(const TsModel* model) {
  if (model == nullptr || !needsModel()) return;
  try {
    hand(*model);
  } catch (const InputError& error) {
    say(EventCode::kModelRefused, error.what());
  }
}

void LoopController::hand(const TsModel& model) {
  if (session_.controller().needsModel()) session_.setModel(model);
  if (layer_) layer_->setModel(model);
}

/// Without the model that the loop file names there is no run.
void LoopController::begin(const TsModel* model) {
  if (model == nullptr || !needsModel()) return;
  try {
    hand(*model);
  } catch (const InputError& error) {
    throw InputError(loop_.name + ": controller: " + error.what());
  }
}

void LoopController::say(EventCode code, const std::string& text) {
  pending_.push_back(eventOf({code, text.c_str()}, step_));
  if (hooks_.said) hooks_.said(pending_.back());
}

std::vector<Event> LoopController::takeEvents() {
  for (Event& event : pending_) event.first = event.last = step_;
  return std::exchange(pending_, {});
}

}  // namespace fpc
