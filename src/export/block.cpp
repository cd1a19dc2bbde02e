#include "export/block.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>

#include "base/text_hash.hpp"
#include "config/model_file.hpp"
#include "export/clp_code.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/control/bumpless_transfer.hpp"

namespace fpc {
namespace {

using ir::Kind;
using ir::Program;
using ir::Value;

constexpr double kTransferNegligible = 1e-3;
constexpr double kRelativeRounding = 1e-9;
constexpr int kLongAgo = 1000000000;

int sourceOf(ActionSource source) { return static_cast<int>(source); }

double bounded(double value) { return std::clamp(value, -ir::kLargest, ir::kLargest); }

std::vector<double> values(const Vector& from) {
  std::vector<double> to;
  for (Eigen::Index i = 0; i < from.size(); ++i) to.push_back(bounded(from[i]));
  return to;
}

/// What a loop may not have if it is to be a block.
void requireExportable(const LoopFile& loop) {
  const auto refuse = [&](bool refused, const std::string& key, const std::string& reason) {
    require(!refused, loop.name + ": " + key, reason);
  };
  refuse(loop.has_identify, "model.identify",
         "a model file: an exported law cannot identify its model");
  refuse(!loop.estimator.outputs.empty(), "estimator",
         "no estimator: what is not measured cannot be estimated in the exported block");
  refuse(!loop.standstill.signals.empty(), "standstill",
         "no standstill watch in the exported block");
  refuse(loop.plausibility.reaction_samples > 0, "plausibility.reaction_samples",
         "0: the reaction of the outputs is not watched in the exported block");
}

/// Builds the block in the order in which it runs.
class BlockBuilder {
 public:
  BlockBuilder(const LoopFile& loop, Program& program)
      : loop_(loop),
        p_(program),
        n_y_(static_cast<int>(loop.plant_info.outputs.size())),
        n_u_(static_cast<int>(loop.plant_info.inputs.size())),
        n_d_(static_cast<int>(loop.plant_info.disturbances.size())) {}

  void build() {
    requireExportable(loop_);
    declareInputs();
    declareStates();
    declareOutputs();
    BlockParts parts{p_,   loop_, n_y_, n_u_, n_d_, y_,      d_,        seen_,    active_,
                     low_, up_,   mv_,  u_,   ok_,  source_, expected_, foreseen_};
    law_ = makeLawCode(parts);
    clp_ = law_->optimizer();
    if (clp_) of_optimizer_ = p_.state("ofOptimizer", Kind::kBool);
    if (clp_) last_base_ = p_.states("lastBase", Kind::kReal, n_u_, initialInput());
    begin();
    checkCommands();
    readSetpoints();
    lookAtMoves();
    law_->begin();
    p_.set(foreseen_, false);
    p_.loop(n_y_, [&](const Value& i) { p_.set(expected_[i], 0.0); });
    p_.when(known_ && !first_ && !interrupted_, [&] { law_->foresee(); });
    judge();
    act(parts);
    finish();
    law_->signals();
  }

 private:
  const std::string& unit(const SignalInfo& info) const { return info.unit; }

  void declareInputs() {
    const auto& plant = loop_.plant_info;
    enable_ = p_.input("xEnable", Kind::kBool, 1, "off: the output follows the actuator");
    mode_ = p_.input("iMode", Kind::kInt, 2, "0 off, 1 manual, 2 automatic, 3 cascade");
    reset_ = p_.input("xReset", Kind::kBool, 0, "starts anew, without a bump");
    sample_time_ = p_.input("rSampleTime", Kind::kReal, 0.0,
                            "measured time between calls [s]; 0: not measured");
    for (int i = 0; i < n_y_; ++i) {
      const SignalInfo& s = plant.outputs[at(i)];
      const std::string name = plainName(s.name), of = " of " + s.name + " [" + s.unit + "]";
      asked_in_.push_back(p_.input("rSetpoint_" + name, Kind::kReal,
                                   bounded(loop_.setpoint.initial[i]), "setpoint" + of));
      cascade_in_.push_back(p_.input("rCascade_" + name, Kind::kReal,
                                     bounded(loop_.setpoint.initial[i]),
                                     "setpoint in mode 3" + of));
      value_in_.push_back(p_.input("rValue_" + name, Kind::kReal, 0.0, "measured value" + of));
      ok_in_.push_back(p_.input("xOk_" + name, Kind::kBool, 1, "the measured value is good"));
    }
    for (int i = 0; i < n_d_; ++i) {
      const SignalInfo& s = plant.disturbances[at(i)];
      const std::string name = plainName(s.name);
      value_in_.push_back(p_.input("rValue_" + name, Kind::kReal, 0.0,
                                   "measured disturbance " + s.name + " [" + s.unit + "]"));
      ok_in_.push_back(p_.input("xOk_" + name, Kind::kBool, 1, "the measured value is good"));
    }
    track_ = p_.input("xTrack", Kind::kBool, 1,
                      "rActuator_ is what the actuator really did; off: it follows");
    for (int i = 0; i < n_u_; ++i) {
      const SignalInfo& s = plant.inputs[at(i)];
      const std::string name = plainName(s.name), of = " of " + s.name + " [" + s.unit + "]";
      manual_in_.push_back(p_.input("rManual_" + name, Kind::kReal,
                                    bounded(loop_.simulation.actuator.initial[i]),
                                    "manual value" + of));
      actuator_in_.push_back(p_.input("rActuator_" + name, Kind::kReal,
                                      bounded(loop_.simulation.actuator.initial[i]),
                                      "position of the actuator" + of));
    }
    declareParameters();
  }

  void declareParameters() {
    const auto& plant = loop_.plant_info;
    const auto& limits = loop_.simulation.actuator.limits;
    for (int i = 0; i < n_u_; ++i) {
      const SignalInfo& s = plant.inputs[at(i)];
      const std::string name = plainName(s.name), of = " of " + s.name + " [" + s.unit + "]";
      lower_in_.push_back(
          p_.input("rLower_" + name, Kind::kReal, bounded(limits.lower[i]), "lower limit" + of));
      upper_in_.push_back(
          p_.input("rUpper_" + name, Kind::kReal, bounded(limits.upper[i]), "upper limit" + of));
      move_in_.push_back(p_.input("rMove_" + name, Kind::kReal, bounded(limits.move[i]),
                                  "largest move per sample" + of + "; 1E12: none"));
      fallback_in_.push_back(
          p_.input("rFallback_" + name, Kind::kReal, bounded(fallback()[i]), "substitute" + of));
    }
    for (int i = 0; i < n_y_; ++i) {
      const SignalInfo& s = plant.outputs[at(i)];
      const std::string name = plainName(s.name),
                        of = " of the setpoint of " + s.name + " [" + s.unit + "]";
      const auto given = [&](const Vector& all, double absent) {
        return all.size() > 0 ? bounded(all[i]) : absent;
      };
      set_lower_in_.push_back(p_.input("rSetLower_" + name, Kind::kReal,
                                       given(loop_.setpoint.lower, -ir::kLargest),
                                       "lower limit" + of));
      set_upper_in_.push_back(p_.input("rSetUpper_" + name, Kind::kReal,
                                       given(loop_.setpoint.upper, ir::kLargest),
                                       "upper limit" + of));
      set_rate_in_.push_back(p_.input("rSetRate_" + name, Kind::kReal,
                                      given(loop_.setpoint.rate_per_h, ir::kLargest),
                                      "largest change per hour" + of));
    }
    hold_samples_ =
        p_.input("iHoldSamples", Kind::kInt,
                 loop_.plausibility.fallback.size() > 0 ? loop_.plausibility.hold_samples : -1,
                 "so long a bad value holds the output, then the substitutes; -1: for ever");
  }

  Vector fallback() const {
    return loop_.plausibility.fallback.size() > 0 ? loop_.plausibility.fallback
                                                  : loop_.simulation.actuator.initial;
  }

  void declareStates() {
    const int n_s = n_y_ + n_d_;
    hash_ = p_.state("hash", Kind::kInt);
    first_ = p_.state("first", Kind::kBool, 1);
    begun_ = p_.state("begun", Kind::kBool);
    interrupted_ = p_.state("interrupted", Kind::kBool);
    other_hand_ = p_.state("otherHand", Kind::kBool);
    asked_ = p_.states("asked", Kind::kReal, n_y_, values(loop_.setpoint.initial));
    active_ = p_.states("active", Kind::kReal, n_y_);
    last_ = p_.states("last", Kind::kReal, n_u_, initialInput());
    manual_given_ = p_.state("manualGiven", Kind::kBool);
    manual_ = p_.states("manual", Kind::kReal, n_u_);
    bias_ = p_.states("bias", Kind::kReal, n_u_);
    left_ = p_.state("biasLeft", Kind::kReal);
    pending_ = p_.state("pending", Kind::kBool);
    moves_active_ = p_.state("movesActive", Kind::kBool);
    away_ = p_.states("away", Kind::kBool, n_u_);
    along_ = p_.states("along", Kind::kBool, n_u_);
    shown_ = p_.states("shown", Kind::kBool, n_u_);
    command_ = p_.states("command", Kind::kReal, n_u_);
    command_before_ = p_.states("commandBefore", Kind::kReal, n_u_);
    applied_before_ = p_.states("appliedBefore", Kind::kReal, n_u_);
    good_ = p_.states("good", Kind::kReal, n_s);
    has_good_ = p_.states("hasGood", Kind::kBool, n_s);
    since_good_ = p_.states("sinceGood", Kind::kInt, n_s);
    if (jumps()) {
      at_level_ = p_.states("atLevel", Kind::kInt, n_s);
      level_ = p_.states("level", Kind::kReal, n_s);
    }
    doubted_ = p_.state("doubted", Kind::kInt);
    declareWork();
  }

  void declareWork() {
    y_ = p_.works("y", Kind::kReal, n_y_);
    d_ = p_.works("d", Kind::kReal, std::max(n_d_, 1));
    raw_ = p_.works("raw", Kind::kReal, n_y_ + n_d_);
    raw_ok_ = p_.works("rawOk", Kind::kBool, n_y_ + n_d_);
    applied_ = p_.works("applied", Kind::kReal, n_u_);
    seen_ = p_.works("seen", Kind::kReal, n_u_);
    proven_ = p_.works("proven", Kind::kReal, n_u_);
    low_ = p_.works("low", Kind::kReal, n_u_);
    up_ = p_.works("up", Kind::kReal, n_u_);
    mv_ = p_.works("mv", Kind::kReal, n_u_);
    sub_ = p_.works("spare", Kind::kReal, n_u_);
    set_low_ = p_.works("setLow", Kind::kReal, n_y_);
    set_up_ = p_.works("setUp", Kind::kReal, n_y_);
    set_rate_ = p_.works("setRate", Kind::kReal, n_y_);
    wish_ = p_.works("wish", Kind::kReal, n_y_);
    u_ = p_.works("u", Kind::kReal, n_u_);
    expected_ = p_.works("expected", Kind::kReal, n_y_);
    foreseen_ = p_.work("foreseen", Kind::kBool);
    ok_ = p_.work("ok", Kind::kBool);
    source_ = p_.work("source", Kind::kInt);
    errors_ = p_.work("errors", Kind::kInt);
    is_manual_ = p_.work("isManual", Kind::kBool);
    takes_ = p_.work("takes", Kind::kBool);
    limits_ok_ = p_.work("limitsOk", Kind::kBool);
    time_ok_ = p_.work("timeOk", Kind::kBool);
    known_ = p_.work("known", Kind::kBool);
    displaced_ = p_.work("displaced", Kind::kBool);
    verdict_ = p_.work("verdict", Kind::kInt);
    fell_back_ = p_.work("fellBack", Kind::kBool);
    a_ = p_.work("a");
    b_ = p_.work("b");
    c_ = p_.work("c");
    flag_ = p_.work("flag", Kind::kBool);
  }

  void declareOutputs() {
    for (int i = 0; i < n_u_; ++i) {
      const SignalInfo& s = loop_.plant_info.inputs[at(i)];
      const std::string name = plainName(s.name);
      out_.push_back(p_.output("rOut_" + name, Kind::kReal, s.name + " [" + s.unit + "]"));
      high_.push_back(p_.output("xHigh_" + name, Kind::kBool, "at the upper limit"));
      lowest_.push_back(p_.output("xLow_" + name, Kind::kBool, "at the lower limit"));
      rate_.push_back(p_.output("xRate_" + name, Kind::kBool, "at the largest move"));
      step_out_.push_back(
          p_.output("rStep_" + name, Kind::kReal, "change of the output [" + s.unit + "]"));
    }
    for (int i = 0; i < n_y_; ++i)
      active_out_.push_back(p_.output("rActive_" + plainName(loop_.plant_info.outputs[at(i)].name),
                                      Kind::kReal, "setpoint in force"));
    state_out_ = p_.output("iState", Kind::kInt,
                           "0 off, 1 manual, 2 automatic, 3 cascade, 4 held, 5 substitute");
    source_out_ =
        p_.output("iSource", Kind::kInt,
                  std::string("1 law, ") + (loop_.has_clp ? "2 optimizer, " : "") +
                      "3 law at a limit, 4 held, 5 manual, 6 substitute, 7 law outside its data");
    valid_out_ = p_.output("xValid", Kind::kBool, "the output is the law's");
    busy_out_ = p_.output("xBusy", Kind::kBool, "enabled and not off");
    error_out_ = p_.output("xError", Kind::kBool, "some error bit is set");
    errors_out_ =
        p_.output("iErrors", Kind::kInt,
                  "1 sample time, 2 measured value, 4 limits, 8 actuator, 16 law, 32 setpoint");
    hash_out_ = p_.output("iIdentity", Kind::kInt, "hash of model and loop");
  }

  std::vector<double> initialInput() const { return values(loop_.simulation.actuator.initial); }
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  bool jumps() const {
    return loop_.plausibility.enabled &&
           std::any_of(loop_.plausibility.outputs.begin(), loop_.plausibility.outputs.end(),
                       [](const auto& s) { return std::isfinite(s.jump); });
  }

  void begin() {
    const int number = blockNumber(loop_);
    p_.when(hash_ != number || reset_, [&] {
      p_.words("another law, or asked to: start anew");
      p_.initialise();
      p_.set(hash_, number);
    });
    p_.set(errors_, 0);
  }

  static Value isRange(const Value& lower, const Value& upper, const Value& rate) {
    return ir::sane(lower) && ir::sane(upper) && lower <= upper && ir::sane(rate) && rate > 0.0;
  }

  static Value initial(const Value& parameter) {
    return Value(parameter.node().variable->initial[0]);
  }

  void raise(const Value& condition, BlockError error) {
    p_.when(condition, [&] { p_.set(errors_, errors_ + static_cast<int>(error)); });
  }

  void checkCommands() {
    p_.words("limits and sample time");
    p_.set(limits_ok_, true);
    for (int i = 0; i < n_u_; ++i) {
      const std::size_t k = at(i);
      p_.set(low_[i], lower_in_[k]);
      p_.set(up_[i], upper_in_[k]);
      p_.set(mv_[i], move_in_[k]);
      p_.set(sub_[i], fallback_in_[k]);
    }
    p_.loop(n_u_, [&](const Value& i) {
      p_.when(!(isRange(low_[i], up_[i], mv_[i]) && ir::sane(sub_[i])),
              [&] { p_.set(limits_ok_, false); });
    });
    set_limits_ok_ = p_.work("setLimitsOk", Kind::kBool);
    p_.set(set_limits_ok_, true);
    for (int i = 0; i < n_y_; ++i) {
      p_.set(set_low_[i], set_lower_in_[at(i)]);
      p_.set(set_up_[i], set_upper_in_[at(i)]);
      p_.set(set_rate_[i], set_rate_in_[at(i)]);
    }
    p_.loop(n_y_, [&](const Value& i) {
      p_.when(!isRange(set_low_[i], set_up_[i], set_rate_[i]),
              [&] { p_.set(set_limits_ok_, false); });
    });
    p_.when(!limits_ok_, [&] {
      p_.words("the limits as they were exported");
      for (int i = 0; i < n_u_; ++i) {
        p_.set(low_[i], initial(lower_in_[at(i)]));
        p_.set(up_[i], initial(upper_in_[at(i)]));
        p_.set(mv_[i], initial(move_in_[at(i)]));
        p_.set(sub_[i], initial(fallback_in_[at(i)]));
      }
    });
    p_.when(!set_limits_ok_, [&] {
      for (int i = 0; i < n_y_; ++i) {
        p_.set(set_low_[i], initial(set_lower_in_[at(i)]));
        p_.set(set_up_[i], initial(set_upper_in_[at(i)]));
        p_.set(set_rate_[i], initial(set_rate_in_[at(i)]));
      }
    });
    const double ts = loop_.plant_info.sample_time_s;
    p_.set(time_ok_, sample_time_ == 0.0 || (sample_time_ >= 0.9 * ts && sample_time_ <= 1.1 * ts));
    p_.set(is_manual_, enable_ && mode_ == 1 && limits_ok_);
    p_.set(takes_, is_manual_ || (enable_ && (mode_ == 2 || mode_ == 3) && limits_ok_ && time_ok_));
    raise(!limits_ok_ || !set_limits_ok_, kLimitsInconsistent);
    raise(!time_ok_, kSampleTimeOff);
  }

  void readSetpoints() {
    p_.words("setpoints");
    p_.set(flag_, false);
    const double hours = loop_.plant_info.sample_time_s / 3600.0;
    for (int i = 0; i < n_y_; ++i) p_.set(wish_[i], asked_in_[at(i)]);
    p_.when(mode_ == 3, [&] {
      for (int i = 0; i < n_y_; ++i) p_.set(wish_[i], cascade_in_[at(i)]);
    });
    p_.loop(n_y_, [&](const Value& i) {
      p_.when(
          ir::sane(wish_[i]), [&] { p_.set(asked_[i], wish_[i]); }, [&] { p_.set(flag_, true); });
      p_.set(b_, asked_[i]);
      p_.clamp(b_, set_low_[i], set_up_[i]);
      p_.when(begun_ && set_rate_[i] < ir::kLargest, [&] {
        p_.set(c_, set_rate_[i] * hours);
        p_.clamp(b_, active_[i] - c_, active_[i] + c_);
      });
      p_.keepInside(b_);
      p_.set(active_[i], b_);
    });
    raise(flag_, kSetpointBad);
  }

  void lookAtMoves() {
    p_.words("what the actuator did, and from where the next move counts");
    p_.set(known_, true);
    for (int i = 0; i < n_u_; ++i) {
      p_.set(applied_[i], last_[i]);
      p_.when(track_, [&] {
        p_.when(
            ir::sane(actuator_in_[at(i)]), [&] { p_.set(applied_[i], actuator_in_[at(i)]); },
            [&] { p_.set(known_, false); });
      });
    }
    raise(!known_, kActuatorBad);
    p_.when(!begun_ || !takes_ || !known_, [&] { restartMoves(); });
    p_.set(displaced_, false);
    p_.loop(n_u_, [&](const Value& i) {
      p_.set(seen_[i], applied_[i]);
      p_.set(proven_[i], applied_[i]);
    });
    p_.when(known_, [&] {
      p_.loop(n_u_, [&](const Value& i) {
        p_.set(c_, kRelativeRounding * (up_[i] - low_[i]));
        p_.setAbsolute(a_, applied_[i] - command_[i]);
        p_.set(flag_, moves_active_ && mv_[i] < ir::kLargest && a_ > c_);
        p_.when(flag_, [&] { judgeMove(i); });
        p_.set(away_[i], flag_);
        p_.when(flag_, [&] { p_.set(displaced_, true); });
        p_.set(applied_before_[i], applied_[i]);
      });
    });
    if (clp_) shareMoves();
    p_.when(!known_, [&] {
      p_.loop(n_u_, [&](const Value& i) { p_.set(proven_[i], (clp_ ? last_base_ : last_)[i]); });
    });
  }

  /// Of what an optimizer sent only the optimizer knows: the law sees what is read.
  void shareMoves() {
    p_.loop(n_u_, [&](const Value& i) {
      p_.set(clp_->previous[i], seen_[i]);
      p_.when(of_optimizer_, [&] {
        p_.set(seen_[i], applied_[i]);
        p_.set(proven_[i], applied_[i]);
      });
    });
  }

  /// Only a command that moved tells an offset from a valve that stands still.
  void judgeMove(const Value& i) {
    const Value moved = applied_[i] - applied_before_[i], asked = command_[i] - command_before_[i];
    p_.setAbsolute(a_, moved);
    p_.setAbsolute(b_, asked);
    p_.set(shown_[i], away_[i] && (shown_[i] || b_ > c_));
    p_.when(
        !away_[i], [&] { p_.set(along_[i], a_ > c_); },
        [&] {
          p_.when(b_ > c_, [&] {
            p_.setAbsolute(b_, moved - asked);
            p_.set(along_[i], b_ < a_);
          });
        });
    p_.when(along_[i], [&] {
      p_.set(seen_[i], command_[i]);
      p_.when(shown_[i], [&] { p_.set(proven_[i], command_[i]); });
    });
  }

  void restartMoves() {
    p_.set(moves_active_, false);
    p_.loop(n_u_, [&](const Value& i) { p_.set(away_[i], false); });
  }

  const SignalPlausibility& plausibility(int i) const {
    static const SignalPlausibility nothing;
    const auto& list = i < n_y_ ? loop_.plausibility.outputs : loop_.plausibility.disturbances;
    const std::size_t k = at(i < n_y_ ? i : i - n_y_);
    return loop_.plausibility.enabled && k < list.size() ? list[k] : nothing;
  }

  using Of = std::function<Value(const Value&)>;

  /// A number for each signal: a table only where they differ.
  Of uniform(const std::string& name, const std::vector<double>& all, Kind kind) {
    if (std::any_of(all.begin(), all.end(), [&](double v) { return v != all[0]; }))
      return [of = p_.table(name, all, kind)](const Value& i) { return of[i]; };
    return [number = ir::literal(all[0], kind)](const Value&) { return number; };
  }

  template <typename Get>
  Of each(const std::string& name, const Get& get, Kind kind = Kind::kReal) {
    std::vector<double> all;
    for (int i = 0; i < n_y_ + n_d_; ++i) all.push_back(bounded(get(plausibility(i))));
    return uniform(name, all, kind);
  }

  bool hasRates() const {
    for (int i = 0; i < n_y_ + n_d_; ++i)
      if (std::isfinite(plausibility(i).rate_per_h)) return true;
    return false;
  }

  /// What of a signal that has no number a law needs: as ControllerSession::noteNeeds().
  bool isNeeded(int i) const {
    const auto& needs = loop_.plausibility.needs;
    const bool needed = needs.empty() || needs[at(i)];
    if (!loop_.controllerType().needs_model || i < n_y_) return needed;
    for (const auto& submodel : loop_.model.submodels)
      for (const auto* list : {&submodel.antecedents, &submodel.regressors})
        for (const Regressor& r : *list)
          if (r.kind == SignalKind::kDisturbance && r.index == i - n_y_) return needed;
    return false;
  }

  void judge() {
    p_.words("can the measured values be true?");
    const int n_s = n_y_ + n_d_;
    for (int i = 0; i < n_s; ++i) {
      p_.set(raw_[i], value_in_[at(i)]);
      p_.set(raw_ok_[i], ok_in_[at(i)]);
    }
    const double hours = loop_.plant_info.sample_time_s / 3600.0;
    const Of lower = each("plLower", [](const auto&s) { return s.lower; }),
             upper = each("plUpper", [](const auto&s) { return s.upper; }),
             rate = each(
                 "plRate",
                 [&](const auto&s) { return s.rate_per_h * hours * (1.0 + kRelativeRounding); }),
             substitute = each(
                 "plSubstitute", [](const auto&s) { return static_cast<double>(s.substitute); },
                 Kind::kInt);
    std::vector<double> needs;
    for (int i = 0; i < n_s; ++i) needs.push_back(isNeeded(i) ? 1.0 : 0.0);
    const Of needed = uniform("plNeeded", needs, Kind::kBool);
    any_ = p_.work("someDoubt", Kind::kBool);
    doubtful_ = p_.work("doubtful", Kind::kBool);
    repaired_ = p_.work("repaired", Kind::kBool);
    may_end_ = p_.work("mayEnd", Kind::kBool);
    const Value doubt = p_.work("doubt", Kind::kInt), jumped = p_.work("jumped", Kind::kBool),
                replaced = p_.work("replaced", Kind::kBool), by = p_.work("how", Kind::kInt),
                modelled = p_.work("modelled", Kind::kBool);
    p_.set(any_, false);
    p_.set(doubtful_, false);
    p_.set(repaired_, true);
    p_.set(may_end_, false);
    constexpr int kNoNumber = 1, kRange = 2, kRate = 3, kJump = 4;
    p_.loop(n_s, [&](const Value& i) {
      p_.set(doubt, 0);
      p_.when(
          !(raw_ok_[i] && ir::sane(raw_[i])), [&] { p_.set(doubt, kNoNumber); },
          [&] {
            p_.setAbsolute(a_, raw_[i] - good_[i]);
            p_.set(jumped, false);
            if (jumps()) lookForJump(i, jumped);
            p_.when(
                raw_[i] < lower(i) || raw_[i] > upper(i), [&] { p_.set(doubt, kRange); },
                [&] {
                  p_.when(
                      Value(hasRates()) && has_good_[i] &&
                          a_ > rate(i) * (ir::toReal(since_good_[i]) + 1.0),
                      [&] { p_.set(doubt, kRate); },
                      [&] { p_.when(jumped, [&] { p_.set(doubt, kJump); }); });
                });
          });
      p_.when(
          doubt == 0,
          [&] {
            p_.set(good_[i], raw_[i]);
            p_.set(has_good_[i], true);
            p_.set(since_good_[i], 0);
          },
          [&] {
            p_.when(since_good_[i] < kLongAgo, [&] { p_.set(since_good_[i], since_good_[i] + 1); });
            p_.set(any_, true);
            p_.set(by, substitute(i));
            p_.when(since_good_[i] <= loop_.plausibility.bridge_samples, [&] { p_.set(by, 2); });
            p_.set(modelled, false);
            p_.set(raw_[i], 0.0);
            p_.when(has_good_[i], [&] { p_.set(raw_[i], good_[i]); });
            p_.when((n_d_ > 0 ? i < n_y_ : Value(true)) && by == 2 && foreseen_,
                    [&] { modelValue(i, modelled); });
            p_.set(replaced, modelled || has_good_[i]);
            p_.when(needed(i), [&] {
              p_.set(doubtful_, true);
              p_.set(may_end_,
                     may_end_ || doubt != kRange || Value(loop_.plausibility.range_falls));
              p_.set(repaired_, repaired_ && replaced && by != 0);
            });
          });
    });
    p_.loop(n_y_, [&](const Value& i) { p_.set(y_[i], raw_[i]); });
    p_.loop(n_d_, [&](const Value& i) { p_.set(d_[i], raw_[i + n_y_]); });
    p_.when(
        doubtful_, [&] { p_.when(doubted_ < kLongAgo, [&] { p_.set(doubted_, doubted_ + 1); }); },
        [&] { p_.set(doubted_, 0); });
    p_.words("0 good, 1 some value is replaced, 2 hold, 3 substitute");
    p_.set(verdict_, 0);
    p_.when(any_, [&] { p_.set(verdict_, 1); });
    p_.when(doubtful_ && !repaired_, [&] { p_.set(verdict_, 2); });
    p_.when(may_end_ && hold_samples_ >= 0 && doubted_ > hold_samples_,
            [&] { p_.set(verdict_, 3); });
    raise(doubtful_, kInputBad);
  }

  /// An index beyond the outputs is compared first, and taken only where it is one.
  void modelValue(const Value& i, const Value& modelled) {
    const Value at = n_d_ > 0 ? p_.work("atOutput", Kind::kInt) : i;
    if (n_d_ > 0) p_.set(at, i);
    if (n_d_ > 0) p_.when(at >= n_y_, [&] { p_.set(at, 0); });
    p_.when(ir::sane(expected_[at]), [&] {
      p_.set(raw_[i], expected_[at]);
      p_.set(modelled, true);
    });
  }

  void lookForJump(const Value& i, const Value& jumped) {
    const Of limit = each("plJump", [](const auto&s) { return s.jump; }),
             samples = each(
                 "plJumpSamples", [](const auto&s) { return s.jump_samples; }, Kind::kInt);
    p_.when(
        has_good_[i] && a_ > limit(i),
        [&] {
          p_.setAbsolute(b_, raw_[i] - level_[i]);
          p_.when(
              at_level_[i] > 0 && b_ <= limit(i),
              [&] {
                p_.when(at_level_[i] < kLongAgo, [&] { p_.set(at_level_[i], at_level_[i] + 1); });
              },
              [&] { p_.set(at_level_[i], 1); });
          p_.set(level_[i], raw_[i]);
          p_.set(jumped, at_level_[i] < samples(i));
        },
        [&] { p_.set(at_level_[i], 0); });
  }

  void act(BlockParts& parts) {
    p_.words("who has the input");
    p_.when(!is_manual_, [&] { p_.set(manual_given_, false); });
    flag_bad_manual_ = p_.work("badManual", Kind::kBool);
    p_.when(is_manual_, [&] {
      p_.set(flag_bad_manual_, false);
      for (int i = 0; i < n_u_; ++i)
        p_.when(!ir::sane(manual_in_[at(i)]), [&] { p_.set(flag_bad_manual_, true); });
      p_.when(!flag_bad_manual_, [&] {
        for (int i = 0; i < n_u_; ++i) {
          p_.set(manual_[i], manual_in_[at(i)]);
          p_.clamp(manual_[i], low_[i], up_[i]);
        }
        p_.set(manual_given_, true);
      });
      raise(flag_bad_manual_, kSetpointBad);
    });
    p_.set(fell_back_, false);
    p_.set(ok_, true);
    p_.set(source_, sourceOf(ActionSource::kHeld));
    p_.loop(n_u_, [&](const Value& i) { p_.set(u_[i], proven_[i]); });
    p_.when(
        is_manual_, [&] { p_.when(known_, [&] { sendManual(); }); },
        [&] {
          p_.when(takes_ && known_, [&] {
            p_.when(
                verdict_ == 3, [&] { fallBack(); },
                [&] { p_.when(verdict_ != 2, [&] { runLaw(parts); }); });
          });
        });
    p_.when(!laws(), [&] {
      clipInputs(parts, u_, proven_);
      p_.when(ok_, [&] { p_.set(interrupted_, true); });
      if (clp_) passThrough();
    });
  }

  Value laws() const {
    return source_ == sourceOf(ActionSource::kBase) ||
           source_ == sourceOf(ActionSource::kClipped) ||
           source_ == sourceOf(ActionSource::kGuarded) ||
           (clp_ ? source_ == sourceOf(ActionSource::kConstrained) : Value(false));
  }

  void sendManual() {
    p_.when(!manual_given_,
            [&] { p_.loop(n_u_, [&](const Value& i) { p_.set(manual_[i], proven_[i]); }); });
    p_.set(manual_given_, true);
    p_.loop(n_u_, [&](const Value& i) { p_.set(u_[i], manual_[i]); });
    p_.set(source_, sourceOf(ActionSource::kManual));
  }

  void fallBack() {
    p_.loop(n_u_, [&](const Value& i) { p_.set(u_[i], sub_[i]); });
    p_.set(source_, sourceOf(ActionSource::kFallback));
    p_.set(fell_back_, true);
  }

  void runLaw(BlockParts& parts) {
    p_.when(interrupted_ || first_, [&] {
      p_.words("the law begins, or begins again");
      law_->reset();
      if (!clp_) {
        p_.set(pending_, other_hand_ || pending_ || left_ > kTransferNegligible);
        p_.set(left_, 0.0);
        p_.loop(n_u_, [&](const Value& i) { p_.set(bias_[i], 0.0); });
        p_.set(other_hand_, false);
      }
      p_.set(interrupted_, false);
      p_.set(first_, false);
    });
    p_.set(source_, sourceOf(ActionSource::kBase));
    p_.words("the law");
    law_->step();
    p_.words("its answer");
    p_.loop(n_u_, [&](const Value& i) { p_.when(!ir::sane(u_[i]), [&] { p_.set(ok_, false); }); });
    raise(!ok_, kLawFailed);
    p_.when(
        ok_,
        [&] {
          if (!clp_) p_.when(pending_ || left_ > kTransferNegligible, [&] { bridge(seen_); });
          clipInputs(parts, u_, seen_);
          p_.loop(n_u_, [&](const Value& i) {
            p_.when(clp_ ? away_[i] && !of_optimizer_ : away_[i], [&] { keepNear(i); });
          });
          if (clp_) optimize(parts);
        },
        [&] {
          p_.set(source_, sourceOf(ActionSource::kHeld));
          p_.loop(n_u_, [&](const Value& i) { p_.set(u_[i], proven_[i]); });
        });
  }

  void keepNear(const Value& i) { p_.clamp(u_[i], command_[i] - mv_[i], command_[i] + mv_[i]); }

  /// The optimizer's answer instead of the law's, and where it comes from; after another hand it
  /// starts where the input is.
  void optimize(BlockParts& parts) {
    const Value guarded = p_.work("guarded", Kind::kBool);
    p_.words("the optimizer");
    p_.set(guarded, source_ == sourceOf(ActionSource::kGuarded));
    p_.loop(n_u_, [&](const Value& i) {
      p_.set(last_base_[i], u_[i]);
      p_.set(applied_before_[i], seen_[i]);
    });
    clp_->run();
    p_.loop(n_u_, [&](const Value& i) { p_.set(u_[i], clp_->u[i]); });
    p_.set(source_, clp_->source);
    p_.when(guarded, [&] { p_.set(source_, sourceOf(ActionSource::kGuarded)); });
    const auto clipped = [&] { p_.set(source_, sourceOf(ActionSource::kClipped)); };
    p_.when(pending_ || left_ > kTransferNegligible, [&] {
      bridge(clp_->previous);
      clipInputs(parts, u_, clp_->previous);
      clipped();
    });
    p_.loop(n_u_, [&](const Value& i) {
      p_.when(away_[i] && of_optimizer_, [&] {
        p_.set(a_, u_[i]);
        keepNear(i);
        p_.when(u_[i] != a_, clipped);
      });
    });
  }

  /// What the optimizer passes through: from another hand it takes over without a bump.
  void passThrough() {
    clp_->rest();
    p_.set(flag_, !begun_ || source_ != sourceOf(ActionSource::kHeld) || pending_ ||
                      left_ > kTransferNegligible);
    p_.loop(n_u_, [&](const Value& i) {
      p_.set(last_base_[i], u_[i]);
      p_.setAbsolute(a_, u_[i] - last_[i]);
      p_.when(a_ > kRelativeRounding * (up_[i] - low_[i]), [&] { p_.set(flag_, true); });
    });
    p_.when(flag_, [&] {
      p_.set(pending_, true);
      p_.set(left_, 0.0);
      p_.loop(n_u_, [&](const Value& i) { p_.set(bias_[i], 0.0); });
    });
  }

  /// After another hand the first answer is where the input is; what the law asks for otherwise
  /// comes in as the bias between them dies out.
  void bridge(const Value& from) {
    p_.when(
        pending_,
        [&] {
          p_.loop(n_u_, [&](const Value& i) {
            p_.set(bias_[i], from[i] - u_[i]);
            p_.set(u_[i], from[i]);
          });
          p_.set(left_, 1.0);
          p_.set(pending_, false);
        },
        [&] { p_.loop(n_u_, [&](const Value& i) { p_.set(u_[i], u_[i] + bias_[i]); }); });
    p_.loop(n_u_, [&](const Value& i) { p_.set(bias_[i], bias_[i] * kTransferDecay); });
    p_.set(left_, left_ * kTransferDecay);
  }

  void finish() {
    p_.words("what goes out");
    if (!clp_)
      p_.set(other_hand_,
             other_hand_ || source_ == sourceOf(ActionSource::kManual) || fell_back_ || !takes_);
    p_.loop(n_u_, [&](const Value& i) { p_.keepInside(u_[i]); });
    for (int i = 0; i < n_u_; ++i) {
      const std::size_t k = at(i);
      p_.set(out_[k], u_[i]);
      p_.set(high_[k], u_[i] >= up_[i]);
      p_.set(lowest_[k], u_[i] <= low_[i]);
      p_.set(step_out_[k], u_[i] - applied_[i]);
      p_.setAbsolute(a_, u_[i] - seen_[i]);
      p_.set(rate_[k], mv_[i] < ir::kLargest && a_ >= mv_[i] * (1.0 - kRelativeRounding));
      p_.set(last_[i], u_[i]);
    }
    p_.when(
        !takes_, [&] { restartMoves(); },
        [&] {
          p_.loop(n_u_, [&](const Value& i) {
            p_.set(command_before_[i], command_[i]);
            const Value other = clp_ ? !moves_active_ || of_optimizer_ != laws() : !moves_active_;
            p_.when(other, [&] {
              p_.set(command_before_[i], u_[i]);
              if (clp_) p_.set(away_[i], false);
            });
            p_.set(command_[i], u_[i]);
          });
          p_.set(moves_active_, true);
        });
    if (clp_) p_.set(of_optimizer_, laws());
    for (int i = 0; i < n_y_; ++i) p_.set(active_out_[at(i)], active_[i]);
    p_.set(source_out_, source_);
    p_.set(valid_out_, laws());
    p_.set(busy_out_, enable_ && mode_ >= 1 && mode_ <= 3);
    p_.set(state_out_, mode_);
    p_.when(source_ == sourceOf(ActionSource::kHeld),
            [&] { p_.set(state_out_, static_cast<int>(BlockState::kHeld)); });
    p_.when(fell_back_, [&] { p_.set(state_out_, static_cast<int>(BlockState::kFallback)); });
    p_.when(!busy_out_, [&] { p_.set(state_out_, static_cast<int>(BlockState::kOff)); });
    p_.set(errors_out_, errors_);
    p_.set(error_out_, errors_ != 0);
    p_.set(hash_out_, hash_);
    p_.set(begun_, true);
  }

  const LoopFile& loop_;
  Program& p_;
  int n_y_, n_u_, n_d_;
  std::unique_ptr<LawCode> law_;
  ClpCode* clp_{nullptr};  // of the law; null: none
  Value of_optimizer_{0}, last_base_{0};
  std::vector<Value> asked_in_, cascade_in_, value_in_, ok_in_, manual_in_, actuator_in_, lower_in_,
      upper_in_, move_in_, fallback_in_, set_lower_in_, set_upper_in_, set_rate_in_;
  std::vector<Value> out_, high_, lowest_, rate_, step_out_, active_out_;
  Value enable_{0}, mode_{0}, reset_{0}, sample_time_{0}, track_{0}, hold_samples_{0};
  Value hash_{0}, first_{0}, begun_{0}, interrupted_{0}, other_hand_{0}, asked_{0}, active_{0},
      last_{0}, manual_given_{0}, manual_{0}, bias_{0}, left_{0}, pending_{0}, moves_active_{0},
      away_{0}, along_{0}, shown_{0}, command_{0}, command_before_{0}, applied_before_{0}, good_{0},
      has_good_{0}, since_good_{0}, at_level_{0}, level_{0}, doubted_{0};
  Value y_{0}, d_{0}, raw_{0}, raw_ok_{0}, applied_{0}, seen_{0}, proven_{0}, low_{0}, up_{0},
      mv_{0}, sub_{0}, set_low_{0}, set_up_{0}, set_rate_{0}, wish_{0}, u_{0}, expected_{0},
      foreseen_{0}, ok_{0}, source_{0}, errors_{0}, is_manual_{0}, takes_{0}, limits_ok_{0},
      set_limits_ok_{0}, time_ok_{0}, known_{0}, displaced_{0}, verdict_{0}, fell_back_{0}, a_{0},
      b_{0}, c_{0}, flag_{0}, any_{0}, doubtful_{0}, repaired_{0}, may_end_{0}, flag_bad_manual_{0};
  Value state_out_{0}, source_out_{0}, valid_out_{0}, busy_out_{0}, error_out_{0}, errors_out_{0},
      hash_out_{0};
};

}  // namespace

/// Of what the law follows from: the loop's text, and its model.
std::string blockHash(const LoopFile& loop) {
  return textHash(loop.resolved + (loop.has_model ? writeModel(loop.model) : ""));
}

int blockNumber(const LoopFile& loop) {
  const std::string hash = blockHash(loop);
  return static_cast<int>(std::stoul(hash.substr(hash.size() - 8), nullptr, 16) & 0x7fffffffU);
}

std::string plainName(const std::string& name) {
  std::string plain;
  for (const char c : name) {
    const bool word = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (word)
      plain += c;
    else if (!plain.empty() && plain.back() != '_')
      plain += '_';
  }
  while (!plain.empty() && plain.back() == '_') plain.pop_back();
  require(!plain.empty(), "export: signal '" + name + "'", "a name with letters or digits");
  return plain;
}

void clipInputs(BlockParts& parts, const Value& input, const Value& previous) {
  parts.p.loop(parts.n_u, [&](const Value& i) {
    parts.p.when(parts.move[i] < ir::kLargest, [&] {
      parts.p.clamp(input[i], previous[i] - parts.move[i], previous[i] + parts.move[i]);
    });
    parts.p.clamp(input[i], parts.lower[i], parts.upper[i]);
  });
}

void buildBlock(const LoopFile& loop, Program& program) { BlockBuilder(loop, program).build(); }

}  // namespace fpc
