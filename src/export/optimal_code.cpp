// Controller type fuzzy_optimal as code of a block: see FuzzyOptimalCore. The path of references is
// summed up beforehand, since it is one of first order to the setpoint.
#include <cmath>
#include <optional>

#include "control/fuzzy_lq/law.hpp"
#include "export/model_code.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/control/registry.hpp"
#include "model/shared_partition.hpp"

namespace fpc {
namespace {

using ir::Kind;
using ir::Value;

/// The law of one rule as gains: u = now y_r(k) + later setpoint - K x - offset g + correction d.
struct RuleGains {
  Matrix now, later, K, offset, correction;
  Vector constant;  ///< of the target
};

class OptimalCode final : public PredictiveCode {
 public:
  OptimalCode(BlockParts& parts, const FuzzyOptimalParams& params)
      : PredictiveCode(parts, params, parts.loop.model),
        params_(params),
        split_(splitRules(parts.loop.model)),
        model_(parts, parts.loop.model, "m", "m"),
        n_x_(model_.n_x()) {
    require(!params.observe, b_.loop.name + ": controller.observer",
            "no observer: it is not exported");
    for (std::size_t r = 0; r < split_.rules.size(); ++r) gains_.push_back(gainsOf(r));
    declare();
  }

  void begin() override {
    PredictiveCode::begin();
    for (const Value& out : error_out_) p_.set(out, 0.0);
    for (const Value& out : weights_out_) p_.set(out, 0.0);
  }

  void foresee() override {
    p_.set(b_.foreseen, !start_);
    p_.when(b_.foreseen, [&] {
      p_.loop(b_.n_y, [&](const Value& i) {
        p_.set(b_.expected[i], base_[i]);
        p_.loop(b_.n_u, [&](const Value& j) {
          p_.set(b_.expected[i], b_.expected[i] + B_[i * b_.n_u + j] * b_.applied[j]);
        });
      });
    });
  }

 private:
  int rules() const { return static_cast<int>(gains_.size()); }
  bool isInside() const { return params_.disturbance == FuzzyOptimalDisturbance::kInside; }

  /// As FuzzyOptimalCore makes its rules.
  RuleGains gainsOf(std::size_t r) const {
    const FuzzyOptimalTuning& tuning = params_.tuning;
    LocalModel local(split_.rules[r]);
    local.blend(Vector::Zero(local.stateSize()), Vector::Zero(b_.n_d));
    const QuadraticLaw law = makeQuadraticLaw(
        local.affine(),
        {tuning.horizon_steps, tuning.move_steps, params_.solve == FuzzyOptimalSolve::kTogether},
        tuning.rules.empty() ? tuning.weight : tuning.rules[r]);
    require(law.usable, b_.loop.name + ": controller.horizon_steps",
            "a law that can be used in every rule");
    const Eigen::Index n_y = b_.n_y, n_u = b_.n_u;
    RuleGains gains{Matrix::Zero(n_u, n_y), Matrix::Zero(n_u, n_y),          law.K, law.offset,
                    Matrix::Zero(n_u, n_y), law.target * tuning.input_target};
    for (Eigen::Index j = 0; j < n_u; ++j)
      gains.K.col(local.inputState(j, 1)) -= law.previous.col(j);
    for (int step = 0; step < tuning.horizon_steps; ++step)
      for (Eigen::Index i = 0; i < n_y; ++i) {
        const double power = std::pow(params_.reference_pole[i], step + 1);
        const Vector column = law.reference.col(step * n_y + i);
        gains.now.col(i) += power * column;
        gains.later.col(i) += (1.0 - power) * column;
        if (!isInside()) gains.correction.col(i) -= column;
      }
    for (Eigen::Index i = 0; isInside() && i < n_y; ++i)
      gains.correction.col(i) = -law.offset.col(local.outputState(i));
    return gains;
  }

  template <typename Of>
  Value table(const std::string& name, const Of& of) {
    std::vector<double> all;
    for (const RuleGains& gains : gains_) {
      const Matrix matrix = of(gains);
      for (Eigen::Index i = 0; i < matrix.rows(); ++i)
        for (Eigen::Index j = 0; j < matrix.cols(); ++j) all.push_back(matrix(i, j));
    }
    return p_.table(name, all);
  }

  /// Models of the rules: rows of the outputs, without and with what d adds to g.
  void declareRules() {
    std::vector<double> A, B, offset, feed;
    for (const TsModel& rule : split_.rules) {
      LocalModel local(rule);
      local.blend(Vector::Zero(n_x_), Vector::Zero(b_.n_d));
      for (int i = 0; i < b_.n_y; ++i) {
        const Eigen::Index row = local.outputState(i);
        for (int j = 0; j < n_x_; ++j) A.push_back(local.affine().A(row, j));
        for (int j = 0; j < b_.n_u; ++j) B.push_back(local.affine().B(row, j));
        offset.push_back(local.affine().g[row]);
      }
      for (int j = 0; j < b_.n_d; ++j) {
        LocalModel fed(rule);
        fed.blend(Vector::Zero(n_x_), Vector::Unit(b_.n_d, j));
        for (int i = 0; i < b_.n_y; ++i)
          feed.push_back(fed.affine().g[fed.outputState(i)] -
                         local.affine().g[local.outputState(i)]);
      }
    }
    rule_A_ = p_.table("ruleA", A);
    rule_B_ = p_.table("ruleB", B);
    rule_offset_ = p_.table("ruleOffset", offset);
    if (b_.n_d > 0) rule_feed_ = p_.table("ruleFeed", feed);
  }

  void declare() {
    declareRules();
    now_ = table("gainNow", [](const RuleGains& g) { return g.now; });
    later_ = table("gainLater", [](const RuleGains& g) { return g.later; });
    K_ = table("gainK", [](const RuleGains& g) { return g.K; });
    off_ = table("gainOffset", [](const RuleGains& g) { return g.offset; });
    correction_ = table("gainCorrection", [](const RuleGains& g) { return g.correction; });
    constant_ = table("gainConstant", [](const RuleGains& g) { return Matrix(g.constant); });
    x_ = p_.states("x", Kind::kReal, n_x_);
    rule_base_ =
        p_.states("ruleBase", Kind::kReal, rules() * b_.n_y);  // y(k+1) of each rule but for u
    d_g_ = p_.states("ruleError", Kind::kReal, rules() * b_.n_y);
    base_ = p_.states("base", Kind::kReal, b_.n_y);
    B_ = p_.states("gainB", Kind::kReal, b_.n_y * b_.n_u);
    g_ = p_.works("ruleG", Kind::kReal, n_x_);
    error_ = p_.works("modelError", Kind::kReal, b_.n_y);
    a_ = p_.work("lawA");
    healthy_ = p_.work("healthy", Kind::kBool);
    beginOptimizer(model_.layout(), 0);
    for (int i = 0; i < b_.n_y; ++i)
      error_out_.push_back(p_.output(
          "rModelError_" + plainName(b_.loop.plant_info.outputs[static_cast<std::size_t>(i)].name),
          Kind::kReal, "measured less what the blended rules say"));
    for (int r = 0; r < rules(); ++r)
      weights_out_.push_back(p_.output("rWeight_" + std::to_string(r + 1), Kind::kReal,
                                       "firing weight of rule " + std::to_string(r + 1)));
  }

  /// g of a rule with these disturbances, for its own row and for those of d.
  void ruleG(const Value& r, const Value& d) {
    const LocalModel& at = model_.layout();
    p_.loop(n_x_, [&](const Value& j) { p_.set(g_[j], 0.0); });
    for (int i = 0; i < b_.n_y; ++i) {
      const Value row = g_[model_.outputRow(i)];
      p_.set(row, rule_offset_[r * b_.n_y + i]);
      for (int j = 0; j < b_.n_d; ++j)
        p_.set(row, row + rule_feed_[r * (b_.n_d * b_.n_y) + (j * b_.n_y + i)] * d[j]);
    }
    for (int j = 0; j < b_.n_d; ++j)
      if (at.model().maxLag(SignalKind::kDisturbance, j) > 0)
        p_.set(g_[static_cast<int>(at.disturbanceState(j, 1))], d[j]);
  }

  void ruleBase(const Value& d) {
    p_.loop(rules(), [&](const Value& r) {
      ruleG(r, d);
      for (int i = 0; i < b_.n_y; ++i) {
        p_.set(a_, g_[model_.outputRow(i)]);
        p_.loop(n_x_, [&](const Value& j) {
          p_.set(a_, a_ + rule_A_[r * (b_.n_y * n_x_) + (j + i * n_x_)] * x_[j]);
        });
        p_.set(rule_base_[r * b_.n_y + i], a_);
      }
    });
  }

  void startModel() override {
    model_.rest(x_, b_.y, b_.applied, dm_);
    ruleBase(dm_);
  }

  void advanceModel() override { model_.shift(x_, b_.y, b_.applied, past_); }

  void estimate() {
    if (params_.disturbance == FuzzyOptimalDisturbance::kNone) return;
    p_.loop(rules(), [&](const Value& r) {
      p_.loop(b_.n_y, [&](const Value& i) {
        p_.set(a_, rule_base_[r * b_.n_y + i]);
        p_.loop(b_.n_u, [&](const Value& j) {
          p_.set(a_, a_ + rule_B_[r * (b_.n_y * b_.n_u) + (i * b_.n_u + j)] * b_.applied[j]);
        });
        p_.set(a_, b_.y[i] - a_);
        p_.set(d_g_[r * b_.n_y + i], a_);
        p_.contain(d_g_[r * b_.n_y + i]);
      });
    });
  }

  void propose() override {
    estimate();
    model_.blend(x_, dm_);
    const Value& w = model_.weights[split_.partition];
    p_.loop(b_.n_u, [&](const Value& j) { p_.set(b_.u[j], 0.0); });
    p_.loop(b_.n_y, [&](const Value& i) { p_.set(error_[i], 0.0); });
    p_.loop(rules(), [&](const Value& r) {
      p_.when(w[r] != 0.0, [&] {
        ruleG(r, dm_);
        p_.loop(b_.n_u, [&](const Value& j) { ruleInput(r, j, w[r]); });
        p_.loop(b_.n_y, [&](const Value& i) {
          p_.set(error_[i], error_[i] + w[r] * d_g_[r * b_.n_y + i]);
        });
      });
    });
    if (clp_) predict(w);
    for (int i = 0; i < b_.n_y; ++i) p_.set(error_out_[static_cast<std::size_t>(i)], error_[i]);
    for (int r = 0; r < rules(); ++r) p_.set(weights_out_[static_cast<std::size_t>(r)], w[r]);
  }

  /// The local model, and how the blended law depends on state and reference.
  void predict(const Value& w) {
    const int n_y = b_.n_y, n_u = b_.n_u;
    p_.loop(n_x_, [&](const Value& j) { p_.set(clp_->x[j], x_[j]); });
    p_.loop(n_y * n_x_, [&](const Value& j) { p_.set(clp_->A[j], model_.A[j]); });
    p_.loop(n_y * n_u, [&](const Value& j) { p_.set(clp_->B[j], model_.B[j]); });
    p_.loop(n_y, [&](const Value& i) {
      p_.set(clp_->g[i], isInside() ? model_.g[i] + error_[i] : model_.g[i]);
      p_.set(clp_->offset[i], isInside() ? Value(0.0) : error_[i]);
    });
    const auto blended = [&](const Value& to, const Value& of, int size) {
      p_.loop(size, [&](const Value& i) {
        p_.set(a_, 0.0);
        p_.loop(rules(), [&](const Value& r) { p_.set(a_, a_ + w[r] * of[r * size + i]); });
        p_.set(to[i], a_);
      });
    };
    blended(clp_->K, K_, n_u * n_x_);
    blended(clp_->L, now_, n_u * n_y);
  }

  void ruleInput(const Value& r, const Value& j, const Value& weight) {
    const int n_y = b_.n_y, n_u = b_.n_u;
    p_.set(a_, constant_[r * n_u + j]);
    p_.loop(n_x_, [&](const Value& i) {
      const Value at = r * (n_u * n_x_) + (j * n_x_ + i);
      p_.set(a_, a_ - off_[at] * g_[i] - K_[at] * x_[i]);
    });
    p_.loop(n_y, [&](const Value& i) {
      const Value at = r * (n_u * n_y) + (j * n_y + i);
      p_.set(a_, a_ + now_[at] * reference_[i] + later_[at] * b_.setpoint[i] +
                     correction_[at] * d_g_[r * n_y + i]);
    });
    p_.set(b_.u[j], b_.u[j] + weight * a_);
  }

  void keep() override {
    ruleBase(dm_);
    p_.loop(b_.n_y, [&](const Value& i) {
      p_.set(base_[i], model_.g[i] + error_[i]);
      p_.loop(n_x_,
              [&](const Value& j) { p_.set(base_[i], base_[i] + model_.A[i * n_x_ + j] * x_[j]); });
    });
    p_.loop(b_.n_y * b_.n_u, [&](const Value& i) { p_.set(B_[i], model_.B[i]); });
  }

  Value healthy() override {
    p_.set(healthy_, true);
    p_.loop(n_x_,
            [&](const Value& i) { p_.when(!ir::sane(x_[i]), [&] { p_.set(healthy_, false); }); });
    return healthy_;
  }

  const FuzzyOptimalParams& params_;
  RuleSplit split_;
  ModelCode model_;
  int n_x_;
  std::vector<RuleGains> gains_;
  Value rule_A_{0}, rule_B_{0}, rule_offset_{0}, rule_feed_{0}, now_{0}, later_{0}, K_{0}, off_{0},
      correction_{0}, constant_{0}, x_{0}, rule_base_{0}, d_g_{0}, base_{0}, B_{0}, g_{0},
      error_{0}, a_{0}, healthy_{0};
  std::vector<Value> error_out_, weights_out_;
};

}  // namespace

std::unique_ptr<LawCode> makeOptimalCode(BlockParts& parts) {
  const auto* params = findParams<FuzzyOptimalParams>(*parts.loop.controller);
  if (params == nullptr) return nullptr;
  require(parts.loop.has_model, parts.loop.name + ": model.file", "a model for the exported law");
  return std::make_unique<OptimalCode>(parts, *params);
}

}  // namespace fpc
