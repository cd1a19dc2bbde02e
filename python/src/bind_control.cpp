// Controllers and plants that are stepped, those of Python, and what is registered.
#include "bind.hpp"
#include "convert.hpp"
#include "fmbpc/control/registry.hpp"
#include "model_handle.hpp"
#include "own_plant.hpp"
#include "runtime/contract.hpp"
#include "stepped_controller.hpp"
#include "stepped_plant.hpp"
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
      .def("step", &SteppedController::step, py::arg("y"), py::arg("setpoint") = py::none(),
           py::arg("disturbance") = py::none(), py::arg("applied") = py::none(),
           py::arg("quality") = py::none())
      .def("reset", &SteppedController::reset, py::arg("y"), py::arg("setpoint") = py::none(),
           py::arg("disturbance") = py::none(), py::arg("applied") = py::none(),
           py::arg("quality") = py::none())
      .def("manual", &SteppedController::manual)
      .def("automatic", &SteppedController::automatic)
      .def("release_setpoint", &SteppedController::releaseSetpoint)
      .def("retune", &SteppedController::retune)
      .def("adapt", &SteppedController::adapt)
      .def("set_model",
           [](SteppedController& c, const ModelHandle& h) { c.setModel(h.identified.model); })
      .def_property_readonly("steps", &SteppedController::steps)
      .def_property_readonly("setpoint", &SteppedController::setpoint)
      .def_property_readonly("reference", &SteppedController::reference)
      .def_property_readonly("source", &SteppedController::source)
      .def_property_readonly("events",
                             [](const SteppedController& c) { return listOf(c.events()); })
      .def_property_readonly("prediction", &SteppedController::prediction)
      .def_property_readonly("signals", &SteppedController::signals)
      .def_property_readonly("settings", &SteppedController::settings)
      .def_property_readonly("report", &SteppedController::report);
}

void bindPlants(py::module_& m) {
  py::class_<SteppedPlant>(m, "Plant")
      .def(py::init<const std::string&, const PlantParameters&, double>())
      .def("step", &SteppedPlant::step)
      .def("reset", &SteppedPlant::reset)
      .def("derivatives", &SteppedPlant::derivatives)
      .def_property_readonly("outputs", &SteppedPlant::outputs)
      .def_property_readonly("state", &SteppedPlant::state)
      .def_property_readonly("time_s", &SteppedPlant::timeS)
      .def_property_readonly("sample_time_s", &SteppedPlant::sampleTimeS)
      .def_property_readonly("description",
                             [](const SteppedPlant& p) { return dictOf(p.description()); });
  py::class_<LoopPlant>(m, "Simulation")
      .def("step", &LoopPlant::step)
      .def("reset", &LoopPlant::reset)
      .def("disturb", &LoopPlant::disturb)
      .def_property_readonly("outputs",
                             [](const LoopPlant& p) { return toArray(p.measurement().outputs); })
      .def_property_readonly(
          "disturbance", [](const LoopPlant& p) { return toArray(p.measurement().disturbances); })
      .def_property_readonly(
          "applied", [](const LoopPlant& p) { return toArray(p.measurement().input_applied); })
      .def_property_readonly("true_outputs",
                             [](const LoopPlant& p) { return toArray(p.state().outputs); })
      .def_property_readonly("state", [](const LoopPlant& p) { return toArray(p.state().state); })
      .def_property_readonly("setpoint", &LoopPlant::setpoint)
      .def_property_readonly("time_h", &LoopPlant::timeH)
      .def_property_readonly("samples",
                             [](const LoopPlant& p) { return p.measurement().header.step; })
      .def_property_readonly("done", [](const LoopPlant& p) { return p.measurement().final; })
      .def_property_readonly("trouble", &LoopPlant::trouble);
}

py::list brokenOf(const std::vector<Promise>& promises) {
  py::list list;
  for (const Promise& p : promises)
    if (!p.broken.empty()) list.append(p.name + ": " + p.broken);
  return list;
}

template <typename Compute>
py::list promisesOf(Compute compute) {
  Watch watch{py::none()};
  std::vector<Promise> promises;
  watch.during([&] { promises = compute(); });
  watch.rethrow();
  return brokenOf(promises);
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
    return promisesOf([&] { return plantPromises(*makePlant(name), name); });
  });
  m.def("check_controller", [](const std::shared_ptr<LoopFile>& loop) {
    return promisesOf([&] { return controllerPromises(*loop); });
  });
  m.def("register_plant", &registerOwnPlant);
  m.def("register_controller", &registerOwnController);
}

}  // namespace fpc::python
