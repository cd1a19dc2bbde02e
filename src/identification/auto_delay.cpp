#include "identification/auto_delay.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr int kNear = 10;           // samples that are looked at first
constexpr double kAlike = 1.005;    // two delays within it are not told apart
constexpr double kFarWorth = 0.97;  // of the free-run error: what a delay beyond kNear must reach
constexpr std::array<double, 8> kPoles{0.0, 0.5, 0.7, 0.8, 0.9, 0.95, 0.98, 0.99};

/// Mean squared one-step error of y(k), y(k-1) and u_j(k - d_j), u_j(k - d_j - 1) for all j, from
/// where even the longest delay has a past.
double oneStepError(const AutoData& p, const std::vector<int>& delay, Index longest) {
  const Index m = static_cast<Index>(delay.size()), q = 3 + 2 * m;
  const Index n_y = static_cast<Index>(p.data->outputs.size());
  Matrix H = 1e-6 * Matrix::Identity(q, q);
  Vector g = Vector::Zero(q), x(q);
  double yy = 0.0, n = 0.0;
  for (const auto& w : p.windows)
    for (Index k = std::max(w.first, longest) + 1; k + 1 < w.last; ++k) {
      x[0] = p.y(k), x[1] = p.y(k - 1), x[2] = 1.0;
      for (Index j = 0; j < m; ++j)
        for (Index lag = 0; lag < 2; ++lag)
          x[3 + 2 * j + lag] =
              p.scaled(std::max<Index>(k - delay[static_cast<std::size_t>(j)] - lag, 0), n_y + j);
      const double y = p.y(k + 1);
      if (!x.allFinite() || !std::isfinite(y)) continue;
      H.selfadjointView<Eigen::Lower>().rankUpdate(x);
      g += x * y;
      yy += y * y, n += 1.0;
    }
  if (n == 0.0) return 0.0;
  const Vector theta = H.selfadjointView<Eigen::Lower>().ldlt().solve(g);
  return std::max(yy - g.dot(theta), 0.0) / n;
}

void guessNear(const AutoData& p, int longest, double worth, DelayGuess& guess) {
  const std::size_t m = guess.delay.size();
  double best = oneStepError(p, guess.delay, longest);
  for (int pass = 0; pass < 2; ++pass)
    for (std::size_t j = 0; j < m; ++j) {
      if (p.isLeftOut(j)) continue;
      std::vector<double> errors;
      auto trial = guess.delay;
      for (trial[j] = 0; trial[j] <= longest; ++trial[j])
        errors.push_back(oneStepError(p, trial, longest));
      const auto lowest = std::min_element(errors.begin(), errors.end());
      if (*lowest < worth * best) {
        guess.delay[j] = static_cast<int>(lowest - errors.begin());
        best = *lowest;
      }
      const double chosen = errors[static_cast<std::size_t>(guess.delay[j])];
      guess.doubt[j] = false;
      for (std::size_t d = 0; d < errors.size(); ++d)
        if (std::abs(static_cast<int>(d) - guess.delay[j]) > 1 && errors[d] < kAlike * chosen &&
            errors.front() > 1.02 * chosen)
          guess.doubt[j] = true;
    }
}

/// Longer delays where they are worth as much more.
std::vector<int> guessFar(const AutoData& p, std::vector<int> delay, int near, int longest,
                          double worth) {
  double best = oneStepError(p, delay, longest);
  for (std::size_t j = 0; j < delay.size(); ++j) {
    if (p.isLeftOut(j)) continue;
    auto trial = delay;
    for (trial[j] = near + 1; trial[j] <= longest; ++trial[j]) {
      const double error = oneStepError(p, trial, longest);
      if (!(error < (delay[j] > near ? 1.0 : worth) * best)) continue;
      delay[j] = trial[j];
      best = error;
    }
  }
  return delay;
}

/// First-order lag of an input: x(k + 1) = a x(k) + (1 - a) u(k); starts again after a gap.
Vector lagged(const Eigen::Ref<const Vector>& u, double pole) {
  Vector x = Vector::Constant(u.size(), kNaN);
  double state = kNaN;
  for (Index k = 0; k + 1 < u.size(); ++k) {
    state = std::isfinite(state) ? pole * state + (1.0 - pole) * u[k] : u[k];
    x[k + 1] = state;
  }
  return x;
}

struct Lag {
  int delay{};
  double error{};  ///< mean squared, of what the others leave
  Vector part;     ///< what the lag says of y
};

/// The best b x(k - delay) + c for `rest`, delays `from`..`to`; judged where `longest` has a past.
Lag bestLag(const Vector& rest, const std::vector<Vector>& filtered, int from, int to,
            Index longest) {
  Lag best{from, kInfinity, Vector()};
  for (const Vector& x : filtered)
    for (int d = from; d <= to; ++d) {
      double n = 0.0, sx = 0.0, sy = 0.0, xx = 0.0, yy = 0.0, xy = 0.0;
      for (Index k = longest + 1; k < rest.size(); ++k) {
        const double a = x[k - d], y = rest[k];
        if (!std::isfinite(a) || !std::isfinite(y)) continue;
        n += 1.0, sx += a, sy += y, xx += a * a, yy += y * y, xy += a * y;
      }
      if (n < 10.0) continue;
      const double vx = xx - sx * sx / n, vxy = xy - sx * sy / n, vy = yy - sy * sy / n;
      const double slope = vx > 1e-9 * n ? vxy / vx : 0.0, error = (vy - slope * vxy) / n;
      if (!(error < best.error)) continue;
      best.delay = d;
      best.error = error;
      best.part = Vector::Constant(x.size(), kNaN);
      for (Index k = d; k < x.size(); ++k) best.part[k] = slope * (x[k - d] - sx / n) + sy / n;
    }
  return best;
}

/// Delays of first-order lags whose sum runs freely beside y, one signal after the other.
std::vector<int> freeRunDelays(const AutoData& p, int near, int longest) {
  const auto n_y = static_cast<Index>(p.data->outputs.size());
  const Index rows = std::min<Index>(p.scaled.rows(), 4000);
  const Vector y = p.scaled.col(p.output).head(rows);
  const Index m = p.scaled.cols() - n_y;
  std::vector<int> delay(static_cast<std::size_t>(m), 0);
  std::vector<Vector> parts(delay.size(), Vector::Zero(rows));
  for (int pass = 0; pass < 2; ++pass)
    for (std::size_t j = 0; j < delay.size(); ++j) {
      if (p.isLeftOut(j)) continue;
      Vector rest = y;
      for (std::size_t i = 0; i < parts.size(); ++i)
        if (i != j) rest -= parts[i];
      std::vector<Vector> filtered;
      for (const double pole : kPoles)
        filtered.push_back(lagged(p.scaled.col(n_y + static_cast<Index>(j)).head(rows), pole));
      Lag lag = bestLag(rest, filtered, 0, near, longest);
      if (longest > near) {
        Lag late = bestLag(rest, filtered, near + 1, longest, longest);
        if (std::sqrt(late.error) < kFarWorth * std::sqrt(lag.error)) lag = std::move(late);
      }
      if (lag.part.size() == 0) continue;
      delay[j] = lag.delay;
      parts[j] = lag.part.array().isFinite().select(lag.part, 0.0);
    }
  return delay;
}

}  // namespace

DelayGuess guessDelays(const AutoData& p, int longest) {
  // a delay must lower the error by more than chance does
  const double worth = 1.0 - std::max(0.03, 10.0 / static_cast<double>(p.scaled.rows()));
  const std::size_t m = p.data->inputs.size() + p.data->disturbances.size();
  DelayGuess guess{std::vector<int>(m, 0), std::vector<bool>(m, false), {}};
  const int near = std::min<int>({kNear, longest, static_cast<int>(p.data->rows() / 20)});
  guessNear(p, near, worth, guess);
  if (longest <= near) return guess;
  const std::vector<int> far = guessFar(p, guess.delay, near, longest, worth);
  const std::vector<int> free = freeRunDelays(p, near, longest);
  std::vector<int> running = far;
  for (std::size_t j = 0; j < m; ++j)
    if (free[j] > near) running[j] = free[j];
  guess.longer = {far, running};
  return guess;
}

std::vector<DelayGuess> guessDelaysByBlock(const AutoData& p, int longest, int threads) {
  std::vector<DelayGuess> guesses(p.windows.size());
  parallelFor(guesses.size(), threads, [&](std::size_t b) {
    AutoData seen = p;
    const Stretch w = p.windows[b];
    seen.scaled.col(p.output).segment(w.first, w.last - w.first).setConstant(kNaN);
    guesses[b] = guessDelays(seen, longest);
  });
  return guesses;
}

std::vector<int> earliestDelays(const AutoData& p, const std::vector<int>& delay) {
  constexpr Index kOwn = 4, kBehind = 6;
  constexpr double kSurely = 5.0;  // standard errors
  std::vector<int> earliest = delay;
  const auto n_y = static_cast<Index>(p.data->outputs.size());
  std::vector<Index> causes, lags;
  Index q = kOwn + 1, longest = kOwn;
  for (std::size_t j = 0; j < delay.size(); ++j) {
    if (p.isLeftOut(j)) continue;
    causes.push_back(static_cast<Index>(j));
    lags.push_back(delay[j] + kBehind);
    q += lags.back();
    longest = std::max(longest, lags.back());
  }
  Matrix H = 1e-6 * Matrix::Identity(q, q);
  Vector g = Vector::Zero(q), x(q);
  double squares = 0.0, n = 0.0;
  for (const auto& w : p.windows)
    for (Index k = w.first + longest; k + 1 < w.last; ++k) {
      Index at = 0;
      x[at++] = 1.0;
      for (Index lag = 0; lag < kOwn; ++lag) x[at++] = p.y(k - lag);
      for (std::size_t c = 0; c < causes.size(); ++c)
        for (Index lag = 0; lag < lags[c]; ++lag) x[at++] = p.scaled(k - lag, n_y + causes[c]);
      if (!x.allFinite() || !std::isfinite(p.y(k + 1))) continue;
      H.selfadjointView<Eigen::Lower>().rankUpdate(x);
      g += x * p.y(k + 1);
      squares += p.y(k + 1) * p.y(k + 1);
      n += 1.0;
    }
  if (n < 3.0 * static_cast<double>(q)) return earliest;
  const Matrix inverse = H.selfadjointView<Eigen::Lower>().ldlt().solve(Matrix::Identity(q, q));
  const Vector theta = inverse * g;
  const double variance = std::max(squares - g.dot(theta), 0.0) / (n - static_cast<double>(q));
  Index at = 1 + kOwn;
  for (std::size_t c = 0; c < causes.size(); at += lags[c], ++c) {
    int& own = earliest[static_cast<std::size_t>(causes[c])];
    for (int d = own - 1; d >= 0; --d)
      if (std::abs(theta[at + d]) > kSurely * std::sqrt(variance * inverse(at + d, at + d)))
        own = d;
  }
  return earliest;
}

bool DelayGuess::isOpen() const {
  return std::any_of(longer.begin(), longer.end(), [this](const auto& d) { return d != delay; });
}

}  // namespace fpc
