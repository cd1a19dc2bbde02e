// Errors of free runs over blocks; several starts of one structure as one.
#include <algorithm>
#include <cmath>

#include "base/order_statistics.hpp"
#include "identification/auto_search.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kStuck = 1.3;  // of the lower quartile of the starts' errors

double squaredError(const AutoData& data, const Vector& predicted, Stretch s, double& n) {
  double sum = 0.0;
  for (Index k = s.first; k < s.last; ++k) {
    const double error = data.data->values(k, data.output) - predicted[k];
    if (std::isfinite(error)) sum += error * error, n += 1.0;
  }
  return sum;
}

const Vector& saidBy(const Judgement& j) { return j.settled.size() > 0 ? j.settled : j.free_run; }

}  // namespace

double penalty(Index parameters, const AutoData& data) {
  double rows = 0.0;
  for (const auto& w : data.windows) rows += static_cast<double>(w.last - w.first);
  const double share = std::min(0.9, static_cast<double>(parameters) / rows);
  return std::sqrt((1.0 + share) / (1.0 - share));
}

double rmseOf(const AutoData& data, const Vector& predicted) {
  double sum = 0.0, n = 0.0;
  for (const auto& w : data.windows) sum += squaredError(data, predicted, w, n);
  return n > 0.0 ? std::sqrt(sum / n) : kInfinity;
}

std::vector<double> blockErrors(const AutoData& data, const Vector& predicted) {
  std::vector<double> errors;
  for (const auto& w : data.windows) {
    double n = 0.0;
    const double sum = squaredError(data, predicted, w, n);
    errors.push_back(n > 0.0 ? std::sqrt(sum / n) : kNaN);
  }
  return errors;
}

double meanBlockError(const AutoData& data, const Vector& predicted) {
  double sum = 0.0, n = 0.0;
  for (const double e : blockErrors(data, predicted))
    if (std::isfinite(e)) sum += e, n += 1.0;
  return n > 0.0 ? sum / n : kInfinity;
}

double seenError(const AutoData& data, const Fitted& fitted, const std::vector<Stretch>& stretches,
                 int window) {
  double sum = 0.0, n = 0.0;
  for (const auto& s : stretches) {
    const Vector y = freeRunOf(data, fitted, s, window);
    sum += squaredError(data, y, {std::min<Index>(s.first + window, s.last), s.last}, n);
  }
  return n > 0.0 ? std::sqrt(sum / n) : kInfinity;
}

std::vector<bool> stuckStarts(const std::vector<double>& seen) {
  const double quartile = sampleQuantile(seen, 0.25);
  std::vector<bool> stuck;
  for (const double e : seen) stuck.push_back(!(e <= kStuck * quartile));
  return stuck;
}

void settleGroup(const AutoData& data, Group& group) {
  for (auto& j : group.members) j.settled = j.free_run;
  for (std::size_t b = 0; b < data.windows.size(); ++b) {
    std::vector<double> seen;
    for (const auto& j : group.members) seen.push_back(j.seen[b]);
    const std::vector<bool> stuck = stuckStarts(seen);
    const Stretch w = data.windows[b];
    for (std::size_t i = 0; i < stuck.size(); ++i)
      if (stuck[i]) group.members[i].settled.segment(w.first, w.last - w.first).setConstant(kNaN);
  }
  std::vector<const Judgement*> members;
  for (auto& j : group.members) {
    j.rmse = rmseOf(data, j.settled);
    members.push_back(&j);
  }
  group.free_run = averaged(members);
  group.rmse = rmseOf(data, group.free_run);
  group.score =
      meanBlockError(data, group.free_run) * penalty(group.members.front().parameters, data);
}

Vector averaged(const std::vector<const Judgement*>& members) {
  Vector mean = Vector::Constant(members.front()->free_run.size(), kNaN);
  for (Index k = 0; k < mean.size(); ++k) {
    std::vector<double> said;
    for (const auto* m : members)
      if (std::isfinite(saidBy(*m)[k])) said.push_back(saidBy(*m)[k]);
    if (!said.empty()) mean[k] = trimmedMean(said);
  }
  return mean;
}

}  // namespace fpc
