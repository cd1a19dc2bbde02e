// Records of a process element under feedback, for tests and studies of what is found in them.
#pragma once

#include <cmath>
#include <vector>

#include "base/random.hpp"
#include "model/process_element.hpp"

namespace fpc::test {

using Eigen::Index;

/// Output of an element, before noise, sample by sample.
class Response {
 public:
  explicit Response(const ProcessElement& element, double sample_time_s = 1.0)
      : s_(sampled(element, sample_time_s)), a_(product(s_.own, s_.shared)) {}
  /// y(k) from u(0..k-1), plus a load.
  double next(const Eigen::Ref<const Matrix>& u, double load = 0.0) {
    const auto k = static_cast<Index>(y_.size());
    double value = load;
    for (std::size_t i = 0; i < s_.b.size(); ++i) {
      const Index at = k - 1 - s_.delay - static_cast<Index>(i);
      if (at >= 0) value += s_.b[i] * u(at, 0);
    }
    for (std::size_t i = 1; i < a_.size() && i <= y_.size(); ++i)
      value -= a_[i] * y_[y_.size() - i];
    y_.push_back(value);
    return value;
  }

 private:
  SampledElement s_;
  std::vector<double> a_, y_;
};

struct Noise {
  double measurement{}, drift{}, coloured{}, load{};
};

struct Data {
  Matrix u;
  Vector y;
};

/// What a process shows whose gain grows e-fold over `range` times 1 / bend of its response; 0: as
/// it is.
inline double bent(double response, double bend, double range) {
  return bend == 0.0 ? response : range / bend * std::expm1(bend * response / range);
}

/// A record under a PI whose output carries binary noise of random dwell. `bend`: see bent(), with
/// the effect of the level as range.
inline Data record(const ProcessElement& element, double kp, double ki, double level,
                   const Noise& noise, Index rows, std::uint64_t seed, double bend = 0.0) {
  auto engine = seededEngine(seed, {3});
  Data d{Matrix::Zero(rows, 1), Vector(rows)};
  Response response(element);
  double drift = 0.0, coloured = 0.0, integral = 0.0, now = 0.0;
  int left = 0;
  for (Index k = 0; k < rows; ++k) {
    coloured = 0.9 * coloured + noise.coloured * standardNormal(engine);
    drift += noise.drift * standardNormal(engine);
    const double w = response.next(d.u, noise.load * standardNormal(engine));
    d.y[k] = bent(w, bend, std::abs(element.gain) * level) + drift + coloured +
             noise.measurement * standardNormal(engine);
    if (left-- <= 0) {
      left = static_cast<int>(3.0 * std::pow(10.0, uniform(engine)));
      now = uniform(engine) < 0.5 ? -level : level;
    }
    integral -= ki * d.y[k];
    d.u(k, 0) = k == 0 ? 0.0 : -kp * d.y[k] + integral + now;
  }
  return d;
}

}  // namespace fpc::test
