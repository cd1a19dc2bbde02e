#include "runtime/identifier_duty.hpp"

#include <utility>

#include "base/same_sample.hpp"

namespace fpc {

void IdentifierDuty::take(const StepHeader& sample, std::optional<IdentificationJob> job) {
  present_ = sample;
  done_ = made_model_ = false;
  if (job) waiting_ = std::move(job);
}

std::optional<IdentificationJob> IdentifierDuty::next() {
  return working_ ? std::nullopt : std::exchange(waiting_, std::nullopt);
}

void IdentifierDuty::begin() {
  working_ = true;
  job_from_ = present_;
  job_made_model_ = made_model_ && !done_;
}

void IdentifierDuty::handOver(const StepHeader& made_from) {
  if (made_from.run_id == 0) return;
  made_model_ = made_model_ || isSameSample(made_from, present_);
  job_made_model_ = job_made_model_ || isSameSample(made_from, job_from_);
}

IdentifierDuty::Words IdentifierDuty::settle() {
  done_ = !(in_step_ && working_);
  return again();
}

IdentifierDuty::Words IdentifierDuty::finish() {
  working_ = false;
  done_ = true;
  Words words{IdentifierWord{job_from_, job_made_model_}};
  if (!isSameSample(job_from_, present_)) words.push_back({present_, made_model_});
  return words;
}

IdentifierDuty::Words IdentifierDuty::again() const {
  return done_ ? Words{IdentifierWord{present_, made_model_}} : Words{};
}

}  // namespace fpc
