// Where the stages of a commissioning, in a thread of their own, reach into a loop that runs: the
// controller's session passes each sample and what its law asks, and gets what is to be sent.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>

#include "fmbpc/base/input_limits.hpp"
#include "runtime/commissioning/staged_plant.hpp"

namespace fpc {

/// The law stays in charge: what the stages send is limited like its own input, and a sample for
/// which they are late gets the law's input with the last difference that they asked for. They see
/// those samples as well. All functions may be called from both threads.
class PlantTap final : public StagedPlant {
 public:
  /// patience_s: of wall time, that a sample waits for the stages; infinite in lockstep.
  explicit PlantTap(double patience_s);

  // ---- the loop's side
  /// input: the law's, then what is to be sent, inside the limits as seen from `previous`.
  void pass(const Measurement& now, const InputLimits& limits, VectorRef previous, Vector& input);
  /// No more samples, for a reason in words; the first one counts.
  void end(const std::string& why);
  bool open() const;
  /// What the stages have in the input beside the law's own; empty before they sent anything.
  Vector difference() const;

  // ---- the stages' side
  const Sample& next() override;
  const Vector& send(VectorRef input) override;
  void release() override { end(""); }
  const Vector& trueOutputs() const override { return current_.now.outputs; }  ///< as measured
  std::uint64_t late() const;  ///< samples that went out without waiting

 private:
  struct Waiting {
    std::uint64_t number;
    Sample sample;
  };
  void requireOpen() const;

  const double patience_s_;
  mutable std::mutex mutex_;  // of what follows
  std::condition_variable for_loop_, for_stages_;
  std::deque<Waiting> queue_;
  Sample current_;
  std::uint64_t number_{}, current_number_{}, late_{};
  InputLimits limits_;  // of the newest sample
  Vector previous_, answer_, difference_;
  bool answered_{false}, closed_{false};
  std::string why_;
};

}  // namespace fpc
