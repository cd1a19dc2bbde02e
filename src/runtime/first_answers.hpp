// What a node that comes back in a run has said first, for listeners that find it only then: the
// node answers at once, a recorder may take a moment to connect.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "fmbpc/base/exchange.hpp"

namespace fpc {

/// When a node came back, if it did.
class Comeback {
 public:
  static constexpr double kConnecting = 5.0;  ///< [s] in which those who listen find it
  /// With every sample that the node answers. One that begins with sample 0 has not come back: the
  /// plant waits until everybody listens.
  void answered(const StepHeader& sample, double now_s) {
    if (!known_ && sample.step > 0) since_s_ = now_s;
    known_ = true;
  }
  bool lately(double now_s) const { return since_s_ >= 0.0 && now_s - since_s_ < kConnecting; }

 private:
  bool known_{false};
  double since_s_{-1.0};
};

/// Who may be told what is old. For the members that act on it (the plant, the optimizer, a
/// controller) only the present sample counts, which is sent again until it is answered; and a
/// plant that may be anyone is told nothing old by mistake: then only the recorder is.
struct Audience {
  std::vector<std::string> plants, controllers;  ///< full names; no plant: it may be anyone
  std::string recorder;

  bool mayHearOld(const std::string& listener) const {
    const auto in = [&](const std::vector<std::string>& names) {
      return std::find(names.begin(), names.end(), listener) != names.end();
    };
    return listener == recorder || (!plants.empty() && !in(plants) && !in(controllers));
  }
};

/// The first answers of a node on one topic, to be told again to whoever connects while
/// Comeback::lately(); nothing is kept of a node that was there from the start, or has been for
/// long.
template <typename Message>
class FirstAnswers {
 public:
  static constexpr std::size_t kMost = 1000;
  /// With everything that is published, but what repeats a message. Those of one run are kept.
  void add(std::uint64_t run_id, Message message, const Comeback& comeback, double now_s) {
    if (!comeback.lately(now_s) || run_id != run_id_) kept_.clear();
    run_id_ = run_id;
    if (comeback.lately(now_s) && kept_.size() < kMost) kept_.push_back(std::move(message));
  }
  /// In their order.
  const std::vector<Message>& all() const { return kept_; }

 private:
  std::uint64_t run_id_{};
  std::vector<Message> kept_;
};

}  // namespace fpc
