// Identification beside a node's callbacks: a thread that knows nothing of ROS, asked now and then
// how far it is.
#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "runtime/identifier_session.hpp"

namespace fpc {

class IdentificationWorker {
 public:
  struct Outcome {
    RecordIdentification result;
    bool cancelled{false};
    std::string error;  ///< why there is no result; empty otherwise
  };

  IdentificationWorker() = default;
  IdentificationWorker(const IdentificationWorker&) = delete;
  IdentificationWorker& operator=(const IdentificationWorker&) = delete;
  ~IdentificationWorker();  ///< cancels and waits

  /// From start() until outcome() has been taken.
  bool busy() const { return thread_.joinable(); }
  void start(IdentificationJob job);    ///< only if not busy()
  void cancel() { cancelled_ = true; }  ///< takes effect at the next step of a clustering or fit
  /// How far it is, if that has changed since the last call.
  std::optional<RecordProgress> progress();
  /// The end, once.
  std::optional<Outcome> outcome();

 private:
  void work(const IdentificationJob& job);

  std::thread thread_;
  std::atomic<bool> cancelled_{false};
  std::mutex mutex_;  // of what follows
  std::optional<RecordProgress> progress_;
  std::optional<Outcome> outcome_;
};

}  // namespace fpc
