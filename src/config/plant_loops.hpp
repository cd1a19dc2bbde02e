// A plant file read into structs: the loops of a plant, where each runs, and what they pass on to
// each other. All keys: docs/plant_loops.md.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/loop_file.hpp"

namespace fpc {

/// A signal of another loop that a loop takes for one of its own.
struct LoopLink {
  /// What of this loop the signal stands for.
  enum class To {
    kDisturbance,  ///< of its plant
    kInput,        ///< what its plant gets as this input: the inner loop's output in a cascade
    kSetpoint,     ///< of its controller: the outer loop's input in a cascade
    kForecast,     ///< what its controller expects of a disturbance: the other loop's plan
    kPace          ///< of nothing: in lockstep the loop does not run too far ahead of its listener
  };
  /// What of the other loop: its measurement's outputs, its inputs as asked, or as planned.
  enum class Of { kOutputs, kInputs, kPlan };
  std::string from;  ///< name of the other loop
  Of of{Of::kOutputs};
  Eigen::Index index{};     ///< there
  std::int64_t every_ns{};  ///< between two samples of it
  std::int64_t reach_ns{};  ///< lockstep: the latest one may be so much older than what needs it
  std::int64_t first_ns{}, last_ns{};  ///< times of the first and the last of them
  To to{To::kDisturbance};
  std::string name;  ///< of the disturbance, input or output
  double gain{1.0}, offset{};
  double lower{}, upper{};  ///< what `name` may be
};

/// One of the loops.
struct PlantLoop {
  std::string name;     ///< also its namespace below the plant's
  std::string machine;  ///< where it runs; empty: where the plant file is launched without one
  bool isolate{};       ///< in a process of its own
  LoopFile loop;
  std::vector<LoopLink> links;  ///< what it takes from others
};

struct PlantLoops {
  std::string name;  ///< the file's stem
  std::string file, title;
  std::vector<PlantLoop> loops;

  /// @throws InputError naming the loops that there are.
  const PlantLoop& of(const std::string& loop) const;
};

/// A plant file from its name in config/plant, or path. `set`: laid over all its loops.
/// @throws InputError naming file, line, key and what was expected, in a loop's file too.
PlantLoops readPlantLoops(const std::string& name_or_path, const Overrides& set = {});

std::string findPlantLoops(const std::string& name_or_path);

/// Links as text for the parameter `loop_links` and back, without a bit lost.
std::string textOf(const std::vector<LoopLink>& links);
std::vector<LoopLink> parseLinks(const std::string& text, const std::string& name);

}  // namespace fpc
