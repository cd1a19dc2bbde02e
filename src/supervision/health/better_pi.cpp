#include "supervision/health/better_pi.hpp"

#include <algorithm>
#include <cmath>

#include "supervision/health/finite_runs.hpp"

namespace fpc {
namespace {

constexpr std::size_t kNewestRows = 20000, kFewestJudged = 60;
constexpr std::size_t kKeptSteps = 120;  // of the response that are kept

struct PiGains {
  double proportional{}, integral{};  // per sample
};

std::vector<double> newestOf(std::vector<double> values) {
  if (values.size() > kNewestRows) values.erase(values.begin(), values.end() - kNewestRows);
  return values;
}

std::vector<double> sampledAt(const StepResponse& response, double Ts) {
  std::vector<double> step;
  for (std::size_t i = 1; i <= kKeptSteps; ++i) {
    const double value = response.at(Ts * static_cast<double>(i));
    if (!std::isfinite(value)) break;
    step.push_back(value);
  }
  return step;
}

/// Closed loop as slow as the dead time.
PiGains simcGains(const ReactionCurve& curve, double gain, double sample_time_s) {
  const double dead = curve.dead_time_s + 0.5 * sample_time_s, lag = curve.time_constant_s;
  PiGains g;
  g.proportional = lag / (gain * 2.0 * dead);
  g.integral = g.proportional * sample_time_s / std::min(lag, 8.0 * dead);
  return g;
}

/// The output's answer to moves beside those of the record; behind the last value known the
/// response goes on as it ended, so that an integrator remains one.
class ResponseTo {
 public:
  explicit ResponseTo(const std::vector<double>& step) {
    for (std::size_t i = 0; i < step.size(); ++i)
      impulse_.push_back(step[i] - (i > 0 ? step[i - 1] : 0.0));
    const std::size_t n = impulse_.size();
    if (n > 1 && impulse_[n - 2] != 0.0)
      keep_ = std::clamp(impulse_[n - 1] / impulse_[n - 2], 0.0, 1.0);
  }
  /// Before the move of this sample.
  double value() {
    double sum = 0.0;
    const std::size_t n = impulse_.size(), k = moves_.size();
    for (std::size_t i = 0; i < std::min(n, k); ++i) sum += impulse_[i] * moves_[k - 1 - i];
    if (k > n) tail_ = keep_ * (tail_ + impulse_[n - 1] * moves_[k - 1 - n]);
    return sum + tail_;
  }
  void add(double move) { moves_.push_back(move); }

 private:
  std::vector<double> impulse_, moves_;
  double keep_{}, tail_{};
};

}  // namespace

double errorUnderPi(const RecordedLoop& loop, const StepResponse& tuned_for,
                    const StepResponse& response) {
  const ReactionCurve curve = reactionCurve(tuned_for);
  if (!std::isfinite(curve.dead_time_s) || !std::isfinite(reactionCurve(response).dead_time_s))
    return kNaN;
  // the record at the samples of a response that is coarser
  const auto factor = static_cast<Eigen::Index>(
      std::max(1.0, std::round(response.sample_time_s / loop.sample_time_s)));
  const double Ts = loop.sample_time_s * static_cast<double>(factor);
  const std::vector<double> e = newestOf(blockMeans(loop.error, factor)),
                            u = newestOf(blockMeans(loop.u, factor)),
                            judged = newestOf(blockMeans(loop.judged, factor));
  const PiGains pi = simcGains(curve, tuned_for.value.back(), Ts);
  ResponseTo answer(sampledAt(response, Ts));
  std::vector<double> under(e.size(), kNaN);
  double integral = 0.0;
  bool in_charge = false;
  for (std::size_t k = 0; k < e.size(); ++k) {
    const double changed = answer.value();
    if (!std::isfinite(e[k]) || !std::isfinite(u[k])) {
      answer.add(0.0);
      in_charge = false;
      continue;
    }
    under[k] = e[k] + changed;
    if (!in_charge) integral = u[k] + pi.proportional * under[k];
    in_charge = true;
    integral -= pi.integral * under[k];
    const double asked = integral - pi.proportional * under[k];
    const double sent = std::clamp(asked, loop.u_lower, loop.u_upper);
    integral += sent - asked;
    answer.add(sent - u[k]);
  }
  std::vector<double> before = e;
  for (std::size_t k = 0; k < e.size(); ++k)
    if (!std::isfinite(judged[k])) before[k] = under[k] = kNaN;
  if (finiteOnly(under).size() < kFewestJudged) return kNaN;
  const double ratio = stdOf(under) / stdOf(before);
  return std::isfinite(ratio) ? ratio : kNaN;
}

}  // namespace fpc
