#include "runtime/commissioning/plant_test.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/random.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr Index kFirstFit = 40;           // rows of the test
constexpr double kNextFit = 1.25;         // the next one after so many times as many rows
constexpr double kFirstAmplitude = 0.01;  // of an input's range
constexpr double kMostAmplitude = 0.25;
constexpr double kGrowth = 2.0;  // of an amplitude between two fits
// Of an input that has not been seen to act: not faster than the record, since an effect may still
// be on its way. Of plants drawn as in plant_test_test.cpp 7 of 60 left a limit with 2, with this 4
// of 120 and 1 of 60 new ones. Were unsure effects to wait too, tests would lack moves.
constexpr double kBlindGrowth = kNextFit;
constexpr double kRoomShare = 0.5;   // of the distance to a limit that the levels may use
constexpr double kSignal = 8.0;      // effect asked for, in deviations of the output
constexpr double kMostUnsure = 0.5;  // of a gain, that it may be used with its bound
constexpr double kLastPart = 0.1;    // of the room, in which no step is made towards a limit
constexpr double kNoises = 3.0;      // kept from a limit
constexpr double kHalfway = 0.5;     // of the room: without a model levels are left out beyond
constexpr Index kLongestAhead = 150, kShortestAhead = 5;
constexpr int kShortestDwell = 2;
constexpr double kFirstDwell = 25.0;                   // longest, samples, while nothing is known
constexpr double kShortDwell = 0.1, kLongDwell = 0.8;  // of the settling time
constexpr double kSettlings = 5.0;                     // that a test lasts at least
constexpr double kDeadTime = 0.25;  // of dead time and lags: bound asked of the dead time
constexpr double kMatters = 0.3;    // of an output's largest gain: dead times that matter
constexpr int kTwice = 2;           // fits in a row that are good enough
constexpr double kListen = 0.5;     // of the time left: for disturbances that have not moved yet

}  // namespace

const char* wordOf(TestEnd end) {
  switch (end) {
    case TestEnd::kEnough:
      return "enough";
    case TestEnd::kTime:
      return "time";
    case TestEnd::kNeedsLoop:
      return "needs_loop";
    default:
      return "none";
  }
}

template <typename Input>
double PlantTest::Track::next(Index k, const std::vector<double>& before,
                              const Input& input) const {
  double value = 0.0;
  for (std::size_t i = 0; i < sampled.b.size(); ++i) {
    const Index at = k - 1 - sampled.delay - static_cast<Index>(i);
    if (at >= 0) value += sampled.b[i] * input(at);
  }
  for (std::size_t i = 1; i < a.size() && i <= before.size(); ++i)
    value -= a[i] * before[before.size() - i];
  return value;
}

PlantTest::PlantTest(PlantTestParams params, PlantRecord watched)
    : params_(std::move(params)),
      record_(std::move(watched)),
      watched_rows_(record_.rows()),
      next_fit_(kFirstFit),
      n_y_(params_.lower.size()),
      n_u_(params_.start_input.size()),
      last_row_(params_.most_rows),
      sent_(params_.start_input),
      last_output_(params_.hold),
      engine_(seededEngine(params_.seed, {11})) {
  require(params_.upper.size() == n_y_ && params_.hold.size() == n_y_ &&
              params_.noise.size() == n_y_ && params_.deviation.size() == n_y_,
          "test", "a limit, a setpoint and a noise for each output");
  params_.limits.validate(n_u_);
  span_ = params_.limits.upper - params_.limits.lower;
  for (Index j = 0; j < n_u_; ++j)
    if (!std::isfinite(span_[j])) span_[j] = 100.0 * params_.limits.move[j];
  amplitude_ = kFirstAmplitude * span_;
  room_ = (params_.upper - params_.hold).cwiseMin(params_.hold - params_.lower);
  level_.assign(static_cast<std::size_t>(n_u_), 0);
  left_.assign(static_cast<std::size_t>(n_u_), 0);
  tracks_.resize(static_cast<std::size_t>(n_y_ * n_u_));
  ahead_.resize(static_cast<std::size_t>(3 * n_u_));
  if (record_.rows() > 0) sent_ = record_.inputs().row(record_.rows() - 1).transpose();
}

double PlantTest::effect(const ElementEstimate& e) const {
  const double hold_s = kLongDwell * std::max(settling_, record_.info().sample_time_s);
  const double gain = std::abs(e.element.gain);
  if (e.element.integrating) return gain * hold_s;
  if (e.element.time_constant < 0.0)
    return gain * std::expm1(std::min(1.0, hold_s / -e.element.time_constant));
  return gain;
}

void PlantTest::add(const Measurement& now, VectorRef sent) {
  record_.add(now, sent);
  sent_ = sent;
  if (end_ == TestEnd::kNone && rows() >= next_fit_) {
    next_fit_ = static_cast<Index>(std::ceil(kNextFit * static_cast<double>(rows())));
    know();
    if (!fits_.empty()) {
      judge();
      setAmplitudes();
    } else {
      amplitude_ = (kBlindGrowth * amplitude_).cwiseMin(kMostAmplitude * span_);
    }
  }
  if (end_ == TestEnd::kNone && rows() >= last_row_) {
    know();
    if (!fits_.empty()) judge();
    if (end_ == TestEnd::kNone) end_ = tested_ > 0 ? TestEnd::kEnough : TestEnd::kTime;
    if (fits_.empty()) reason_ = "no input was seen to move an output";
  }
}

/// Fits all outputs to what has been seen; one that cannot be fitted stays as it was.
void PlantTest::know() {
  const Matrix inputs = record_.inputsAndDisturbances();
  std::vector<ProcessFit> fits;
  ProcessFitParams p;
  p.ensemble = 0;
  p.passing = true;
  p.seed = params_.seed;
  for (Index i = 0; i < n_y_; ++i) {
    try {
      fits.push_back(fitProcess(inputs, record_.outputs().col(i), record_.info().sample_time_s, p));
    } catch (const InputError&) {
      if (fits_.empty()) return;
      fits.push_back(fits_[static_cast<std::size_t>(i)]);  // what is known of it
    }
  }
  fits_ = std::move(fits);
  settling_ = dead_time_ = 0.0;
  for (Index i = 0; i < n_y_; ++i)
    for (Index j = 0; j < n_u_; ++j) {
      const ElementEstimate& e =
          fits_[static_cast<std::size_t>(i)].elements[static_cast<std::size_t>(j)];
      const double longest = record_.info().sample_time_s * static_cast<double>(record_.rows());
      if (e.seen && e.gain_bound < std::abs(e.element.gain)) {
        settling_ = std::max(settling_, std::min(e.element.settling(), longest));
        dead_time_ = std::max(dead_time_, std::min(e.element.dead_time, longest));
      }
      Track& t = tracks_[static_cast<std::size_t>(i * n_u_ + j)];
      t.seen = e.seen && fits_[static_cast<std::size_t>(i)].kind != ProcessKind::kUnstable;
      if (!t.seen) continue;
      t.sampled = sampled(e.element, record_.info().sample_time_s);
      t.a = product(t.sampled.own, t.sampled.shared);
      t.margin = std::min(1.0, e.gain_bound / std::abs(e.element.gain));
      // An integrator is at rest near the mean of its input, wherever that began.
      t.rest = e.element.integrating ? fits_[static_cast<std::size_t>(i)].input[j]
                                     : record_.inputs()(0, j);
      t.w.assign(1, 0.0);
    }
  follow();
}

/// Responses up to the present sample.
void PlantTest::follow() {
  const auto& u = record_.inputs();
  for (Index i = 0; i < n_y_; ++i)
    for (Index j = 0; j < n_u_; ++j) {
      Track& t = tracks_[static_cast<std::size_t>(i * n_u_ + j)];
      if (!t.seen) continue;
      const auto input = [&](Index k) { return u(k, j) - t.rest; };
      while (static_cast<Index>(t.w.size()) <= record_.rows())
        t.w.push_back(t.next(static_cast<Index>(t.w.size()), t.w, input));
    }
}

/// Changes of the outputs from now on, for each input at each of its levels.
void PlantTest::predict(const Vector& present) {
  const double Ts = record_.info().sample_time_s;
  // Past all dead times and the way to a level.
  const double ramp = (2.0 * amplitude_).cwiseQuotient(params_.limits.move).maxCoeff(),
               lags = (params_.closed ? 0.5 : 1.0) * std::max(settling_ - dead_time_, 0.0);
  const Index H = static_cast<Index>(std::clamp<double>(std::ceil((dead_time_ + lags) / Ts + ramp),
                                                        kShortestAhead, kLongestAhead));
  const auto& u = record_.inputs();
  const Index now = record_.rows();  // of the sample that is answered
  for (Index j = 0; j < n_u_; ++j)
    for (int level = -1; level <= 1; ++level) {
      Matrix& ahead = ahead_[static_cast<std::size_t>(3 * j + level + 1)];
      ahead.setZero(n_y_, H);
      Vector planned(H);
      double at = sent_[j];
      const double aim = std::clamp(present[j] + level * amplitude_[j], params_.limits.lower[j],
                                    params_.limits.upper[j]);
      for (Index h = 0; h < H; ++h)
        planned[h] = at += std::clamp(aim - at, -params_.limits.move[j], params_.limits.move[j]);
      for (Index i = 0; i < n_y_; ++i) {
        const Track& t = tracks_[static_cast<std::size_t>(i * n_u_ + j)];
        if (!t.seen) continue;
        const auto input = [&](Index k) {
          return (k >= now ? planned[k - now] : u(k, j)) - t.rest;
        };
        const auto known = static_cast<Index>(t.w.size());
        std::vector<double> w(t.w.end() - std::min<Index>(known, countOf(t.a)), t.w.end());
        for (Index h = 0; h < H; ++h) {
          w.push_back(t.next(known + h, w, input));
          ahead(i, h) = w.back() - t.w.back();
        }
      }
    }
}

/// By how much each output would leave its limits under these levels, in parts of the room.
Vector PlantTest::excess(const std::vector<int>& levels) const {
  const Index H = ahead_.front().cols();
  Matrix change = Matrix::Zero(n_y_, H), bound = change;
  for (Index j = 0; j < n_u_; ++j) {
    const Matrix& ahead =
        ahead_[static_cast<std::size_t>(3 * j + levels[static_cast<std::size_t>(j)] + 1)];
    change += ahead;
    for (Index i = 0; i < n_y_; ++i)
      bound.row(i) +=
          tracks_[static_cast<std::size_t>(i * n_u_ + j)].margin * ahead.row(i).cwiseAbs();
  }
  Vector excess(n_y_);
  for (Index i = 0; i < n_y_; ++i) {
    const double kept = kNoises * params_.noise[i] + kLastPart * room_[i];
    const double highest = last_output_[i] + (change + bound).row(i).maxCoeff(),
                 lowest = last_output_[i] + (change - bound).row(i).minCoeff(),
                 up = highest - (params_.upper[i] - kept), down = params_.lower[i] + kept - lowest;
    excess[i] = std::max({up, down, 0.0}) / room_[i];
  }
  return excess;
}

/// What no level keeps inside its limits may be moved by inputs of which not even the direction is
/// known: they are left to the control in charge.
void PlantTest::leaveUnsure(std::vector<int>& levels) const {
  const Vector left = excess(levels);
  for (Index i = 0; i < n_y_; ++i)
    for (Index j = 0; j < n_u_ && left[i] > 0.0; ++j) {
      const Track& t = tracks_[static_cast<std::size_t>(i * n_u_ + j)];
      if (!t.seen || t.margin >= 1.0) levels[static_cast<std::size_t>(j)] = 0;
    }
}

/// An output of which nothing is known that could be predicted is halfway to a limit.
bool PlantTest::nearLimitUnknown() const {
  for (Index i = 0; i < n_y_; ++i) {
    const auto first = tracks_.begin() + i * n_u_;
    if (std::none_of(first, first + n_u_,
                     [](const Track& t) { return t.seen && t.margin < kMostUnsure; }) &&
        std::abs(last_output_[i] - params_.hold[i]) > kHalfway * room_[i])
      return true;
  }
  return false;
}

Vector PlantTest::sent(const std::vector<int>& levels, const Vector& present,
                       VectorRef previous) const {
  Vector u(n_u_);
  for (Index j = 0; j < n_u_; ++j)
    u[j] = present[j] + levels[static_cast<std::size_t>(j)] * amplitude_[j];
  params_.limits.clip(u, previous);
  return u;
}

const Vector& PlantTest::choose(const Measurement& now, const Vector& present) {
  for (Index i = 0; i < n_y_; ++i)
    if (std::isfinite(now.outputs[i])) last_output_[i] = now.outputs[i];
  record_.fillTo(now.header);
  follow();
  if (tested_ > 0) return sent_ = sent(level_, present, sent_);
  const double Ts = record_.info().sample_time_s;
  const double longest = settling_ > 0.0 ? std::max(kLongDwell * settling_ / Ts, 3.0) : kFirstDwell;
  const double shortest = std::max<double>(kShortestDwell, kShortDwell * settling_ / Ts);
  std::vector<int> asked = level_;
  for (std::size_t j = 0; j < asked.size(); ++j) {
    if (left_[j]-- > 0) continue;
    asked[j] = uniform(engine_) < 0.5 ? -1 : 1;
    const double ratio = std::max(longest / shortest, 1.0);
    left_[j] = static_cast<int>(std::lround(shortest * std::pow(ratio, uniform(engine_)))) - 1;
  }
  std::vector<int> taken = asked;
  if (nearLimitUnknown()) {
    std::fill(taken.begin(), taken.end(), 0);
  } else if (std::any_of(tracks_.begin(), tracks_.end(), [](const Track& t) { return t.seen; })) {
    predict(present);
    double least = excess(taken).sum();
    // The input that helps most is turned, or left out, until no limit is left any more.
    for (std::size_t round = 0; round < taken.size() && least > 0.0; ++round) {
      std::vector<int> best = taken;
      for (std::size_t j = 0; j < taken.size(); ++j)
        for (int level = -1; level <= 1; ++level) {
          std::vector<int> other = taken;
          other[j] = level;
          const double value = excess(other).sum();
          if (value < least - 1e-12) {
            least = value;
            best = other;
          }
        }
      if (best == taken) break;
      taken = best;
    }
    if (least > 0.0) leaveUnsure(taken);
  }
  if (taken != asked) ++turned_;
  level_ = taken;
  return sent_ = sent(taken, present, sent_);
}

/// Heights for what is to be seen beside the noise, within the room of the limits.
void PlantTest::setAmplitudes() {
  for (Index j = 0; j < n_u_; ++j) {
    double asked_for = 0.0, most = kMostAmplitude * span_[j];
    bool known = false, seen = false;
    for (Index i = 0; i < n_y_; ++i) {
      const ElementEstimate& e =
          fits_[static_cast<std::size_t>(i)].elements[static_cast<std::size_t>(j)];
      const double unit = effect(e), gain = std::abs(e.element.gain);
      const double share = gain > 0.0 ? std::min(1.0, e.gain_bound / gain) : 0.0;
      // All inputs together may use the room.
      const double worst = gain > 0.0 ? unit * (1.0 + share) : e.gain_bound;
      if (worst > 0.0 && std::isfinite(worst))
        most = std::min(most, kRoomShare *
                                  std::max(room_[i] - kNoises * params_.noise[i], 0.1 * room_[i]) /
                                  (worst * std::sqrt(static_cast<double>(n_u_))));
      seen = seen || (e.seen && e.gain_bound < gain);
      if (!e.seen || e.gain_bound > kMostUnsure * gain) continue;
      const double asked = kSignal * std::max(params_.deviation[i], params_.noise[i]) / unit;
      asked_for = known ? std::min(asked_for, asked) : asked;
      known = true;
    }
    if (!known) asked_for = (seen ? kGrowth : kBlindGrowth) * amplitude_[j];
    asked_for = std::max(asked_for, kFirstAmplitude * span_[j]);
    amplitude_[j] = std::min({asked_for, most, kGrowth * amplitude_[j]});
  }
}

/// Are gains and delays known well enough? If not, which input needs more.
void PlantTest::judge() {
  const auto unheld = std::find_if(fits_.begin(), fits_.end(),
                                   [this](const ProcessFit& fit) { return needsLoop(fit); });
  unheld_ = unheld == fits_.end() ? 0 : unheld_ + 1;
  if (unheld_ >= kTwice) {
    const auto i = static_cast<std::size_t>(unheld - fits_.begin());
    end_ = TestEnd::kNeedsLoop;
    reason_ = record_.info().outputs[i].name +
              (unheld->kind == ProcessKind::kUnstable ? " is unstable" : " integrates") +
              ": the loop file needs a controller that holds it while it is tested";
    return;
  }
  const double Ts = record_.info().sample_time_s;
  double worst = 0.0;
  std::string why;
  const auto need = [&](double ratio, Index i, Index j, const std::string& what) {
    if (ratio <= worst) return;
    worst = ratio;
    const auto& info = record_.info();
    why = what + " from " + info.inputs[static_cast<std::size_t>(j)].name + " to " +
          info.outputs[static_cast<std::size_t>(i)].name + " is known to " + shortText(ratio) +
          " times the bound asked for: " + info.inputs[static_cast<std::size_t>(j)].name +
          " needs more";
  };
  for (Index i = 0; i < n_y_; ++i) {
    const ProcessFit& fit = fits_[static_cast<std::size_t>(i)];
    double largest = 0.0;
    for (Index j = 0; j < n_u_; ++j)
      largest = std::max(
          largest, std::abs(fit.elements[static_cast<std::size_t>(j)].element.gain) * span_[j]);
    for (Index j = 0; j < n_u_; ++j) {
      const ElementEstimate& e = fit.elements[static_cast<std::size_t>(j)];
      const double allowed = params_.gain_tolerance * largest;
      need(allowed > 0.0 ? e.gain_bound * span_[j] / allowed : 1e9, i, j, "the gain");
      if (!e.seen || std::abs(e.element.gain) * span_[j] < kMatters * largest) continue;
      const double allowed_time = kDeadTime * (e.element.dead_time + e.element.lags());
      need(e.dead_time_bound / std::max(Ts, allowed_time), i, j, "the dead time");
    }
  }
  const bool long_enough =
      settling_ > 0.0 && static_cast<double>(rows()) * Ts >= kSettlings * settling_;
  enough_ = worst <= 1.0 && long_enough && unheld_ == 0 ? enough_ + 1 : 0;
  if (tested_ == 0) {
    reason_ = why;
    if (enough_ < kTwice) return;
    reason_ = "gains and dead times are within the bounds asked for";
    tested_ = rows();
    last_row_ = tested_ + static_cast<Index>(kListen * static_cast<double>(last_row_ - tested_));
    std::fill(level_.begin(), level_.end(), 0);
  }
  if (knowsDisturbances()) end_ = TestEnd::kEnough;
}

/// A slow load looks like an integrator while gains are unsure.
bool PlantTest::needsLoop(const ProcessFit& fit) const {
  return !params_.closed && fit.kind != ProcessKind::kStable && rows() >= 2 * kFirstFit &&
         std::any_of(fit.elements.begin(), fit.elements.begin() + n_u_,
                     [](const ElementEstimate& e) {
                       return e.seen && e.gain_bound < kMostUnsure * std::abs(e.element.gain);
                     });
}

/// Each measured disturbance was seen to act on an output.
bool PlantTest::knowsDisturbances() const {
  const auto columns = fits_.front().elements.size();
  for (std::size_t d = static_cast<std::size_t>(n_u_); d < columns; ++d) {
    const bool seen = std::any_of(fits_.begin(), fits_.end(), [&](const ProcessFit& fit) {
      const ElementEstimate& e = fit.elements[d];
      return e.seen && e.gain_bound < kMostUnsure * std::abs(e.element.gain);
    });
    if (!seen) return false;
  }
  return true;
}

}  // namespace fpc
