// What an identifier owes the exchange beside its models: a word when it has done with a sample.
#pragma once

#include <optional>
#include <vector>

#include "runtime/identifier_session.hpp"
#include "runtime/model_inbox.hpp"

namespace fpc {

/// Keeps which job is at work or waits, and which samples are done with. One job is at work at a
/// time; one that a sample asks for meanwhile waits for the next sample, and a later one replaces
/// it.
class IdentifierDuty {
 public:
  using Words = std::vector<IdentifierWord>;

  /// `in_step`: a sample is done with only when no job is at work (lockstep), otherwise at once.
  explicit IdentifierDuty(bool in_step) : in_step_(in_step) {}

  /// A new sample, and the job that it asks for.
  void take(const StepHeader& sample, std::optional<IdentificationJob> job);
  /// The job to begin now, if one waits and none is at work.
  std::optional<IdentificationJob> next();
  void begin();  ///< a job made from the present sample is at work from now on
  /// A model was handed over; one of no sample (run 0) or of an earlier one is no matter of a word.
  void handOver(const StepHeader& made_from);
  /// All that the present sample asks for has been done or begun. To be said now.
  Words settle();
  /// The job is at its end, whichever it is. To be said now: the word of the sample that it was
  /// made from and, if another has come meanwhile, the word of that one.
  Words finish();
  /// The plant sends the present sample again: its word once more, if it is done with.
  Words again() const;

  bool working() const { return working_; }
  const StepHeader& jobFrom() const { return job_from_; }  ///< the sample of the job at work

 private:
  bool in_step_;
  StepHeader present_, job_from_;
  bool done_{false}, made_model_{false};  // of the present sample
  bool job_made_model_{false};            // of the job's sample, unless its word has been said
  bool working_{false};
  std::optional<IdentificationJob> waiting_;
};

}  // namespace fpc
