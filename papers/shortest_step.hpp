// How fast could any controller be? The quickest step response that the plant and the limits of its
// input allow, found by simulation: the input at one limit, then at the other.
#pragma once

#include "config/loop_file.hpp"

namespace fpc {

struct ShortestStep {
  double rise_s{};             ///< from 10 to 90 % of the step, straight lines between samples
  double overshoot_percent{};  ///< of the step
  double pulse_s{};            ///< how long the input stands at the limit that drives the output
};

/// The loop's plant, at rest at its initial state and `actuator.initial`, is to bring its first
/// output to `target` with at most `overshoot_percent` beyond it. With one input and an output that
/// rises monotonely with it, time-optimal control is bang-bang (Pontryagin): the limit that drives
/// towards the target as long as the overshoot allows, then the other one. Begin and length of that
/// pulse are free, also between samples, where the input takes the mean; the begin is searched in
/// twentieths of a sample, the length by bisection. Nothing after the response has turned round
/// counts. (A run-up the other way first could shorten the 10 to 90 % rise further, at the price of
/// a later arrival; that is not looked for.) Works on the run's length; setpoints, controller,
/// model and noise play no part.
/// @throws InputError unless the plant is simulated, has one input, and the target is another
/// value than that at rest and can be reached within the run.
ShortestStep shortestStep(const LoopFile& loop, double target, double overshoot_percent);

}  // namespace fpc
