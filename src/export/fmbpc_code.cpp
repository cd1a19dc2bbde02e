// Controller type fmbpc as code of a block: the published and the general law, the parallel and
// the realigned model, a transport delay. See FmbpcLaw, CoincidenceGains.
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "control/fmbpc/law.hpp"
#include "export/math.hpp"
#include "export/model_code.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/control/registry.hpp"
#include "model/undelayed.hpp"

namespace fpc {
namespace {

using ir::Kind;
using ir::Value;

constexpr double kSingularPivot = 1e-12;  // as CoincidenceGains

/// The way of CoincidenceGains to a horizon: short ones step by step, longer ones by doubling.
struct CoincidenceWalk {
  explicit CoincidenceWalk(int horizon) : start(horizon) {
    constexpr int kWalked = 32, kStart = 8;
    int bits = 0;
    while (horizon > kWalked && (horizon >> bits) >= kStart) ++bits;
    start = horizon >> bits;
    for (int bit = bits - 1; bit >= 0; --bit) odd.push_back((horizon >> bit) % 2);
  }
  int start;
  std::vector<double> odd;
};

class FmbpcCode final : public PredictiveCode {
 public:
  FmbpcCode(BlockParts& parts, const FmbpcParams& params)
      : PredictiveCode(parts, params, parts.loop.model),
        params_(params),
        realigned_(params.realisation == FmbpcRealisation::kRealigned),
        model_(parts, withoutDelay(parts.loop.model, params.delay_steps), "m", "m"),
        n_x_(model_.n_x()) {
    requireExported();
    if (params.delay_steps > 0)
      delayed_.emplace(parts, withoutDelay(parts.loop.model, params.delay_steps), "s", "m");
    for (int i = 0; i < b_.n_y; ++i)
      if (weightOf(i) > 0.0) followed_.push_back(i);
    declare();
  }

  void begin() override {
    PredictiveCode::begin();
    for (const Value& out : error_out_) p_.set(out, 0.0);
    for (const auto& outs : weights_out_)
      for (const Value& out : outs) p_.set(out, 0.0);
  }

  void foresee() override {
    p_.set(b_.foreseen, !start_);
    p_.when(b_.foreseen, [&] {
      const bool late = delayed_.has_value();
      p_.loop(b_.n_y, [&](const Value& i) {
        late ? addInputs(b_.expected[i], late_base_[i], late_B_, i, pastInput())
             : addInputs(b_.expected[i], base_[i], B_, i, nowInput());
        p_.set(b_.expected[i], b_.expected[i] + offset_[i]);
      });
    });
  }

 private:
  void requireExported() const {
    const std::string where = b_.loop.name + ": controller.";
    require(params_.law != FmbpcForm::kIterated, where + "law",
            "published or general: the iterated law's work per sample is not fixed");
    require(params_.realisation == FmbpcRealisation::kParallel || realigned_, where + "realisation",
            "parallel or realigned: others are not exported");
    require(params_.coincidence_steps <= 10000, where + "coincidence_steps",
            "at most 10000 in an exported block");
  }

  /// What an input does, or its square: with less the law has no answer.
  double faint() const { return p_.single ? 1e-20 : 1e-30; }

  double weightOf(int output) const {
    if (params_.law == FmbpcForm::kPublished) return output == b_.n_y - 1 ? 1.0 : 0.0;
    return params_.weight_output[output];
  }

  void declare() {
    x_ = p_.states("x", Kind::kReal, n_x_);
    base_ = p_.states("base", Kind::kReal, b_.n_y);
    B_ = p_.states("gainB", Kind::kReal, b_.n_y * b_.n_u);
    offset_ = p_.states("offset", Kind::kReal, b_.n_y);  // y - y_m, or w_hat
    if (delayed_) {
      const int n = params_.delay_steps;
      late_x_ = p_.states("lateX", Kind::kReal, n_x_);
      late_base_ = p_.states("lateBase", Kind::kReal, b_.n_y);
      late_B_ = p_.states("lateGainB", Kind::kReal, b_.n_y * b_.n_u);
      past_inputs_ = p_.states("pastInputs", Kind::kReal, n * b_.n_u);
      oldest_ = p_.state("oldestInput", Kind::kInt);
      oldest_d_ = p_.state("oldestD", Kind::kInt);
      if (b_.n_d > 0) late_past_ = p_.states("latePastD", Kind::kReal, b_.n_d);
      if (b_.n_d > 0) past_ds_ = p_.states("pastDs", Kind::kReal, n * b_.n_d);
      late_d_ = p_.works("lateD", Kind::kReal, std::max(b_.n_d, 1));
      late_u_ = p_.works("lateU", Kind::kReal, b_.n_u);
    }
    undelayed_ = p_.works("undelayed", Kind::kReal, b_.n_y);
    const int n = followed();
    free_ = p_.works("freeP", Kind::kReal, (n + powers()) * n_x_);
    next_ = p_.works("nextP", Kind::kReal, n_x_);
    sum_ = p_.works("sumS", Kind::kReal, n * n_x_);
    effect_ = p_.works("effect", Kind::kReal, n * b_.n_u);
    size_ = p_.works("effectSize", Kind::kReal, n * b_.n_u);
    lack_ = p_.works("lack", Kind::kReal, n);
    a_ = p_.work("lawA");
    c_ = p_.work("lawC");
    some_ = p_.work("someEffect", Kind::kBool);
    beginOptimizer(model_.layout(), params_.reference_lead_steps);
    for (int i = 0; i < b_.n_y; ++i) {
      const std::string& name = b_.loop.plant_info.outputs[static_cast<std::size_t>(i)].name;
      error_out_.push_back(p_.output("rModelError_" + plainName(name), Kind::kReal,
                                     "measured less what the model says"));
      const auto rules =
          static_cast<int>(model_.weights[static_cast<std::size_t>(i)].node().variable->size);
      weights_out_.emplace_back();
      for (int r = 0; r < rules && rules > 1 && model_.partitionOf(i) == i; ++r)
        weights_out_.back().push_back(
            p_.output("rWeight_" + plainName(name) + "_" + std::to_string(r + 1), Kind::kReal,
                      "firing weight of rule " + std::to_string(r + 1)));
    }
  }

  void startModel() override {
    model_.rest(x_, b_.y, b_.applied, dm_);
    p_.loop(b_.n_y, [&](const Value& i) {
      if (realigned_)
        p_.set(offset_[i], 0.0);
      else if (!delayed_)
        p_.set(undelayed_[i], b_.y[i]);
    });
    if (!delayed_) return;
    model_.rest(late_x_, b_.y, b_.applied, dm_);
    p_.loop(params_.delay_steps, [&](const Value& k) {
      for (int j = 0; j < b_.n_u; ++j) p_.set(past_inputs_[k * b_.n_u + j], b_.applied[j]);
      for (int j = 0; j < b_.n_d; ++j) p_.set(past_ds_[k * b_.n_d + j], dm_[j]);
    });
    p_.set(oldest_, 0);
    p_.set(oldest_d_, 0);
  }

  /// undelayed_ := y_m(k) from what was kept, under the applied input.
  void advanceModel() override {
    p_.loop(b_.n_y, [&](const Value& i) { addInputs(undelayed_[i], base_[i], B_, i, nowInput()); });
    if (realigned_) {
      p_.loop(b_.n_y, [&](const Value& i) {
        p_.set(offset_[i],
               offset_[i] + params_.offset_gain * (b_.y[i] - undelayed_[i] - offset_[i]));
        p_.contain(offset_[i]);
      });
      model_.shift(x_, b_.y, b_.applied, past_);
      return;
    }
    model_.shift(x_, undelayed_, b_.applied, past_);
    if (!delayed_) return;
    p_.loop(b_.n_u,
            [&](const Value& j) { p_.set(late_u_[j], past_inputs_[oldest_ * b_.n_u + j]); });
    const Value late_y = p_.works("lateY", Kind::kReal, b_.n_y);
    p_.loop(b_.n_y,
            [&](const Value& i) { addInputs(late_y[i], late_base_[i], late_B_, i, pastInput()); });
    model_.shift(late_x_, late_y, late_u_, late_d_before());
    p_.loop(b_.n_u,
            [&](const Value& j) { p_.set(past_inputs_[oldest_ * b_.n_u + j], b_.applied[j]); });
    p_.set(oldest_, oldest_ + 1);
    p_.when(oldest_ >= params_.delay_steps, [&] { p_.set(oldest_, 0); });
  }

  using Of = std::function<Value(const Value&)>;
  Of nowInput() const {
    return [this](const Value& j) { return b_.applied[j]; };
  }
  Of pastInput() const {
    return [this](const Value& j) { return past_inputs_[oldest_ * b_.n_u + j]; };
  }

  /// to := base + B u
  void addInputs(const Value& to, const Value& base, const Value& B, const Value& i, const Of& u) {
    p_.set(to, 0.0);
    p_.loop(b_.n_u, [&](const Value& j) { p_.set(to, to + B[i * b_.n_u + j] * u(j)); });
    p_.set(to, base + to);
    p_.contain(to);
  }

  /// d that the delayed model was blended with at k-1: the one before the oldest, in the ring.
  Value late_d_before() const { return b_.n_d == 0 ? dm_ : late_past_; }

  void propose() override {
    model_.blend(x_, dm_);
    if (delayed_) {
      for (int j = 0; j < b_.n_d; ++j) {
        p_.set(late_d_[j], past_ds_[oldest_d_ * b_.n_d + j]);
        p_.set(past_ds_[oldest_d_ * b_.n_d + j], dm_[j]);
      }
      p_.set(oldest_d_, oldest_d_ + 1);
      p_.when(oldest_d_ >= params_.delay_steps, [&] { p_.set(oldest_d_, 0); });
      delayed_->blend(late_x_, late_d_);
      for (int j = 0; j < b_.n_d; ++j) p_.set(late_d_before()[j], late_d_[j]);
    }
    if (!realigned_)
      for (int i = 0; i < b_.n_y; ++i)
        p_.set(offset_[i], b_.y[i] - (delayed_ ? late_x_[model_.outputRow(i)] : undelayed_[i]));
    for (int i = 0; i < b_.n_y; ++i) {
      const auto o = static_cast<std::size_t>(i);
      p_.set(error_out_[o], offset_[i]);
      for (std::size_t r = 0; r < weights_out_[o].size(); ++r)
        p_.set(weights_out_[o][r], model_.weights[o][static_cast<int>(r)]);
    }
    p_.words("free response and effect of a held input after the coincidence horizon");
    walk();
    if (params_.law == FmbpcForm::kPublished)
      published();
    else
      general();
    if (clp_) predict();
  }

  /// The local model and how the law depends on state and reference, but for published() and
  /// general(), which know their gains.
  void predict() {
    p_.loop(n_x_, [&](const Value& j) { p_.set(clp_->x[j], x_[j]); });
    p_.loop(b_.n_y * n_x_, [&](const Value& j) { p_.set(clp_->A[j], model_.A[j]); });
    p_.loop(b_.n_y * b_.n_u, [&](const Value& j) { p_.set(clp_->B[j], model_.B[j]); });
    p_.loop(b_.n_y, [&](const Value& i) {
      p_.set(clp_->g[i], realigned_ ? model_.g[i] + offset_[i] : model_.g[i]);
      p_.set(clp_->offset[i], realigned_ ? Value(0.0) : offset_[i]);
    });
  }

  /// K and L of input j from its gains on what output number k lacks.
  void feedBack(const Value& j, const Value& gain, int k) {
    const int output = followed_[static_cast<std::size_t>(k)];
    p_.loop(n_x_, [&](const Value& i) {
      p_.set(clp_->K[j * n_x_ + i], clp_->K[j * n_x_ + i] + gain * free_[i + k * n_x_]);
    });
    const double at_aim =
        std::pow(params_.reference_pole[output], static_cast<double>(params_.aimedColumn() + 1));
    p_.set(clp_->L[j * b_.n_y + output], gain * at_aim);
  }

  void clearFeedback() {
    p_.loop(b_.n_u * n_x_, [&](const Value& i) { p_.set(clp_->K[i], 0.0); });
    p_.loop(b_.n_u * b_.n_y, [&](const Value& i) { p_.set(clp_->L[i], 0.0); });
  }

  /// Rows of P = C A^H, S = C (I + ... + A^(H-1)), S B for the outputs that are followed, in the
  /// order of CoincidenceGains: what is added otherwise differs by what cancels.
  void walk() {
    const int n = followed(), n_u = b_.n_u;
    const auto each = [&](const std::function<void(const Value&, const Value&)>& of) {
      p_.loop(n, [&](const Value& k) { of(k, k * n_x_); });
    };
    p_.loop((n + powers()) * n_x_, [&](const Value& i) { p_.set(free_[i], 0.0); });
    p_.loop(n * n_x_, [&](const Value& i) { p_.set(sum_[i], 0.0); });
    for (int k = 0; k < n; ++k)
      p_.set(free_[k * n_x_ + model_.outputRow(followed_[static_cast<std::size_t>(k)])], 1.0);
    p_.loop(powers(), [&](const Value& i) { p_.set(free_[i * (n_x_ + 1) + n * n_x_], 1.0); });
    p_.loop(n * n_u, [&](const Value& i) { p_.set(size_[i], 0.0); });
    const auto step = [&] {
      each([&](const Value& k, const Value& row) {
        addEffect(k, free_, row);
        p_.loop(n_x_,
                [&](const Value& j) { p_.set(sum_[row + j], sum_[row + j] + free_[row + j]); });
      });
    };
    const CoincidenceWalk way(params_.coincidence_steps);
    p_.loop(way.start, [&](const Value&) {
      step();
      p_.loop(n + powers(), [&](const Value& k) { advance(k * n_x_); });
    });
    if (powers() > 0) leap(way, step);
    for (int k = 0; k < n; ++k) p_.set(lack_[k], aimOf(followed_[static_cast<std::size_t>(k)]));
    each([&](const Value& k, const Value& row) {
      for (int j = 0; j < n_u; ++j) {
        const Value effect = effect_[k * n_u + j];
        p_.set(effect, effectOf(sum_, row, j));
        p_.setAbsolute(a_, effect);
        p_.when(a_ <= kSingularPivot * size_[k * n_u + j], [&] { p_.set(effect, 0.0); });
        p_.keepInside(effect);
      }
      subtractFrom(k, row);
      p_.keepInside(lack_[k]);
    });
  }

  /// From n steps to 2 n, and to 2 n + 1 where the bit of H is set; A^n goes along.
  void leap(const CoincidenceWalk& way, const std::function<void()>& step) {
    const int n = followed(), n_x = n_x_;
    const Value odd = p_.table("oddSteps", way.odd, Kind::kBool),
                square = p_.works("powerSquare", Kind::kReal, n_x * n_x);
    const auto timesPower = [&](const Value& from, const Value& row, const Value& to,
                                const Value& at) {
      p_.loop(n_x, [&](const Value& j) {
        p_.set(a_, 0.0);
        p_.loop(n_x, [&](const Value& i) {
          p_.set(a_, a_ + from[row + i] * free_[i * n_x + (j + n * n_x)]);
        });
        p_.contain(a_);
        p_.set(to[at + j], a_);
      });
    };
    p_.loop(static_cast<int>(way.odd.size()), [&](const Value& bit) {
      p_.loop(n, [&](const Value& k) {
        const Value row = k * n_x;
        timesPower(sum_, row, next_, 0);
        p_.loop(n_x, [&](const Value& j) { p_.set(sum_[row + j], sum_[row + j] + next_[j]); });
        addEffect(k, next_, 0);
        timesPower(free_, row, next_, 0);
        p_.loop(n_x, [&](const Value& j) { p_.set(free_[row + j], next_[j]); });
      });
      p_.loop(n_x, [&](const Value& i) { timesPower(free_, i * n_x + n * n_x, square, i * n_x); });
      p_.loop(n_x * n_x, [&](const Value& i) { p_.set(free_[i + n * n_x], square[i]); });
      p_.when(odd[bit], [&] {
        step();
        p_.loop(n + n_x, [&](const Value& k) { advance(k * n_x); });
      });
    });
  }

  int followed() const { return static_cast<int>(followed_.size()); }
  /// Rows of A^n behind those of the outputs.
  int powers() const { return CoincidenceWalk(params_.coincidence_steps).odd.empty() ? 0 : n_x_; }

  /// What an input does by a row.
  Value effectOf(const Value& from, const Value& row, int j) {
    Value effect = 0.0;
    for (int o = 0; o < b_.n_y; ++o) {
      const Value part = from[row + model_.outputRow(o)] * model_.B[o * b_.n_u + j];
      effect = o == 0 ? part : effect + part;
    }
    return effect + from[row + static_cast<int>(model_.layout().inputState(j, 1))];
  }

  void addEffect(const Value& k, const Value& from, const Value& row) {
    for (int j = 0; j < b_.n_u; ++j) {
      const Value size = size_[k * b_.n_u + j];
      p_.setAbsolute(a_, effectOf(from, row, j));
      p_.set(size, size + a_);
    }
  }

  /// A row times A, whose rows below those of the outputs shift.
  void advance(const Value& row) {
    const std::vector<double> after = shifts();
    const bool last =
        std::all_of(after.begin(), after.end(), [&](double o) { return o == 0.0 || o == b_.n_y; });
    const Value shift = p_.table("shifts", after, last ? Kind::kBool : Kind::kInt);
    p_.loop(n_x_, [&](const Value& j) {
      p_.set(a_, 0.0);
      for (int o = 0; o < b_.n_y; ++o) {
        p_.set(a_, a_ + free_[row + model_.outputRow(o)] * model_.A[j + o * n_x_]);
        if (last && o + 1 < b_.n_y) continue;
        p_.when(last ? shift[j] : shift[j] == o + 1,
                [&] { p_.set(a_, a_ + free_[row + (j + 1)]); });
      }
      p_.contain(a_);
      p_.set(next_[j], a_);
    });
    p_.loop(n_x_, [&](const Value& j) { p_.set(free_[row + j], next_[j]); });
  }

  /// Of each row of the state j: behind which output's row stands j + 1, if that is j of one sample
  /// before; 0: it is not.
  std::vector<double> shifts() const {
    std::vector<double> after(static_cast<std::size_t>(n_x_), 0.0);
    model_.eachShift([&](int j) {
      int outputs = 0;
      while (outputs < b_.n_y && model_.outputRow(outputs) <= j) ++outputs;
      after[static_cast<std::size_t>(j)] = outputs;
    });
    return after;
  }

  /// y_r at the aim, less what the model says too little; as ReferenceTrajectory goes there.
  Value aimOf(int output) {
    const int aim = static_cast<int>(params_.aimedColumn());
    constexpr int kFar = 32;
    const bool far =
        aim > kFar && aim > params_.reference_lead_steps + params_.prediction_steps + kFar;
    const double pole = params_.reference_pole[output];
    const auto power = far ? std::pow(pole, aim) : 1.0;
    p_.set(a_, reference_[output]);
    if (far) p_.set(a_, power * a_ + (1.0 - power) * b_.setpoint[output]);
    p_.loop(far ? 1 : aim + 1,
            [&](const Value&) { p_.set(a_, pole * a_ + (1.0 - pole) * b_.setpoint[output]); });
    return realigned_ ? a_ : a_ - offset_[output];
  }

  /// Less what comes without an input: of g and the state.
  void subtractFrom(const Value& k, const Value& row) {
    p_.set(a_, 0.0);
    for (int o = 0; o < b_.n_y; ++o)
      p_.set(a_, a_ + sum_[row + model_.outputRow(o)] *
                          (realigned_ ? model_.g[o] + offset_[o] : model_.g[o]));
    const LocalModel& at = model_.layout();
    for (int d = 0; d < b_.n_d; ++d)
      if (at.model().maxLag(SignalKind::kDisturbance, d) > 0)
        p_.set(a_, a_ + sum_[row + static_cast<int>(at.disturbanceState(d, 1))] * dm_[d]);
    p_.set(lack_[k], lack_[k] - a_);
    p_.set(a_, 0.0);
    p_.loop(n_x_, [&](const Value& j) { p_.set(a_, a_ + free_[row + j] * x_[j]); });
    p_.set(lack_[k], lack_[k] - a_);
  }

  void published() {
    p_.when((effect_[0] <= -faint() || effect_[0] >= faint()) && ir::sane(effect_[0]),
            [&] {
              p_.set(a_, 1.0 / effect_[0]);
              p_.set(b_.u[0], a_ * lack_[0]);
              if (!clp_) return;
              clearFeedback();
              feedBack(0, a_, 0);
            },
            [&] {
              p_.set(b_.ok, false);
              p_.set(b_.u[0], b_.applied[0]);
            });
  }

  /// u = (M' W M + L)^-1 (M' W e + L u(k-1)), by Cholesky of the matrix with a unit diagonal.
  void general() {
    const int n = static_cast<int>(followed_.size()), m = b_.n_u;
    const Value normal = p_.works("normal", Kind::kReal, m * m),
                scale = p_.works("scale", Kind::kReal, m),
                right = p_.works("rightSide", Kind::kReal, m);
    std::vector<double> weight, moves;
    for (const int i : followed_) weight.push_back(weightOf(i));
    for (int j = 0; j < m; ++j) moves.push_back(params_.weight_move[j]);
    const Value w = p_.table("weightOutput", weight), l = p_.table("weightMove", moves);
    p_.set(some_, false);
    p_.loop(n * m,
            [&](const Value& i) { p_.when(effect_[i] != 0.0, [&] { p_.set(some_, true); }); });
    p_.when(!some_, [&] { p_.set(b_.ok, false); });
    p_.loop(m, [&](const Value& i) {
      p_.set(right[i], l[i] * b_.applied[i]);
      p_.loop(n, [&](const Value& k) {
        p_.set(right[i], right[i] + w[k] * effect_[k * m + i] * lack_[k]);
      });
      p_.loop(m, [&](const Value& j) {
        p_.set(a_, 0.0);
        p_.loop(n, [&](const Value& k) {
          p_.set(a_, a_ + w[k] * effect_[k * m + i] * effect_[k * m + j]);
        });
        p_.when(i == j, [&] { p_.set(a_, a_ + l[i]); });
        p_.set(normal[i * m + j], a_);
      });
      p_.set(a_, normal[i * m + i]);
      p_.set(scale[i], 0.0);
      p_.when(
          a_ > faint() && ir::sane(a_), [&] { p_.set(scale[i], 1.0 / ir::squareRoot(p_, a_)); },
          [&] { p_.set(b_.ok, false); });
    });
    p_.when(
        b_.ok,
        [&] {
          factor(normal, scale, m);
          p_.loop(m, [&](const Value& i) {
            p_.set(right[i], right[i] * scale[i]);
            p_.keepInside(right[i]);
          });
          substitute(normal, right, m);
          p_.loop(m, [&](const Value& i) { p_.set(b_.u[i], right[i] * scale[i]); });
          if (clp_) gains(normal, scale, right, w, l);
        },
        [&] { p_.loop(m, [&](const Value& i) { p_.set(b_.u[i], b_.applied[i]); }); });
  }

  /// K and L: u of a unit of what each output lacks, and of each input before.
  void gains(const Value& normal, const Value& scale, const Value& right, const Value& w,
             const Value& l) {
    const int m = b_.n_u;
    clearFeedback();
    for (int k = 0; k < static_cast<int>(followed_.size()); ++k) {
      p_.loop(m, [&](const Value& i) { p_.set(right[i], w[k] * effect_[i + k * m] * scale[i]); });
      substitute(normal, right, m);
      p_.loop(m, [&](const Value& i) {
        p_.set(a_, right[i] * scale[i]);
        feedBack(i, a_, k);
      });
    }
    for (int j = 0; j < m; ++j) {
      p_.loop(m, [&](const Value& i) { p_.set(right[i], 0.0); });
      p_.set(right[j], l[j] * scale[j]);
      substitute(normal, right, m);
      const int row = static_cast<int>(model_.layout().inputState(j, 1));
      p_.loop(m, [&](const Value& i) {
        p_.set(clp_->K[i * n_x_ + row], clp_->K[i * n_x_ + row] - right[i] * scale[i]);
      });
    }
  }

  void factor(const Value& normal, const Value& scale, int m) {
    p_.loop(m, [&](const Value& i) {
      p_.loop(m, [&](const Value& j) {
        p_.set(normal[i * m + j], normal[i * m + j] * scale[i] * scale[j]);
        p_.clamp(normal[i * m + j], -2.0, 2.0);  // it is within 1, but for rounding
      });
    });
    const auto entry = [&](int i, int j) { return normal[i * m + j]; };
    for (int j = 0; j < m; ++j) {
      p_.set(a_, entry(j, j));
      for (int k = 0; k < j; ++k) p_.set(a_, a_ - entry(j, k) * entry(j, k));
      p_.when(
          a_ > kSingularPivot, [&] { p_.set(c_, ir::squareRoot(p_, a_)); },
          [&] {
            p_.set(b_.ok, false);
            p_.set(c_, 1.0);
          });
      p_.set(entry(j, j), c_);
      for (int i = j + 1; i < m; ++i) {
        p_.set(a_, entry(i, j));
        for (int k = 0; k < j; ++k) p_.set(a_, a_ - entry(i, k) * entry(j, k));
        p_.set(entry(i, j), a_ / c_);
        p_.clamp(entry(i, j), -2.0, 2.0);
      }
    }
  }

  /// right := the solution, by the factor.
  void substitute(const Value& normal, const Value& right, int m) {
    const auto entry = [&](int i, int j) { return normal[i * m + j]; };
    for (int i = 0; i < m; ++i) {
      p_.set(a_, right[i]);
      for (int k = 0; k < i; ++k) p_.set(a_, a_ - entry(i, k) * right[k]);
      p_.set(right[i], a_ / entry(i, i));
    }
    for (int i = m - 1; i >= 0; --i) {
      p_.set(a_, right[i]);
      for (int k = i + 1; k < m; ++k) p_.set(a_, a_ - entry(k, i) * right[k]);
      p_.set(right[i], a_ / entry(i, i));
    }
  }

  /// y_m(k+1) but for the input.
  void keep() override {
    const auto keepOf = [&](const ModelCode& model, const Value& x, const Value& base,
                            const Value& B) {
      p_.loop(b_.n_y, [&](const Value& i) {
        p_.set(base[i], 0.0);
        p_.loop(n_x_,
                [&](const Value& j) { p_.set(base[i], base[i] + model.A[i * n_x_ + j] * x[j]); });
        p_.set(base[i], model.g[i] + base[i]);
        p_.contain(base[i]);
      });
      p_.loop(b_.n_y * b_.n_u, [&](const Value& i) { p_.set(B[i], model.B[i]); });
    };
    keepOf(model_, x_, base_, B_);
    if (delayed_) keepOf(*delayed_, late_x_, late_base_, late_B_);
  }

  Value healthy() override {
    p_.set(some_, true);
    p_.loop(n_x_,
            [&](const Value& i) { p_.when(!ir::contained(x_[i]), [&] { p_.set(some_, false); }); });
    p_.loop(b_.n_y, [&](const Value& i) {
      p_.when(!ir::contained(base_[i]), [&] { p_.set(some_, false); });
    });
    return some_;
  }

  const FmbpcParams& params_;
  bool realigned_;
  ModelCode model_;
  std::optional<ModelCode> delayed_;
  int n_x_;
  std::vector<int> followed_;
  Value x_{0}, base_{0}, B_{0}, offset_{0}, late_x_{0}, late_base_{0}, late_B_{0}, past_inputs_{0},
      oldest_{0}, oldest_d_{0}, past_ds_{0}, late_d_{0}, late_u_{0}, late_past_{0}, undelayed_{0},
      free_{0}, next_{0}, sum_{0}, effect_{0}, size_{0}, lack_{0}, a_{0}, c_{0}, some_{0};
  std::vector<Value> error_out_;
  std::vector<std::vector<Value>> weights_out_;
};

}  // namespace

std::unique_ptr<LawCode> makeFmbpcCode(BlockParts& parts) {
  const auto* params = findParams<FmbpcParams>(*parts.loop.controller);
  if (params == nullptr) return nullptr;
  require(parts.loop.has_model, parts.loop.name + ": model.file", "a model for the exported law");
  return std::make_unique<FmbpcCode>(parts, *params);
}

}  // namespace fpc
