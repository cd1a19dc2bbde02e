#include "supervision/candidate_trial.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/finite_json.hpp"
#include "base/statistics.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"
#include "model/process_trust.hpp"
#include "supervision/guard_params.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr int kLookAt[CandidateTrial::kLooks] = {1, 2, 3, 5, 7, 10};  // times params.samples
const double kTrusted = GuardParams().trust_low;

std::string brief(double value) {
  if (!std::isfinite(value)) return "?";
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

std::string brief(const Bounded& of) {
  return brief(of.value) + " (" + brief(of.lower) + ".." + brief(of.upper) + ")";
}

OrderedJson toJson(const Bounded& of) {
  return {numberOrNull(of.value), numberOrNull(of.lower), numberOrNull(of.upper)};
}

const char* nameOf(TrialResult result) {
  return result == TrialResult::kRight ? "right" : result == TrialResult::kWrong ? "wrong" : "open";
}

}  // namespace

CandidateTrial::CandidateTrial(const TsModel& model, const TsModel* present,
                               const CandidateParams& params, InputLimits limits,
                               std::vector<bool> moved)
    : params_(params),
      limits_(std::move(limits)),
      trial_(model, Index{kLookAt[kLooks - 1]} * params.samples, std::move(moved)),
      errors_(&model, params.horizon, trial_.capacity()),
      present_(present, params.horizon, trial_.capacity()),
      point_(countOf(model.outputs) + countOf(model.inputs) + countOf(model.disturbances)) {}

void CandidateTrial::reset() {
  trial_.reset();
  errors_.reset();
  present_.reset();
  squares_ = 0.0;
  compared_ = limited_ = outside_ = seen_ = 0;
  look_ = window_ = 0;
  ended_ = false;
}

void CandidateTrial::interrupt() {
  trial_.interrupt();
  errors_.interrupt();
  present_.interrupt();
}

void CandidateTrial::look(const Measurement& now) {
  trial_.look(now);
  errors_.look(now);
  present_.look(now);
  const Index n_y = now.outputs.size(), n_u = now.input_applied.size();
  point_.head(n_y) = now.outputs;
  point_.segment(n_y, n_u) = now.input_applied;
  point_.tail(now.disturbances.size()) = now.disturbances;
  ++seen_;
  if (processTrustOf(model(), point_) < kTrusted) ++outside_;
}

void CandidateTrial::compare(VectorRef law, VectorRef candidate, VectorRef applied) {
  constexpr double kNear = 1e-9;
  double largest = 0.0;
  bool limited = false;
  for (Index i = 0; i < candidate.size(); ++i) {
    const double range = limits_.upper[i] - limits_.lower[i];
    const double width = std::isfinite(range) && range > 0.0 ? range : 1.0, near = kNear * width;
    largest = std::max(largest, std::abs(candidate[i] - law[i]) / width);
    limited = limited || candidate[i] <= limits_.lower[i] + near ||
              candidate[i] >= limits_.upper[i] - near ||
              std::abs(candidate[i] - applied[i]) >= limits_.move[i] - near;
  }
  if (!std::isfinite(largest)) return;
  squares_ += largest * largest;
  ++compared_;
  if (limited) ++limited_;
}

bool CandidateTrial::judgeIfDue() {
  if (ended_) {  // anew, with half the chance of an error
    const int window = window_ + 1;
    reset();
    window_ = window;
  }
  if (trial_.kept() < Index{kLookAt[look_]} * params_.samples) return false;
  figures_ = judge();
  ended_ = ++look_ == kLooks;
  return true;
}

/// Mean squares over those of "it stays" or of the law in charge, outputs weighed by the inverse of
/// their mean squares of "it stays".
Bounded CandidateTrial::ratio(std::size_t h, bool to_present, double t) const {
  constexpr int n = ModelTrial::kBlocks;
  const Index kept = errors_.kept(), n_y = countOf(model().outputs);
  Vector mine = Vector::Zero(n), theirs = mine;
  for (Index o = 0; o < n_y; ++o) {
    Vector a = Vector::Zero(n), b = a;
    double stays = 0.0;
    for (Index k = 0; k < kept; ++k) {
      const double s = errors_.stays(o, h, k), m = errors_.model(o, h, k);
      const double other = to_present ? present_.model(o, h, k) : s;
      if (!std::isfinite(s) || !std::isfinite(other)) continue;
      const Index block = std::min<Index>(k * n / kept, n - 1);
      a[block] += std::isfinite(m) ? m : kInfinity;
      b[block] += other;
      stays += s;
    }
    if (!(stays > 0.0)) continue;
    mine += a / stays;
    theirs += b / stays;
  }
  const double sum = mine.sum(), of = theirs.sum();
  if (!(of > 0.0)) return {};
  if (!std::isfinite(sum)) return {kInfinity, kInfinity, kInfinity};
  return jackknife(
      n, t, [&](int but) { return but < 0 ? sum / of : (sum - mine[but]) / (of - theirs[but]); });
}

CandidateFigures CandidateTrial::judge() const {
  CandidateFigures f;
  f.confidence = 1.0 - (1.0 - params_.confidence) / (kLooks * std::pow(2.0, window_));
  f.model = trial_.judge(f.confidence);
  f.result = f.model.result;
  f.why = f.model.why;
  const double t = studentBound(f.confidence, ModelTrial::kBlocks - 1);
  for (std::size_t h = 0; h < errors_.horizons().size(); ++h) {
    CandidateFigures::Horizon horizon;
    horizon.samples = errors_.horizons()[h];
    if (errors_.kept() > 0) {
      horizon.ratio = errors_.ratio(h);
      horizon.squares = ratio(h, false, t);
    }
    if (errors_.kept() > 0 && present_.hasModel()) {
      horizon.present = present_.ratio(h);
      horizon.against = ratio(h, true, t);
    }
    f.horizons.push_back(horizon);
  }
  const CandidateFigures::Horizon& last = f.horizons.back();  // nearer ones carry sensors' noise
  const auto refuse_worse = [&](const Bounded& squares, const std::string& than) {
    if (f.result == TrialResult::kWrong || !(squares.lower > kWorse)) return;
    f.result = TrialResult::kWrong;
    f.why = "its predictions are worse than " + than + " " + std::to_string(last.samples) +
            " samples ahead";
  };
  refuse_worse(last.squares, "'it stays'");
  refuse_worse(last.against, "those of the law in charge");
  if (seen_ > 0) f.outside = static_cast<double>(outside_) / static_cast<double>(seen_);
  if (compared_ > 0) {
    f.difference = std::sqrt(squares_ / static_cast<double>(compared_));
    f.at_limit = static_cast<double>(limited_) / static_cast<double>(compared_);
  }
  if (f.result == TrialResult::kRight && f.outside > kOutside) {
    f.result = TrialResult::kOpen;
    f.why = "the process is outside the data of its model";
  }
  return f;
}

std::string textOf(const CandidateFigures& f) {
  std::string text = f.why.empty() ? "" : f.why + "; ";
  text += std::to_string(f.model.samples) + " samples, explains " + brief(f.model.explained);
  std::string gains;
  for (const Bounded& gain : f.model.gain)
    if (std::isfinite(gain.value)) gains += (gains.empty() ? "" : ", ") + brief(gain);
  if (!gains.empty()) text += ", gains " + gains;
  std::string errors;
  for (std::size_t h = 0; h < f.horizons.size();
       h += std::max<std::size_t>(1, f.horizons.size() - 1))
    errors += (errors.empty() ? "" : ", ") + brief(f.horizons[h].ratio) + " at " +
              std::to_string(f.horizons[h].samples);
  if (!errors.empty()) text += ", error over 'it stays' " + errors;
  text += ", input differs by " + brief(100.0 * f.difference) + " %, at limits " +
          brief(100.0 * f.at_limit) + " %, outside its data " + brief(100.0 * f.outside) + " %";
  return text.substr(0, 300);
}

std::string jsonOf(const CandidateFigures& f) {
  OrderedJson json;
  json["result"] = nameOf(f.result);
  json["why"] = f.why;
  json["samples"] = f.model.samples;
  json["confidence"] = f.confidence;
  json["explained"] = toJson(f.model.explained);
  json["gain"] = OrderedJson::array();
  for (const Bounded& gain : f.model.gain) json["gain"].push_back(toJson(gain));
  json["shift_loss"] = OrderedJson::array();
  for (const auto& input : f.model.shifts) {
    OrderedJson shifts = OrderedJson::object();
    for (const auto& shift : input) shifts[std::to_string(shift.samples)] = toJson(shift.loss);
    json["shift_loss"].push_back(shifts);
  }
  json["horizons"] = OrderedJson::array();
  for (const auto& h : f.horizons)
    json["horizons"].push_back({{"samples", h.samples},
                                {"error_over_stays", numberOrNull(h.ratio)},
                                {"law_in_charge_over_stays", numberOrNull(h.present)},
                                {"squares_over_stays", toJson(h.squares)},
                                {"squares_over_law_in_charge", toJson(h.against)}});
  json["input_difference"] = numberOrNull(f.difference);
  json["at_limit"] = numberOrNull(f.at_limit);
  json["outside_data"] = numberOrNull(f.outside);
  return json.dump();
}

}  // namespace fpc
