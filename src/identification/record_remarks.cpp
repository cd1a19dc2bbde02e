#include "identification/record_remarks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "identification/feedback_share.hpp"
#include "identification/record_faults.hpp"

#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kHardly = 0.01;  // share of rows in which an input must move
constexpr Index kFewMoves = 10;
constexpr Index kStill = 4;      // fewer moves tell nothing beside inputs that move
constexpr double kSlow = 300.0;  // samples per time constant: too many
constexpr double kFast = 0.5;    // too few
constexpr double kUnstable = 1.002;
constexpr double kLeft = 1.0;      // spans beyond the data: a free run has gone
constexpr double kDrift = 0.7;     // correlation of a residual with the one before
constexpr double kMatters = 0.05;  // a correlation below it is true of a long record and no trouble

std::vector<SignalInfo> causesOf(const DataSet& data) {
  std::vector<SignalInfo> causes = data.inputs;
  causes.insert(causes.end(), data.disturbances.begin(), data.disturbances.end());
  return causes;
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
                        shortText(slowest) + ", so that free runs leave any bounds in the end");
    if (!(slowest > 0.0 && slowest < 1.0)) continue;
    const double samples = -1.0 / std::log(slowest);
    if (samples > kSlow)
      remarks.push_back(d.output + ": sample time of " + shortText(data.sample_time_s) +
                        " s looks short: the slowest time constant is " + shortText(samples) +
                        " samples (or the output integrates or drifts)");
    if (samples < kFast)
      remarks.push_back(d.output + ": sample time of " + shortText(data.sample_time_s) +
                        " s looks long: the slowest time constant is " + shortText(samples) +
                        " samples");
  }
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
                        shortText(share) + " % of the rows, first in row " +
                        std::to_string(first + 1));
  }
}

/// Bartlett: how much wider the bound of a correlation is where both signals are coloured.
double colour(const Vector& e, const Vector& u) {
  double sum = 1.0;
  for (Index lag = 0; lag < std::min(e.size(), u.size()); ++lag) {
    const double product = e[lag] * u[lag];
    if (product <= 0.0) break;
    sum += 2.0 * product;
  }
  return std::sqrt(sum);
}

void addResidual(const std::string& name, const DataSet& data,
                 const Eigen::Ref<const Vector>& residual, const ValidationParams& params,
                 std::vector<std::string>& remarks) {
  const ResidualCorrelation c = residualCorrelation(data, residual, params);
  const bool drifts = c.autocorrelation.size() > 0 && c.autocorrelation[0] > kDrift;
  if (drifts)
    remarks.push_back(name + ": residuals drift (correlation " + shortText(c.autocorrelation[0]) +
                      " with the one before): something acts that was not recorded, or the model "
                      "is off here");
  std::string others;
  double strongest = 0.0;
  std::string words;
  for (std::size_t j = 0; j < c.signals.size(); ++j) {
    const auto row = c.cross.row(static_cast<Index>(j));
    Index lag = 0;
    const double largest = row.cwiseAbs().maxCoeff(&lag);
    const auto u = data.values.col(static_cast<Index>(data.outputs.size() + j));
    const double bound = c.bound * colour(c.autocorrelation, autocorrelation(u, params));
    if (!(largest > std::max(1.5 * bound, kMatters))) continue;
    others += " " + c.signals[j];
    if (largest <= strongest) continue;
    strongest = largest;
    words = name + ": residual correlated with " + c.signals[j] + " at lag " +
            std::to_string(lag + 1) + " (" + shortText(row[lag]) + ", bound " + shortText(bound) +
            "): a lag, a delay or a bend is missing";
  }
  if (words.empty()) return;
  if (others.find(' ', 1) != std::string::npos) words += "; of all inputs:" + others;
  remarks.push_back(words);
}

}  // namespace

std::vector<Index> stillCauses(const DataSet& data) {
  std::vector<Index> still;
  bool others = false;
  for (auto c = static_cast<Index>(data.outputs.size()); c < data.values.cols(); ++c) {
    const Index moves = movesOf(data.values.col(c));
    others = others || moves >= kFewMoves;
    if (moves < kStill) still.push_back(c);
  }
  if (!others) still.clear();
  return still;
}

namespace {

void addOutliers(const DataSet& data, std::vector<std::string>& remarks) {
  const auto found = outliersOf(data);
  const auto causes = causesOf(data);
  const std::size_t n_y = data.outputs.size();
  for (std::size_t c = 0; c < found.size(); ++c) {
    const auto n = found[c].size();
    if (n == 0) continue;
    const std::string& name = c < n_y ? data.outputs[c].name : causes[c - n_y].name;
    remarks.push_back(name + ": " + std::to_string(n) + (n == 1 ? " outlier" : " outliers") +
                      (n == 1 ? " in row " : ", the first in row ") +
                      std::to_string(found[c].front() + 1) +
                      (c < n_y ? ": left out of fits and figures"
                               : ": no output notices; a straight line instead"));
  }
}

void addFeedback(const DataSet& data, std::vector<std::string>& remarks) {
  const auto n_y = static_cast<Index>(data.outputs.size());
  for (std::size_t j = 0; j < data.inputs.size(); ++j) {
    const auto u = data.values.col(n_y + static_cast<Index>(j));
    if (movesOf(u) < kFewMoves) continue;
    for (Index i = 0; i < n_y; ++i) {
      const auto y = data.values.col(i);
      const std::string& name = data.outputs[static_cast<std::size_t>(i)].name;
      const double before = feedbackShare(u, y, 1), within = feedbackShare(u, y);
      if (before > 0.0 || within > 0.0)
        remarks.push_back(
            data.inputs[j].name + " answers to " + name + ", which explains " +
            shortText(100.0 * std::max(before, within)) + " % of what its own past does not: " +
            (before > 0.0 ? "closed-loop data, whose gains may be biased"
                          : "an input that acts within its sample (--input-row same), or a closed "
                            "loop"));
    }
  }
}

}  // namespace

std::vector<std::string> recordRemarks(const DataSet& data, const TsModel* linear) {
  std::vector<std::string> remarks;
  const auto causes = causesOf(data);
  const auto n_y = static_cast<Index>(data.outputs.size());
  for (std::size_t j = 0; j < causes.size(); ++j) {
    const Index moves = movesOf(data.values.col(n_y + static_cast<Index>(j)));
    if (moves < kFewMoves ||
        static_cast<double>(moves) < kHardly * static_cast<double>(data.rows()))
      remarks.push_back(causes[j].name + " hardly moved: " + std::to_string(moves) +
                        (moves == 1 ? " move in " : " moves in ") + std::to_string(data.rows()) +
                        " rows");
  }
  for (const auto& remark : faultRemarks(data)) remarks.push_back(remark);
  addOutliers(data, remarks);
  addFeedback(withoutOutliers(data), remarks);
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
