// Section `targets` of a loop file: what is asked of a plant at rest.
#pragma once

#include <vector>

#include "estimation/disturbance_observer.hpp"
#include "fmbpc/base/exchange.hpp"
#include "fmbpc/base/input_limits.hpp"
#include "fmbpc/base/types.hpp"

namespace fpc {

struct ControllerContext;
class YamlSection;

/// A zone, a setpoint, or both; of neither nothing is asked.
struct TargetOutput {
  double lower{-kInfinity}, upper{kInfinity};  ///< zone
  int rank{1};                                 ///< of the zone; 1 is kept first
  bool setpoint{false};                        ///< the one of section `setpoint` is asked for
  double unit{1.0};         ///< > 0: how much given up counts as much as one unit of another
  double price{0.0};        ///< of one unit; negative: it earns
  bool integrating{false};  ///< held in balance at the level where it is
  bool hasZone() const { return lower > -kInfinity || upper < kInfinity; }
};

struct TargetInput {
  double lower{}, upper{};  ///< never given up, inside the actuator's
  double rest{};            ///< where it ideally stands; NaN: where its last target was
  double price{0.0};
};

struct TargetParams {
  bool enabled{false};
  std::vector<TargetOutput> outputs;  ///< n_y
  std::vector<TargetInput> inputs;    ///< n_u
  double band{0.0};   ///< of the cost, >= 0: as long as the last target costs no more above the
                      ///< least, it stays as near as the limits allow
  int iterations{5};  ///< most linearisations per sample
  ObserverParams observer;
  /// @throws InputError naming the field.
  void validate(const PlantInfo& plant, const InputLimits& limits) const;
  int lastRank() const;  ///< the largest of all
};

/// Reads the section's keys over defaults. @throws InputError naming file, key and what was
/// expected.
TargetParams readTargetParams(YamlSection& section, const ControllerContext& loop);

}  // namespace fpc
