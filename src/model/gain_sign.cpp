#include "model/gain_sign.hpp"

#include <cmath>

#include "base/decompositions.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "fmbpc/model/local_model.hpp"

namespace fpc {
namespace {

constexpr double kCounts = 1.0 / 3.0;  // of the largest gain of an output
constexpr double kWorse = 5.0;         // an error one sample ahead, in parts of another
constexpr double kWeak = 0.05;         // of the largest gain of all directions
constexpr double kTakesPart = 0.1;     // of an input in a direction

/// Columns in parts of the inputs' ranges, where those are finite.
Matrix scaled(Matrix gains, const TsModel& model) {
  for (Eigen::Index j = 0; j < gains.cols(); ++j) {
    const SignalInfo& input = model.inputs[static_cast<std::size_t>(j)];
    const double range = input.upper - input.lower;
    if (std::isfinite(range) && range > 0.0) gains.col(j) *= range;
  }
  return gains;
}

/// The first large gain of output i that is turned round; -1: none.
Eigen::Index turnedInput(const Matrix& before, const Matrix& after, Eigen::Index i) {
  const double large_before = kCounts * before.row(i).cwiseAbs().maxCoeff();
  const double large_after = kCounts * after.row(i).cwiseAbs().maxCoeff();
  for (Eigen::Index j = 0; j < before.cols(); ++j) {
    const bool large =
        std::abs(before(i, j)) >= large_before && std::abs(after(i, j)) >= large_after;
    if (large && before(i, j) * after(i, j) < 0.0) return j;
  }
  return -1;
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

std::string weakDirection(const TsModel& model, const Measurement& at) {
  Matrix gains = scaled(stepGains(model, at), model);
  if (gains.cols() < 2 || gains.cols() > gains.rows() || !gains.allFinite()) return "";
  for (Eigen::Index i = 0; i < gains.rows(); ++i) {
    const SignalInfo& output = model.outputs[static_cast<std::size_t>(i)];
    const double range = output.upper - output.lower;
    if (std::isfinite(range) && range > 0.0) gains.row(i) /= range;
  }
  const Eigen::JacobiSVD<Matrix> svd = svdOf(gains, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Vector& sizes = svd.singularValues();
  const Eigen::Index last = sizes.size() - 1;
  if (!(sizes[0] > 0.0) || sizes[last] >= kWeak * sizes[0]) return "";
  std::string inputs;
  for (Eigen::Index j = 0; j < gains.cols(); ++j)
    if (std::abs(svd.matrixV()(j, last)) > kTakesPart)
      inputs += (inputs.empty() ? "" : ", ") + model.inputs[static_cast<std::size_t>(j)].name;
  return "moved together in one way, " + inputs + " have " + shortText(sizes[last] / sizes[0]) +
         " of the effect that they have in another: a model error of that size turns its sign";
}

std::vector<TurnedGain> turnedGains(const TsModel& running, const TsModel& fresh,
                                    const Measurement& at) {
  const Matrix before = scaled(stepGains(running, at), running);
  const Matrix after = scaled(stepGains(fresh, at), running);
  std::vector<TurnedGain> turned;
  if (!before.allFinite() || !after.allFinite()) return turned;
  for (Eigen::Index i = 0; i < before.rows(); ++i) {
    const Eigen::Index j = turnedInput(before, after, i);
    if (j < 0) continue;
    turned.push_back({running.outputs[static_cast<std::size_t>(i)].name,
                      running.inputs[static_cast<std::size_t>(j)].name, i});
  }
  return turned;
}

bool tooManyTurned(const std::vector<TurnedGain>& turned, const TsModel& fresh) {
  return 2 * turned.size() > fresh.outputs.size();
}

std::string wordsOf(const std::vector<TurnedGain>& turned, const TsModel& fresh) {
  std::string words;
  for (const TurnedGain& gain : turned)
    words += (words.empty() ? "" : ", ") + gain.input + " to " + gain.output;
  return words.empty() ? "" : "model '" + fresh.name + "' turns the sign of the gain from " + words;
}

void requireForeseen(const std::vector<TurnedGain>& turned, const TsModel& fresh,
                     const Vector& running_errors, const Vector& fresh_errors) {
  if (running_errors.size() == 0 || fresh_errors.size() == 0) return;
  for (const TurnedGain& gain : turned)
    if (fresh_errors[gain.row] > kWorse * running_errors[gain.row])
      throw InputError("model '" + fresh.name + "': expected to foresee " + gain.output +
                       " as well as the running model, since it turns the sign of the gain from " +
                       gain.input + ", got errors of " + shortText(fresh_errors[gain.row]) +
                       " instead of " + shortText(running_errors[gain.row]) + " one sample ahead");
}

void requireFewTurned(const std::vector<TurnedGain>& turned, const TsModel& fresh) {
  if (!tooManyTurned(turned, fresh)) return;
  throw InputError("model '" + fresh.name +
                   "': expected the sign of the running model's gain from " + turned[0].input +
                   " to " + turned[0].output + ", got the opposite");
}

}  // namespace fpc
