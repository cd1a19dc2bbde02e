#include "identification/coupled_options.hpp"

#include <algorithm>
#include <cmath>

#include "identification/joint_run.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kCoupledOneStepShare = 0.15;  // of a score, as in the search of one output
constexpr double kLess = 1e-6;                 // of the objective: what counts as a fall
constexpr int kMostPasses = 3;
constexpr double kPerStep = 100.0;  // multiply-adds of a step of a joint run beside its parameters

/// Other outputs act on this one: where one of their values is missing within a record, the last
/// known one stands.
AutoData withBridgedPartners(const AutoData& given) {
  AutoData data = given;
  const auto n_y = static_cast<Index>(data.data->outputs.size());
  for (Index j = 0; j < n_y; ++j)
    for (Index k = 1; j != data.output && k < data.scaled.rows(); ++k)
      if (!std::isfinite(data.scaled(k, j)) && data.scaled.row(k).array().isFinite().any())
        data.scaled(k, j) = data.scaled(k - 1, j);
  return data;
}

}  // namespace

CoupledOptions::CoupledOptions(const std::vector<SearchedOutput>& alone, const SearchLimits& limits)
    : limits_(limits), options_(alone.size()) {
  for (const auto& a : alone) data_.push_back(withBridgedPartners(a.data));
  measured_.resize(alone.front().data.scaled.rows(), static_cast<Index>(alone.size()));
  for (std::size_t i = 0; i < alone.size(); ++i)
    measured_.col(static_cast<Index>(i)) = alone[i].data.scaled.col(static_cast<Index>(i));
}

bool CoupledOptions::isOver() const { return limits_.isOver(); }

std::vector<std::size_t> CoupledOptions::add(std::size_t output,
                                             const std::vector<Candidate>& candidates) {
  const AutoData& data = data_[output];
  const std::size_t blocks = data.windows.size();
  std::vector<Fitted> fits(candidates.size() * blocks);
  limitedFor(fits.size(), limits_, [&](std::size_t task) {
    const std::size_t b = task % blocks;
    fits[task] =
        fitCandidate(data, candidates[task / blocks], trainingStretches(data, static_cast<int>(b)));
    return fits[task].work;
  });
  std::vector<std::size_t> places;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    CoupledOption option;
    option.candidate = candidates[c];
    option.one_step = Vector::Constant(data.scaled.rows(), kNaN);
    bool kept = true;
    for (std::size_t b = 0; b < blocks; ++b) {
      const Fitted& fit = option.blocks.emplace_back(std::move(fits[c * blocks + b]));
      kept = kept && fit.finite;
      if (!kept) break;
      const Stretch w = data.windows[b];
      option.one_step.segment(w.first, w.last - w.first) =
          oneStepOf(data, fit, w).segment(w.first, w.last - w.first);
    }
    places.push_back(kept ? options_[output].size() : kNone);
    if (!kept) continue;
    option.record = recurrentData(data, option.blocks.front().exogenous, false);
    option.parameters = option.blocks.front().shape.parameterCount();
    options_[output].push_back(std::move(option));
  }
  return places;
}

std::vector<Vector> CoupledOptions::freeRuns(const CoupledChoice& choice) const {
  std::vector<Vector> free(outputs(), Vector::Constant(measured_.rows(), kNaN));
  const auto& windows = data_.front().windows;
  double terms = 0.0;
  for (std::size_t i = 0; i < outputs(); ++i)
    terms += kPerStep + static_cast<double>(option(i, choice[i]).parameters);
  limits_.spend(terms * static_cast<double>(rowsOf(windows)));
  for (std::size_t b = 0; b < windows.size(); ++b) {
    std::vector<JointMember> members;
    for (std::size_t i = 0; i < outputs(); ++i)
      members.push_back({&option(i, choice[i]).blocks[b], &option(i, choice[i]).record});
    for (const Stretch& piece : runsOf(data_.front(), {windows[b]})) {
      const Matrix run = jointFreeRun(members, measured_, piece);
      const Index start = data_.front().reach > 0 ? kRunStart : Index{limits_.window};
      const Index first = std::min(piece.first + start, piece.last);
      for (std::size_t i = 0; i < outputs(); ++i) {
        const auto c = static_cast<Index>(i);
        free[i].segment(first, piece.last - first) =
            (data_[i].scale[c] * run.col(c).segment(first, piece.last - first)).array() +
            data_[i].shift[c];
      }
    }
  }
  return free;
}

std::vector<AutoFigures> CoupledOptions::figures(const CoupledChoice& choice) const {
  const std::vector<Vector> free = freeRuns(choice);
  std::vector<AutoFigures> all;
  for (std::size_t i = 0; i < outputs(); ++i)
    all.push_back(figuresOf(data_[i], free[i], option(i, choice[i]).one_step));
  return all;
}

double CoupledOptions::objective(const CoupledChoice& choice) const {
  const std::vector<Vector> free = freeRuns(choice);
  double sum = 0.0;
  for (std::size_t i = 0; i < outputs(); ++i) {
    const CoupledOption& o = option(i, choice[i]);
    for (const double block : blockErrors(data_[i], free[i]))
      if (!std::isfinite(block)) return kInfinity;
    const double one = rmseOf(data_[i], o.one_step), mean = meanBlockError(data_[i], free[i]);
    const double weight = std::isfinite(one) && one > 0.0 ? kCoupledOneStepShare : 0.0;
    sum += (1.0 - weight) * std::log(mean) + std::log(penalty(o.parameters, data_[i]));
    if (weight > 0.0) sum += weight * std::log(one);
  }
  return sum;
}

CoupledChoice CoupledOptions::descend(CoupledChoice choice) const {
  double lowest = objective(choice);
  bool falls = true;
  for (int pass = 0; pass < kMostPasses && falls; ++pass) {
    falls = false;
    for (std::size_t i = 0; i < outputs(); ++i)
      for (std::size_t o = 0; o < count(i) && !isOver(); ++o) {
        CoupledChoice trial = choice;
        trial[i] = o;
        const double value = objective(trial);
        if (!(value < lowest - kLess)) continue;
        lowest = value;
        choice = std::move(trial);
        falls = true;
      }
  }
  return choice;
}

}  // namespace fpc
