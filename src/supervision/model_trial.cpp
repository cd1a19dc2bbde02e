#include "supervision/model_trial.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/decompositions.hpp"
#include "base/statistics.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"
#include "supervision/jackknife.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr int kShifts[] = {0, -2, -1, 1, 2};
constexpr auto kShiftCount = static_cast<Index>(std::size(kShifts));
constexpr double kNoise = 1e-6;    // least share of unexplained squares
constexpr double kMatters = 0.02;  // of the inputs' effect: less of it says nothing of an input
constexpr Index kPerUnknown = 3;   // samples for each coefficient

}  // namespace

/// By block: what all figures follow from.
struct ModelTrial::Sums {
  explicit Sums(Index n_u) {
    none = model = any = Vector::Zero(kBlocks);
    loss = variance = Matrix::Zero(n_u, kShiftCount);
    squares.assign(kBlocks, Matrix::Zero(n_u, n_u));
    products.assign(kBlocks, Vector::Zero(n_u));
  }
  /// Over all blocks but one.
  static double total(const Vector& of, int but) { return of.sum() - (but < 0 ? 0.0 : of[but]); }
  double effect(int but) const { return total(none, but) - total(any, but); }
  /// Deviation of the gains from 1, over inputs that act.
  Vector deviation(int but) const {
    Matrix m = Matrix::Zero(products[0].size(), products[0].size());
    Vector g = Vector::Zero(m.rows());
    for (int b = 0; b < kBlocks; ++b) {
      if (b == but) continue;
      m += squares[static_cast<std::size_t>(b)];
      g += products[static_cast<std::size_t>(b)];
    }
    for (Index i = 0; i < m.rows(); ++i)
      if (!(m(i, i) > 0.0)) m(i, i) = 1.0;
    return m.ldlt().solve(g);
  }
  void add(const Sums& other) {
    none += other.none;
    model += other.model;
    any += other.any;
    loss += other.loss;
    variance += other.variance;
    for (std::size_t b = 0; b < squares.size(); ++b) {
      squares[b] += other.squares[b];
      products[b] += other.products[b];
    }
  }
  Vector none, model, any;
  Matrix loss, variance;  // of each input and shift
  std::vector<Matrix> squares;
  std::vector<Vector> products;
  Index samples{};
};

ModelTrial::ModelTrial(const TsModel& model, Index capacity, std::vector<bool> moved)
    : parts_(model, {std::begin(kShifts), std::end(kShifts)}),
      names_(namesOf(model.inputs)),
      moved_(std::move(moved)) {
  require(capacity > 0, "candidate.samples", "an integer > 0");
  const Index n_y = countOf(model.outputs), n_u = countOf(model.inputs);
  moved_.resize(names_.size(), true);
  errors_ = Matrix::Zero(n_y, capacity);
  inputs_ = Matrix::Zero(n_u, capacity);
  effects_.assign(kShiftCount, Matrix::Zero(n_y * n_u, capacity));
  age_.assign(static_cast<std::size_t>(capacity), 0);
  reach_ = kOrder;
  for (Index i = 0; i < n_u; ++i)
    if (parts_.knows(i)) reach_ = std::max(reach_, parts_.lastLag(i) + kSlack);
}

void ModelTrial::reset() {
  parts_.reset();
  kept_ = running_ = 0;
}

void ModelTrial::interrupt() {
  parts_.interrupt();
  running_ = 0;
}

void ModelTrial::look(const Measurement& now) {
  const bool foreseen = parts_.look(now);
  if (!foreseen || kept_ == capacity()) return;
  errors_.col(kept_) = parts_.error();
  inputs_.col(kept_) = now.input_applied;
  for (std::size_t s = 0; s < effects_.size(); ++s) effects_[s].col(kept_) = parts_.effect(s);
  age_[static_cast<std::size_t>(kept_++)] = running_++;
}

/// Samples whose past is known and whose errors are numbers.
std::vector<Index> ModelTrial::usable(Index output) const {
  std::vector<Index> rows;
  Index finite = 0;
  for (Index k = 0; k < kept_; ++k) {
    const bool good = std::isfinite(errors_(output, k)) && inputs_.col(k).allFinite();
    finite = good ? finite + 1 : 0;
    if (finite > reach_ && age_[static_cast<std::size_t>(k)] >= reach_) rows.push_back(k);
  }
  return rows;
}

bool ModelTrial::actsOn(Index output, Index input) const {
  const auto row = effects_[0].row(input * errors_.rows() + output).head(kept_);
  return kept_ > 0 && (row.array() != row[0]).any();
}

/// False: too few samples, or no input acts on this output.
bool ModelTrial::fillSums(Index output, Sums& sums) const {
  const std::vector<Index> rows = usable(output);
  const Index n = static_cast<Index>(rows.size()), n_u = inputs_.rows(), n_y = errors_.rows();
  std::vector<std::pair<Index, int>> lags;  // input, samples back
  bool acts = false;
  for (Index i = 0; i < n_u; ++i) {
    if (!parts_.knows(i)) continue;
    acts = acts || actsOn(output, i);
    for (int lag = std::max(0, parts_.firstLag(i) - kSlack); lag <= parts_.lastLag(i) + kSlack;
         ++lag)
      if (lag <= reach_) lags.emplace_back(i, lag);
  }
  const Index unknown = 1 + kOrder + static_cast<Index>(lags.size());
  if (!acts || n < kPerUnknown * unknown || n < 2 * kBlocks) return false;
  Matrix X(n, unknown - 1);
  Vector e(n);
  for (Index r = 0; r < n; ++r) {
    const Index k = rows[static_cast<std::size_t>(r)];
    e[r] = errors_(output, k);
    for (int j = 0; j < kOrder; ++j) X(r, j) = errors_(output, k - 1 - j);
    for (std::size_t j = 0; j < lags.size(); ++j)
      X(r, kOrder + static_cast<Index>(j)) = inputs_(lags[j].first, k - lags[j].second);
  }
  e.array() -= e.mean();
  const Vector centre = X.colwise().mean().transpose();
  X.rowwise() -= centre.transpose();
  for (Index c = 0; c < X.cols(); ++c) {  // an input that stands still says nothing
    const double size = X.col(c).norm();
    if (size > 1e-9 * (1.0 + std::abs(centre[c])) * std::sqrt(static_cast<double>(n))) continue;
    X.col(c).setZero();
  }
  const Vector found = solvedByPivotedQr(X, e);
  const Vector any = e - X * found;
  // The same autoregression for all.
  const auto whitened = [&](const auto& at) {
    Vector w(n);
    for (Index r = 0; r < n; ++r) {
      const Index k = rows[static_cast<std::size_t>(r)];
      w[r] = at(k);
      for (int j = 0; j < kOrder; ++j) w[r] -= found[j] * at(k - 1 - j);
    }
    w.array() -= w.mean();
    return w;
  };
  const auto part = [&](Index i, Index s, Index k) {
    return effects_[static_cast<std::size_t>(s)](i * n_y + output, k);
  };
  const Vector model = whitened([&](Index k) { return errors_(output, k); });
  Matrix parts(n, n_u);
  for (Index i = 0; i < n_u; ++i) parts.col(i) = whitened([&](Index k) { return part(i, 0, k); });
  const Vector none = model + parts.rowwise().sum();
  const double freedom = static_cast<double>(n) / static_cast<double>(n - unknown);
  const double least = kNoise * none.squaredNorm();
  const double variance = std::max(any.squaredNorm() * freedom, least) / static_cast<double>(n);
  if (!(variance > 0.0)) return false;
  const auto add = [&](Vector& to, const Vector& of, double factor) {
    for (Index r = 0; r < n; ++r)
      to[std::min<Index>(r * kBlocks / n, kBlocks - 1)] += factor * of[r] * of[r] / variance;
  };
  add(sums.none, none, 1.0);
  add(sums.model, model, 1.0);
  add(sums.any, any, freedom);
  for (Index i = 0; i < n_u; ++i)
    for (Index s = 0; s < kShiftCount; ++s) {
      if (!parts_.knows(i) || parts_.firstLag(i) + kShifts[s] < 0) continue;
      const Vector other =
          whitened([&](Index k) { return errors_(output, k) + part(i, 0, k) - part(i, s, k); });
      const Vector delta = other - model;
      const double alike = delta.squaredNorm() / variance;
      const double each = delta.cwiseProduct(any).squaredNorm() / (variance * variance);
      sums.loss(i, s) = (other.squaredNorm() - model.squaredNorm()) / variance;
      sums.variance(i, s) = 4.0 * std::max(alike, each);
    }
  for (Index r = 0; r < n; ++r) {
    const auto b = static_cast<std::size_t>(std::min<Index>(r * kBlocks / n, kBlocks - 1));
    sums.squares[b] += parts.row(r).transpose() * parts.row(r) / variance;
    sums.products[b] += parts.row(r).transpose() * model[r] / variance;
  }
  sums.samples = n;
  return true;
}

TrialFigures ModelTrial::judge(double confidence) const {
  const Index n_u = inputs_.rows(), n_y = errors_.rows();
  TrialFigures figures;
  figures.gain.resize(names_.size());
  figures.shifts.resize(names_.size());
  figures.why = "too few samples";
  Sums all(n_u);
  std::vector<Sums> each;
  std::vector<Index> whose;
  for (Index o = 0; o < n_y; ++o) {
    Sums sums(n_u);
    if (!fillSums(o, sums)) continue;
    figures.samples = std::max(figures.samples, sums.samples);
    all.add(sums);
    each.push_back(std::move(sums));
    whose.push_back(o);
  }
  if (each.empty()) return figures;
  const double t = studentBound(confidence, kBlocks - 1);
  const double effect = all.effect(-1);
  if (!(effect > 0.0)) {
    figures.why = "no input has shown an effect";
    return figures;
  }
  figures.explained = jackknife(kBlocks, t, [&](int b) {
    return (Sums::total(all.none, b) - Sums::total(all.model, b)) / all.effect(b);
  });
  std::string wrong, open;
  const auto say = [](std::string& to, const std::string& text) {
    if (to.empty()) to = text;
  };
  if (figures.explained.upper < kExplained)
    say(wrong, "it explains too little of the inputs' effect");
  else if (!(figures.explained.lower >= kExplained))
    say(open, "the inputs' effect is not known well enough");
  for (Index i = 0; i < n_u; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (!parts_.knows(i) || !moved_[at]) continue;
    Bounded& gain = figures.gain[at];
    gain = jackknife(kBlocks, t, [&](int b) { return 1.0 + all.deviation(b)[i]; });
    if (gain.upper < 1.0 / kGain || gain.lower > kGain)
      say(wrong, "the gain of " + names_[at] + " is wrong");
    else if (!(gain.lower >= 1.0 / kGain && gain.upper <= kGain))
      say(open, "the gain of " + names_[at] + " is not known well enough");
    for (Index s = 1; s < kShiftCount; ++s) {
      if (parts_.firstLag(i) + kShifts[s] < 0) continue;
      TrialFigures::Shift shift{kShifts[s], {}};
      const double width = t * std::sqrt(all.variance(i, s));
      shift.loss = {all.loss(i, s) / effect, (all.loss(i, s) - width) / effect,
                    (all.loss(i, s) + width) / effect};
      if (shift.loss.upper < 0.0)
        say(wrong, names_[at] + " acts " + std::to_string(std::abs(kShifts[s])) + " samples " +
                       (kShifts[s] > 0 ? "later" : "earlier"));
      else if (std::abs(kShifts[s]) == 2 && !(shift.loss.lower > 0.0))
        say(open, "the delay of " + names_[at] + " is not known well enough");
      figures.shifts[at].push_back(shift);
    }
    for (std::size_t o = 0; o < each.size(); ++o) {
      if (!actsOn(whose[o], i)) continue;
      double mine = 0.0;
      for (const Matrix& m : each[o].squares) mine += m(i, i);
      if (mine < kMatters * effect) continue;
      const Bounded one =
          jackknife(kBlocks, t, [&](int b) { return 1.0 + each[o].deviation(b)[i]; });
      if (one.upper < 0.0)
        say(wrong, "the gain of " + names_[at] + " has the wrong sign for output " +
                       std::to_string(whose[o] + 1));
    }
  }
  figures.result = !wrong.empty()  ? TrialResult::kWrong
                   : !open.empty() ? TrialResult::kOpen
                                   : TrialResult::kRight;
  figures.why = wrong.empty() ? open : wrong;
  return figures;
}

}  // namespace fpc
