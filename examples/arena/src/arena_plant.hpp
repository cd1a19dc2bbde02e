// What the plants of the arena have in common: a description, and the numbers of its parameters.
#pragma once

#include <fmbpc/plant/plant.hpp>

#include <memory>
#include <utility>

namespace arena {

class ArenaPlant : public fpc::Plant {
 public:
  /// @throws fpc::InputError naming a parameter that the description has not, or out of its range.
  ArenaPlant(fpc::PlantDescription description, const fpc::PlantParameters& given)
      : description_(std::move(description)), p_(fpc::parameterValues(description_, given)) {
    description_.frames = {{"plant", "map", 0.0, 0.0, 0.0}};
  }
  const fpc::PlantDescription& description() const override { return description_; }

 protected:
  fpc::PlantDescription description_;
  fpc::Vector p_;  ///< in the order of the description's parameters
};

/// The registration line of a plant.
template <typename Type>
bool registered(const char* name) {
  return fpc::registerPlant(
      name, [](const fpc::PlantParameters& given) { return std::make_unique<Type>(given); });
}

}  // namespace arena
