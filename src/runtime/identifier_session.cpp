#include "runtime/identifier_session.hpp"

#include <utility>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/model/model_match.hpp"
#include "model/model_check.hpp"

namespace fpc {

IdentifierSession::IdentifierSession(const LoopFile& loop)
    : plant_(loop.plant_info),
      estimated_(loop.controller->signalUse(controllerContext(loop)).estimated),
      params_(loop.identify),
      max_pole_(loop.max_pole),
      has_start_(loop.has_model),
      has_identify_(loop.has_identify),
      start_(loop.model),
      collector_(loop.plant_info, IdentifyParams::kWindow) {}

void IdentifierSession::announce(std::uint64_t run_id, double now_s) {
  collector_.announce(run_id);
  if (!announced_s_) announced_s_ = now_s;
}

bool IdentifierSession::hearKept(const StepHeader& made_from) {
  kept_known_ = true;
  return made_from.run_id != 0 && published_ == 0;
}

bool IdentifierSession::startDue(double now_s) const {
  if (!has_start_ || published_ > 0 || !announced_s_) return false;
  return kept_known_ || now_s - *announced_s_ > kKeptPatience;
}

const TsModel* IdentifierSession::start() { return has_start_ ? &use(matched(start_)) : nullptr; }

const TsModel& IdentifierSession::restore(const TsModel& model) {
  use(matched(model));
  if (params_.online.enabled) learner_.emplace(model_, plant_, params_.online);
  done_by_itself_ = true;
  return model_;
}

const TsModel& IdentifierSession::use(TsModel matched) {
  model_ = std::move(matched);
  if (published_++ == 0 && params_.online.enabled) learner_.emplace(model_, plant_, params_.online);
  return model_;
}

IdentifierSession::Due IdentifierSession::take(const Measurement& measurement) {
  Due due;
  due.arrival = collector_.take(measurement);
  if (!isNew(due.arrival)) return due;
  const auto after = static_cast<std::uint64_t>(params_.after);
  const bool asked = after > 0 && !done_by_itself_ && collector_.counts().samples >= after;
  const bool learned = learner_ && learner_->take(measurement, due.arrival);
  if (asked)
    identify(due);  // what was learned would be used for no sample
  else if (learned)
    learn(due);
  return due;
}

void IdentifierSession::identify(Due& due) {
  done_by_itself_ = true;
  try {
    due.job = job(params_.structure, 0, IdentifyParams::kValidationShare);
  } catch (const InputError& error) {
    due.refusal = error.what();
    due.refused = EventCode::kIdentificationFailed;
  }
}

void IdentifierSession::learn(Due& due) {
  try {
    due.model = &use(checked(learner_->model()));
  } catch (const InputError& error) {  // counted
    due.refusal = error.what();
  }
}

IdentificationJob IdentifierSession::job(Structure structure, std::size_t newest,
                                         double share) const {
  require(has_identify_, "model.identify", "that section in the loop file: nothing is collected");
  require(collector_.size() > 0, "identify", "samples: none have come yet");
  IdentificationJob job;
  job.values = collector_.rows(structure, newest);
  job.structure = std::move(structure);
  const CollectorCounts& counts = collector_.counts();
  job.source = "the running plant " + plant_.name + ", samples up to " +
               std::to_string(collector_.present().header.step) + " (" +
               std::to_string(counts.missing) + " missing, " + std::to_string(counts.incomplete) +
               " incomplete, " + std::to_string(counts.runs) + " runs)";
  job.share = share;
  return job;
}

TsModel IdentifierSession::matched(const TsModel& model) const {
  return matchToPlant(model, plant_, estimated_);
}

TsModel IdentifierSession::checked(const TsModel& model) {
  try {
    TsModel fitting = matched(model);
    if (collector_.present().outputs.size() > 0)
      requireStable(fitting, collector_.present(), max_pole_);
    return fitting;
  } catch (const InputError&) {
    ++refused_;
    throw;
  }
}

const TsModel& IdentifierSession::accept(const TsModel& identified) {
  use(checked(identified));
  if (params_.online.enabled) learner_.emplace(model_, plant_, params_.online);
  return model_;
}

}  // namespace fpc
