// Processes that do not come to rest: how far a run may go before it says nothing.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "base/decompositions.hpp"
#include "identification/auto_candidate.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr Index kLongestReach = 30, kShortestReach = 10;
constexpr double kGrowth = 20.0;     // of an error within the reach
constexpr double kOutside = 1.0005;  // a pole beyond it is unstable
constexpr double kOfRecord = 2.0;    // time constants that a record must hold

struct SlowestPoles {
  double outside{};  ///< largest radius
  double real{};     ///< largest real pole
};

/// Poles of y(k+1) = a_1 y(k) + .. + a_n y(k-n+1).
SlowestPoles polesOf(const Eigen::Ref<const Vector>& a) {
  const Index n = a.size();
  Matrix companion = Matrix::Zero(n, n);
  companion.row(0) = a.transpose();
  for (Index i = 1; i < n; ++i) companion(i, i - 1) = 1.0;
  SlowestPoles slowest;
  const Eigen::VectorXcd poles = eigenOf(companion).eigenvalues();
  for (const auto& pole : poles) {
    slowest.outside = std::max(slowest.outside, std::abs(pole));
    if (std::abs(pole.imag()) < 1e-6) slowest.real = std::max(slowest.real, pole.real());
  }
  return slowest;
}

/// One-step least squares of the order (2 to 4) with the lowest final prediction error.
SlowestPoles oneStepPoles(const AutoData& p) {
  const auto n_y = static_cast<Index>(p.data->outputs.size());
  const Index m = p.scaled.cols() - n_y;
  double lowest = kInfinity;
  SlowestPoles best;
  for (Index order = 2; order <= 4; ++order) {
    const Index q = order * (1 + m) + 1;
    Matrix H = 1e-8 * Matrix::Identity(q, q);
    Vector g = Vector::Zero(q), x(q);
    double squares = 0.0, n = 0.0;
    for (const auto& w : p.windows)
      for (Index k = w.first + order; k + 1 < w.last; ++k) {
        for (Index lag = 0; lag < order; ++lag) x[lag] = p.y(k - lag);
        for (Index j = 0; j < m; ++j)
          for (Index lag = 0; lag < order; ++lag)
            x[order * (1 + j) + lag] = p.scaled(k - lag, n_y + j);
        x[q - 1] = 1.0;
        if (!x.allFinite() || !std::isfinite(p.y(k + 1))) continue;
        H.selfadjointView<Eigen::Lower>().rankUpdate(x);
        g += x * p.y(k + 1);
        squares += p.y(k + 1) * p.y(k + 1);
        n += 1.0;
      }
    if (n < 5.0 * static_cast<double>(q)) continue;
    const Vector theta = H.selfadjointView<Eigen::Lower>().ldlt().solve(g);
    const double share = static_cast<double>(q) / n;
    const double error = std::max(squares - g.dot(theta), 0.0) * (1.0 + share) / (1.0 - share);
    if (!(error < lowest)) continue;
    lowest = error;
    best = polesOf(theta.head(order));
  }
  return best;
}

/// The same of a first-order model fitted to free runs, which noise does not pull inside.
SlowestPoles freeRunPole(const AutoData& p) {
  Candidate c;
  c.order = c.input_terms = 1;
  c.delay.assign(p.data->inputs.size() + p.data->disturbances.size(), 0);
  const Fitted fitted = fitCandidate(p, c, p.windows);
  return fitted.finite ? polesOf(fitted.parameters.head(1)) : SlowestPoles{};
}

}  // namespace

Index reachOf(const AutoData& p) {
  const double nearly =
      1.0 - kOfRecord / static_cast<double>(std::max<Index>(rowsOf(p.windows), 10));
  const SlowestPoles step = oneStepPoles(p), run = freeRunPole(p);
  const double outside = std::max(step.outside, run.outside);
  if (!(outside > kOutside) && !(std::max(step.real, run.real) > nearly)) return 0;
  if (!(outside > kOutside)) return kLongestReach;
  return std::clamp(static_cast<Index>(std::log(kGrowth) / std::log(outside)), kShortestReach,
                    kLongestReach);
}

}  // namespace fpc
