// The contract between a plant and everything that simulates it: sizes, names, equations. One plant
// = one .cpp.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "fmbpc/base/exchange.hpp"
#include "fmbpc/base/layout.hpp"
#include "fmbpc/base/types.hpp"

namespace fpc {

/// A named quantity with its unit, usual value and physical range.
struct Quantity {
  std::string name;
  std::string unit;
  double nominal{};
  double lower{};
  double upper{};
};

/// A piece of equipment: position [m] of its frame in the parent frame.
struct EquipmentFrame {
  std::string name;
  std::string parent;
  double x{}, y{}, z{};
};

/// What a plant is, before it moves.
struct PlantDescription {
  std::string name;
  std::string title;        ///< one line: what it is, source
  double time_unit_s{1.0};  ///< derivatives are per this many seconds
  std::vector<Quantity> states;
  std::vector<Quantity> inputs;
  std::vector<Quantity> disturbances;
  std::vector<Quantity> algebraic;     ///< what can be measured and is no state: y = h(x, u)
  std::vector<std::string> outputs;    ///< default measured outputs: names of states or `algebraic`
  std::vector<Quantity> parameters;    ///< what a loop file may override under plant.parameters
  std::vector<EquipmentFrame> frames;  ///< the first one is the plant's own frame
  std::map<std::string, std::string> output_frames;  ///< state name -> frame of its analyser
  std::vector<std::string> hidden_disturbances;      ///< not measured unless a loop file says so
  std::map<std::string, double>
      noise_std;  ///< white noise per sample of an output's measurement, or
                  ///< of a disturbance, unless a loop file says otherwise
};

/// Moves a plant that is no differential equation in its state (dead times, difference equations),
/// exactly, one sample at a time, in place of an integrator.
class PlantStepper {
 public:
  virtual ~PlantStepper() = default;
  virtual void reset(VectorRef u, VectorRef d) = 0;  ///< the plant has rested at these
  /// Moves x over the sample with u and d held. No allocation.
  virtual void advance(Eigen::Ref<Vector> x, VectorRef u, VectorRef d) = 0;
  /// False for a difference equation: x, u and d say everything, as with an integrator.
  virtual bool remembers() const { return true; }
  /// False if the sample time is part of the plant: it cannot be moved over a part of a sample.
  virtual bool divisible() const { return true; }
  /// Why the state after the last advance() is none of the plant's: it is not used then. Empty
  /// (default) if it is one, or not finite, which is seen anyway.
  virtual std::string failure() const { return {}; }
};

/// dx/dt = f(x, u, d), y = h(x, u, d): measured outputs are states or `algebraic`.
class Plant {
 public:
  virtual ~Plant() = default;
  virtual const PlantDescription& description() const = 0;
  /// dxdt [unit of the state per time unit]; must be finite for finite arguments inside the ranges.
  virtual void derivatives(VectorRef x, VectorRef u, VectorRef d,
                           Eigen::Ref<Vector> dxdt) const = 0;
  /// The description's `algebraic` quantities at x and d, with u the input in force until then.
  /// Without allocation. Default: there are none.
  virtual void algebraic(VectorRef x, VectorRef u, VectorRef d, Eigen::Ref<Vector> y) const;
  /// What a local loop inside the plant, sampled with the exchange, makes of the applied input:
  /// called once per sample before the integration, u is written over and then held. x: the state
  /// now, before: one sample ago (at the start the same). Controllers never see what it adds.
  /// Default: no such loop.
  virtual void localLoop(VectorRef x, VectorRef before, Eigen::Ref<Vector> u) const;
  /// nullptr (default): derivatives() say everything and an integrator moves the plant. May keep a
  /// reference to the plant.
  virtual std::unique_ptr<PlantStepper> makeStepper(double sample_time_s) const;
};

/// Parameter values by name; absent names keep the description's nominal values.
using PlantParameters = std::map<std::string, double>;
using PlantFactory = std::function<std::unique_ptr<Plant>(const PlantParameters&)>;
class YamlSection;
/// Reads what a type needs of section `plant` of a loop file to make the plant. @throws InputError
using PlantReader = std::function<PlantFactory(YamlSection& plant)>;

using PlantLayout = LayoutOf<PlantDescription, Quantity, EquipmentFrame, Plant, PlantStepper>;
template <>
void requireSameLayout<PlantLayout>();
/// False if the name is taken.
bool addPlant(const std::string& name, PlantFactory factory);
/// Called by the registration line of each plant.
inline bool registerPlant(const std::string& name, PlantFactory factory) {
  requireSameLayout<PlantLayout>();
  return addPlant(name, std::move(factory));
}
/// Called by the registration line of a type whose equations are in the loop file. `title`: one
/// line for lists.
bool registerPlantReader(const std::string& name, const std::string& title, PlantReader reader);
/// All types with their titles: those of plantNames() and those whose equations are in a loop file.
std::map<std::string, std::string> plantTypes();
/// Of any type; `plant` is read by those that need it. @throws InputError
PlantFactory plantFactory(const std::string& type, YamlSection& plant);
/// @throws InputError with the known names, or naming an unknown parameter.
std::unique_ptr<Plant> makePlant(const std::string& name, const PlantParameters& parameters = {});
std::vector<std::string> plantNames();  ///< of plants that need nothing but parameters
/// Names that were registered although they were taken, in the order in which that happened.
std::vector<std::string> refusedPlants();

/// The description's parameters with `parameters` written over them, in the description's order.
/// @throws InputError on an unknown name, a non-finite value or one outside [lower, upper].
Vector parameterValues(const PlantDescription& description, const PlantParameters& parameters);

}  // namespace fpc
