// Every type of controller, registered by its own file: what it is, how its section of a loop file
// is read, how it is made. Everything else learns of controllers here.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "fmbpc/base/layout.hpp"
#include "fmbpc/base/yaml_section.hpp"
#include "fmbpc/control/controller.hpp"
#include "fmbpc/control/settings.hpp"

namespace fpc {

class SampleModel;

/// What a loop tells its controller. A controller that can see the plant is not being tested:
/// nothing here comes from the plant but what an operator knows, and `plant_model`, for baselines
/// that are told the truth.
struct ControllerContext {
  PlantInfo plant;
  InputLimits limits;
  Vector initial_input;        ///< n_u, u(-1)
  Vector fallback_input;       ///< n_u, what the actuator falls back to
  Vector disturbance_nominal;  ///< n_d, of the measured disturbances
  Vector noise_std;            ///< n_y, of the measurements, as the loop file states, with that of
                               ///< their resolution; 0: unknown
  int perturbation_steps{0};   ///< n_c of the optimizer behind the controller; 0: there is none
  /// One sample of the simulated plant by four Runge-Kutta steps; empty for an external plant.
  /// @throws InputError for a plant that has no such model.
  std::function<std::unique_ptr<SampleModel>()> plant_model;
  bool quantised{false};  ///< the resolution of an output is stated
  std::uint64_t seed{1};  ///< of the run, for what a controller draws

  std::vector<std::string> outputs() const;       ///< names, in the order of PlantInfo
  std::vector<std::string> inputs() const;        ///< names
  std::vector<std::string> disturbances() const;  ///< names of the measured ones
  Eigen::Index outputCount() const;               ///< n_y
  Eigen::Index inputCount() const;                ///< n_u
};

/// What a controller of a loop looks at, and what it moves.
struct SignalUse {
  std::vector<bool> needed;  ///< outputs, then measured disturbances: without one it has no answer
  std::vector<Eigen::Index> followed;    ///< outputs that it steers to their setpoints
  std::vector<bool> moved{};             ///< inputs; the others stay where they are. Empty: all
  std::vector<std::string> estimated{};  ///< disturbances of its model that nobody measures
  bool looks_ahead{};                    ///< takes Controller::expect()
};
SignalUse everySignal(const ControllerContext& loop);
SignalUse noSignal(const ControllerContext& loop);
/// True for these inputs, for SignalUse::moved.
std::vector<bool> theseInputs(const ControllerContext& loop, const std::vector<int>& inputs);
/// Indices of the outputs with a weight above 0.
std::vector<Eigen::Index> weighted(VectorRef weight_output);

/// What the rest of the house knows of a type.
struct ControllerType {
  std::string name;                     ///< controller.type
  std::string summary;                  ///< one line for lists
  bool needs_model{false};              ///< it waits for a fuzzy model
  bool predicts{false};                 ///< an optimizer (clp) can stand behind it
  bool open_loop{false};                ///< it follows no setpoint
  std::vector<SettingInfo> settings{};  ///< what may change in a run; empty: nothing
};

/// The section `controller` of a loop file, read and valid.
class ControllerConfig {
 public:
  explicit ControllerConfig(const ControllerType& type) : type_(type) {}
  virtual ~ControllerConfig() = default;
  const ControllerType& type() const { return type_; }
  virtual std::unique_ptr<Controller> make(const ControllerContext& loop) const = 0;
  /// @throws InputError if the controller cannot work with this model, matched to the plant.
  virtual void checkModel(const TsModel& model, const ControllerContext& loop) const = 0;
  virtual SignalUse signalUse(const ControllerContext& loop) const = 0;

 private:
  const ControllerType& type_;  // of the registry
};

/// What one type registers. `Params` is its struct of parameters.
template <typename Params>
struct ControllerRegistration {
  ControllerType type;
  /// Reads the keys of the section but `type` and finish(). @throws InputError for what is missing
  /// or out of range, so that make() with the same context does not.
  Params (*read)(YamlSection& section, const ControllerContext& loop){};
  std::unique_ptr<Controller> (*make)(const Params& params, const ControllerContext& loop){};
  /// See ControllerConfig::checkModel(). nullptr: any model of the plant will do.
  void (*check_model)(const Params& params, const TsModel& model,
                      const ControllerContext& loop){nullptr};
  /// nullptr: everySignal().
  SignalUse (*signal_use)(const Params& params, const ControllerContext& loop){nullptr};
};

/// A configuration whose parameters have a type of their own.
template <typename Params>
class ControllerConfigOf final : public ControllerConfig {
 public:
  ControllerConfigOf(const ControllerType& type, Params params,
                     const ControllerRegistration<Params>& by)
      : ControllerConfig(type), params_(std::move(params)), by_(by) {}
  const Params& params() const { return params_; }
  std::unique_ptr<Controller> make(const ControllerContext& loop) const override {
    return by_.make(params_, loop);
  }
  void checkModel(const TsModel& model, const ControllerContext& loop) const override {
    if (by_.check_model) by_.check_model(params_, model, loop);
  }
  SignalUse signalUse(const ControllerContext& loop) const override {
    return by_.signal_use ? by_.signal_use(params_, loop) : everySignal(loop);
  }

 private:
  Params params_;
  ControllerRegistration<Params> by_;
};

using ControllerReader = std::function<std::unique_ptr<ControllerConfig>(
    const ControllerType& type, YamlSection& section, const ControllerContext& loop)>;
/// The registration without its types; false if the name is taken.
bool registerControllerReader(ControllerType type, ControllerReader read);

using ControllerLayout =
    LayoutOf<ControllerType, ControllerContext, ControllerConfig, Controller, ControllerOutput,
             Measurement, SetpointSource, SettingInfo, SignalUse, TsModel, OutputModel, Rule>;
template <>
void requireSameLayout<ControllerLayout>();

/// Called by the registration line of each type:
///   const bool kRegistered = registerController<PiParams>({{"pi", "..."}, readPi, makePi});
template <typename Params>
bool registerController(const ControllerRegistration<Params>& given) {
  requireSameLayout<ControllerLayout>();
  return registerControllerReader(
      given.type,
      [given](const ControllerType& type, YamlSection& section, const ControllerContext& loop) {
        return std::make_unique<ControllerConfigOf<Params>>(type, given.read(section, loop), given);
      });
}

std::vector<std::string> controllerNames();  ///< in alphabetical order
/// Names that were registered although they were taken, in the order in which that happened.
std::vector<std::string> refusedControllers();
/// @throws InputError with the known names.
const ControllerType& controllerType(const std::string& name);
/// Reads the whole section, key `type` included. @throws InputError naming file, key and what was
/// expected.
std::unique_ptr<ControllerConfig> readController(YamlSection& section,
                                                 const ControllerContext& loop);

/// The parameters of a configuration, or nullptr if it is of a type with others.
template <typename Params>
const Params* findParams(const ControllerConfig& config) {
  const auto* typed = dynamic_cast<const ControllerConfigOf<Params>*>(&config);
  return typed ? &typed->params() : nullptr;
}

/// Key prediction_steps of a type that predicts: its optimizer fixes it.
void readPredictionSteps(YamlSection& section, const ControllerContext& loop, int& steps);

}  // namespace fpc
