#include "identification/process_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/decompositions.hpp"
#include "base/order_statistics.hpp"
#include "base/random.hpp"
#include "base/statistics.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr Index kFewestRows = 30;
constexpr double kStartPole = 0.9;  // of the noise while starts are sought
constexpr double kGridRatio = 1.7;  // of the lags that are tried first
constexpr int kFitIterations = 40;
constexpr double kFreeTerm = 2.0;      // of the noise, by Akaike's criterion
constexpr double kWorthwhile = 6.0;    // by which Schwarz's criterion must fall
constexpr double kWorthLead = 18.0;    // likewise, for the best of some hundred starts
constexpr double kCurveEdge = 0.02;    // of a signal's values lie beyond either end of a curve
constexpr double kLeastFactor = 0.05;  // at an end of a curve, of that in its middle
constexpr double kShortestLag = 0.15;  // of a sample
constexpr double kConverged = 1e-7;    // of the cost, relative
constexpr double kLowestDamping = 0.1, kHighestDamping = 1e3;
constexpr double kMostLead = 1e3;  // of the lags: a gain that is hardly one beside its lead

/// Shape of an element: which of its numbers are free.
/// kTied: its lag is given, see shortenLags().
enum Shape { kNone = 0, kFirst = 1, kSecond = 2, kLead = 3, kTied = 4 };

struct Candidate {
  ProcessKind kind{ProcessKind::kStable};
  std::vector<ProcessElement> elements;
  std::vector<Shape> shapes;
  double pole{1.0};  // shared, of kUnstable, as a time constant [samples], > 0
  Vector noise;
  double constant{};
};

class Fitter {
 public:
  Fitter(const Matrix& inputs, const Vector& output, double Ts, const ProcessFitParams& params)
      : y_(output), Ts_(Ts), params_(params), N_(output.size()) {
    mean_ = Vector::Zero(inputs.cols());
    u_ = inputs;
    for (Index j = 0; j < u_.cols(); ++j) {
      u_(0, j) = firstKnown(u_.col(j));
      for (Index k = 1; k < N_; ++k)
        if (!std::isfinite(u_(k, j))) u_(k, j) = u_(k - 1, j);
      mean_[j] = u_.col(j).mean();
      start_.push_back(u_(0, j));
      u_.col(j).array() -= u_(0, j);
    }
    longest_ = params.longest_dead_time_s > 0.0 ? params.longest_dead_time_s / Ts
                                                : 0.1 * static_cast<double>(N_);
    longest_ = std::min(longest_, 0.3 * static_cast<double>(N_));
    // A term of the noise costs all rows behind a gap: fewer where most rows would be lost.
    const Index known = y_.array().isFinite().count();
    for (rows_ = usable();
         params_.most_noise_terms > 1 && 2 * static_cast<Index>(rows_.size()) < known;
         rows_ = usable())
      params_.most_noise_terms /= 2;
  }

  ProcessFit best() {
    std::optional<Candidate> best;
    double least = std::numeric_limits<double>::infinity();
    for (const ProcessKind kind : params_.kinds) {
      Candidate c = start(kind);
      if (!refine(c)) continue;
      const double value = params_.passing ? criterion(c) : freeCriterion(c);
      // Another kind than stable must be worth it, unless all lags are an eighth of the record.
      double asked = kind == ProcessKind::kStable ? 0.0 : kWorthwhile;
      if (!params_.passing && kind == ProcessKind::kIntegrating && best && endsNowhere(*best))
        asked = -kWorthwhile;
      if (value + asked < least) {
        least = value;
        best = c;
      }
    }
    require(best.has_value(), "record",
            "data to which a process of one of the kinds can be fitted");
    ProcessFit fit = finish(*best);
    return shortenLags(*best, fit) ? finish(*best) : fit;
  }

  std::optional<GainCurve> curve(const ProcessFit& fit, Index moved) const {
    const Candidate c = candidateOf(fit);
    std::vector<Index> signals{-1};
    for (Index j = 0; j < moved; ++j)
      if (c.shapes[static_cast<std::size_t>(j)] != kNone) signals.push_back(j);
    const double confidence = 1.0 - 0.05 / static_cast<double>(signals.size());
    std::optional<GainCurve> found;
    double surest = 1.0;
    for (const Index signal : signals) {
      const std::optional<GainCurve> curve =
          curveAlong(c, fit.noise, fit.output, signal, confidence);
      if (!curve || !(std::abs(curve->change) > surest * curve->bound)) continue;
      surest = std::abs(curve->change) / curve->bound;
      found = curve;
    }
    return found;
  }

  std::optional<ProcessNoise> noiseBeside(const ProcessFit& fit) const {
    if (static_cast<Index>(rows_.size()) < kFewestRows) return std::nullopt;
    Candidate c = candidateOf(fit);
    chooseNoise(c, schwarz());
    const Vector e = errorsOf(c, residualOf(c));
    return ProcessNoise{c.noise, std::sqrt(e.squaredNorm() / static_cast<double>(e.size()))};
  }

 private:
  Candidate candidateOf(const ProcessFit& fit) const {
    Candidate c;
    c.kind = fit.kind;
    for (const ElementEstimate& e : fit.elements) {
      c.elements.push_back(e.element);
      c.shapes.push_back(e.seen ? kFirst : kNone);
      if (e.seen && c.kind == ProcessKind::kUnstable) c.pole = -e.element.time_constant / Ts_;
    }
    return c;
  }

  // ---- gains that change

  /// Values along which gains may change: those that are known when the next output is not, held
  /// where they are missing; of an input those that act on it first.
  Vector along(const Candidate& c, Index signal) const {
    Vector z = signal < 0 ? y_ : Vector(u_.col(signal));
    z[0] = firstKnown(z);
    for (Index k = 1; k < N_; ++k)
      if (!std::isfinite(z[k])) z[k] = z[k - 1];
    if (signal < 0) return z;
    const Index late = sampled(c.elements[static_cast<std::size_t>(signal)], Ts_).delay;
    Vector delayed = Vector::Constant(N_, z[0]);
    if (late < N_) delayed.tail(N_ - late) = z.head(N_ - late);
    return delayed;
  }

  /// What the inputs do whose gain is multiplied by `factor`, from their means on, behind the
  /// common denominator of all elements and before the shared pole: as a rule of a model has it.
  Vector modulated(const Candidate& c, Index signal, const Vector& factor) const {
    std::vector<double> poles{1.0};
    Vector drive = Vector::Zero(N_);
    for (std::size_t j = 0; j < c.elements.size(); ++j)
      if (c.shapes[j] != kNone) poles = product(poles, sampled(c.elements[j], Ts_).own);
    for (std::size_t j = 0; j < c.elements.size(); ++j) {
      if (c.shapes[j] == kNone || (signal >= 0 && signal != static_cast<Index>(j))) continue;
      const SampledElement s = sampled(c.elements[j], Ts_);
      std::vector<double> b = s.b;
      for (std::size_t i = 0; i < c.elements.size(); ++i)
        if (i != j && c.shapes[i] != kNone) b = product(b, sampled(c.elements[i], Ts_).own);
      const auto& u = u_.col(static_cast<Index>(j));
      const double mean = u.mean();
      for (Index k = 0; k < N_; ++k)
        for (std::size_t i = 0; i < b.size(); ++i)
          drive[k] += b[i] * (u[std::max<Index>(k - s.delay - static_cast<Index>(i), 0)] - mean);
    }
    drive.array() *= factor.array();
    double rest = 0.0;  // of a process that has rested before the first row
    for (const double a : poles) rest += a;
    const double before = c.kind == ProcessKind::kStable ? drive[0] / rest : 0.0;
    Vector w(N_);
    w[0] = before;
    for (Index k = 1; k < N_; ++k) {
      w[k] = drive[k - 1];
      for (std::size_t i = 1; i < poles.size(); ++i) {
        const Index at = k - static_cast<Index>(i);
        w[k] -= poles[i] * (at >= 0 ? w[at] : before);
      }
    }
    return w;
  }

  /// The mean of what effects leave of the output; `otherwise` where a shared pole hides it.
  double outputAtRest(const Candidate& c, const Vector& factor, double change,
                      const Vector& changed, double otherwise) const {
    if (c.kind != ProcessKind::kStable) return otherwise;
    Vector left = y_ - change * changed;
    for (std::size_t j = 0; j < c.elements.size(); ++j) {
      if (c.shapes[j] == kNone) continue;
      const auto at = static_cast<Index>(j);
      const double level = c.elements[j].gain * (mean_[at] - start_[j]);
      left -= factor[at] * (response(c.elements[j], at).array() - level).matrix();
    }
    double sum = 0.0;
    for (const Index k : rows_) sum += left[k];
    return sum / static_cast<double>(rows_.size());
  }

  /// Gains and their change by least squares of the prediction errors, elements and noise as
  /// fitted.
  std::optional<GainCurve> curveAlong(const Candidate& c, const Vector& noise, double rest,
                                      Index signal, double confidence) const {
    const Vector z = along(c, signal);
    std::vector<double> values(z.begin(), z.end());
    GainCurve curve;
    curve.signal = signal;
    curve.lower = sampleQuantile(values, kCurveEdge);
    curve.upper = sampleQuantile(std::move(values), 1.0 - kCurveEdge);
    if (!(curve.upper > curve.lower)) return std::nullopt;
    const Vector place =
        ((z.array() - curve.lower) / (curve.upper - curve.lower) - 0.5).min(0.5).max(-0.5);
    std::vector<std::size_t> seen;
    for (std::size_t j = 0; j < c.shapes.size(); ++j)
      if (c.shapes[j] != kNone) seen.push_back(j);
    const auto n = static_cast<Index>(rows_.size()), gains = static_cast<Index>(seen.size());
    Matrix X(n, gains + 2);
    const auto put = [&](Index column, const Vector& effect) {
      for (Index r = 0; r < n; ++r) X(r, column) = effect[rows_[static_cast<std::size_t>(r)]];
    };
    for (Index j = 0; j < gains; ++j) {
      const std::size_t at = seen[static_cast<std::size_t>(j)];
      put(j, filteredResponse(response(c.elements[at], static_cast<Index>(at)), noise));
    }
    put(gains, filteredResponse(modulated(c, signal, place), noise));
    X.col(gains + 1).setOnes();
    const Vector all = filtered(reduced(sharedPole(c)), noise);
    Vector target(n);
    for (Index r = 0; r < n; ++r) target[r] = all[rows_[static_cast<std::size_t>(r)]];
    const Eigen::ColPivHouseholderQR<Matrix> qr = pivotedQrOf(X);
    if (qr.rank() < X.cols()) return std::nullopt;
    const Vector theta = solvedBy(qr, target), e = target - X * theta;
    const Matrix inverse = (X.transpose() * X).ldlt().solve(Matrix::Identity(X.cols(), X.cols()));
    const double plain =
        inverse(gains, gains) * e.squaredNorm() / static_cast<double>(n - X.cols());
    double blocked = 0.0;
    for (int b = 0; b < params_.blocks; ++b) {
      const Index from = n * b / params_.blocks, count = n * (b + 1) / params_.blocks - from;
      const Vector g = X.middleRows(from, count).transpose() * e.segment(from, count);
      blocked += std::pow(inverse.row(gains).dot(g), 2);
    }
    const double freedom = params_.blocks - 1.0;
    blocked *= params_.blocks / freedom;
    curve.change = theta[gains];
    curve.bound = studentBound(confidence, freedom) * std::sqrt(std::max(plain, blocked));
    curve.factor = Vector::Ones(static_cast<Index>(c.shapes.size()));
    for (Index j = 0; j < gains; ++j)
      if (theta[j] > 0.0)
        curve.factor[static_cast<Index>(seen[static_cast<std::size_t>(j)])] = theta[j];
    curve.output = outputAtRest(c, curve.factor, theta[gains], modulated(c, signal, place), rest);
    if (signal >= 0)
      for (double* end : {&curve.lower, &curve.upper})
        *end += start_[static_cast<std::size_t>(signal)];
    auto engine = seededEngine(params_.seed, {8});
    for (int member = 0; member < params_.ensemble; ++member)
      curve.ensemble.push_back(curve.change + std::sqrt(std::max(plain, blocked)) *
                                                  std::clamp(standardNormal(engine), -2.5, 2.5));
    return curve;
  }

  /// The record does not show that the effects of the inputs come to an end.
  bool endsNowhere(const Candidate& c) const {
    bool any = false;
    for (std::size_t j = 0; j < c.elements.size(); ++j) {
      if (c.shapes[j] == kNone) continue;
      any = true;
      if (c.elements[j].time_constant < 0.5 * highLag()) return false;
    }
    return any && c.kind == ProcessKind::kStable;
  }

  // ---- what a candidate makes of the record

  double sharedPole(const Candidate& c) const {
    if (c.kind == ProcessKind::kStable) return 0.0;
    return c.kind == ProcessKind::kIntegrating ? 1.0 : std::exp(1.0 / c.pole);
  }

  ProcessElement shaped(const Candidate& c, ProcessElement e) const {
    e.integrating = c.kind == ProcessKind::kIntegrating;
    if (c.kind == ProcessKind::kUnstable) e.time_constant = -c.pole * Ts_;
    return e;
  }

  /// (own response) of one element to its input, before the shared pole.
  Vector response(const ProcessElement& element, Index j) const {
    const SampledElement s = sampled(element, Ts_);
    Vector w = Vector::Zero(N_);
    const auto n_a = static_cast<Index>(s.own.size()), n_b = static_cast<Index>(s.b.size());
    const auto& u = u_.col(j);
    for (Index k = 1 + s.delay; k < N_; ++k) {
      double value = 0.0;
      for (Index i = 0; i < n_b && k - 1 - s.delay - i >= 0; ++i)
        value += s.b[static_cast<std::size_t>(i)] * u[k - 1 - s.delay - i];
      for (Index i = 1; i < n_a && k - i >= 0; ++i)
        value -= s.own[static_cast<std::size_t>(i)] * w[k - i];
      w[k] = value;
    }
    return w;
  }

  /// y without the shared pole.
  Vector reduced(double pole) const {
    Vector v = y_;
    if (pole > 0.0) {
      v[0] = std::numeric_limits<double>::quiet_NaN();
      for (Index k = 1; k < N_; ++k) v[k] = y_[k] - pole * y_[k - 1];
    }
    return v;
  }

  static Vector filtered(const Vector& v, const Vector& noise) {
    const Index p = noise.size(), n = v.size();
    Vector e(n);
    for (Index k = 0; k < n; ++k) {
      double value = v[k];
      for (Index i = 0; i < p; ++i)
        value -= noise[i] * (k > i ? v[k - 1 - i] : std::numeric_limits<double>::quiet_NaN());
      e[k] = value;
    }
    return e;
  }

  /// The same of a response, which was 0 before.
  static Vector filteredResponse(const Vector& w, const Vector& noise) {
    Vector e = w;
    for (Index i = 0; i < noise.size(); ++i)
      e.tail(w.size() - 1 - i) -= noise[i] * w.head(w.size() - 1 - i);
    return e;
  }

  /// Its first reading stands for those before it; 0: there is none.
  static double firstKnown(const Eigen::Ref<const Vector>& column) {
    for (const double value : column)
      if (std::isfinite(value)) return value;
    return 0.0;
  }

  /// Where all of the errors are known: the same rows whatever the noise terms, so that costs of
  /// one record can be compared.
  std::vector<Index> usable() const {
    std::vector<Index> rows;
    const Index past = params_.most_noise_terms + 1;
    Index good = 0;
    for (Index k = 0; k < N_; ++k) {
      good = std::isfinite(y_[k]) ? good + 1 : 0;
      if (good > past) rows.push_back(k);
    }
    return rows;
  }

  // ---- starts

  std::vector<double> lagGrid() const {
    std::vector<double> lags;
    for (double lag = 0.7; lag <= std::max(2.0, 0.25 * static_cast<double>(N_)); lag *= kGridRatio)
      lags.push_back(lag);
    return lags;
  }
  std::vector<double> delayGrid() const {
    std::vector<double> delays;
    for (double d = 0.0; d <= longest_ + 0.5; d = std::max(d + 1.0, std::floor(1.3 * d)))
      delays.push_back(d);
    return delays;
  }

  Candidate start(ProcessKind kind) {
    Candidate c;
    c.kind = kind;
    const Index m = u_.cols();
    c.elements.assign(static_cast<std::size_t>(m), {});
    c.shapes.assign(static_cast<std::size_t>(m), kNone);
    c.noise = Vector::Constant(1, kind == ProcessKind::kStable ? kStartPole : 0.0);
    std::vector<double> poles{1.0};
    if (kind == ProcessKind::kUnstable) poles = {3.0, 8.0, 20.0, 50.0, 120.0};
    double least = std::numeric_limits<double>::infinity();
    Candidate found = c;
    for (const double pole : poles) {
      c.pole = pole;
      const double cost = startWith(c);
      if (cost < least) {
        least = cost;
        found = c;
      }
    }
    return found;
  }

  /// One element after the other, each with the best of the grid; the sum of squares left.
  double startWith(Candidate& c) {
    const Vector target = filtered(reduced(sharedPole(c)), c.noise);
    Vector left(static_cast<Index>(rows_.size()));
    for (std::size_t i = 0; i < rows_.size(); ++i) left[static_cast<Index>(i)] = target[rows_[i]];
    left.array() -= left.mean();
    const auto pick = [&](const Vector& w) {
      Vector x(left.size());
      for (std::size_t i = 0; i < rows_.size(); ++i) x[static_cast<Index>(i)] = w[rows_[i]];
      x.array() -= x.mean();
      return x;
    };
    const std::vector<double> lags = lagGrid(), delays = delayGrid();
    std::vector<Vector> parts(c.elements.size(), Vector::Zero(left.size()));
    for (int pass = 0; pass < 2; ++pass)
      for (std::size_t j = 0; j < c.elements.size(); ++j) {
        left += parts[j];
        double most = 0.0;
        ProcessElement chosen;
        Vector part = Vector::Zero(left.size());
        for (const double lag : lags) {
          ProcessElement e = shaped(c, {});
          e.gain = 1.0;
          (c.kind == ProcessKind::kStable ? e.time_constant : e.second) = lag * Ts_;
          const Vector w = filteredResponse(response(e, static_cast<Index>(j)), c.noise);
          for (const double delay : delays) {
            const auto d = static_cast<Index>(delay);
            Vector late = Vector::Zero(N_);
            if (d < N_) late.tail(N_ - d) = w.head(N_ - d);
            const Vector x = pick(late);
            const double square = x.squaredNorm();
            if (!(square > 0.0)) continue;
            const double inner = x.dot(left);
            if (inner * inner / square <= most) continue;
            most = inner * inner / square;
            chosen = e;
            chosen.dead_time = delay * Ts_;
            chosen.gain = inner / square;
            part = chosen.gain * x;
          }
        }
        c.elements[j] = chosen;
        c.shapes[j] = most > 0.0 ? kFirst : kNone;
        parts[j] = part;
        left -= part;
      }
    return left.squaredNorm();
  }

  /// Two lags and a lead of element j, dead time on a coarse grid, gain and lead by least squares:
  /// a fast effect and a slow one of the other sign are no single lag, from which none finds them.
  ProcessElement startWithLead(const Candidate& c, std::size_t j) const {
    Candidate others = c;
    others.shapes[j] = kNone;
    const auto pick = [&](const Vector& all, Index delay) {
      Vector x(static_cast<Index>(rows_.size()));
      for (std::size_t i = 0; i < rows_.size(); ++i)
        x[static_cast<Index>(i)] = rows_[i] < delay ? 0.0 : all[rows_[i] - delay];
      x.array() -= x.mean();
      return x;
    };
    const Vector left = pick(filtered(residualOf(others), c.noise), 0);
    const std::vector<double> lags = lagGrid(), delays = delayGrid();
    ProcessElement best = c.elements[j];
    double most = 0.0;
    const auto look = [&](ProcessElement e) {
      e.gain = 1.0;
      const auto effect = [&](double lead) {
        e.lead = lead;
        return filteredResponse(response(e, static_cast<Index>(j)), c.noise);
      };
      const double unit = scaleOf(e);
      const Vector straight = effect(0.0), bent = effect(unit) - straight;
      for (const double delay : delays) {
        const Vector a = pick(straight, static_cast<Index>(delay)),
                     b = pick(bent, static_cast<Index>(delay));
        const double aa = a.squaredNorm(), ab = a.dot(b), bb = b.squaredNorm();
        const double det = aa * bb - ab * ab;
        if (!(det > 1e-9 * aa * bb)) continue;
        const double al = a.dot(left), bl = b.dot(left);
        const double gain = (bb * al - ab * bl) / det, lead = (aa * bl - ab * al) / det;
        const double explained = gain * al + lead * bl;
        if (explained <= most || gain == 0.0) continue;
        most = explained;
        best = e;
        best.gain = gain;
        best.lead = lead * unit / gain;
        best.dead_time = delay * Ts_;
      }
    };
    for (std::size_t one = 0; one < lags.size(); one += 2) {
      ProcessElement e = shaped(c, {});
      e.second = lags[one] * Ts_;
      if (c.kind != ProcessKind::kStable) {
        look(e);
        continue;
      }
      for (std::size_t other = one; other < lags.size(); other += 2) {
        e.time_constant = lags[other] * Ts_;
        look(e);
      }
    }
    return best;
  }

  // ---- parameters

  /// Free numbers: pole (unstable), then gain, lag (of two: their geometric mean, then the
  /// damping), gain times lead over the lags, dead time of each element, then the noise, then the
  /// constant.
  Index shapeParameters(const Candidate& c) const {
    Index n = c.kind == ProcessKind::kUnstable ? 1 : 0;
    for (const Shape s : c.shapes) n += countOf(c.kind, s);
    return n;
  }
  /// Stable: gain, tau_1 (tau_2 (beta)) theta. With a shared pole: gain, tau_2 (beta) theta.
  static Index countOf(ProcessKind kind, Shape s) {
    if (s == kNone) return 0;
    if (s == kTied) return 2;
    if (kind == ProcessKind::kStable) return s == kFirst ? 3 : s == kSecond ? 4 : 5;
    return s == kLead ? 4 : 3;
  }

  double lowLag() const { return kShortestLag * Ts_; }
  double highLag() const { return 0.25 * static_cast<double>(N_) * Ts_; }

  Vector pack(const Candidate& c) const {
    std::vector<double> p;
    if (c.kind == ProcessKind::kUnstable) p.push_back(std::log(c.pole));
    for (std::size_t j = 0; j < c.elements.size(); ++j) {
      const ProcessElement& e = c.elements[j];
      if (c.shapes[j] == kNone) continue;
      p.push_back(e.gain);
      if (c.kind != ProcessKind::kStable) {
        p.push_back(std::log(std::max(e.second, lowLag())));
      } else if (c.shapes[j] == kFirst) {
        p.push_back(std::log(e.time_constant));
      } else if (c.shapes[j] != kTied) {  // smooth where two lags meet, as they themselves are not
        const double second = std::max(e.second, lowLag());
        const double both = std::sqrt(e.time_constant * second);
        p.push_back(std::log(both));
        p.push_back(
            std::log(e.damping < 1.0 ? e.damping : 0.5 * (e.time_constant + second) / both));
      }
      if (c.shapes[j] == kLead) p.push_back(e.gain * e.lead / scaleOf(e));
      p.push_back(e.dead_time / Ts_);
    }
    return Eigen::Map<const Vector>(p.data(), static_cast<Index>(p.size()));
  }
  static double scaleOf(const ProcessElement& e) { return std::max(e.lags(), 1e-300); }
  void unpack(const Vector& p, Candidate& c) const {
    Index i = 0;
    const double low = std::log(lowLag()), high = std::log(highLag());
    const auto lag = [&](double value) { return std::exp(std::clamp(value, low, high)); };
    if (c.kind == ProcessKind::kUnstable)
      c.pole = std::exp(std::clamp(p[i++], std::log(1.0), std::log(static_cast<double>(N_))));
    for (std::size_t j = 0; j < c.elements.size(); ++j) {
      if (c.shapes[j] == kNone) continue;
      ProcessElement e = shaped(c, {});
      e.gain = p[i++];
      if (c.kind != ProcessKind::kStable) {
        e.second = lag(p[i++]);
      } else if (c.shapes[j] == kFirst) {
        e.time_constant = lag(p[i++]);
      } else if (c.shapes[j] == kTied) {
        e.time_constant = c.elements[j].time_constant;
      } else {
        const double both = lag(p[i++]);
        const double damping = std::clamp(std::exp(p[i++]), kLowestDamping, kHighestDamping);
        const double apart = std::sqrt(std::max(damping * damping - 1.0, 0.0));
        e.damping = std::min(damping, 1.0);
        const double split = std::max(damping, 1.0) + apart;
        e.time_constant = std::min(both * split, highLag());
        e.second = std::max(both / split, lowLag());
      }
      if (c.shapes[j] == kLead) {
        const double bent = p[i++], least = std::abs(bent) / kMostLead;
        if (std::abs(e.gain) < least) e.gain = std::copysign(least, e.gain);
        if (e.gain != 0.0) e.lead = bent / e.gain * scaleOf(e);
      }
      e.dead_time = std::clamp(p[i++], 0.0, longest_) * Ts_;
      c.elements[j] = e;
    }
  }

  Vector residualOf(const Candidate& c) const {
    Vector v = reduced(sharedPole(c));
    for (std::size_t j = 0; j < c.elements.size(); ++j)
      if (c.shapes[j] != kNone) v -= response(c.elements[j], static_cast<Index>(j));
    return v;
  }

  struct Evaluation {
    Vector e;  // of the usable rows
    double cost{};
    Matrix J;  // d e / d parameters
  };

  Vector errorsOf(const Candidate& c, const Vector& v) const {
    const Vector all = filtered(v, c.noise);
    Vector e(static_cast<Index>(rows_.size()));
    for (std::size_t i = 0; i < rows_.size(); ++i)
      e[static_cast<Index>(i)] = all[rows_[i]] - c.constant;
    return e;
  }

  /// Noise and constant by least squares of v on its past.
  void fitNoise(Candidate& c, const Vector& v, Index terms) const {
    const auto n = static_cast<Index>(rows_.size());
    Matrix A(n, terms + 1);
    Vector b(n);
    for (Index r = 0; r < n; ++r) {
      const Index k = rows_[static_cast<std::size_t>(r)];
      for (Index i = 0; i < terms; ++i) A(r, i) = v[k - 1 - i];
      A(r, terms) = 1.0;
      b[r] = v[k];
    }
    const double mean = b.mean();
    A.leftCols(terms).array() -= mean;  // about the mean: the constant is not lost
    Matrix normal = A.transpose() * A;
    normal.diagonal().array() += 1e-12 * normal.diagonal().maxCoeff();
    const Vector x = normal.ldlt().solve(A.transpose() * (b.array() - mean).matrix());
    c.noise = x.head(terms);
    c.constant = x[terms] + mean * (1.0 - x.head(terms).sum());
  }

  double logCost(double cost) const {
    const auto n = static_cast<double>(rows_.size());
    return n * std::log(std::max(cost, 1e-300) / n);
  }
  double schwarz() const { return std::log(static_cast<double>(rows_.size())); }
  /// `price`: of a term of the noise.
  double criterion(const Candidate& c, double price) const {
    return logCost(errorsOf(c, residualOf(c)).squaredNorm()) +
           static_cast<double>(shapeParameters(c) + 1) * schwarz() +
           static_cast<double>(c.noise.size()) * price;
  }
  double criterion(const Candidate& c) const { return criterion(c, schwarz()); }

  void chooseNoise(Candidate& c, double price) const {
    const Vector v = residualOf(c);
    double least = std::numeric_limits<double>::infinity();
    Index chosen = 0;
    for (Index terms = 0; terms <= params_.most_noise_terms; ++terms) {
      fitNoise(c, v, terms);
      const double value =
          logCost(errorsOf(c, v).squaredNorm()) + static_cast<double>(terms) * price;
      if (value < least - 1e-9) {
        least = value;
        chosen = terms;
      }
    }
    fitNoise(c, v, chosen);
  }

  Matrix jacobian(const Candidate& c, const Vector& v) const {
    const Index shape = shapeParameters(c), terms = c.noise.size();
    Matrix J(static_cast<Index>(rows_.size()), shape + terms + 1);
    const Vector p = pack(c);
    const auto put = [&](Index column, const Vector& full) {
      for (std::size_t r = 0; r < rows_.size(); ++r)
        J(static_cast<Index>(r), column) = full[rows_[r]];
    };
    Index i = 0;
    if (c.kind == ProcessKind::kUnstable) {
      Candidate up = c, down = c;
      Vector q = p;
      q[0] = p[0] + 1e-4;
      unpack(q, up);
      q[0] = p[0] - 1e-4;
      unpack(q, down);
      put(i++, (filtered(residualOf(up), c.noise) - filtered(residualOf(down), c.noise)) / 2e-4);
    }
    for (std::size_t j = 0; j < c.elements.size(); ++j) {
      const Index n = countOf(c.kind, c.shapes[j]);
      if (n == 0) continue;
      const auto input = static_cast<Index>(j);
      Candidate beside = c;
      for (Index a = 0; a < n; ++a) {
        const bool is_gain = a == 0, is_delay = a == n - 1;
        const bool is_lead = c.shapes[j] == kLead && a == n - 2;
        if (is_gain || is_lead) {  // linear
          ProcessElement unit = c.elements[j];
          unit.gain = 1.0;
          unit.lead = 0.0;
          Vector effect = response(unit, input);
          if (is_lead) {
            unit.lead = scaleOf(unit);
            effect = response(unit, input) - effect;
          }
          put(i + a, -filteredResponse(effect, c.noise));
          continue;
        }
        const double step = is_delay ? 1e-3 : 1e-4;
        Vector q = p;
        q[i + a] = p[i + a] + step;
        unpack(q, beside);
        const Vector up = response(beside.elements[j], input);
        double width = step;
        q[i + a] = std::max(p[i + a] - step, is_delay ? 0.0 : p[i + a] - step);
        width += p[i + a] - q[i + a];
        unpack(q, beside);
        const Vector down = response(beside.elements[j], input);
        put(i + a, -filteredResponse((up - down) / width, c.noise));
      }
      i += n;
    }
    for (Index a = 0; a < terms; ++a)
      for (std::size_t r = 0; r < rows_.size(); ++r)
        J(static_cast<Index>(r), shape + a) = -v[rows_[r] - 1 - a];
    J.col(shape + terms).setConstant(-1.0);
    return J;
  }

  /// Levenberg-Marquardt over all free numbers.
  bool descend(Candidate& c) {
    Vector v = residualOf(c);
    Vector e = errorsOf(c, v);
    double cost = e.squaredNorm(), damping = 1e-3;
    if (!std::isfinite(cost)) return false;
    const Index shape = shapeParameters(c), terms = c.noise.size();
    for (int iteration = 0; iteration < kFitIterations; ++iteration) {
      const Matrix J = jacobian(c, v);
      const Matrix H = J.transpose() * J;
      const Vector g = J.transpose() * e;
      bool better = false;
      double before = cost;
      for (int attempt = 0; attempt < 8 && !better; ++attempt) {
        Matrix A = H;
        A.diagonal() += damping * H.diagonal();
        A.diagonal().array() += 1e-14 * H.diagonal().maxCoeff();
        const Vector step = A.ldlt().solve(-g);
        Candidate next = c;
        unpack(pack(c) + step.head(shape), next);
        next.noise += step.segment(shape, terms);
        next.constant += step[shape + terms];
        const Vector v_next = residualOf(next);
        const Vector e_next = errorsOf(next, v_next);
        const double value = e_next.squaredNorm();
        if (std::isfinite(value) && value < cost) {
          c = next;
          v = v_next;
          e = e_next;
          cost = value;
          damping = std::max(damping * 0.2, 1e-9);
          better = true;
        } else {
          damping *= 6.0;
        }
      }
      if (!better || before - cost < kConverged * cost) break;
    }
    return true;
  }

  /// With as many terms of the noise as Akaike's criterion asks for: with Schwarz's fewer an
  /// integrator, whose noise is differenced, loses against a lag.
  double freeCriterion(Candidate c) {
    for (int pass = 0; pass < 2; ++pass) {
      chooseNoise(c, kFreeTerm);
      if (!descend(c)) break;
    }
    return criterion(c, kFreeTerm);
  }

  bool refine(Candidate& c) {
    if (static_cast<Index>(rows_.size()) < kFewestRows - params_.most_noise_terms) return false;
    for (int pass = 0; pass < 3; ++pass) {
      chooseNoise(c, schwarz());
      if (!descend(c)) return false;
    }
    double value = criterion(c);
    for (std::size_t j = 0; j < c.elements.size(); ++j)
      for (const Shape shape : {kSecond, kLead}) {
        if (c.shapes[j] == kNone || c.shapes[j] >= shape) continue;
        if (shape == kSecond && c.kind != ProcessKind::kStable) continue;
        value = tryShape(c, j, shape, value);
      }
    for (std::size_t j = 0; j < c.elements.size(); ++j) value = tryWithout(c, j, value);
    return std::isfinite(value);
  }

  double tryShape(Candidate& c, std::size_t j, Shape shape, double value) {
    Candidate best = c;
    const double asked = shape == kLead ? kWorthLead : kWorthwhile;
    double least = value - asked;
    const ProcessElement from = c.elements[j];
    std::vector<ProcessElement> starts;
    if (shape == kSecond) {
      ProcessElement e = from;
      e.second = std::max(0.4 * from.time_constant, lowLag());
      e.time_constant = std::max(0.8 * from.time_constant, lowLag());
      e.dead_time = std::max(0.0, from.dead_time - 0.3 * from.time_constant);
      starts.push_back(e);
    } else {
      for (const double lead : {-0.5, 0.5}) {
        ProcessElement e = from;
        if (c.kind == ProcessKind::kStable && e.second <= lowLag())
          e.second = 0.3 * e.time_constant;
        e.lead = lead * scaleOf(e);
        if (lead < 0.0) e.dead_time = 0.5 * from.dead_time;
        starts.push_back(e);
      }
      starts.push_back(startWithLead(c, j));
    }
    for (const ProcessElement& e : starts) {
      Candidate next = c;
      next.shapes[j] = shape;
      next.elements[j] = e;
      if (!descend(next)) continue;
      chooseNoise(next, schwarz());
      if (!descend(next)) continue;
      const double criterion_next = criterion(next);
      if (criterion_next < least) {
        least = criterion_next;
        best = next;
      }
    }
    if (least < value - asked) {
      c = best;
      return least;
    }
    return value;
  }

  /// An element that the record does not show: its gain is nothing beside its bound.
  double tryWithout(Candidate& c, std::size_t j, double value) {
    if (c.shapes[j] == kNone) return value;
    Candidate next = c;
    next.shapes[j] = kNone;
    next.elements[j].gain = 0.0;
    // While a test goes on its first element is what is known.
    if (params_.passing &&
        std::all_of(next.shapes.begin(), next.shapes.end(), [](Shape s) { return s == kNone; }))
      return value;
    if (!descend(next)) return value;
    const double without = criterion(next);
    if (without > value) return value;
    c = next;
    return without;
  }

  /// A record under feedback may show how an element begins and not where it ends: its gain is
  /// nothing beside its bound, its lag anything. The shortest lag that does as well is taken, of
  /// the slowest that is known and its doubles. True where one was.
  bool shortenLags(Candidate& c, const ProcessFit& fit) {
    if (c.kind != ProcessKind::kStable) return false;
    const auto isKnown = [](const ElementEstimate& e) {
      return e.seen && e.gain_bound < std::abs(e.element.gain);
    };
    double slowest = 0.0;
    for (const ElementEstimate& e : fit.elements)
      if (isKnown(e)) slowest = std::max(slowest, e.element.lags());
    bool changed = false;
    for (std::size_t j = 0; j < c.elements.size() && slowest > 0.0; ++j) {
      const ElementEstimate& e = fit.elements[j];
      if (!e.seen || isKnown(e)) continue;
      for (double lag = slowest; lag < e.element.lags(); lag *= 2.0) {
        Candidate next = c;
        next.shapes[j] = kTied;
        next.elements[j] = shaped(c, {});
        next.elements[j].gain = e.element.gain * lag / e.element.lags();
        next.elements[j].time_constant = lag;
        next.elements[j].dead_time = e.element.dead_time;
        if (!descend(next) || criterion(next) > criterion(c) + kWorthwhile) continue;
        c = next;
        changed = true;
        break;
      }
    }
    return changed;
  }

  // ---- bounds

  ProcessFit finish(Candidate c) {
    const Vector v = residualOf(c);
    const Vector e = errorsOf(c, v);
    const Matrix J = jacobian(c, v);
    const auto n = static_cast<double>(e.size());
    const Index all = J.cols(), shape = shapeParameters(c);
    const double variance = e.squaredNorm() / std::max(1.0, n - static_cast<double>(all));
    Matrix H = J.transpose() * J;
    H.diagonal().array() += 1e-12 * H.diagonal().array().abs().maxCoeff() * 1e-6;
    const Vector scale = H.diagonal().cwiseSqrt().cwiseMax(1e-300).cwiseInverse();
    const Matrix scaled = scale.asDiagonal() * H * scale.asDiagonal();
    const Matrix inverse =
        scale.asDiagonal() *
        (scaled + 1e-12 * Matrix::Identity(all, all)).ldlt().solve(Matrix::Identity(all, all)) *
        scale.asDiagonal();
    // Of the model as it is, and from blocks of the record, which show what it is not: the larger.
    Matrix B = Matrix::Zero(all, all);
    const Index size = e.size() / params_.blocks;
    for (int b = 0; b < params_.blocks; ++b) {
      const Index from = b * size, count = b + 1 == params_.blocks ? e.size() - from : size;
      const Vector g = J.middleRows(from, count).transpose() * e.segment(from, count);
      B += g * g.transpose();
    }
    const double few = static_cast<double>(params_.blocks) / (params_.blocks - 1.0);
    const Matrix plain = variance * inverse, blocked = few * inverse * B * inverse;
    const auto larger = [&](double factor) -> Matrix {
      Vector stretch(all);
      for (Index i = 0; i < all; ++i)
        stretch[i] =
            std::max(1.0, factor * std::sqrt(blocked(i, i) / std::max(plain(i, i), 1e-300)));
      return (stretch.asDiagonal() * plain * stretch.asDiagonal()).topLeftCorner(shape, shape);
    };
    // Few blocks bound as Student's t does.
    const double t =
        params_.passing ? 1.0 : studentBound(0.95, params_.blocks - 1.0) / normalBound(0.95);
    ProcessFit fit;
    fit.kind = c.kind;
    fit.noise = c.noise;
    fit.one_step = std::sqrt(e.squaredNorm() / n);
    fit.rows = e.size();
    fit.input = mean_;
    rest(c, v, fit);
    bounds(c, larger(t), variance, fit);
    draw(c, larger(1.0), fit);
    return fit;
  }

  void rest(const Candidate& c, const Vector& v, ProcessFit& fit) const {
    double sum = 0.0, square = 0.0, y = 0.0, count = 0.0;
    for (const Index k : rows_) {
      sum += v[k];
      square += v[k] * v[k];
      y += y_[k];
      count += 1.0;
    }
    const double mean = sum / count;
    if (c.kind != ProcessKind::kStable) {
      fit.output = y / count;
      fit.free_run = fit.one_step;
      return;
    }
    fit.free_run = std::sqrt(std::max(square / count - mean * mean, 0.0));
    fit.output = mean;
    for (std::size_t j = 0; j < c.elements.size(); ++j)
      if (c.shapes[j] != kNone)
        fit.output += c.elements[j].gain * (mean_[static_cast<Index>(j)] - start_[j]);
  }

  void bounds(const Candidate& c, const Matrix& covariance, double variance,
              ProcessFit& fit) const {
    const double z = normalBound(0.95);
    fit.elements.resize(c.elements.size());
    Index i = c.kind == ProcessKind::kUnstable ? 1 : 0;
    for (std::size_t j = 0; j < c.elements.size(); ++j) {
      ElementEstimate& out = fit.elements[j];
      const Index n = countOf(c.kind, c.shapes[j]);
      if (n == 0) {
        out.gain_bound = unseenBound(c, j, variance);
        continue;
      }
      out.seen = true;
      out.element = c.elements[j];
      out.gain_bound = z * std::sqrt(std::max(covariance(i, i), 0.0));
      out.dead_time_bound = z * std::sqrt(std::max(covariance(i + n - 1, i + n - 1), 0.0)) * Ts_;
      // The mean residence time, by its slopes with respect to the element's numbers.
      Vector slope = Vector::Zero(covariance.rows());
      const ProcessElement& e = out.element;
      if (c.shapes[j] != kTied) slope[i + 1] = e.lags() - e.lead;
      if (c.kind == ProcessKind::kStable && c.shapes[j] != kFirst && c.shapes[j] != kTied)
        slope[i + 2] = slope[i + 1];
      if (c.shapes[j] == kLead) {
        slope[i] = e.lead / e.gain;
        slope[i + n - 2] = -scaleOf(e) / e.gain;
      }
      slope[i + n - 1] = Ts_;
      out.time_bound = z * std::sqrt(std::max(slope.dot(covariance * slope), 0.0));
      i += n;
    }
  }

  /// Of a gain that is taken for none: what it may be, with lags as another of the output has.
  double unseenBound(const Candidate& c, std::size_t j, double variance) const {
    ProcessElement unit = shaped(c, {});
    for (std::size_t i = 0; i < c.elements.size(); ++i)  // as one that is seen
      if (c.shapes[i] != kNone) unit = c.elements[i];
    if (unit.time_constant == 0.0 && unit.second == 0.0)
      (c.kind == ProcessKind::kStable ? unit.time_constant : unit.second) = 10.0 * Ts_;
    unit.gain = 1.0;
    const Vector w = filteredResponse(response(unit, static_cast<Index>(j)), c.noise);
    double square = 0.0, sum = 0.0;
    for (const Index k : rows_) {
      square += w[k] * w[k];
      sum += w[k];
    }
    square -= sum * sum / static_cast<double>(rows_.size());
    return square > 0.0 ? normalBound(0.95) * std::sqrt(variance / square)
                        : std::numeric_limits<double>::infinity();
  }

  /// Normal draws of the free numbers.
  void draw(const Candidate& c, const Matrix& covariance, ProcessFit& fit) const {
    const Index n = covariance.rows();
    Matrix root = Matrix::Zero(n, n);
    if (n > 0) {
      const Vector scale = covariance.diagonal().cwiseSqrt().cwiseMax(1e-300);
      const Vector less = scale.cwiseInverse();
      Matrix correlation = less.asDiagonal() * covariance * less.asDiagonal();
      correlation.diagonal().array() += 1e-9;
      const Eigen::LLT<Matrix> llt(correlation);
      if (llt.info() == Eigen::Success)
        root = scale.asDiagonal() * Matrix(llt.matrixL());
      else
        root = scale.asDiagonal();
    }
    auto engine = seededEngine(params_.seed, {7});
    const Vector p = pack(c);
    for (int member = 0; member < params_.ensemble; ++member) {
      Vector z(n);
      for (Index i = 0; i < n; ++i) z[i] = std::clamp(standardNormal(engine), -2.5, 2.5);
      Candidate drawn = c;
      unpack(p + root * z, drawn);
      for (std::size_t j = 0; j < c.elements.size(); ++j)
        if (c.shapes[j] != kNone && drawn.elements[j].gain * c.elements[j].gain <= 0.0)
          drawn.elements[j].gain = 0.1 * c.elements[j].gain;  // the sign is what is known
      fit.ensemble.push_back(drawn.elements);
    }
  }

  Vector y_;
  Matrix u_;
  double Ts_;
  ProcessFitParams params_;
  Index N_;
  double longest_{};  // dead time [samples]
  Vector mean_;
  std::vector<double> start_;
  std::vector<Index> rows_;
};

/// Powers of two near the deviations of what is fitted, by which it is divided: what keeps the
/// equations of a fit regular does not depend on units, and every other number keeps its bits.
struct Scales {
  double y{1.0};
  Vector u;

  Scales(const Matrix& inputs, const Vector& output) : y(scaleOf(output)), u(inputs.cols()) {
    for (Index j = 0; j < u.size(); ++j) u[j] = scaleOf(inputs.col(j));
  }
  double gain(std::size_t j) const { return y / u[static_cast<Index>(j)]; }
  Matrix inputs(const Matrix& all) const { return all * u.cwiseInverse().asDiagonal(); }
  Vector output(const Vector& all) const { return all / y; }

 private:
  static double scaleOf(const Eigen::Ref<const Vector>& column) {
    double sum = 0.0, square = 0.0, n = 0.0, shift = 0.0;
    for (const double value : column) {
      if (!std::isfinite(value)) continue;
      if (n == 0.0) shift = value;
      sum += value - shift;
      square += (value - shift) * (value - shift);
      n += 1.0;
    }
    const double variance = n > 0.0 ? (square - sum * sum / n) / n : 0.0;
    return variance > 0.0 ? std::exp2(std::round(0.5 * std::log2(variance))) : 1.0;
  }
};

}  // namespace

void ProcessFitParams::validate() const {
  require(longest_dead_time_s >= 0.0, "longest_dead_time_s", "a time >= 0");
  require(most_noise_terms >= 1 && most_noise_terms <= 50, "most_noise_terms", "1 to 50");
  require(blocks >= 2 && blocks <= 100, "blocks", "2 to 100");
  require(ensemble >= 0 && ensemble <= 10000, "ensemble", "0 to 10000");
}

ProcessFit fitProcess(const Matrix& inputs, const Vector& output, double sample_time_s,
                      const ProcessFitParams& params) {
  params.validate();
  require(inputs.rows() == output.size() && inputs.cols() > 0, "record",
          "a row of inputs per output");
  require(output.size() >= kFewestRows, "record", "30 rows or more");
  require(sample_time_s > 0.0, "sample time", "a time > 0");
  bool moves = false;
  for (Index j = 0; j < inputs.cols() && !moves; ++j) {
    const Eigen::Array<bool, Eigen::Dynamic, 1> known = inputs.col(j).array().isFinite();
    moves = known.any() && known.select(inputs.col(j).array(), kInfinity).minCoeff() <
                               known.select(inputs.col(j).array(), -kInfinity).maxCoeff();
  }
  require(moves, "record", "an input that moves");
  const Scales scales(inputs, output);
  ProcessFit fit =
      Fitter(scales.inputs(inputs), scales.output(output), sample_time_s, params).best();
  for (std::size_t j = 0; j < fit.elements.size(); ++j) {
    fit.elements[j].element.gain *= scales.gain(j);
    fit.elements[j].gain_bound *= scales.gain(j);
    for (auto& member : fit.ensemble) member[j].gain *= scales.gain(j);
  }
  for (double* value : {&fit.one_step, &fit.free_run, &fit.output}) *value *= scales.y;
  fit.input.array() *= scales.u.array();
  return fit;
}

namespace {

/// use(Fitter, the fit in its units, scales) of a fit on a record with its columns.
template <typename Use>
auto onRecord(const ProcessFit& fit, const Matrix& inputs, const Vector& output,
              double sample_time_s, const ProcessFitParams& params, const Use& use) {
  params.validate();
  require(
      inputs.rows() == output.size() && inputs.cols() == static_cast<Index>(fit.elements.size()),
      "record", "a row of inputs per output, and the columns of the fit");
  require(sample_time_s > 0.0, "sample time", "a time > 0");
  const Scales scales(inputs, output);
  ProcessFit same = fit;
  for (std::size_t j = 0; j < same.elements.size(); ++j)
    same.elements[j].element.gain /= scales.gain(j);
  same.output /= scales.y;
  return use(Fitter(scales.inputs(inputs), scales.output(output), sample_time_s, params), same,
             scales);
}

}  // namespace

double GainCurve::factorAt(Index element, bool upper_end, double changed) const {
  const double middle = factor[element];
  if (signal >= 0 && signal != element) return middle;
  return std::max(middle + (upper_end ? 0.5 : -0.5) * changed, kLeastFactor * middle);
}

std::optional<GainCurve> gainCurve(const ProcessFit& fit, const Matrix& inputs, Index moved,
                                   const Vector& output, double sample_time_s,
                                   const ProcessFitParams& params) {
  require(moved >= 0 && moved <= inputs.cols(), "moved", "columns of the inputs");
  if (output.size() < kFewestRows) return std::nullopt;
  return onRecord(fit, inputs, output, sample_time_s, params,
                  [moved](const Fitter& fitter, const ProcessFit& same, const Scales& scales) {
                    auto curve = fitter.curve(same, moved);
                    if (!curve) return curve;
                    const double unit = curve->signal < 0 ? scales.y : scales.u[curve->signal];
                    curve->lower *= unit;
                    curve->upper *= unit;
                    curve->output *= scales.y;
                    return curve;
                  });
}

std::optional<ProcessNoise> noiseBeside(const ProcessFit& fit, const Matrix& inputs,
                                        const Vector& output, double sample_time_s) {
  if (output.size() < kFewestRows) return std::nullopt;
  return onRecord(fit, inputs, output, sample_time_s, {},
                  [](const Fitter& fitter, const ProcessFit& same, const Scales& scales) {
                    auto noise = fitter.noiseBeside(same);
                    if (noise) noise->one_step *= scales.y;
                    return noise;
                  });
}

}  // namespace fpc
