#include "identification/auto_choice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "base/order_statistics.hpp"
#include "identification/prediction.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr std::size_t kFewestMembers = 5;  // of a committee
constexpr std::size_t kMostGroups = 4;     // of structures in it
constexpr int kLastIterations = 150;
constexpr double kSuspicious = 1.3;  // fitted error over held-out error: another minimum
constexpr double kCoverage = 0.95;
constexpr double kWorth = 0.97;         // a better model must lower the held-out error by this
constexpr double kSure = 1.5;           // standard errors of the mean ratio of errors
constexpr Eigen::Index kPieces = 12;    // parts of the blocks that models are compared on
constexpr Eigen::Index kShortest = 20;  // rows of a part

/// Half width that holds the stated share of the errors.
double widthOf(const Vector& errors) {
  std::vector<double> sizes;
  for (const double e : errors)
    if (std::isfinite(e)) sizes.push_back(std::abs(e));
  if (sizes.empty()) return 0.0;
  const auto at = static_cast<std::size_t>(
      std::min<double>(std::ceil(kCoverage * static_cast<double>(sizes.size() + 1)),
                       static_cast<double>(sizes.size())) -
      1.0);
  return orderStatistic(std::move(sizes), at);
}

/// rmse over about kPieces parts of the blocks, none across two of them.
std::vector<double> pieceErrors(const AutoData& data, const Vector& predicted) {
  std::vector<double> errors;
  const auto windows = static_cast<Index>(data.windows.size());
  const Vector error = data.data->values.col(data.output) - predicted;
  for (const auto& w : data.windows) {
    const Index length = w.last - w.first;
    const Index parts = std::clamp<Index>((kPieces + windows - 1) / windows, 1,
                                          std::max<Index>(1, length / kShortest));
    for (Index i = 0; i < parts; ++i) {
      double sum = 0.0, n = 0.0;
      for (Index k = w.first + length * i / parts; k < w.first + length * (i + 1) / parts; ++k)
        if (std::isfinite(error[k])) sum += error[k] * error[k], n += 1.0;
      errors.push_back(n > 0.0 ? std::sqrt(sum / n) : kNaN);
    }
  }
  return errors;
}

}  // namespace

Committee chooseCommittee(const AutoData& data, const StructureSearch& found) {
  Committee best;
  double lowest = std::numeric_limits<double>::infinity();
  const auto consider = [&](std::vector<const Judgement*> members) {
    if (members.empty()) return;
    const Vector mean = averaged(members);
    const double error = meanBlockError(data, mean);
    if (!(error < lowest)) return;
    lowest = error;
    best.members = std::move(members);
    best.free_run = mean;
  };
  const auto take = [](const std::vector<Judgement>& from, std::size_t most, auto& members) {
    for (std::size_t i = 0; i < std::min(most, from.size()); ++i) members.push_back(&from[i]);
  };
  std::vector<const Judgement*> members, mixed;
  for (std::size_t g = 0; g < std::min(kMostGroups, found.state.size()); ++g) {
    take(found.state[g].members, found.state[g].members.size(), members);
    if (members.size() >= kFewestMembers) consider(members);
    if (g == 0) mixed = members;
  }
  std::vector<const Judgement*> past;
  take(found.regressors, kFewestMembers, past);
  consider(past);
  mixed.insert(mixed.end(), past.begin(), past.end());
  consider(mixed);
  std::vector<const Judgement*> lines;
  take(found.linear, kFewestMembers, lines);
  consider(lines);
  if (best.members.empty()) return best;
  const Vector measured = data.data->values.col(data.output);
  best.correction = fitCorrection(measured - best.free_run);
  best.one_step = corrected(measured, best.free_run, best.correction);
  return best;
}

AutoFigures figuresOf(const AutoData& data, const Vector& free_run, const Vector& one_step,
                      const Vector& confirmed) {
  const Vector measured = data.data->values.col(data.output);
  AutoFigures f;
  const FitFigures free = fitFigures(measured, free_run), one = fitFigures(measured, one_step);
  f.free_run = free.rmse;
  f.fit = free.fit;
  f.one_step = one.samples > 0 ? one.rmse : kNaN;
  f.blocks = blockErrors(data, free_run);
  f.mean = meanBlockError(data, free_run);
  const Vector& judged = confirmed.size() > 0 ? confirmed : free_run;
  f.confirmed = meanBlockError(data, judged);
  f.pieces = pieceErrors(data, judged);
  f.width = widthOf(measured - free_run);
  f.one_step_width = widthOf(measured - one_step);
  return f;
}

Vector meanOf(const Vector& one, const Vector& other) {
  if (one.size() != other.size()) return {};
  return 0.5 * (one + other);
}

Fitted fitWhole(const AutoData& data, const Judgement& judged, int window, double most) {
  Candidate c = judged.candidate;
  c.iterations = kLastIterations;
  Fitted best;
  best.error = kInfinity;
  const auto isGood = [&](const std::vector<Stretch>& stretches) {
    Fitted fitted = fitCandidate(data, c, runsOf(data, stretches));
    fitted.rows = rowsOf(stretches);
    fitted.error = fitted.finite ? seenError(data, fitted, data.all, window) : kInfinity;
    if (fitted.error < best.error || !best.finite) best = std::move(fitted);
    return best.error < kSuspicious * judged.rmse;
  };
  const int attempts = c.hidden ? 1 : 3;  // hidden states have other members
  for (int attempt = 0; attempt < attempts; ++attempt, ++c.seed)
    if (isGood(data.all)) return best;
  c.seed = judged.candidate.seed;
  if (best.wild && rowsOf(data.windows) < rowsOf(data.all)) isGood(data.windows);
  best.finite = best.finite && best.error < most * judged.rmse;
  return best;
}

void dropStuck(const Committee& committee, std::vector<Fitted>& fitted) {
  std::map<std::string, std::vector<std::size_t>> structures;
  for (std::size_t i = 0; i < fitted.size(); ++i)
    if (fitted[i].finite) structures[committee.members[i]->candidate.structure()].push_back(i);
  for (const auto& [text, all] : structures) {
    std::vector<double> errors;
    for (const std::size_t i : all) errors.push_back(fitted[i].error);
    const std::vector<bool> stuck = stuckStarts(errors);
    for (std::size_t m = 0; m < all.size(); ++m)
      if (stuck[m]) fitted[all[m]].finite = false;
  }
}

bool isLower(const AutoFigures& other, const AutoFigures& than) {
  return other.confirmed < kWorth * than.confirmed;
}

bool isWorthIt(const AutoFigures& other, const AutoFigures& linear) {
  return isLower(other, linear) && beyondSpread(other, linear);
}

bool beyondSpread(const AutoFigures& other, const AutoFigures& linear) {
  if (!(other.confirmed < linear.confirmed)) return false;
  std::vector<double> ratios;
  for (std::size_t b = 0; b < std::min(other.pieces.size(), linear.pieces.size()); ++b) {
    const double ratio = std::log(other.pieces[b] / linear.pieces[b]);
    if (std::isfinite(ratio)) ratios.push_back(ratio);
  }
  if (ratios.size() < 2) return false;
  double mean = 0.0, spread = 0.0;
  for (const double r : ratios) mean += r / static_cast<double>(ratios.size());
  for (const double r : ratios) spread += (r - mean) * (r - mean);
  const double n = static_cast<double>(ratios.size());
  return mean + kSure * std::sqrt(spread / (n - 1.0) / n) < 0.0;
}

}  // namespace fpc
