// Controller type pi as code of a block: see PiController and PiTermState.
#include <cmath>

#include "control/pi/pi.hpp"
#include "export/block.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/control/registry.hpp"

namespace fpc {
namespace {

using ir::Kind;
using ir::Value;

class PiCode final : public LawCode {
 public:
  PiCode(BlockParts& parts, const PiParams& params) : b_(parts), p_(parts.p), params_(params) {
    const int n = static_cast<int>(params_.loops.size());
    hours_ = parts.loop.plant_info.sample_time_s / 3600.0;
    integral_ = p_.states("share", Kind::kReal, n);
    pending_ = p_.states("piPending", Kind::kBool, n);
    error_ = p_.work("error");
    unclipped_ = p_.works("unclipped", Kind::kReal, n);
    errors_ = p_.works("loopError", Kind::kReal, n);
    t_ = p_.work("t");
    v_ = p_.work("v");
    w_ = p_.work("w");
    gain_ = p_.work("gain");
    clipped_ = p_.work("clipped", Kind::kBool);
    for (int i = 0; i < n; ++i) declareTerms(i);
    for (int i = 0; i < n; ++i)
      integral_out_.push_back(
          p_.output("rIntegral_" + inputName(i), Kind::kReal, "integral's share"));
  }

  void reset() override {
    for (int i = 0; i < count(); ++i) {
      p_.set(integral_[i], 0.0);
      p_.set(pending_[i], true);
      if (loop(i).terms.any()) p_.set(fresh_[k(i)], true);
    }
  }

  void step() override {
    p_.loop(b_.n_u, [&](const Value& i) { p_.set(b_.u[i], b_.applied[i]); });
    for (int i = 0; i < count(); ++i) propose(i);
    clipInputs(b_, b_.u, b_.applied);
    p_.set(clipped_, false);
    for (int i = 0; i < count(); ++i) {
      p_.when(b_.u[loop(i).input] != unclipped_[i], [&] { p_.set(clipped_, true); });
      integrate(i);
    }
    p_.when(clipped_, [&] { p_.set(b_.source, static_cast<int>(ActionSource::kClipped)); });
  }

  void signals() override {
    for (int i = 0; i < count(); ++i) p_.set(integral_out_[k(i)], integral_[i]);
  }

 private:
  static std::size_t k(int i) { return static_cast<std::size_t>(i); }
  int count() const { return static_cast<int>(params_.loops.size()); }
  const PiLoop& loop(int i) const { return params_.loops[k(i)]; }
  std::string inputName(int i) const {
    return plainName(b_.loop.plant_info.inputs[k(loop(i).input)].name);
  }

  void declareTerms(int i) {
    const std::string n = std::to_string(i);
    require(loop(i).terms.preview_h == 0.0, b_.loop.name + ": controller.loops.preview_h",
            "0: a block gets setpoints as they come and cannot look ahead");
    const bool any = loop(i).terms.any();
    const auto state = [&](const char* name, bool used, Kind kind = Kind::kReal) {
      return used ? p_.state(name + n, kind) : Value(0.0);
    };
    fresh_.push_back(state("piFresh", any, Kind::kBool));
    path_.push_back(state("piPath", any));
    path_before_.push_back(any ? p_.work("piPathBefore" + n) : Value(0.0));
    output_before_.push_back(state("piOutput", loop(i).terms.kd_h != 0.0));
    slope_.push_back(state("piSlope", loop(i).terms.kd_h != 0.0));
    const int lags = static_cast<int>(loop(i).terms.feedforward.size());
    lagged_.push_back(lags > 0 ? p_.states("piLagged" + n, Kind::kReal, lags) : Value(0.0));
  }

  /// to := the curve at `x`, linear between points, held outside.
  void curve(const std::string& name, const std::vector<CurvePoint>& points, const Value& x,
             const Value& to) {
    std::vector<double> at, value;
    for (const CurvePoint& point : points) {
      at.push_back(point.at);
      value.push_back(point.value);
    }
    const int n = static_cast<int>(at.size());
    const Value xs = p_.table(name + "At", at), ys = p_.table(name + "Is", value);
    p_.set(to, ys[0]);
    p_.loop(n - 1, [&](const Value& i) {
      p_.when(x >= xs[i], [&] {
        p_.set(to, ys[i] + ((x - xs[i]) / (xs[i + 1] - xs[i])) * (ys[i + 1] - ys[i]));
      });
    });
    p_.when(x >= xs[n - 1], [&] { p_.set(to, ys[n - 1]); });
  }

  /// t_ := what the error is taken from.
  void aim(int i) {
    const PiLoop& l = loop(i);
    p_.set(t_, b_.setpoint[l.output]);
    if (!l.terms.any()) return;
    const std::size_t n = k(i);
    const double lead = l.terms.setpoint_lead_h / hours_;
    if (l.terms.setpoint_pole > 0.0) {
      p_.set(path_before_[n], path_[n]);
      p_.when(fresh_[n], [&] { p_.set(path_before_[n], b_.y[l.output]); });
      p_.set(path_[n],
             l.terms.setpoint_pole * path_before_[n] + (1.0 - l.terms.setpoint_pole) * t_);
      p_.set(t_, path_before_[n] + lead * (path_[n] - path_before_[n]));
      return;
    }
    p_.set(path_before_[n], path_[n]);
    p_.when(fresh_[n], [&] { p_.set(path_before_[n], t_); });
    p_.set(path_[n], t_);
    p_.set(t_, t_ + lead * (path_[n] - path_before_[n]));
  }

  /// v_ += steady input, derivative, feed-forward.
  void addTerms(int i) {
    const PiLoop& l = loop(i);
    if (!l.terms.any()) return;
    const std::size_t n = k(i);
    if (!l.terms.static_input.empty()) {
      const Value from = l.terms.setpoint_pole > 0.0 ? path_before_[n] : path_[n];
      p_.set(w_, from + (l.terms.setpoint_lead_h / hours_) * (path_[n] - path_before_[n]));
      curve("piStatic" + std::to_string(i), l.terms.static_input, w_, gain_);
      p_.set(v_, v_ + gain_);
    }
    if (l.terms.kd_h != 0.0) {
      const double share = hours_ / (l.terms.derivative_lag_h + hours_);
      const Value y = b_.y[l.output];
      p_.when(
          fresh_[n], [&] { p_.set(slope_[n], 0.0); },
          [&] {
            p_.set(slope_[n], slope_[n] + share * ((y - output_before_[n]) / hours_ - slope_[n]));
          });
      p_.set(output_before_[n], y);
      p_.set(v_, v_ - (l.reverse ? -l.terms.kd_h : l.terms.kd_h) * slope_[n]);
    }
    for (std::size_t f = 0; f < l.terms.feedforward.size(); ++f) addFeedforward(i, f);
    p_.set(fresh_[n], false);
  }

  void addFeedforward(int i, std::size_t which) {
    const PiFeedforward& f = loop(i).terms.feedforward[which];
    const Value slow = lagged_[k(i)][static_cast<int>(which)];
    const double share = f.lag_h > 0.0 ? -std::expm1(-hours_ / f.lag_h) : 1.0;
    if (f.times < 0)
      p_.set(w_, b_.d[f.disturbance] - f.nominal);
    else
      p_.set(w_, b_.d[f.disturbance] * b_.d[f.times] - f.nominal);
    p_.when(fresh_[k(i)], [&] { p_.set(slow, w_); });
    p_.set(slow, slow + share * (w_ - slow));
    p_.set(v_, v_ + f.gain * slow);
  }

  void propose(int i) {
    const PiLoop& l = loop(i);
    p_.words("loop of " + inputName(i));
    aim(i);
    p_.set(error_, l.reverse ? b_.y[l.output] - t_ : t_ - b_.y[l.output]);
    if (!l.gain_schedule.empty()) {
      curve("piGain" + std::to_string(i), l.gain_schedule, b_.y[l.output], gain_);
      p_.set(error_, error_ * gain_);
    }
    p_.set(errors_[i], error_);
    p_.set(v_, (l.terms.static_input.empty() ? l.bias : 0.0) + l.kp * error_);
    addTerms(i);
    p_.set(unclipped_[i], v_ + integral_[i]);
    p_.when(pending_[i] && ir::sane(v_), [&] {
      p_.set(unclipped_[i], b_.applied[l.input]);
      p_.set(integral_[i], unclipped_[i] - v_);
      p_.set(pending_[i], false);
    });
    p_.when(
        ir::sane(unclipped_[i]), [&] { p_.set(b_.u[l.input], unclipped_[i]); },
        [&] { p_.set(b_.ok, false); });
  }

  void integrate(int i) {
    const PiLoop& l = loop(i);
    if (l.ki_per_h == 0.0) {
      p_.set(integral_[i], integral_[i] * 0.9);
      return;
    }
    p_.set(v_, l.ki_per_h * errors_[i] * hours_);
    if (l.anti_windup == AntiWindup::kClamp) {
      const auto end = [&](const Value& to, const Value& from) {
        p_.set(to, from);
        p_.clamp(to, b_.lower[l.input], b_.upper[l.input]);
      };
      end(t_, b_.applied[l.input] + b_.move[l.input]);
      end(w_, b_.applied[l.input] - b_.move[l.input]);
      p_.when((unclipped_[i] > t_ && v_ > 0.0) || (unclipped_[i] < w_ && v_ < 0.0),
              [&] { p_.set(v_, 0.0); });
    } else if (l.anti_windup == AntiWindup::kTracking) {
      p_.set(v_, v_ + (b_.u[l.input] - unclipped_[i]) * trackingShare(l, hours_));
    }
    p_.set(v_, integral_[i] + v_);
    p_.when(ir::sane(v_), [&] { p_.set(integral_[i], v_); });
  }

  BlockParts& b_;
  ir::Program& p_;
  const PiParams& params_;
  double hours_{};
  Value integral_{0}, pending_{0}, error_{0}, unclipped_{0}, errors_{0}, t_{0}, v_{0}, w_{0},
      gain_{0}, clipped_{0};
  std::vector<Value> fresh_, path_, path_before_, output_before_, slope_, lagged_, integral_out_;
};

}  // namespace

std::unique_ptr<LawCode> makePiCode(BlockParts& parts) {
  const auto* params = findParams<PiParams>(*parts.loop.controller);
  return params ? std::make_unique<PiCode>(parts, *params) : nullptr;
}

}  // namespace fpc
