#include "control/hybrid/evolution.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kGridPoints = 4000;   // of all outputs together, where extremes are checked
constexpr double kMostPoints = 40000;  // with the corners of sets
constexpr double kSlack = 1e-12;       // of the comparison of two predictions

using Axis = std::vector<double>;

/// Moves to the next point of a grid; false after the last one.
bool nextPoint(std::vector<std::size_t>& index, const std::vector<Axis>& axes) {
  for (std::size_t i = 0; i < index.size(); ++i) {
    if (++index[i] < axes[i].size()) return true;
    index[i] = 0;
  }
  return false;
}

/// Where the sets on an output have corners, and half-way between them: a rule that holds between
/// two points of an even grid only is seen as well.
void addCorners(const TsModel& model, int output, Axis& axis) {
  const double lower = axis.front(), upper = axis.back();
  Axis corners;
  for (const OutputModel& submodel : model.submodels)
    for (std::size_t j = 0; j < submodel.antecedents.size(); ++j) {
      const Regressor& z = submodel.antecedents[j];
      if (z.kind != SignalKind::kOutput || z.index != output) continue;
      for (const Rule& rule : submodel.rules) {
        if (rule.multivariate) continue;
        const auto& set = rule.antecedents[j].parameters;
        corners.insert(corners.end(), set.begin(), set.end());
      }
    }
  std::sort(corners.begin(), corners.end());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const double middle = 0.5 * (corners[i] + corners[i > 0 ? i - 1 : 0]);
    for (const double point : {corners[i], middle})
      if (point > lower && point < upper) axis.push_back(point);
  }
  std::sort(axis.begin(), axis.end());
  axis.erase(std::unique(axis.begin(), axis.end()), axis.end());
}

}  // namespace

bool matches(const Vector& pattern, VectorRef input) {
  for (Index i = 0; i < pattern.size(); ++i)
    if (!std::isnan(pattern[i]) && std::abs(pattern[i] - input[i]) > kSameInput) return false;
  return true;
}

HybridEvolution::HybridEvolution(HybridMpcParams params, InputLimits limits, const TsModel& model)
    : params_(std::move(params)),
      limits_(std::move(limits)),
      model_(model, params_.choices),
      first_cost_(Vector::Zero(params_.choices.cols())),
      disturbances_(Vector::Zero(static_cast<Index>(model.disturbances.size()))),
      high_(Vector::Zero(model_.stateSize())),
      low_(high_) {
  const Index n = params_.choices.cols();
  block_cost_.resize(n, n);
  for (Index before = 0; before < n; ++before)
    for (Index choice = 0; choice < n; ++choice)
      block_cost_(before, choice) =
          blockCost(params_.choices.col(before), static_cast<int>(choice));
  if (params_.bound != BranchBound::kReach || !model_.isMemoryless()) return;
  highest_ = extremeChoice(1.0);
  lowest_ = extremeChoice(-1.0);
}

double HybridEvolution::blockCost(VectorRef before, int choice) const {
  const auto now = params_.choices.col(choice);
  for (const ForbiddenTransition& t : params_.forbidden_transitions)
    if (matches(t.from, before) && matches(t.to, now)) return kInfinity;
  for (Index i = 0; i < now.size(); ++i)
    if (std::abs(now[i] - before[i]) > limits_.move[i] * (1.0 + kSameInput)) return kInfinity;
  double cost = 0.0;
  for (const SwitchTerm& s : params_.switching)
    cost += s.weight * std::max(before[s.before], 0.0) * now[s.after];
  for (const TravelTerm& t : params_.travel)
    cost += t.weight * std::abs(now[t.input] - before[t.input]) *
            (t.gate < 0 ? 1.0 : std::max(before[t.gate], 0.0));
  return cost;
}

void HybridEvolution::start(VectorRef input_before, VectorRef disturbances,
                            const Matrix& reference) {
  for (Index choice = 0; choice < first_cost_.size(); ++choice)
    first_cost_[choice] = blockCost(input_before, static_cast<int>(choice));
  disturbances_ = disturbances;
  reference_ = &reference;
}

double HybridEvolution::trackingCost(VectorRef state, Index sample) const {
  double cost = 0.0;
  for (Index i = 0; i < params_.weight_tracking.size(); ++i) {
    if (params_.weight_tracking[i] == 0.0) continue;
    const double error = state[model_.outputState(i)] - (*reference_)(i, sample);
    cost += params_.weight_tracking[i] * error * error;
  }
  return cost;
}

double HybridEvolution::advance(int level, int before, int choice, Eigen::Ref<Vector> state) {
  double cost = before < 0 ? first_cost_[choice] : block_cost_(before, choice);
  if (cost == kInfinity) return cost;
  const Index first = static_cast<Index>(level) * params_.hold_samples;
  for (Index k = 0; k < params_.hold_samples; ++k) {
    model_.step(choice, disturbances_, state);
    cost += trackingCost(state, first + k);
  }
  return cost;
}

// The least squared errors of outputs that lie between low_ and high_.
double HybridEvolution::bandCost(Index sample) const {
  double cost = 0.0;
  for (Index i = 0; i < params_.weight_tracking.size(); ++i) {
    if (params_.weight_tracking[i] == 0.0) continue;
    const double asked = (*reference_)(i, sample);
    double error = 0.0;
    if (highest_ >= 0) error = std::max(error, asked - high_[model_.outputState(i)]);
    if (lowest_ >= 0) error = std::max(error, low_[model_.outputState(i)] - asked);
    cost += params_.weight_tracking[i] * error * error;
  }
  return cost;
}

bool HybridEvolution::insideRanges(VectorRef state) const {
  for (Index i = 0; i < state.size(); ++i) {
    const SignalInfo& range = model_.model().outputs[static_cast<std::size_t>(i)];
    if (!(state[i] >= range.lower && state[i] <= range.upper)) return false;
  }
  return true;
}

double HybridEvolution::leastCostToGo(int level, Eigen::Ref<Vector> state, double enough) {
  if (highest_ < 0 && lowest_ < 0) return 0.0;
  high_ = low_ = state;
  double cost = 0.0;
  const Index first = static_cast<Index>(level) * params_.hold_samples;
  const Index last = static_cast<Index>(params_.horizon_blocks) * params_.hold_samples;
  for (Index sample = first; sample < last && cost <= enough; ++sample) {
    if (!insideRanges(high_) || !insideRanges(low_)) break;
    if (highest_ >= 0) model_.step(highest_, disturbances_, high_);
    if (lowest_ >= 0) model_.step(lowest_, disturbances_, low_);
    cost += bandCost(sample);
  }
  return cost;
}

Vector HybridEvolution::mapped(int choice, const Vector& state) {
  Vector next = state;
  model_.step(choice, disturbances_, next);
  return next;
}

int HybridEvolution::extremeChoice(double sign) {
  Vector middle(model_.stateSize());
  for (Index i = 0; i < middle.size(); ++i) {
    const SignalInfo& range = model_.model().outputs[static_cast<std::size_t>(i)];
    middle[i] = 0.5 * (range.lower + range.upper);
  }
  if (!middle.allFinite()) return -1;  // a range is missing
  int best = 0;
  double most = -kInfinity;
  for (int choice = 0; choice < static_cast<int>(params_.choices.cols()); ++choice) {
    const double sum = sign * mapped(choice, middle).sum();
    if (sum > most) {
      most = sum;
      best = choice;
    }
  }
  return isExtreme(best, sign) ? best : -1;
}

// On a grid: no choice leads further, and the map grows with every output. Three points along each
// of many outputs, or many corners, are more than can be tried: then nothing is claimed.
bool HybridEvolution::isExtreme(int choice, double sign) {
  const auto n_y = static_cast<std::size_t>(model_.stateSize());
  if (std::pow(3.0, static_cast<double>(n_y)) > kGridPoints) return false;
  const int n =
      std::max(3, static_cast<int>(std::pow(kGridPoints, 1.0 / static_cast<double>(n_y))));
  const auto& outputs = model_.model().outputs;
  std::vector<Axis> axes(n_y);
  double points = 1.0;
  for (std::size_t i = 0; i < n_y; ++i) {
    const double step = (outputs[i].upper - outputs[i].lower) / (n - 1);
    for (int j = 0; j < n; ++j) axes[i].push_back(outputs[i].lower + j * step);
    addCorners(model_.model(), static_cast<int>(i), axes[i]);
    points *= static_cast<double>(axes[i].size());
  }
  if (points > kMostPoints) return false;
  std::vector<std::size_t> index(n_y, 0);
  Vector state(model_.stateSize());
  do {
    for (std::size_t i = 0; i < n_y; ++i) state[static_cast<Index>(i)] = axes[i][index[i]];
    const Vector here = mapped(choice, state);
    for (int other = 0; other < static_cast<int>(params_.choices.cols()); ++other)
      if ((sign * (here - mapped(other, state))).minCoeff() < -kSlack) return false;
    for (std::size_t i = 0; i < n_y; ++i) {
      if (index[i] + 1 == axes[i].size()) continue;
      Vector further = state;
      further[static_cast<Index>(i)] = axes[i][index[i] + 1];
      if ((mapped(choice, further) - here).minCoeff() < -kSlack) return false;
    }
  } while (nextPoint(index, axes));
  return true;
}

}  // namespace fpc
