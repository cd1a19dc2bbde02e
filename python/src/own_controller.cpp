#include <algorithm>
#include <map>
#include <variant>
#include <vector>

#include "bind.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"
#include "fmbpc/control/registry.hpp"
#include "own.hpp"
#include "own_plant.hpp"

namespace fpc::python {
namespace {

using Parameter = std::variant<bool, double, std::string, std::vector<double>>;
using Parameters = std::vector<std::pair<std::string, Parameter>>;

struct OwnControllerType {
  std::string name;
  Parameters defaults;
  Held make;
};

/// By name, as ownPlantTypes().
std::map<std::string, std::shared_ptr<const OwnControllerType>>& ownControllerTypes() {
  static auto* types = new std::map<std::string, std::shared_ptr<const OwnControllerType>>;
  return *types;
}

/// What the class finds at its start.
py::dict contextOf(const ControllerContext& loop) {
  py::dict context;
  context["sample_time_s"] = loop.plant.sample_time_s;
  context["outputs"] = listOf(loop.plant.outputs);
  context["inputs"] = listOf(loop.plant.inputs);
  context["disturbances"] = listOf(loop.plant.disturbances);
  context["input_lower"] = toArray(loop.limits.lower);
  context["input_upper"] = toArray(loop.limits.upper);
  context["move"] = toArray(loop.limits.move);
  context["initial_input"] = toArray(loop.initial_input);
  return context;
}

class OwnController final : public Controller {
 public:
  OwnController(std::shared_ptr<const OwnControllerType> type, const Parameters& parameters,
                const ControllerContext& loop)
      : name_(type->name), inputs_(loop.inputs()), limits_(loop.limits) {
    const py::gil_scoped_acquire gil;
    py::dict given;
    for (const auto& [key, value] : parameters) given[py::str(key)] = py::cast(value);
    calling(name_, [&] { object_ = held((*type->make)(given, contextOf(loop))); });
    resets_ = py::hasattr(*object_, "reset");
  }
  void reset(const Measurement& start) override {
    if (!resets_) return;
    const py::gil_scoped_acquire gil;
    calling(name_ + ": reset()",
            [&] { object_->attr("reset")(toArray(start.outputs), toArray(start.input_applied)); });
  }
  void step(const Measurement& now, const SetpointSource& setpoint,
            ControllerOutput& output) override {
    const py::gil_scoped_acquire gil;
    output.reference = setpoint.present();
    calling(name_ + ": step()", [&] {
      object_->attr("applied") = toArray(now.input_applied);
      object_->attr("disturbance") = toArray(now.disturbances);
      const py::object result =
          object_->attr("step")(toArray(now.outputs), toArray(setpoint.present()));
      require(!result.is_none(), name_ + ": step()", "the input as its result");
      Vector asked = now.input_applied;
      readSignals(result, inputs_, "step()", asked);
      output.input = asked;
    });
    proposal_ = output.input;
    limits_.clip(output.input, now.input_applied);
    if (proposal_ != output.input) output.source = ActionSource::kClipped;
  }

 private:
  std::string name_;
  Names inputs_;
  InputLimits limits_;
  Held object_;
  bool resets_{false};
  Vector proposal_;
};

class OwnControllerConfig final : public ControllerConfig {
 public:
  OwnControllerConfig(const ControllerType& of, std::shared_ptr<const OwnControllerType> type,
                      Parameters parameters)
      : ControllerConfig(of), type_(std::move(type)), parameters_(std::move(parameters)) {}
  std::unique_ptr<Controller> make(const ControllerContext& loop) const override {
    return std::make_unique<OwnController>(type_, parameters_, loop);
  }
  void checkModel(const TsModel&, const ControllerContext&) const override {}
  SignalUse signalUse(const ControllerContext& loop) const override { return everySignal(loop); }

 private:
  std::shared_ptr<const OwnControllerType> type_;
  Parameters parameters_;
};

/// The keys of the section over the defaults.
Parameters readOver(Parameters parameters, YamlSection& section) {
  for (auto& named : parameters) {
    const std::string& key = named.first;
    std::visit(
        [&](auto& value) {
          using Type = std::decay_t<decltype(value)>;
          if constexpr (std::is_same_v<Type, bool>)
            section.boolean(key, value);
          else if constexpr (std::is_same_v<Type, double>)
            section.number(key, value, kFinite);
          else if constexpr (std::is_same_v<Type, std::string>)
            section.text(key, value);
          else
            section.numbers(key, value, kFinite);
        },
        named.second);
  }
  return parameters;
}

Parameter parameterOf(const std::string& where, py::handle value) {
  if (PyBool_Check(value.ptr())) return value.cast<bool>();
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  try {
    if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value) ||
        (py::isinstance<py::array>(value) && py::cast<py::array>(value).ndim() > 0))
      return value.cast<std::vector<double>>();
    return value.cast<double>();
  } catch (const py::cast_error&) {
    throw InputError(where + ": expected a number, numbers, a truth value or a text");
  }
}

}  // namespace

void registerOwnController(const std::string& name, const std::string& summary,
                           const py::dict& parameters, const py::object& make) {
  Parameters defaults;
  for (const auto& item : parameters) {
    const auto key = py::str(item.first).cast<std::string>();
    defaults.emplace_back(key, parameterOf(name + ": parameters." + key, item.second));
  }
  require(!name.empty(), "controller", "a name");
  auto& known = ownControllerTypes();
  if (known.count(name) == 0) {
    const auto names = controllerNames();
    require(std::find(names.begin(), names.end(), name) == names.end(), "controller '" + name + "'",
            "a name that no controller has");
    ControllerType about;
    about.name = name;
    about.summary = summary;
    requireSameLayout<ControllerLayout>();
    registerControllerReader(
        about, [](const ControllerType& of, YamlSection& section, const ControllerContext&) {
          const py::gil_scoped_acquire gil;
          auto type = ownControllerTypes().at(of.name);
          Parameters read = readOver(type->defaults, section);
          return std::make_unique<OwnControllerConfig>(of, std::move(type), std::move(read));
        });
  }
  known[name] =
      std::make_shared<OwnControllerType>(OwnControllerType{name, std::move(defaults), held(make)});
}

}  // namespace fpc::python
