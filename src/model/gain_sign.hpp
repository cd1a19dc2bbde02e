// Does a new model push the plant the same way as the one it replaces?
#pragma once

#include <string>
#include <vector>

#include "fmbpc/base/exchange.hpp"
#include "fmbpc/model/ts_model.hpp"

namespace fpc {

/// n_y n_u: how far each output has moved kGainSamples samples after a step of one unit in an
/// input, with the rules frozen as they fire at the sample, taken as a state of rest. `model` must
/// be matched to the plant. Not finite where the model is unstable.
Matrix stepGains(const TsModel& model, const Measurement& at);
inline constexpr int kGainSamples = 1024;

/// What a model error turns round: with outputs and inputs in parts of their ranges, a direction of
/// the inputs whose gain is less than 0.05 of the largest, in words; empty if there is none, with
/// one input, or more inputs than outputs.
std::string weakDirection(const TsModel& model, const Measurement& at);

/// An output, and the first of its large gains that is turned round, by names.
struct TurnedGain {
  std::string output, input;
  Eigen::Index row{};  ///< of the output
};

/// Gains count where they are at least a third of the largest of their output, in both models and
/// in parts of the inputs' ranges. One entry per output; none for models whose gains are not
/// finite, which are not judged.
std::vector<TurnedGain> turnedGains(const TsModel& running, const TsModel& fresh,
                                    const Measurement& at);
/// A model that was learned anew may know better in some outputs: more than half of them are too
/// many.
bool tooManyTurned(const std::vector<TurnedGain>& turned, const TsModel& fresh);
/// "model 'new' turns the sign of the gain from q_r to x, q_r to s"; empty if there is none.
std::string wordsOf(const std::vector<TurnedGain>& turned, const TsModel& fresh);

/// Errors of both models one sample ahead over the same samples (n_y; empty: not known): an output
/// whose gain a model turns it must not foresee more than five times as badly. (Models learned
/// online from few samples err twice as much without harm; one that is negated errs far more.)
/// @throws InputError naming output and input of the first that it does.
void requireForeseen(const std::vector<TurnedGain>& turned, const TsModel& fresh,
                     const Vector& running_errors, const Vector& fresh_errors);
/// @throws InputError naming the first output and input whose sign is turned round, if too many
/// are.
void requireFewTurned(const std::vector<TurnedGain>& turned, const TsModel& fresh);

}  // namespace fpc
