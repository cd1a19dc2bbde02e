// The parts of the module `fmbpc._core`, one function a file.
#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "fmbpc/base/event.hpp"
#include "fmbpc/base/exchange.hpp"
#include "fmbpc/plant/plant.hpp"

namespace fpc::python {
namespace py = pybind11;

void bindLoop(py::module_& m);
void bindControl(py::module_& m);
void bindModel(py::module_& m);
void bindReports(py::module_& m);

/// (name, unit, lower, upper) of each.
py::list listOf(const std::vector<SignalInfo>& signals);
/// (code, severity, signal, text, first, last, count) of each.
py::list listOf(const std::vector<Event>& events);
/// Name, title, time unit, outputs, and quantities as (name, unit, nominal, lower, upper).
py::dict dictOf(const PlantDescription& plant);

}  // namespace fpc::python
