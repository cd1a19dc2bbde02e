// Controllers and plants that are stepped, those of Python, and what is registered.
#include "bind.hpp"
#include "config/plugins.hpp"
#include "convert.hpp"
#include "fmbpc/control/registry.hpp"
#include "own_plant.hpp"
#include "runtime/contract.hpp"
#include "stepped_controller.hpp"
#include "stepped_plant.hpp"
#include "used_alone.hpp"
#include "watch.hpp"

namespace fpc::python {
namespace {

py::list listOfQuantities(const std::vector<Quantity>& quantities) {
  py::list list;
  for (const Quantity& q : quantities)
    list.append(py::make_tuple(q.name, q.unit, q.nominal, q.lower, q.upper));
  return list;
}

py::dict typeOf(const std::string& name) {
  const ControllerType& type = controllerType(name);
  py::dict about;
  about["name"] = type.name;
  about["summary"] = type.summary;
  about["needs_model"] = type.needs_model;
  about["predicts"] = type.predicts;
  about["open_loop"] = type.open_loop;
  py::dict settings;
  for (const SettingInfo& setting : type.settings)
    settings[py::str(setting.key)] = setting.description;
  about["settings"] = settings;
  return about;
}

void bindController(py::module_& m) {
  py::class_<SteppedController>(m, "Controller")
      .def("step", alone(&SteppedController::step), py::arg("y"), py::arg("setpoint") = py::none(),
           py::arg("disturbance") = py::none(), py::arg("applied") = py::none(),
           py::arg("quality") = py::none())
      .def("reset", alone(&SteppedController::reset), py::arg("y"),
           py::arg("setpoint") = py::none(), py::arg("disturbance") = py::none(),
           py::arg("applied") = py::none(), py::arg("quality") = py::none())
      .def("manual", alone(&SteppedController::manual))
      .def("automatic", alone(&SteppedController::automatic))
      .def("release_setpoint", alone(&SteppedController::releaseSetpoint))
      .def("retune", alone(&SteppedController::retune))
      .def("adapt", alone(&SteppedController::adapt))
      .def("set_model", alone(&SteppedController::setModel))
      .def_property_readonly("steps", alone(&SteppedController::steps))
      .def_property_readonly("setpoint", alone(&SteppedController::setpoint))
      .def_property_readonly("reference", alone(&SteppedController::reference))
      .def_property_readonly("source", alone(&SteppedController::source))
      .def_property_readonly(
          "events", alone<SteppedController>([](const auto& c) { return listOf(c.events()); }))
      .def_property_readonly("prediction", alone(&SteppedController::prediction))
      .def_property_readonly("signals", alone(&SteppedController::signals))
      .def_property_readonly("settings", alone(&SteppedController::settings))
      .def_property_readonly("report", alone(&SteppedController::report));
}

void bindPlants(py::module_& m) {
  py::class_<SteppedPlant>(m, "Plant")
      .def(py::init<const std::string&, const PlantParameters&, double>())
      .def("step", alone(&SteppedPlant::step))
      .def("reset", alone(&SteppedPlant::reset))
      .def("derivatives", alone(&SteppedPlant::derivatives))
      .def_property_readonly("outputs", alone(&SteppedPlant::outputs))
      .def_property_readonly("state", alone(&SteppedPlant::state))
      .def_property_readonly("time_s", alone(&SteppedPlant::timeS))
      .def_property_readonly("sample_time_s", &SteppedPlant::sampleTimeS)
      .def_property_readonly("description",
                             [](const SteppedPlant& p) { return dictOf(p.description()); });
  const auto get = [](auto read) { return alone<LoopPlant>(read); };
  py::class_<LoopPlant>(m, "Simulation")
      .def("step", alone(&LoopPlant::step))
      .def("reset", alone(&LoopPlant::reset))
      .def("disturb", alone(&LoopPlant::disturb))
      .def_property_readonly("outputs", get([](auto& p) { return toArray(p.now().outputs); }))
      .def_property_readonly("disturbance",
                             get([](auto& p) { return toArray(p.now().disturbances); }))
      .def_property_readonly("applied", get([](auto& p) { return toArray(p.now().input_applied); }))
      .def_property_readonly("true_outputs",
                             get([](auto& p) { return toArray(p.state().outputs); }))
      .def_property_readonly("state", get([](auto& p) { return toArray(p.state().state); }))
      .def_property_readonly("setpoint", alone(&LoopPlant::setpoint))
      .def_property_readonly("time_h", alone(&LoopPlant::timeH))
      .def_property_readonly("samples", get([](auto& p) { return p.now().header.step; }))
      .def_property_readonly("done", get([](auto& p) { return p.now().final; }))
      .def_property_readonly("trouble", alone(&LoopPlant::trouble));
}

py::list brokenOf(const std::vector<Promise>& promises) {
  py::list list;
  for (const Promise& p : promises)
    if (!p.broken.empty()) list.append(p.name + ": " + p.broken);
  return list;
}

}  // namespace

py::dict dictOf(const PlantDescription& plant) {
  py::dict about;
  about["name"] = plant.name;
  about["title"] = plant.title;
  about["time_unit_s"] = plant.time_unit_s;
  about["outputs"] = plant.outputs;
  about["states"] = listOfQuantities(plant.states);
  about["inputs"] = listOfQuantities(plant.inputs);
  about["disturbances"] = listOfQuantities(plant.disturbances);
  about["parameters"] = listOfQuantities(plant.parameters);
  return about;
}

void bindControl(py::module_& m) {
  bindController(m);
  bindPlants(m);
  m.def("plant_names", &plantNames);
  m.def("plant_description",
        [](const std::string& name) { return dictOf(makePlant(name)->description()); });
  m.def("controller_names", &controllerNames);
  m.def("controller_type", &typeOf);
  m.def("check_plant", [](const std::string& name) {
    return brokenOf(withoutGil([&] { return plantPromises(*makePlant(name), name); }));
  });
  m.def("check_controller", [](const std::shared_ptr<LoopFile>& loop) {
    return brokenOf(withoutGil([&] { return controllerPromises(*loop); }));
  });
  m.def("register_library", [](const std::string& name) { loadPlugin(name, "register"); });
  m.def("register_plant", &registerOwnPlant);
  m.def("register_controller", &registerOwnController);
}

}  // namespace fpc::python
