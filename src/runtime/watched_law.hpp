// A law in charge, and a candidate beside it that is watched, judged and, if it passes, handed the
// inputs over in steps of authority, with a way back.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "control/controller_around.hpp"
#include "fmbpc/control/bumpless_transfer.hpp"
#include "supervision/candidate_trial.hpp"
#include "supervision/oscillation_detector.hpp"
#include "supervision/promise.hpp"

namespace fpc {

/// A law that waits for its turn.
struct CandidateLaw {
  std::string name;
  std::unique_ptr<Controller> law;  ///< has its model
  TsModel model;                    ///< matched to the plant
  CandidateParams params;
  std::vector<bool> moved;  ///< by input: the law may move it; empty: all
};

enum class CandidateState { kNone, kWatched, kPassed, kRefused, kInCharge, kBack };
const char* nameOf(CandidateState state);  ///< "none", "watched", "passed", ...

/// As long as the candidate is only watched, what the law `inside` answers passes untouched, bit
/// for bit; what the candidate throws ends its trial and nothing else. The verdict is
/// CandidateTrial's.
/// In charge with authority a the candidate's input counts as far as it is within a of the allowed
/// move (of the range, where moves are free) from what the former law asks for at that sample; the
/// former law goes on beside it. The first input is the former law's, and the bias dies out
/// (BumplessTransfer); where an optimizer follows, the prediction carries the limits instead. The
/// authority grows every step_samples. At each sample the candidate must keep what was seen while
/// it was watched (ErrorPromise): its model's errors one sample ahead, and the errors of the
/// outputs; and it must not throw an input from end to end (OscillationDetector). Else, or if it
/// gives no input, the former law is back from that sample on, bumplessly, and the candidate stays
/// out until it is watched anew. Every change of state is an event with its figures. signals():
/// those of the law inside, then beside_INPUT, what the law asks for that is not in charge, and
/// candidate_authority. Judging allocates; other samples do not.
class WatchedLaw final : public ControllerAround {
 public:
  /// optimizer: what the laws answer goes to one.
  /// present: the model of the law in charge, matched to the plant; without submodels: none yet.
  WatchedLaw(std::unique_ptr<Controller> inside, TsModel present, InputLimits limits,
             PlantInfo plant, bool optimizer);
  /// Begins anew with this candidate. If another one was in charge, the former law is back.
  /// @throws InputError naming candidate.KEY.
  void watch(CandidateLaw candidate);
  /// From the next sample on. @throws InputError unless the candidate has passed.
  void handOver();
  /// By an operator's word, from the next sample on. @throws InputError unless it is in charge.
  void back();
  CandidateState state() const { return state_; }
  /// As of now: a JSON object with name, state, authority and the figures.
  std::string report() const;

  void reset(const Measurement& start) override;
  void forget() override;
  void step(const Measurement& now, const SetpointSource& setpoint,
            ControllerOutput& output) override;
  void lookOn(const Measurement& now) override;
  bool foresee(const Measurement& now, Eigen::Ref<Vector> outputs) override;
  bool expect(std::uint32_t k, Eigen::Index disturbance, VectorRef ahead) override;
  void setModel(const TsModel& model) override;
  bool mayBeSent(VectorRef input) const override;
  void makeSendable(Eigen::Ref<Vector> input) const override;
  const std::vector<std::pair<std::string, double>>& signals() const override { return signals_; }

 private:
  bool inCharge() const { return state_ == CandidateState::kInCharge; }
  bool onTrial() const {
    return state_ == CandidateState::kWatched || state_ == CandidateState::kPassed;
  }
  const Controller& acting() const { return inCharge() ? *candidate_.law : *inside_; }
  double authority() const;  // 0 unless it is in charge
  void begin();
  double changeTo(const Vector& setpoint) const;
  void observe(const Measurement& now, const SetpointSource* setpoint);
  void shadow(const Measurement& now, const SetpointSource& setpoint, const Vector& law);
  void drive(const Measurement& now, const SetpointSource& setpoint, ControllerOutput& output);
  bool runCandidate(const Measurement& now, const SetpointSource& setpoint,
                    ControllerOutput& output);
  void mix(const Measurement& now, ControllerOutput& output);
  std::string brokenPromise() const;
  bool throws(const Measurement& now, VectorRef wish);
  void goBack(const std::string& why);
  void decide();
  void say(EventCode code, const std::string& text);
  void speak(ControllerOutput& output);
  void refreshSignals();

  TsModel present_;  // of the law inside; without submodels: none
  InputLimits limits_;
  PlantInfo plant_;
  bool optimizer_;
  CandidateLaw candidate_;
  std::optional<CandidateTrial> trial_;
  ErrorPromise errors_, outputs_;
  std::vector<OscillationDetector> swings_;
  CandidateState state_{CandidateState::kNone};
  std::size_t level_{};  // of authority
  int in_level_{};       // samples
  bool fresh_{true};     // the candidate has not run since it began, or since a gap
  bool taking_{false};   // the first sample of a hand-over
  bool seen_{false};     // last_ and setpoint_ are of a sample
  StepHeader last_;
  Vector setpoint_, squares_, deviation_;
  BumplessTransfer into_, backward_;
  ControllerOutput beside_;  // of who is not in charge
  std::vector<std::pair<EventCode, std::string>> due_, said_;
  std::vector<std::pair<std::string, double>> signals_;
};

}  // namespace fpc
