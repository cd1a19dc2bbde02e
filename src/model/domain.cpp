#include "fmbpc/model/domain.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/model/ts_model.hpp"
#include "model/process_trust.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kPi = 3.14159265358979323846;
constexpr Index kMostDomainRows = 5000;
constexpr double kStrays = 0.01;  // of the rows may lie where hardly any others do

double fade(double t) {
  if (t <= 0.0) return 1.0;
  return t >= 1.0 ? 0.0 : 0.5 * (1.0 + std::cos(kPi * t));
}

/// Rows without gaps, evenly spaced, at most kMostDomainRows; column: one row, scaled.
Matrix scaledRows(const Matrix& values, const Vector& scale) {
  std::vector<Index> whole;
  for (Index k = 0; k < values.rows(); ++k)
    if (values.row(k).allFinite()) whole.push_back(k);
  const Index n = std::min(kMostDomainRows, static_cast<Index>(whole.size()));
  Matrix rows(values.cols(), n);
  for (Index i = 0; i < n; ++i) {
    const auto from = static_cast<std::size_t>(i) * whole.size() / static_cast<std::size_t>(n);
    rows.col(i) = values.row(whole[from]).transpose().cwiseQuotient(scale);
  }
  return rows;
}

const SignalInfo& signalAt(const TsModel& model, Index i) {
  const auto n_y = static_cast<Index>(model.outputs.size());
  const auto n_u = static_cast<Index>(model.inputs.size());
  if (i < n_y) return model.outputs[static_cast<std::size_t>(i)];
  if (i < n_y + n_u) return model.inputs[static_cast<std::size_t>(i - n_y)];
  return model.disturbances[static_cast<std::size_t>(i - n_y - n_u)];
}

Index signalCount(const TsModel& model) {
  return static_cast<Index>(model.outputs.size() + model.inputs.size() + model.disturbances.size());
}

bool isInput(const TsModel& model, Index i) {
  const auto n_y = static_cast<Index>(model.outputs.size());
  return i >= n_y && i < n_y + static_cast<Index>(model.inputs.size());
}

/// Distance from the box of the ranges, in parts of each range.
double beyondRanges(const TsModel& model, VectorRef point, bool with_inputs) {
  double square = 0.0;
  for (Index i = 0; i < point.size(); ++i) {
    const SignalInfo& s = signalAt(model, i);
    const double range = s.upper - s.lower;
    if (!std::isfinite(range) || range <= 0.0 || (isInput(model, i) && !with_inputs)) continue;
    const double beyond = std::max({s.lower - point[i], point[i] - s.upper, 0.0}) / range;
    square += beyond * beyond;
  }
  return std::sqrt(square);
}

/// How far a signal is beyond its values at all centres, scaled.
double beyondCentres(const ModelDomain& domain, Index signal, double value) {
  const auto row = domain.centres.row(signal);
  return std::max({row.minCoeff() - value, value - row.maxCoeff(), 0.0}) / domain.scale[signal];
}

}  // namespace

void ModelDomain::validate(Index n) const {
  if (empty()) return;
  require(centres.rows() == n && centres.allFinite(), "domain.centres",
          "lists of " + std::to_string(n) + " finite numbers");
  require(scale.size() == n && (scale.array() > 0.0).all(), "domain.scale",
          std::to_string(n) + " numbers > 0");
  require(std::isfinite(radius) && radius > 0.0, "domain.radius", "a number > 0");
}

namespace {

/// The ranges of the columns; infinite where nothing moves.
Vector rangesOf(const Matrix& values) {
  Vector scale = Vector::Constant(values.cols(), kInfinity);
  for (Index j = 0; j < scale.size(); ++j) {
    double least = kInfinity, most = -kInfinity;
    for (Index k = 0; k < values.rows(); ++k) {
      if (!std::isfinite(values(k, j))) continue;
      least = std::min(least, values(k, j));
      most = std::max(most, values(k, j));
    }
    if (most > least) scale[j] = most - least;
  }
  return scale;
}

/// Rows that are farthest from those before, and how far any row is from the nearest of them.
std::vector<Index> spreadRows(const Matrix& rows, int centres, Vector& nearest) {
  nearest = Vector::Constant(rows.cols(), kInfinity);
  std::vector<Index> chosen;
  Index next = 0;
  (rows.colwise() - rows.rowwise().mean()).colwise().squaredNorm().minCoeff(&next);
  for (int c = 0; c < centres; ++c) {
    chosen.push_back(next);
    nearest =
        nearest.cwiseMin((rows.colwise() - rows.col(next)).colwise().squaredNorm().transpose());
    if (nearest.maxCoeff(&next) <= 0.0) break;
  }
  return chosen;
}

/// Leaves out the balls of radius sqrt(square) that hold the fewest rows, while together they hold
/// no more than kStrays of them.
std::vector<Index> denseOf(const Matrix& rows, const std::vector<Index>& chosen, double square) {
  std::vector<std::pair<Index, std::size_t>> held;
  for (std::size_t c = 0; c < chosen.size(); ++c) {
    const Index n =
        ((rows.colwise() - rows.col(chosen[c])).colwise().squaredNorm().array() <= square).count();
    held.emplace_back(n, c);
  }
  std::sort(held.begin(), held.end());
  std::vector<bool> kept(chosen.size(), true);
  double lost = 0.0;
  for (const auto& [n, c] : held) {
    lost += static_cast<double>(n);
    if (lost > kStrays * static_cast<double>(rows.cols())) break;
    kept[c] = false;
  }
  std::vector<Index> dense;
  for (std::size_t c = 0; c < chosen.size(); ++c)
    if (kept[c]) dense.push_back(chosen[c]);
  return dense;
}

}  // namespace

ModelDomain makeDomain(const Matrix& values, int centres) {
  ModelDomain domain;
  const Index n = values.cols();
  domain.scale = rangesOf(values);
  const Matrix rows = scaledRows(values, domain.scale);
  if (rows.cols() == 0) return {};
  Vector nearest;
  const std::vector<Index> chosen = spreadRows(rows, centres, nearest);
  const double square = nearest.maxCoeff();
  domain.radius = std::max(std::sqrt(square), 1e-3);
  const std::vector<Index> dense = denseOf(rows, chosen, square);
  domain.centres.resize(n, static_cast<Index>(dense.size()));
  for (std::size_t c = 0; c < dense.size(); ++c)
    for (Index j = 0; j < n; ++j)
      domain.centres(j, static_cast<Index>(c)) =
          std::isfinite(domain.scale[j]) ? rows(j, dense[c]) * domain.scale[j] : 0.0;
  return domain;
}

namespace {

/// Squared distance of outputs and disturbances from the nearest centre, scaled.
double nearestCentre(const TsModel& model, VectorRef point) {
  const ModelDomain& domain = model.domain;
  double nearest = kInfinity;
  for (Index c = 0; c < domain.centres.cols(); ++c) {
    double square = 0.0;
    for (Index j = 0; j < point.size(); ++j) {
      if (isInput(model, j)) continue;
      const double apart = (point[j] - domain.centres(j, c)) / domain.scale[j];
      square += apart * apart;
    }
    nearest = std::min(nearest, square);
  }
  return nearest;
}

double trustAt(const TsModel& model, VectorRef point, bool with_inputs) {
  const ModelDomain& domain = model.domain;
  if (!point.allFinite()) return 0.0;
  if (domain.empty()) return fade(beyondRanges(model, point, with_inputs) / kRangeFade);
  double square = nearestCentre(model, point);
  for (Index j = 0; j < point.size() && with_inputs; ++j) {
    if (!isInput(model, j)) continue;
    const double beyond = beyondCentres(domain, j, point[j]);
    square += beyond * beyond;
  }
  const double width = std::max(kDomainFade * domain.radius, kRangeFade);
  return fade((std::sqrt(square) - domain.radius) / width);
}

}  // namespace

double trustOf(const TsModel& model, VectorRef point) { return trustAt(model, point, true); }

double processTrustOf(const TsModel& model, VectorRef point) {
  return trustAt(model, point, false);
}

bool knowsDomain(const TsModel& model) {
  if (!model.domain.empty()) return true;
  for (Index i = 0; i < signalCount(model); ++i) {
    const SignalInfo& s = signalAt(model, i);
    if (std::isfinite(s.lower) && std::isfinite(s.upper)) return true;
  }
  return false;
}

}  // namespace fpc
