// A loop with a gateway, and a plant behind it that counts what it is told.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "config/loop_file.hpp"
#include "runtime/plant_gateway.hpp"

namespace fpc {

/// One output, one disturbance, one input inside [0, 10] with moves of 1; fallback 4 after 3
/// samples.
inline LoopFile gatewayLoop(const std::string& gateway) {
  return parseLoop(
      "plant:\n  type: external\n  name: tank\n"
      "  outputs: [{name: level, unit: m, lower: 0, upper: 4}]\n"
      "  inputs: [{name: inflow, unit: m3/h, lower: 0, upper: 10}]\n"
      "  disturbances: [{name: rain, unit: m3/h, lower: 0, upper: 5}]\n"
      "sampling: {sample_time_s: 1, duration_h: 1}\n"
      "setpoint: {initial: {level: 1}}\n"
      "controller: {type: pi, loops: [{input: inflow, output: level, kp: 1}]}\n"
      "actuator: {move_upper: {inflow: 1}, initial: {inflow: 2}, hold_samples: 3, fallback: "
      "{inflow: 4}}\n"
      "gateway:\n" +
          gateway,
      "tank");
}

inline LoopFile topicLoop() {
  return gatewayLoop("  type: float64\n  stale_s: 2\n  tags: {inflow: {readback: inflow/now}}\n");
}

inline LoopFile modbusLoop() {
  return gatewayLoop(
      "  type: modbus\n  stale_s: 2\n  heartbeat_s: 3\n  modbus: {heartbeat_in: 20}\n"
      "  tags:\n    level: {register: 0}\n    rain: {register: 2}\n"
      "    inflow: {register: 4, type: int16, scale: 0.3}\n");
}

inline Vector one(double value) { return Vector::Constant(1, value); }

}  // namespace fpc
