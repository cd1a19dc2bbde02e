// The recorder as a member of the loop: makes samples of what arrives, passes each on when it is
// whole, and what there is of those that are not. The node and the run in one process are made of
// it.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/step_gate.hpp"
#include "config/loop_file.hpp"
#include "runtime/record.hpp"

namespace fpc {

/// What belongs to a record of a loop.
struct RecordLayout {
  std::string loop;
  PlantInfo info;
  bool has_optimizer{};  ///< actions and reports of the optimizer come besides base actions
  bool has_state{};      ///< the plant is simulated
  std::vector<std::string> states, state_units;
  std::size_t true_disturbances{};             ///< of the simulated plant
  std::vector<Eigen::Index> without_setpoint;  ///< outputs: setpoint and reference become NaN
  std::string text;            ///< of the loop, for parseLoop(): a record tells what it is of
  std::uint32_t samples{};     ///< step of the final sample; 0: endless
  std::uint32_t first_step{};  ///< of this part of an endless run

  bool fits(const Measurement& m) const;
  bool fits(const PlantState& s) const;
  bool fits(const Tracking& t) const;
  bool fits(const ControlAction& a) const;
  bool fits(const SolverReport& r) const;
  bool isComplete(const SampleRecord& sample) const;  ///< has all that belongs to it
  RunRecord emptyRecord() const;
};
RecordLayout recordLayout(const LoopFile& loop);

/// Memory is bounded: at most kWindow samples wait for what they lack; the oldest is given up.
class RecorderSession {
 public:
  static constexpr std::uint32_t kWindow = 10000;
  static constexpr std::size_t kMostEarly = 10000;
  /// Gets each sample once it is whole, in order where none lacks anything. One that lacks
  /// something comes by keep(), again when it has more, and at the latest by close().
  using Sink = std::function<void(std::uint32_t step, const SampleRecord&)>;
  using Samples = std::vector<std::pair<std::uint32_t, SampleRecord>>;  ///< with their steps

  RecorderSession(RecordLayout layout, Sink sink);

  /// Only this run counts from now on. What came before it was announced is looked at again.
  void announce(std::uint64_t run_id);
  /// A run of which the samples before this one are recorded already (a recorder that comes back);
  /// of the `unfinished` among them more may come.
  void resume(std::uint64_t run_id, std::uint32_t next_step, Samples unfinished = {});
  void receive(const Measurement& m);
  void receive(const PlantState& s, const std::vector<Event>& events = {});  ///< likewise
  void receive(const Tracking& t, const std::vector<Event>& events = {});
  void receiveBase(const ControlAction& a);
  void receiveAction(const ControlAction& a);
  void receive(const SolverReport& r);
  /// Passes on what there is of samples that lacked something at the last call, too, and are not
  /// the newest. They go on waiting.
  void keep();
  /// Passes on what waits; what it lacks is then a gap.
  void close();

  bool running() const { return next_ > 0; }  ///< something has come
  bool announced() const { return run_id_.has_value(); }
  bool finalSeen() const { return final_.has_value(); }
  bool complete() const {
    return final_ && next_ == *final_ + 1 && waiting_.empty() && gap_count_ == 0;
  }
  /// It has all of this sample, now or since before.
  bool holds(const StepHeader& sample) const;
  /// "sample 17: no control_action" for the first holes, those of waiting samples included.
  std::vector<std::string> gaps(std::size_t limit = 10) const;
  /// Samples from `from` to before `before` that lack something, each with the first part of it.
  std::vector<std::pair<std::uint32_t, std::string>> incomplete(std::uint32_t from,
                                                                std::uint32_t before) const;
  /// Whether the newest sample but one lacks something: what was lost is not coming again.
  bool lacks() const;
  std::uint64_t gapCount() const { return gap_count_; }  ///< samples given up
  std::uint32_t samples() const { return next_; }        ///< up to the newest
  std::size_t waiting() const { return waiting_.size(); }
  const StepHeader& latest() const { return latest_; }  ///< of the measurements
  std::uint64_t strays() const { return strays_; }      ///< other runs, or too far from now
  std::uint64_t wrongSize() const { return wrong_size_; }
  const RecordLayout& layout() const { return layout_; }

 private:
  template <typename Item, typename Place>
  void collect(const Item& item, bool SampleRecord::*has, Place place);
  bool farAhead(std::uint32_t step);
  void reach(std::uint32_t step);
  void noteGaps(const SampleRecord& sample, std::uint32_t step, std::size_t limit,
                std::vector<std::string>& lines) const;
  void giveUpFirst();

  RecordLayout layout_;
  Sink sink_;
  std::optional<std::uint64_t> run_id_;
  StepGate gate_;         // of the measurements
  std::uint32_t next_{};  // step behind the newest sample
  struct Waiting {
    SampleRecord sample;
    bool seen{}, changed{};  // by keep(); since it was passed on
  };
  std::map<std::uint32_t, Waiting> waiting_;  // by step: samples that lack something
  std::vector<std::function<void()>> early_;  // before any run was announced
  StepHeader latest_;
  std::optional<std::uint32_t> final_;
  std::vector<std::string> gaps_;
  std::uint64_t gap_count_{}, strays_{}, wrong_size_{};
  std::uint32_t far_step_{}, far_streak_{};  // of measurements far ahead that follow each other
};

}  // namespace fpc
