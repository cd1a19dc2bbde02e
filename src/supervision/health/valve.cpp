#include "supervision/health/valve.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/order_statistics.hpp"
#include "supervision/health/finite_runs.hpp"

namespace fpc {
namespace {

constexpr int kPastOutputs = 10;
constexpr double kMemories[] = {6.0, 15.0, 40.0, 100.0};  // of smoothed pasts [means]
constexpr int kSmoothed = 2 * static_cast<int>(std::size(kMemories));
constexpr double kBands[] = {0.1, 0.15, 0.2, 0.27, 0.35, 0.45, 0.55, 0.65, 0.75, 0.85, 0.92, 1.0};
constexpr double kLeastF = 8.5, kLeastValveShare = 0.05, kLeastJumpF = 10.0;
constexpr Eigen::Index kFewest = 1000;
constexpr int kFewestTurns = 10;

template <typename Valve>
std::vector<double> positions(const std::vector<double>& signal, double band, double jump) {
  Valve valve(band, jump);
  std::vector<double> x(signal.size(), kNaN);
  for (std::size_t k = 0; k < signal.size(); ++k)
    if (std::isfinite(signal[k])) x[k] = valve.move(signal[k]);
  return x;
}

/// Exponential means of a series about its mean; holes keep what there was.
std::vector<double> smoothed(const std::vector<double>& values, double mean, double memory) {
  std::vector<double> result(values.size());
  double state = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (std::isfinite(values[k])) state += (values[k] - mean - state) / memory;
    result[k] = state;
  }
  return result;
}

/// Rows of past outputs, past signals, their exponential means and a one; what they leave of y, and
/// what of valve positions they do not explain.
class ValveRegression {
 public:
  ValveRegression(const std::vector<double>& signal, const std::vector<double>& y, int lags)
      : lags_(lags) {
    const auto size = static_cast<Eigen::Index>(y.size());
    const Eigen::Index past = std::max<Eigen::Index>(kPastOutputs, lags);
    Eigen::Index run = 0;
    for (Eigen::Index k = 0; k < size; ++k) {
      const auto at = static_cast<std::size_t>(k);
      run = std::isfinite(y[at]) && std::isfinite(signal[at]) ? run + 1 : 0;
      if (run > past) rows_.push_back(k);
    }
    const int own = kPastOutputs + lags;
    base_.resize(static_cast<Eigen::Index>(rows_.size()), own + kSmoothed + 1);
    target_.resize(base_.rows());
    const double mean_y = meanOf(y), mean_u = meanOf(signal);
    std::vector<std::vector<double>> smooth;
    for (const double memory : kMemories) {
      smooth.push_back(smoothed(y, mean_y, memory));
      smooth.push_back(smoothed(signal, mean_u, memory));
    }
    for (Eigen::Index r = 0; r < base_.rows(); ++r) {
      const auto k = static_cast<std::size_t>(rows_[static_cast<std::size_t>(r)]);
      target_[r] = y[k] - mean_y;
      for (int i = 0; i < kPastOutputs; ++i)
        base_(r, i) = y[k - static_cast<std::size_t>(i) - 1] - mean_y;
      for (int i = 0; i < lags; ++i)
        base_(r, kPastOutputs + i) = signal[k - static_cast<std::size_t>(i) - 1] - mean_u;
      for (int i = 0; i < kSmoothed; ++i)
        base_(r, own + i) = smooth[static_cast<std::size_t>(i)][k - 1];
      base_(r, own + kSmoothed) = 1.0;
    }
    scale(base_);
    Matrix normal = base_.transpose() * base_;
    normal.diagonal().array() += 1e-9 * static_cast<double>(std::max<Eigen::Index>(1, rows()));
    solver_.compute(normal);
    target_ -= base_ * solver_.solve(base_.transpose() * target_);
    left_ = target_.squaredNorm();
  }

  Eigen::Index rows() const { return base_.rows(); }
  Eigen::Index unknowns() const { return base_.cols() + lags_; }
  double left() const { return left_; }

  /// Squares that are left when positions of the valve are known too.
  double leftWith(const std::vector<double>& x) const {
    Matrix add(rows(), lags_);
    addPast(x, 0, add);
    return leftBy(add);
  }

  /// The mean square that is left, per degree of freedom, when the answer may bend smoothly:
  /// squares and cubes of the signal, products with the output.
  double smoothVariance(const std::vector<double>& signal, const std::vector<double>& y) const {
    Matrix add(rows(), 3 * lags_);
    const double mean_u = meanOf(signal), mean_y = meanOf(y);
    std::vector<double> square(signal.size()), cube(signal.size()), product(signal.size());
    for (std::size_t k = 0; k < signal.size(); ++k) {
      const double u = signal[k] - mean_u;
      square[k] = u * u;
      cube[k] = u * u * u;
      product[k] = u * (y[k] - mean_y);
    }
    addPast(square, 0, add);
    addPast(cube, lags_, add);
    addPast(product, 2 * lags_, add);
    return leftBy(add) / static_cast<double>(rows() - base_.cols() - add.cols());
  }

 private:
  void addPast(const std::vector<double>& x, Eigen::Index column, Matrix& add) const {
    const double mean = meanOf(x);
    for (Eigen::Index r = 0; r < rows(); ++r) {
      const auto k = static_cast<std::size_t>(rows_[static_cast<std::size_t>(r)]);
      for (int i = 0; i < lags_; ++i)
        add(r, column + i) = x[k - static_cast<std::size_t>(i) - 1] - mean;
    }
  }

  double leftBy(Matrix& add) const {
    scale(add);
    add -= base_ * solver_.solve(base_.transpose() * add);
    Matrix normal = add.transpose() * add;
    normal.diagonal().array() += 1e-6 * static_cast<double>(rows());
    const Vector cross = add.transpose() * target_;
    return std::max(1e-12 * left_, left_ - cross.dot(normal.ldlt().solve(cross)));
  }

  static void scale(Matrix& columns) {
    for (Eigen::Index c = 0; c < columns.cols(); ++c) {
      const double size = std::sqrt(columns.col(c).squaredNorm() /
                                    static_cast<double>(std::max<Eigen::Index>(1, columns.rows())));
      if (size > 0.0) columns.col(c) /= size;
    }
  }

  int lags_;
  std::vector<Eigen::Index> rows_;
  Matrix base_;
  Vector target_;
  Eigen::LDLT<Matrix> solver_;
  double left_{};
};

/// Turns of a signal by more than `least`.
int turnsOf(const std::vector<double>& signal, double least) {
  int turns = 0, way = 0;
  double extreme = signal.front();
  for (const double v : signal) {
    const bool turned = way * (extreme - v) > least || (way == 0 && std::abs(v - extreme) > least);
    if (turned) {
      way = v > extreme ? 1 : -1;
      ++turns;
    }
    if (turned || way * (v - extreme) > 0.0) extreme = v;
  }
  return turns;
}

/// In parts of the signal's range, the jump in parts of the band; what it leaves.
struct Shape {
  double band, jump;
  bool slips;
  double left;
};

/// Halves its steps around the best of the grid.
template <typename Left>
void refine(Shape& best, double jump_step, Left left_of) {
  double band_step = 1.15;
  for (int round = 0; round < 4; ++round) {
    const Shape centre = best;
    for (const double factor : {1.0 / band_step, 1.0, band_step})
      for (const double add : {-jump_step, 0.0, jump_step}) {
        Shape s{std::max(kBands[0], centre.band * factor), std::clamp(centre.jump + add, 0.0, 1.0),
                centre.slips, 0.0};
        if ((factor == 1.0 && add == 0.0) || (jump_step == 0.0 && add != 0.0)) continue;
        if (jump_step > 0.0 && s.jump <= 0.05) continue;
        s.left = left_of(s);
        if (s.left < best.left) best = s;
      }
    band_step = std::sqrt(band_step);
    jump_step *= 0.5;
  }
}

}  // namespace

double StickingValve::move(double signal) {
  if (!started_) {
    started_ = true;
    position_ = signal_ = turned_ = signal;
    return position_;
  }
  const double change = signal - signal_;
  if (change != 0.0) {
    const int way = change > 0.0 ? 1 : -1;
    if (!rests_ && way != way_) {  // a reversal of a moving valve
      rests_ = true;
      turned_ = signal_;
    }
    if (rests_) {
      const double gone = signal - turned_;
      const int to = gone > 0.0 ? 1 : -1;
      const double needed = to == way_ ? jump_ : band_;
      if (std::abs(gone) > needed) {
        rests_ = false;
        way_ = to;
      }
    }
    if (!rests_) position_ = signal - way_ * 0.5 * (band_ - jump_);
  } else if (!rests_) {  // it has come to a stop
    rests_ = jump_ > 0.0;
    turned_ = signal_;
  }
  signal_ = signal;
  return position_;
}

double SlippingValve::move(double signal) {
  if (!started_) {
    started_ = true;
    position_ = signal_ = signal;
  }
  force_ += signal - signal_;
  signal_ = signal;
  if (std::abs(force_) > still_) {
    const double left = force_ > 0.0 ? moves_ : -moves_;
    position_ += force_ - left;
    force_ = left;
  }
  return position_;
}

ValveFit fitValve(const std::vector<double>& signal, const std::vector<double>& y, int delay,
                  Eigen::Index factor) {
  ValveFit fit;
  const std::vector<double> finite = finiteOnly(signal);
  if (finite.size() < static_cast<std::size_t>(kFewest)) return fit;
  const double range = sampleQuantile(finite, 0.99) - sampleQuantile(finite, 0.01);
  if (!(range > 0.0)) return fit;
  const int lags = std::clamp(delay + 4, 5, 20);
  const std::vector<double> coarse = blockMeans(signal, factor), answer = blockMeans(y, factor);
  const ValveRegression regression(coarse, answer, lags);
  const Eigen::Index free = regression.rows() - regression.unknowns();
  if (regression.rows() < kFewest || !(regression.left() > 0.0)) return fit;
  const auto leftOf = [&](const Shape& s) {
    const double band = s.band * range, jump = s.jump * band;
    return regression.leftWith(blockMeans(s.slips ? positions<SlippingValve>(signal, band, jump)
                                                  : positions<StickingValve>(signal, band, jump),
                                          factor));
  };

  Shape play{0.0, 0.0, false, kInfinity}, stick = play, slip{0.0, 0.0, true, kInfinity};
  const auto look = [&](Shape& best, double band, double jump) {
    Shape s{std::max(kBands[0], band), jump, best.slips, 0.0};
    s.left = leftOf(s);
    if (s.left < best.left) best = s;
  };
  for (const double band : kBands) look(play, band, 0.0);
  refine(play, 0.0, leftOf);
  for (Shape* jumping : {&stick, &slip}) {
    for (const double band : kBands)
      for (const double jump : {0.5, 1.0}) look(*jumping, band, jump);
    for (const double near : {0.75, 0.9, 1.0, 1.1, 1.3})
      for (const double jump : {0.15, 0.3, 0.45, 0.6, 0.75, 0.9})
        look(*jumping, near * play.band, jump);
    refine(*jumping, 0.08, leftOf);
  }
  if (stick.left < slip.left) slip = stick;
  const double best = std::min(play.left, slip.left), best_play = play.left;
  fit.band = (slip.left < play.left ? slip : play).band * range;
  fit.jump = slip.left < play.left ? slip.jump * fit.band : 0.0;
  const double play_band = play.band * range;
  const double of_noise = best / static_cast<double>(free);
  fit.share = 1.0 - best / regression.left();
  fit.significance = (regression.left() - best) / lags / of_noise;
  fit.jump_significance = (best_play - best) / of_noise;
  const bool certain = fit.significance > kLeastF && fit.share > kLeastValveShare &&
                       turnsOf(finite, 0.5 * fit.band) >= kFewestTurns &&
                       of_noise < regression.smoothVariance(coarse, answer);
  fit.sticks = certain && fit.jump > 0.0 && fit.jump_significance > kLeastJumpF;
  fit.plays = certain && !fit.sticks;
  if (fit.plays) {
    fit.band = play_band;
    fit.jump = 0.0;
  }
  return fit;
}

}  // namespace fpc
