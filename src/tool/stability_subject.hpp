// What `fmbpc stability` looks at: a model, the law around it, the plant behind it if there is one,
// and a point.
#pragma once

#include <memory>
#include <string>

#include "analysis/closed_loop.hpp"
#include "analysis/fuzzy_equilibrium.hpp"
#include "config/loop_file.hpp"
#include "fmbpc/plant/plant.hpp"

namespace fpc::tool {

struct StabilitySubject {
  std::string name;
  std::shared_ptr<const LoopFile> loop;  ///< none for a model alone; never of an external plant
  bool has_model{false};                 ///< with a law that is linear around it
  TsModel model;
  LoopLaw law;
  std::shared_ptr<const Plant> plant;  ///< none for a model alone
  double sample_time_s{};
  double input_lower{}, input_upper{};       ///< with a plant: the loop's limits of its first input
  bool lower_said{}, upper_said{};           ///< in the loop file, not the plant's by default
  std::string note;                          ///< what the analysis does not cover of this subject
  Vector outputs, input, disturbances;       ///< the point, in the model's order
  std::vector<FuzzyEquilibrium> equilibria;  ///< of the model for that input
};

/// Loops go before models of the same name. `at` is "name=value,...": outputs given choose the
/// nearest equilibrium; `set` is KEY=VALUE over the loop file. @throws InputError naming what was
/// not understood.
StabilitySubject readSubject(const std::string& name, const std::vector<std::string>& set,
                             const std::string& at, bool on_model);

}  // namespace fpc::tool
