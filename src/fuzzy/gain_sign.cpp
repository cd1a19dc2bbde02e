#include "fmbpc/fuzzy/gain_sign.hpp"

#include <cmath>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "fmbpc/fuzzy/local_model.hpp"

namespace fpc {
namespace {

constexpr double kCounts = 1.0 / 3.0;  // of the largest gain of an output

/// Columns in parts of the inputs' ranges, where those are finite.
Matrix scaled(Matrix gains, const TsModel& model) {
  for (Eigen::Index j = 0; j < gains.cols(); ++j) {
    const SignalInfo& input = model.inputs[static_cast<std::size_t>(j)];
    const double range = input.upper - input.lower;
    if (std::isfinite(range) && range > 0.0) gains.col(j) *= range;
  }
  return gains;
}

struct Turned {
  Eigen::Index outputs{}, output{-1}, input{-1};  // how many outputs; the first gain
};

Turned compared(const Matrix& before, const Matrix& after) {
  Turned turned;
  for (Eigen::Index i = 0; i < before.rows(); ++i) {
    bool here = false;
    for (Eigen::Index j = 0; j < before.cols(); ++j) {
      const bool counts = std::abs(before(i, j)) >= kCounts * before.row(i).cwiseAbs().maxCoeff() &&
                          std::abs(after(i, j)) >= kCounts * after.row(i).cwiseAbs().maxCoeff();
      if (!counts || !(before(i, j) * after(i, j) < 0.0)) continue;
      if (turned.output < 0) turned.output = i, turned.input = j;
      here = true;
    }
    if (here) ++turned.outputs;
  }
  return turned;
}

}  // namespace

Matrix stepGains(const TsModel& model, const Measurement& at) {
  LocalModel local(model);
  Vector state(local.stateSize());
  local.restState(at.outputs, at.input_applied, at.disturbances, state);
  local.blend(state, at.disturbances);
  const AffineModel& affine = local.affine();
  PowerSum powers(local.stateSize());
  powers.compute(affine.A, kGainSamples);
  return affine.C * powers.sum() * affine.B;
}

void requireSameGainSigns(const TsModel& running, const TsModel& fresh, const Measurement& at) {
  const Matrix before = scaled(stepGains(running, at), running);
  const Matrix after = scaled(stepGains(fresh, at), running);
  if (!before.allFinite() || !after.allFinite()) return;
  const Turned turned = compared(before, after);
  if (2 * turned.outputs <= before.rows()) return;
  const auto name = [](const std::vector<SignalInfo>& signals, Eigen::Index k) {
    return signals[static_cast<std::size_t>(k)].name;
  };
  throw InputError("model '" + fresh.name +
                   "': expected the sign of the running model's gain from " +
                   name(fresh.inputs, turned.input) + " to " + name(fresh.outputs, turned.output) +
                   ", got the opposite (plausibility.gain_sign)");
}

}  // namespace fpc
