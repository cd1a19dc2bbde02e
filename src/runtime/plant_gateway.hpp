// A plant that is not ours, as the exchange sees it: readings of any time become samples, actions
// become commands that keep every limit, whatever arrives and whatever does not.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "config/gateway_params.hpp"
#include "config/loop_file.hpp"
#include "fmbpc/base/sample_clock.hpp"
#include "plant/process.hpp"

namespace fpc {

/// How far a value can be trusted; numbers are those of Measurement.msg.
enum class Quality : std::uint8_t {
  kGood = 0,
  kStale = 1,    ///< older than it may be
  kBad = 2,      ///< no number
  kMissing = 3,  ///< nothing has come yet
};

/// Whether the plant takes commands.
enum class FieldState : std::uint8_t {
  kRunning,
  kUnknown,  ///< where the inputs are has not been read yet
  kLocal,    ///< its own hand has the inputs
  kLed,      ///< another master leads it
  kFrozen,   ///< its heartbeat stands still
  kLost,     ///< its link is down
};

/// Times are seconds on a steady clock of the caller's. Rules:
/// - a signal is missing until it has come, bad when it is no number, stale when it is older than
///   gateway.stale_s or when the plant's heartbeat stands still;
/// - the actuator's rules (bounds, move limit, hold, fallback: class Actuator) make every command;
///   it is then rounded to what the field can carry, inside the same limits;
/// - commands are made only while the field is running; a command that was not confirmed has to be
///   read back (or confirmed late) before the next one. Until then the plant takes no actions,
///   which is said with the sample, so that a controller goes on from the true input without a
///   bump;
/// - what is read back says where commands begin: at the start, and after a doubt (own hand, link,
///   heartbeat, a write without an answer). From then on every move is counted from the command
///   before it, and no reading leads it: where an input does not follow is positions(), and what is
///   done about it the session's (StuckWatch). A reading that did not agree with its command before
///   the link was lost, and has not moved since, says nothing about where commands begin;
/// - values that are not good are NaN in measurement().
class PlantGateway : public Process {
 public:
  /// The number next to a value inside [lower, upper] that the field can carry for this input;
  /// nothing if there is none.
  using Rounding = std::function<std::optional<double>(Eigen::Index input, double value,
                                                       double lower, double upper)>;

  /// `loop` has a section gateway. @throws InputError naming the field.
  explicit PlantGateway(const LoopFile& loop, Rounding rounding = nullptr);

  // The field's side.
  void sense(std::size_t signal, double value, double now_s);  ///< outputs, then disturbances
  void readBack(Eigen::Index input, double value, double now_s);
  void beat(std::uint64_t value, double now_s);  ///< the plant's heartbeat: any change counts
  void remote(bool on, double now_s);            ///< false: the plant's own hand
  void lead(bool on, double now_s);              ///< false: another master leads the plant
  void link(bool up, double now_s);  ///< down: inputs are read back before the next write
  /// The time of everything that follows.
  void tick(double now_s) { now_s_ = now_s; }

  /// What the plant is to be told, and its number; the same number: nothing new.
  const Vector& command() const { return command_; }
  std::uint64_t commandNumber() const { return number_; }
  /// Whether the plant is to be told anything.
  bool commands() const { return commanded_ && voided_ != number_; }
  void confirm(std::uint64_t number, double now_s);  ///< it has been told this
  void fail(std::uint64_t number, double now_s);     ///< it may have been told this, or not

  // The exchange's side.
  const PlantInfo& info() const override { return info_; }
  const Measurement& measurement() const override { return measurement_; }
  const Actuator& actuator() const override { return actuator_; }
  const Measurement& reset(std::uint64_t run_id) override;
  /// The sample on the table once more, with what has come meanwhile: while sample 0 waits.
  void renew() { measure(); }
  void take(VectorRef input) override;
  const Measurement& advance(VectorRef input) override;
  const Measurement& advanceWithoutAction() override;
  const std::string& trouble() const override { return trouble_; }
  bool takesActions() const override { return takes_; }  ///< as sample k was taken
  bool underWay() const override { return unconfirmed(); }
  const Vector& positions() const override { return seen_; }        ///< as sample k was taken
  const std::vector<Quality>& quality() const { return quality_; }  ///< outputs, disturbances
  const Vector& age() const { return age_s_; }                      ///< [s], the same order

  FieldState field() const;
  /// Signals (and inputs to be read back) that have not come yet.
  std::vector<std::string> missing() const;
  /// What is wrong in one sentence, empty if nothing is.
  std::string problem() const;
  std::uint64_t skipped() const { return skipped_; }  ///< actions that the plant could not take
  const SampleClock& clock() const { return clock_; }

 private:
  struct Reading {
    double value{}, at_s{};
    bool come{false};
  };
  bool unconfirmed() const { return number_ != confirmed_; }
  bool mayCommand() const { return field() == FieldState::kRunning && !unconfirmed(); }
  void doubtPosition(double now_s, bool moved = false);
  void followReadings();
  double positionOf(Eigen::Index i) const;
  bool agrees(Eigen::Index i, double reading, double with) const;
  void command(VectorRef input);
  void tell();
  void measure();
  Quality qualityOf(const Reading& reading) const;

  GatewayParams params_;
  PlantInfo info_;
  SampleClock clock_;
  Actuator actuator_;
  Rounding rounding_;
  std::uint32_t samples_;
  Measurement measurement_;
  std::vector<Quality> quality_;
  Vector age_s_;
  std::vector<Reading> signals_, positions_;  // of outputs and disturbances; of inputs
  Vector command_;                            // as it was rounded
  Vector seen_;                               // where the inputs were when the sample was taken
  Vector astray_, lying_;  // the same of an input that did not agree, else NaN: at the last sample,
                           // before the doubt
  double tolerance_;       // of an input's range
  double asked_s_{};       // when the oldest command was made that is not confirmed
  std::uint64_t number_{}, confirmed_{}, voided_{}, skipped_{}, beat_{};
  double now_s_{}, told_s_{-1.0}, beat_s_{};
  Vector waiting_;  // an action that came before the command ahead of it was confirmed
  bool link_{true}, remote_{true}, lead_{true}, beaten_{false}, commanded_{false};
  bool position_known_{false}, exact_{false}, waits_{false}, just_told_{false}, takes_{false};
  std::string trouble_;
};

}  // namespace fpc
