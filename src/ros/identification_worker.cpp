#include "ros/identification_worker.hpp"

#include <utility>

#include "config/design_library.hpp"

namespace fpc {

IdentificationWorker::~IdentificationWorker() {
  cancel();
  if (thread_.joinable()) thread_.join();
}

void IdentificationWorker::start(IdentificationJob job) {
  cancelled_ = false;
  progress_.reset();
  outcome_.reset();
  thread_ = std::thread([this, job = std::move(job)] { work(job); });
}

void IdentificationWorker::work(const IdentificationJob& job) {
  Outcome outcome;
  try {
    outcome.result = designLibrary("model.identify")
                         .identify_record(job.values, job.structure, job.source, job.share,
                                          [this](const RecordProgress& progress) {
                                            const std::lock_guard<std::mutex> lock(mutex_);
                                            progress_ = progress;
                                            return !cancelled_;
                                          });
  } catch (const std::exception& error) {
    outcome.error = error.what();
  }
  outcome.cancelled = cancelled_ || outcome.result.cancelled;
  const std::lock_guard<std::mutex> lock(mutex_);
  outcome_ = std::move(outcome);
}

std::optional<RecordProgress> IdentificationWorker::progress() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(progress_, std::nullopt);
}

std::optional<IdentificationWorker::Outcome> IdentificationWorker::outcome() {
  std::optional<Outcome> outcome;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    outcome = std::exchange(outcome_, std::nullopt);
  }
  if (outcome) thread_.join();
  return outcome;
}

}  // namespace fpc
