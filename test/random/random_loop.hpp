// Random loop files that a user could have written: any plant, any controller that can run it,
// limits, delays, noise, disturbances, setpoints. The same seed gives the same text.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace fpc {

struct RandomLoop {
  std::uint64_t seed{};
  std::string controller, plant;
  std::string text;                          ///< the loop file
  std::map<std::string, std::string> files;  ///< records beside it: name -> content
  std::vector<std::string> outputs;          ///< in the order of plant.outputs

  /// Everything that is needed to see what was run, for messages.
  std::string told() const;
};

/// Types of controllers that random_controllers.cpp has no generator for: none has to.
std::vector<std::string> typesWithoutGenerator();

/// A few of them, more for more types, are of those types: randomShippedLoop().
RandomLoop randomLoop(std::uint64_t seed,
                      const std::vector<std::string>& shipped = typesWithoutGenerator());

/// The first shipped loop of a type of controller, shortened, with noise and a fault of an
/// actuator. @throws InputError if no loop is shipped.
RandomLoop randomShippedLoop(const std::string& type, std::uint64_t seed);

/// A random transfer matrix under PI or a law with a model, its first output and input counted in
/// units `output_unit` and `input_unit` times as small, that output from `output_zero` on.
RandomLoop randomMatrixLoop(std::uint64_t seed, double output_unit = 1.0, double input_unit = 1.0,
                            double output_zero = 0.0);

}  // namespace fpc
