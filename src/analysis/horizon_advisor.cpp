#include "analysis/horizon_advisor.hpp"

#include <cmath>
#include <cstdio>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

constexpr int kSimulated = 5000;  // samples
constexpr double kBand = 0.02;
constexpr int kGramianDoublings = 40;

/// W = A W A' + G G', by doubling.
Matrix stationaryVariance(Matrix A, const Matrix& G) {
  Matrix W = G * G.transpose();
  for (int i = 0; i < kGramianDoublings; ++i) {
    W += (A * W * A.transpose()).eval();
    A = (A * A).eval();
  }
  return W;
}

std::string sentence(const char* format, double a, double b) {
  char text[160];
  std::snprintf(text, sizeof text, format, a, b);
  return text;
}

}  // namespace

int settlingSamples(const LinearModel& model, const LoopLaw& law, double reference_pole) {
  const ClosedLoop loop = closeLoop(model, law);
  if (!loop.applicable || !(spectralRadius(loop.values) < 1.0)) return -1;
  const Eigen::Index last = model.affine.C.rows() - 1;
  Vector xi = Vector::Zero(model.affine.A.rows());
  double left = std::pow(reference_pole, law.coincidence_steps);
  int outside = -1;
  for (int k = 0; k < kSimulated; ++k) {
    const double y = model.affine.C.row(last).dot(xi);
    if (!(std::abs(y - 1.0) <= kBand)) outside = k;
    const double u = loop.F(0, last) * (1.0 - left) - loop.K.row(0).dot(xi);
    xi = (model.affine.A * xi + model.affine.B.col(0) * u).eval();
    left *= reference_pole;
  }
  return outside == kSimulated - 1 ? -1 : outside + 1;
}

HorizonFigures horizonFigures(const LinearModel& model, const LoopLaw& law) {
  HorizonFigures figures;
  figures.coincidence_steps = law.coincidence_steps;
  const ClosedLoop loop = closeLoop(model, law);
  if (!loop.applicable) return figures;
  figures.radius = spectralRadius(loop.values);
  figures.stable = figures.radius < 1.0;
  if (!figures.stable) return figures;
  const Vector F = loop.F.col(loop.F.cols() - 1);
  const Matrix W = stationaryVariance(loop.A, loop.B * F);
  figures.noise_gain = std::sqrt(F[0] * F[0] + loop.K.row(0).dot(W * loop.K.row(0).transpose()));
  figures.settling = settlingSamples(model, law, 0.0);
  return figures;
}

HorizonAdvice adviseHorizon(const LinearModel& model, LoopLaw law, const HorizonLimits& limits) {
  require(limits.noise_gain > 0.0 && limits.settling > 0 && limits.longest > 0, "limits",
          "numbers > 0");
  HorizonAdvice advice;
  int first_stable = 0;
  for (law.coincidence_steps = 1; law.coincidence_steps <= limits.longest;
       ++law.coincidence_steps) {
    const HorizonFigures figures = horizonFigures(model, law);
    if (!figures.stable) continue;
    if (first_stable == 0) {
      first_stable = law.coincidence_steps;
      advice.reasons.push_back(sentence("H = %.0f is the shortest stable horizon, noise gain %.4g",
                                        first_stable, figures.noise_gain));
    }
    if (figures.noise_gain > limits.noise_gain) continue;
    advice.figures = figures;
    advice.coincidence_steps = law.coincidence_steps;
    break;
  }
  if (first_stable == 0) {
    advice.reasons.emplace_back("no horizon gives a stable loop with this model");
    return advice;
  }
  if (advice.coincidence_steps == 0) {
    advice.reasons.push_back(sentence("no horizon up to %.0f keeps the noise gain below %.4g",
                                      limits.longest, limits.noise_gain));
    return advice;
  }
  advice.reasons.push_back(sentence("H = %.0f is the shortest that keeps the noise gain: %.4g",
                                    advice.coincidence_steps, advice.figures.noise_gain));
  const int fastest = advice.figures.settling;
  if (fastest < 0 || fastest > limits.settling) {
    advice.reasons.push_back(
        sentence("even without a reference path it settles in %.0f samples, not in %.0f", fastest,
                 limits.settling));
    return advice;
  }
  for (int hundredths = 99; hundredths >= 0; --hundredths) {
    advice.reference_pole = 0.01 * hundredths;
    const int settling = settlingSamples(model, law, advice.reference_pole);
    if (settling < 0 || settling > limits.settling) continue;
    advice.reasons.push_back(
        sentence("a_r = %.2f is the slowest, hence gentlest, reference that settles: in %.0f "
                 "samples",
                 advice.reference_pole, settling));
    advice.found = true;
    break;
  }
  return advice;
}

}  // namespace fpc
