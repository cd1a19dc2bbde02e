// A loop that runs in a few milliseconds, with a badly tuned PI, and its tuning file.
#pragma once

#include <string>

#include "config/tuning_file.hpp"
#include "runtime/loop_fixture.hpp"

namespace fpc {

/// One lag of 10 min under a PI; noise of 0.001; 60 samples.
inline std::string lagLoop() {
  return "title: One lag\n"
         "plant:\n  type: transfer_matrix\n  matrix:\n"
         "    outputs: [{name: y, unit: g, nominal: 0, lower: -10, upper: 10}]\n"
         "    inputs: [{name: u, unit: g, nominal: 0, lower: -5, upper: 5}]\n"
         "    elements: [{output: y, from: u, gain: 2, time_constant_min: 10, dead_time_min: 1}]\n"
         "sampling: {sample_time_s: 60, duration_h: 1}\n"
         "setpoint: {initial: {y: 1}, schedule: [{time_h: 0.5, y: 0.5}]}\n"
         "noise: {std: {y: 0.001}}\n"
         "controller:\n  type: pi\n  loops:\n    - {input: u, output: y, kp: 0.2, ki_per_h: 0.5}\n";
}

/// Gains of that PI, for the ISE; judged with other noise.
inline std::string lagTuning(const std::string& more = "") {
  return "parameters:\n"
         "  - {key: controller.loops.0.kp, lower: 0.1, upper: 5, scale: log}\n"
         "  - {key: controller.loops.0.ki_per_h, lower: 0.1, upper: 100, scale: log}\n"
         "fitness:\n  terms:\n    - {index: ise, output: y}\n"
         "    - {index: effort, input: u, weight: 0.1}\n"
         "scenarios: {seeds: [1, 2]}\n"
         "held_out: {seeds: [3, 4, 5]}\n"
         "search: {population: 8, evaluations: 60}\n" +
         more;
}

}  // namespace fpc
