#include "fmbpc/fuzzy/record_remarks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kHardly = 0.01;  // share of rows in which an input must move
constexpr Index kFewMoves = 10;
constexpr double kSpike = 12.0;  // robust deviations of a sample from its neighbours
constexpr double kSlow = 300.0;  // samples per time constant: too many
constexpr double kFast = 0.5;    // too few
constexpr double kUnstable = 1.002;
constexpr double kLeft = 1.0;      // spans beyond the data: a free run has gone
constexpr double kFeedback = 2.0;  // bounds
constexpr Index kFeedbackLags = 10;
constexpr double kMatters = 0.05;  // a correlation below it is true of a long record and no trouble

std::string shortNumber(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

std::vector<SignalInfo> causesOf(const DataSet& data) {
  std::vector<SignalInfo> causes = data.inputs;
  causes.insert(causes.end(), data.disturbances.begin(), data.disturbances.end());
  return causes;
}

double medianOf(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Index movesOf(const Eigen::Ref<const Vector>& u) {
  Index moves = 0;
  for (Index k = 1; k < u.size(); ++k)
    if (std::isfinite(u[k] - u[k - 1]) && u[k] != u[k - 1]) ++moves;
  return moves;
}

void addSampleTime(const DataSet& data, const TsModel& linear, std::vector<std::string>& remarks) {
  for (const auto& d : ruleDynamics(linear)) {
    double slowest = 0.0;
    for (const auto& pole : d.poles) slowest = std::max(slowest, std::abs(pole));
    if (slowest > kUnstable)
      remarks.push_back(d.output + ": unstable by itself: the linear model has a pole at " +
                        shortNumber(slowest) + ", so that free runs leave any bounds in the end");
    if (!(slowest > 0.0 && slowest < 1.0)) continue;
    const double samples = -1.0 / std::log(slowest);
    if (samples > kSlow)
      remarks.push_back(d.output + ": sample time of " + shortNumber(data.sample_time_s) +
                        " s looks short: the slowest time constant is " + shortNumber(samples) +
                        " samples (or the output integrates or drifts)");
    if (samples < kFast)
      remarks.push_back(d.output + ": sample time of " + shortNumber(data.sample_time_s) +
                        " s looks long: the slowest time constant is " + shortNumber(samples) +
                        " samples");
  }
}

/// Correlation of e(k) with u(k + lag), both without their means.
double laterCorrelation(const Eigen::Ref<const Vector>& e, const Eigen::Ref<const Vector>& u,
                        Index lag) {
  double n = 0.0, se = 0.0, su = 0.0, see = 0.0, suu = 0.0, seu = 0.0;
  for (Index k = 0; k + lag < e.size(); ++k) {
    const double a = e[k], b = u[k + lag];
    if (!std::isfinite(a) || !std::isfinite(b)) continue;
    n += 1.0, se += a, su += b, see += a * a, suu += b * b, seu += a * b;
  }
  const double spread = (see - se * se / std::max(n, 1.0)) * (suu - su * su / std::max(n, 1.0));
  return spread > 0.0 ? (seu - se * su / n) / std::sqrt(spread) : 0.0;
}

void addLeft(const std::string& name, const SignalInfo& range, const Eigen::Ref<const Vector>& run,
             std::vector<std::string>& remarks) {
  const double span = range.upper - range.lower;
  if (!std::isfinite(span)) return;
  for (Index k = 0; k < run.size(); ++k)
    if (run[k] > range.upper + kLeft * span || run[k] < range.lower - kLeft * span) {
      remarks.push_back(name + ": unstable in free run: it leaves the data at sample " +
                        std::to_string(k + 1));
      return;
    }
}

void addExtrapolation(const DataSet& data, SignalKind kind, const std::vector<SignalInfo>& signals,
                      std::vector<std::string>& remarks) {
  for (std::size_t j = 0; j < signals.size(); ++j) {
    const double margin = 1e-9 * (signals[j].upper - signals[j].lower);
    const auto column = data.values.col(data.column(kind, static_cast<int>(j)));
    Index first = -1;
    double count = 0.0;
    for (Index k = 0; k < column.size(); ++k)
      if (column[k] > signals[j].upper + margin || column[k] < signals[j].lower - margin) {
        if (first < 0) first = k;
        count += 1.0;
      }
    const double share = 100.0 * count / static_cast<double>(std::max<Index>(1, column.size()));
    if (share >= 0.5)
      remarks.push_back("the model extrapolates: " + signals[j].name + " is outside its data in " +
                        shortNumber(share) + " % of the rows, first in row " +
                        std::to_string(first + 1));
  }
}

void addResidual(const std::string& name, const DataSet& data,
                 const Eigen::Ref<const Vector>& residual, const ValidationParams& params,
                 std::vector<std::string>& remarks) {
  const ResidualCorrelation c = residualCorrelation(data, residual, params);
  for (std::size_t j = 0; j < c.signals.size(); ++j) {
    const auto row = c.cross.row(static_cast<Index>(j));
    Index lag = 0;
    const double largest = row.cwiseAbs().maxCoeff(&lag);
    if (largest > std::max(1.5 * c.bound, kMatters))
      remarks.push_back(name + ": residual correlated with " + c.signals[j] + " at lag " +
                        std::to_string(lag + 1) + " (" + shortNumber(row[lag]) + ", bound " +
                        shortNumber(c.bound) + "): a lag or delay is missing");
    double later = 0.0;
    const auto u = data.values.col(static_cast<Index>(data.outputs.size() + j));
    for (Index ahead = 0; ahead <= kFeedbackLags; ++ahead)
      later = std::max(later, std::abs(laterCorrelation(residual, u, ahead)));
    if (later > std::max(kFeedback * c.bound, kMatters) && c.bound > 0.0)
      remarks.push_back(
          name + ": " + c.signals[j] + " follows residuals (correlation " + shortNumber(later) +
          "): closed-loop data, whose gains may be biased, or an input that acts within the "
          "sample");
  }
}

}  // namespace

std::vector<Index> outliersOf(const Eigen::Ref<const Vector>& y) {
  const auto bend = [&](Index k) { return y[k] - 0.5 * (y[k - 1] + y[k + 1]); };
  std::vector<double> bends;
  for (Index k = 1; k + 1 < y.size(); ++k)
    if (std::isfinite(bend(k)) && bend(k) != 0.0) bends.push_back(std::abs(bend(k)));
  const double usual = 1.4826 * medianOf(bends);
  // a neighbour of a spike bends the other way; those of a corner hardly bend
  const auto bendsBack = [&](Index k, double size) {
    if (k < 1 || k + 1 >= y.size() || !std::isfinite(bend(k))) return true;
    return bend(k) * size < 0.0 && std::abs(bend(k)) > 0.3 * std::abs(size);
  };
  std::vector<Index> found;
  for (Index k = 1; usual > 0.0 && k + 1 < y.size(); ++k) {
    const double size = bend(k);
    if (!(std::abs(size) > kSpike * usual)) continue;
    if (std::abs(y[k + 1] - y[k - 1]) > 0.3 * std::abs(size)) continue;
    if (bendsBack(k - 1, size) && bendsBack(k + 1, size)) found.push_back(k);
  }
  return found;
}

DataSet withoutOutliers(const DataSet& data) {
  DataSet clean = data;
  for (Index i = 0; i < static_cast<Index>(data.outputs.size()); ++i)
    for (const Index k : outliersOf(data.values.col(i)))
      clean.values(k, i) = std::numeric_limits<double>::quiet_NaN();
  return clean;
}

std::vector<std::string> recordRemarks(const DataSet& data, const TsModel* linear) {
  std::vector<std::string> remarks;
  const auto causes = causesOf(data);
  const auto n_y = static_cast<Index>(data.outputs.size());
  for (std::size_t j = 0; j < causes.size(); ++j) {
    const Index moves = movesOf(data.values.col(n_y + static_cast<Index>(j)));
    if (moves < kFewMoves ||
        static_cast<double>(moves) < kHardly * static_cast<double>(data.rows()))
      remarks.push_back(causes[j].name + " hardly moved: " + std::to_string(moves) + " moves in " +
                        std::to_string(data.rows()) + " rows");
  }
  for (Index i = 0; i < n_y; ++i) {
    const auto found = outliersOf(data.values.col(i));
    if (!found.empty())
      remarks.push_back(data.outputs[static_cast<std::size_t>(i)].name + ": " +
                        std::to_string(found.size()) + " outliers, the first in row " +
                        std::to_string(found.front() + 1));
  }
  if (linear != nullptr) addSampleTime(data, *linear, remarks);
  return remarks;
}

std::vector<std::string> predictionRemarks(const TsModel& model, const DataSet& data,
                                           const Matrix& one_step, const Matrix& free_run,
                                           const ValidationParams& params) {
  std::vector<std::string> remarks;
  for (std::size_t i = 0; i < model.outputs.size(); ++i) {
    const auto c = static_cast<Index>(i);
    addLeft(model.outputs[i].name, model.outputs[i], free_run.col(c), remarks);
    addResidual(model.outputs[i].name, data, data.values.col(c) - one_step.col(c), params, remarks);
  }
  addExtrapolation(data, SignalKind::kOutput, model.outputs, remarks);
  addExtrapolation(data, SignalKind::kInput, model.inputs, remarks);
  addExtrapolation(data, SignalKind::kDisturbance, model.disturbances, remarks);
  return remarks;
}

}  // namespace fpc
