// What must hold of the record of any run: finite, inside its limits, the same again.
#pragma once

#include <cmath>
#include <string>

#include "config/loop_file.hpp"
#include "runtime/record.hpp"

namespace fpc {
namespace random_random_loops_test {

constexpr double kTolerance = 1e-9;  // of an input's range

/// Empty if all is finite.
inline std::string notFinite(const RunRecord& record) {
  for (std::size_t k = 0; k < record.samples.size(); ++k) {
    const SampleRecord& s = record.samples[k];
    const std::string at = " of sample " + std::to_string(k);
    if (!s.measurement.outputs.allFinite()) return "outputs" + at;
    if (!s.measurement.input_applied.allFinite()) return "applied input" + at;
    if (!s.state.state.allFinite()) return "state" + at;
    if (s.has_action && !s.action.input.allFinite()) return "action" + at;
  }
  return "";
}

inline bool isOfLaw(ActionSource source) {
  return source != ActionSource::kHeld && source != ActionSource::kManual &&
         source != ActionSource::kFallback;
}

/// From where the move of action k counts: from what is read, or, where a valve is not where the
/// law told it to be, from the command before (of others than the law: from the nearer).
inline Vector origin(const RunRecord& record, std::size_t k, const Vector& slack) {
  const SampleRecord& s = record.samples[k];
  Vector from = s.measurement.input_applied;
  if (k == 0 || !record.samples[k - 1].has_action) return from;
  const SampleRecord& before = record.samples[k - 1];
  const bool of_law = isOfLaw(s.action.source) && isOfLaw(before.action.source);
  for (Eigen::Index i = 0; i < from.size(); ++i) {
    const double u = s.action.input[i], last = before.action.input[i];
    const bool nearer = std::abs(u - last) < std::abs(u - from[i]);
    if (std::abs(from[i] - last) > slack[i] && (of_law || nearer)) from[i] = last;
  }
  return from;
}

/// Empty if every action and every applied input is inside its limits.
inline std::string beyondLimits(const LoopFile& loop, const RunRecord& record) {
  const InputLimits& limits = loop.simulation.actuator.limits;
  const Vector slack = kTolerance * (limits.upper - limits.lower);
  const auto inside = [&](const Vector& u) {
    return ((u - limits.lower + slack).array() >= 0.0).all() &&
           ((limits.upper - u + slack).array() >= 0.0).all();
  };
  for (std::size_t k = 0; k < record.samples.size(); ++k) {
    const SampleRecord& s = record.samples[k];
    const std::string at = " of sample " + std::to_string(k);
    if (!inside(s.measurement.input_applied)) return "applied input" + at;
    if (!s.has_action) continue;
    if (!inside(s.action.input)) return "action" + at;
    const Vector move = (s.action.input - origin(record, k, slack)).cwiseAbs();
    if (!((limits.move + slack - move).array() >= 0.0).all()) return "move" + at;
  }
  return "";
}

/// Whether nothing but the law acted in the whole run and every valve went where it was told.
inline bool isPlain(const LoopFile& loop, const RunRecord& record) {
  const InputLimits& limits = loop.simulation.actuator.limits;
  const Vector slack = kTolerance * (limits.upper - limits.lower);
  for (std::size_t k = 0; k + 1 < record.samples.size(); ++k) {
    const SampleRecord& s = record.samples[k];
    if (!s.has_action || !isOfLaw(s.action.source)) return false;
    const Vector& shown = record.samples[k + 1].measurement.input_applied;
    if (!((slack - (shown - s.action.input).cwiseAbs()).array() >= 0.0).all()) return false;
  }
  return record.samples.size() > 1;
}

/// In a plain run: the first command that is further from the one before than the move limit, by
/// commands alone and without a choice of origin; empty if there is none.
inline std::string beyondMoves(const LoopFile& loop, const RunRecord& record) {
  const InputLimits& limits = loop.simulation.actuator.limits;
  const Vector slack = kTolerance * (limits.upper - limits.lower);
  Vector last = record.samples.front().measurement.input_applied;
  for (std::size_t k = 0; k + 1 < record.samples.size(); ++k) {
    const Vector& u = record.samples[k].action.input;
    for (Eigen::Index i = 0; i < u.size(); ++i)
      if (!(std::abs(u[i] - last[i]) <= limits.move[i] + slack[i]))
        return "command " + std::to_string(i) + " of sample " + std::to_string(k);
    last = u;
  }
  return "";
}

/// The same bits; what is missing (a setpoint that nobody follows) equals what is missing.
inline bool same(const Vector& a, const Vector& b) {
  if (a.size() != b.size()) return false;
  return ((a.array() == b.array()) || (a.array().isNaN() && b.array().isNaN())).all();
}

/// The first sample that differs in what a plant and a controller say; -1 if none does.
inline int firstDifference(const RunRecord& a, const RunRecord& b) {
  if (a.samples.size() != b.samples.size()) return 0;
  for (std::size_t k = 0; k < a.samples.size(); ++k) {
    const SampleRecord &x = a.samples[k], &y = b.samples[k];
    const bool equal =
        same(x.measurement.outputs, y.measurement.outputs) &&
        same(x.measurement.input_applied, y.measurement.input_applied) &&
        same(x.state.state, y.state.state) && same(x.state.disturbances, y.state.disturbances) &&
        same(x.tracking.setpoint, y.tracking.setpoint) &&
        same(x.tracking.reference, y.tracking.reference) && same(x.action.input, y.action.input);
    if (!equal) return static_cast<int>(k);
  }
  return -1;
}

}  // namespace random_random_loops_test
}  // namespace fpc
