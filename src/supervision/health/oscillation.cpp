#include "supervision/health/oscillation.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <unsupported/Eigen/FFT>

#include "base/statistics.hpp"
#include "supervision/health/finite_runs.hpp"

namespace fpc {
namespace {

constexpr double kTau = 6.283185307179586;
constexpr int kPerOctave = 12;      // bands of the spectrum
constexpr double kHalfBand = 1.45;  // the band around a peak: from f / this to f times this
constexpr int kPeaks = 4;           // that are looked at
constexpr double kFewestPeriods = 12.0, kShortestPeriod = 3.5;
constexpr int kIntervals = 10;  // between zero crossings
constexpr double kLeastRegularity = 4.0, kLeastShare = 0.2, kLeastAfterOne = 0.6;

using Complexes = std::vector<std::complex<double>>;

std::size_t powerOfTwo(std::size_t least) {
  std::size_t n = 1;
  while (n < least) n *= 2;
  return n;
}

/// Without mean; large outliers are cut, holes are 0.
std::vector<double> centred(const std::vector<double>& signal) {
  std::vector<double> x = signal;
  const double mean = meanOf(x), most = 5.0 * stdOf(x);
  for (double& v : x) v = std::isfinite(v) ? std::clamp(v - mean, -most, most) : 0.0;
  return x;
}

struct Spectrum {
  Complexes bins;
  std::vector<double> power;  // up to half of the bins
  double n{}, total{};
  double frequency(std::size_t bin) const {
    return static_cast<double>(bin) / static_cast<double>(bins.size());
  }
  std::size_t bin(double frequency) const {
    const double at = frequency * static_cast<double>(bins.size());
    return static_cast<std::size_t>(std::clamp(at, 1.0, static_cast<double>(power.size()) - 1.0));
  }
};

Spectrum spectrumOf(std::vector<double> x) {
  Spectrum s;
  s.n = static_cast<double>(x.size());
  x.resize(powerOfTwo(2 * x.size()), 0.0);
  Eigen::FFT<double> fft;
  fft.fwd(s.bins, x);
  s.power.resize(s.bins.size() / 2);
  for (std::size_t k = 0; k < s.power.size(); ++k) s.power[k] = std::norm(s.bins[k]);
  for (std::size_t k = 1; k < s.power.size(); ++k) s.total += s.power[k];
  return s;
}

/// Frequencies of the highest peaks of f S, by bands of a twelfth of an octave.
std::vector<double> peaksOf(const Spectrum& s) {
  const double lowest = kFewestPeriods / s.n, highest = 1.0 / kShortestPeriod;
  if (lowest >= highest) return {};
  const double step = std::exp2(1.0 / kPerOctave);
  std::vector<double> centre, height;
  for (double f = lowest; f < highest; f *= step) {
    const std::size_t from = s.bin(f / std::sqrt(step)),
                      to = std::max(from + 1, s.bin(f * std::sqrt(step)));
    double sum = 0.0;
    for (std::size_t k = from; k < to; ++k) sum += s.power[k];
    centre.push_back(f);
    height.push_back(f * sum / static_cast<double>(to - from));
  }
  std::vector<std::size_t> tops;
  for (std::size_t i = 1; i + 1 < height.size(); ++i)
    if (height[i] >= height[i - 1] && height[i] > height[i + 1]) tops.push_back(i);
  std::sort(tops.begin(), tops.end(),
            [&](std::size_t a, std::size_t b) { return height[a] > height[b]; });
  std::vector<double> peaks;
  for (const std::size_t top : tops)
    if (peaks.size() < kPeaks) peaks.push_back(centre[top]);
  return peaks;
}

/// Autocorrelation of a part of the spectrum at any lag, from sums of neighbouring bins.
class BandCorrelation {
 public:
  BandCorrelation(const Spectrum& s, std::size_t from, std::size_t to) {
    const std::size_t group = std::max<std::size_t>(1, (to - from) / 1024);
    for (std::size_t k = from; k < to; k += group) {
      double sum = 0.0, place = 0.0;
      for (std::size_t j = k; j < std::min(k + group, to); ++j) {
        sum += s.power[j];
        place += s.power[j] * s.frequency(j);
      }
      if (sum <= 0.0) continue;
      power_.push_back(sum);
      frequency_.push_back(place / sum);
      total_ += sum;
    }
  }
  double at(double lag) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < power_.size(); ++k)
      sum += power_[k] * std::cos(kTau * frequency_[k] * lag);
    return total_ > 0.0 ? sum / total_ : 0.0;
  }
  double total() const { return total_; }

 private:
  std::vector<double> power_, frequency_;
  double total_{};
};

/// Highest value within half a period around one period, unbiased for the record's length.
double heightAfterOne(const BandCorrelation& c, double period, double n) {
  double most = 0.0;
  for (int k = -8; k <= 8; ++k) most = std::max(most, c.at(period + period * k / 32.0));
  return most / std::max(0.05, 1.0 - period / n);
}

/// Standard deviation over mean of the envelope of the band.
double unrestOf(const Spectrum& s, std::size_t from, std::size_t to, double period) {
  Complexes band(s.bins.size(), {0.0, 0.0}), envelope;
  for (std::size_t k = from; k < to; ++k) band[k] = 2.0 * s.bins[k];
  Eigen::FFT<double> fft;
  fft.inv(envelope, band);
  const auto n = static_cast<std::size_t>(s.n), margin = static_cast<std::size_t>(period);
  double sum = 0.0, squares = 0.0, count = 0.0;
  for (std::size_t k = margin; k + margin < n; ++k) {
    const double a = std::abs(envelope[k]);
    sum += a;
    squares += a * a;
    count += 1.0;
  }
  const double mean = sum / count;
  return mean > 0.0 ? std::sqrt(std::max(0.0, squares / count - mean * mean)) / mean : kNaN;
}

Oscillation oscillationAt(const Spectrum& s, double f) {
  const std::size_t from = s.bin(f / kHalfBand), to = std::max(from + 2, s.bin(f * kHalfBand));
  const BandCorrelation c(s, from, std::min(to, s.power.size()));
  Oscillation o;
  std::vector<double> crossings;
  const double step = 1.0 / f / 32.0;
  double before = 1.0;
  for (int k = 1; k <= 32 * kIntervals && crossings.size() <= kIntervals; ++k) {
    const double now = c.at(k * step);
    if (before * now < 0.0) crossings.push_back((k - now / (now - before)) * step);
    before = now;
  }
  if (crossings.size() <= kIntervals / 2) return o;
  std::vector<double> intervals;
  for (std::size_t i = 1; i < crossings.size(); ++i)
    intervals.push_back(crossings[i] - crossings[i - 1]);
  const double mean = meanOf(intervals);
  o.period = 2.0 * mean;
  o.regularity = mean / std::max(1e-9 * mean, 3.0 * stdOf(intervals));
  o.share = c.total() / s.total;
  // twice the power of positive frequencies over all bins is the mean square of the padded signal
  o.amplitude = std::sqrt(2.0 * 2.0 * c.total() / static_cast<double>(s.bins.size()) / s.n);
  o.after_one = heightAfterOne(c, o.period, s.n);
  o.found =
      o.regularity > kLeastRegularity && o.share >= kLeastShare && o.after_one >= kLeastAfterOne;
  if (o.found) o.unrest = unrestOf(s, from, std::min(to, s.power.size()), o.period);
  return o;
}

}  // namespace

Oscillation findOscillation(const std::vector<double>& signal) {
  if (static_cast<double>(signal.size()) < 4.0 * kFewestPeriods) return {};
  const Spectrum s = spectrumOf(centred(signal));
  if (!(s.total > 0.0)) return {};
  Oscillation best;
  for (const double f : peaksOf(s)) {
    const Oscillation o = oscillationAt(s, f);
    if (o.found && (!best.found || o.share > best.share)) best = o;
  }
  return best;
}

std::vector<double> autocorrelationOf(const std::vector<double>& signal, Eigen::Index most) {
  std::vector<double> x = signal;
  const double mean = meanOf(x);
  for (double& v : x) v -= mean;
  std::vector<double> result;
  const auto n = static_cast<Eigen::Index>(x.size());
  for (Eigen::Index lag = 0; lag <= most && lag < n; ++lag) {
    double sum = 0.0, count = 0.0;
    for (Eigen::Index k = lag; k < n; ++k) {
      const double product = x[static_cast<std::size_t>(k)] * x[static_cast<std::size_t>(k - lag)];
      if (!std::isfinite(product)) continue;
      sum += product;
      count += 1.0;
    }
    result.push_back(count > 0.0 ? sum / count : kNaN);
  }
  const double first = result.empty() ? 0.0 : result.front();
  for (double& r : result) r = first > 0.0 ? r / first : 0.0;
  return result;
}

}  // namespace fpc
