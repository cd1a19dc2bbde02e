// Rows of constraints from what is known of a process.
#include "identification/prior_knowledge.hpp"

#include <algorithm>
#include <cmath>

#include "fmbpc/base/input_error.hpp"
#include "identification/data_set.hpp"
#include "identification/prediction.hpp"
#include "model/rule_poles.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kLeastGain = 1e-6;   // of span over span: a known sign is never left at zero
constexpr double kLeastRest = 1e-5;   // 1 - sum of the output's own coefficients
constexpr Index kMostPoints = 80;     // of the data, where slopes are known
constexpr double kNudge = 1e-5;       // of a span, for slopes of the sets
constexpr double kInside = 0.8;       // of a rest's tolerance, which is kept to first order only
constexpr double kPoleMargin = 1e-9;  // rounding

/// Collects rows.
class Rows {
 public:
  explicit Rows(Index unknowns) : unknowns_(unknowns) {}
  Vector& add(double lower, double upper) {
    lower_.push_back(lower);
    upper_.push_back(upper);
    rows_.push_back(Vector::Zero(unknowns_));
    return rows_.back();
  }
  KnowledgeRows finished() const {
    const auto m = static_cast<Index>(rows_.size());
    KnowledgeRows all{Matrix(m, unknowns_), Vector(m), Vector(m)};
    for (Index i = 0; i < m; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const double scale = std::max(rows_[at].cwiseAbs().maxCoeff(), 1e-300);
      all.A.row(i) = rows_[at].transpose() / scale;
      all.lower[i] = lower_[at] / scale;
      all.upper[i] = upper_[at] / scale;
    }
    return all;
  }

 private:
  Index unknowns_;
  std::vector<Vector> rows_;
  std::vector<double> lower_, upper_;
};

/// One output's model and its record, and the rows that follow from what is known.
class KnowledgeBuilder {
 public:
  KnowledgeBuilder(const OutputModel& model, int output, const DataSet& data,
                   const PriorKnowledge& known)
      : model_(model),
        output_(output),
        data_(data),
        known_(known),
        p_(static_cast<Index>(model.regressors.size())),
        rules_(static_cast<Index>(model.rules.size())),
        rows_(rules_ * (p_ + 1)) {}

  KnowledgeRows build() {
    const bool signs = anySign(known_.gain) || anySign(known_.monotone);
    for (Index i = 0; i < rules_; ++i) {
      if (signs) rest(i);
      if (known_.max_pole > 0.0) poles(i);
      for (Index j = 0; j < causes(); ++j) gain(i, j);
    }
    if (anySign(known_.monotone) && rules_ > 1) slopes();
    for (const auto& state : known_.steady) steady(state);
    return rows_.finished();
  }

 private:
  static bool anySign(const std::vector<int>& signs) {
    return std::any_of(signs.begin(), signs.end(), [](int s) { return s != 0; });
  }
  Index causes() const {
    return static_cast<Index>(data_.inputs.size() + data_.disturbances.size());
  }
  Index at(Index rule) const { return rule * (p_ + 1); }
  bool isOwn(const Regressor& r) const {
    return r.kind == SignalKind::kOutput && r.index == output_;
  }
  bool isCause(const Regressor& r, Index j) const {
    const auto n_u = static_cast<Index>(data_.inputs.size());
    return j < n_u ? r.kind == SignalKind::kInput && r.index == j
                   : r.kind == SignalKind::kDisturbance && r.index == j - n_u;
  }
  int sign(const std::vector<int>& signs, Index j) const {
    return j < static_cast<Index>(signs.size()) ? signs[static_cast<std::size_t>(j)] : 0;
  }
  double span(Index column) const {
    const auto n_y = static_cast<Index>(data_.outputs.size()),
               n_u = static_cast<Index>(data_.inputs.size());
    const auto& list = column < n_y         ? data_.outputs
                       : column < n_y + n_u ? data_.inputs
                                            : data_.disturbances;
    const auto& s = list[static_cast<std::size_t>(column < n_y         ? column
                                                  : column < n_y + n_u ? column - n_y
                                                                       : column - n_y - n_u)];
    return std::isfinite(s.upper - s.lower) && s.upper > s.lower ? s.upper - s.lower : 1.0;
  }
  double leastGain(Index j) const {
    return kLeastGain * span(output_) / span(static_cast<Index>(data_.outputs.size()) + j);
  }
  template <typename Of>
  bool each(Vector& row, Index rule, double weight, Of&& of) const {
    bool any = false;
    for (Index k = 0; k < p_; ++k)
      if (of(model_.regressors[static_cast<std::size_t>(k)])) {
        row[at(rule) + k] += weight;
        any = true;
      }
    return any;
  }
  bool depends(Index j) const {
    return std::any_of(model_.regressors.begin(), model_.regressors.end(),
                       [&](const Regressor& r) { return isCause(r, j); });
  }
  bool hasOwn() const {
    return std::any_of(model_.regressors.begin(), model_.regressors.end(),
                       [&](const Regressor& r) { return isOwn(r); });
  }

  /// A gain has a sign only if the rule comes to rest: the own coefficients sum up to less than 1.
  void rest(Index rule) {
    if (!hasOwn()) return;
    each(rows_.add(-kInfinity, 1.0 - kLeastRest), rule, 1.0, [&](auto& r) { return isOwn(r); });
  }

  void gain(Index rule, Index j) {
    const int s = sign(known_.monotone, j) != 0 ? sign(known_.monotone, j) : sign(known_.gain, j);
    if (s == 0 || !depends(j)) return;
    each(rows_.add(leastGain(j), kInfinity), rule, s, [&](auto& r) { return isCause(r, j); });
  }

  /// The triangle of Jury for z^2 = a0 z + a1 in a circle of radius r, in terms of z / r.
  void poles(Index rule) {
    Index first = -1, second = -1;
    int lags = 0;
    for (Index k = 0; k < p_; ++k) {
      const Regressor& r = model_.regressors[static_cast<std::size_t>(k)];
      if (!isOwn(r)) continue;
      lags = std::max(lags, r.lag + 1);
      (r.lag == 0 ? first : second) = k;
    }
    const double r = known_.max_pole - kPoleMargin;
    if (lags == 0 || lags > 2) return;
    for (const double side : {1.0, -1.0}) {
      Vector& row = rows_.add(-kInfinity, 1.0);
      if (first >= 0) row[at(rule) + first] = side / r;
      if (second >= 0) row[at(rule) + second] = 1.0 / (r * r);
    }
    if (second >= 0) rows_.add(-1.0, kInfinity)[at(rule) + second] = 1.0 / (r * r);
  }

  /// Change of all weights if the antecedents that `of` names move by one unit.
  template <typename Of>
  Vector weightSlope(const Vector& z, double step, Of&& of) {
    Vector side = z;
    const auto weightsAt = [&](double by) {
      for (std::size_t k = 0; k < model_.antecedents.size(); ++k)
        side[static_cast<Index>(k)] =
            z[static_cast<Index>(k)] + (of(model_.antecedents[k]) ? by : 0.0);
      firingWeights(model_, side, firing_);
      return firing_.weights;
    };
    const Vector above = weightsAt(step);
    return (above - weightsAt(-step)) / (2.0 * step);
  }

  /// Slope of the blended prediction along all lags of one signal, as a row.
  template <typename Of>
  void slope(Vector& row, const Vector& z, const Vector& x, const Vector& weights, double step,
             double sign, Of&& of) {
    const Vector change = weightSlope(z, step, of);
    for (Index i = 0; i < rules_; ++i) {
      each(row, i, sign * weights[i], of);
      row.segment(at(i), p_) += sign * change[i] * x;
      row[at(i) + p_] += sign * change[i];
    }
  }

  void slopes() {
    const Regression points = makeRegression(data_, model_.regressors, model_.antecedents, output_);
    const Index stride = std::max<Index>(1, points.rows() / kMostPoints);
    for (Index k = 0; k < points.rows(); k += stride) {
      const Vector z = points.antecedents.row(k), x = points.regressors.row(k);
      firingWeights(model_, z, firing_);
      const Vector weights = firing_.weights;
      for (Index j = 0; j < causes(); ++j) {
        const int s = sign(known_.monotone, j);
        const Index column = static_cast<Index>(data_.outputs.size()) + j;
        if (s != 0 && depends(j))
          slope(rows_.add(0.0, kInfinity), z, x, weights, kNudge * span(column), s,
                [&](const Regressor& r) { return isCause(r, j); });
      }
    }
  }

  double valueOf(const KnownRest& state, const Regressor& r) const {
    const double value = state.values[data_.column(r.kind, r.index)];
    require(std::isfinite(value), place(), "a value of every signal that the model depends on");
    return value;
  }
  std::string place() const {
    return "steady state of " + data_.outputs[static_cast<std::size_t>(output_)].name;
  }

  /// f - y lies within `within` times 1 - (slope along the output's own past).
  void steady(const KnownRest& state) {
    Vector z(static_cast<Index>(model_.antecedents.size())), x(p_);
    for (Index k = 0; k < z.size(); ++k)
      z[k] = valueOf(state, model_.antecedents[static_cast<std::size_t>(k)]);
    for (Index k = 0; k < p_; ++k)
      x[k] = valueOf(state, model_.regressors[static_cast<std::size_t>(k)]);
    const double y = state.values[output_];
    require(std::isfinite(y), place(), "its value");
    firingWeights(model_, z, firing_);
    const Vector weights = firing_.weights;
    const double within = kInside * state.within;
    for (const double side : {1.0, -1.0}) {
      Vector& row = rows_.add(-kInfinity, within + side * y);
      for (Index i = 0; i < rules_; ++i) {
        row.segment(at(i), p_) += side * weights[i] * x;
        row[at(i) + p_] += side * weights[i];
      }
      slope(row, z, x, weights, kNudge * span(output_), within,
            [&](const Regressor& r) { return isOwn(r); });
    }
  }

  const OutputModel& model_;
  int output_;
  const DataSet& data_;
  const PriorKnowledge& known_;
  Index p_, rules_;
  Rows rows_;
  FiringResult firing_;
};

}  // namespace

KnowledgeRows knowledgeRows(const OutputModel& model, int output, const DataSet& data,
                            const PriorKnowledge& known) {
  return KnowledgeBuilder(model, output, data, known).build();
}

bool keepsPoles(const OutputModel& model, int output, const PriorKnowledge& known) {
  if (!(known.max_pole > 0.0)) return true;
  return std::all_of(model.rules.begin(), model.rules.end(), [&](const Rule& rule) {
    const auto poles = rulePoles(model, rule, static_cast<std::size_t>(output));
    return poles.empty() || std::abs(poles.front()) <= known.max_pole;
  });
}

}  // namespace fpc
