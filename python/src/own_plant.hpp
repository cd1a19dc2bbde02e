// Plants and controllers that are Python classes, registered like ours.
#pragma once

#include <string>

#include "convert.hpp"

namespace fpc::python {

/// `about`: what a PlantDescription holds, quantities as (name, unit, nominal, lower, upper).
/// `make(parameters)` gives an object with derivatives(x, u, d), or with step(u, d) where `steps`.
/// A name that Python gave to a plant before is given to this one.
/// @throws InputError naming what is wrong with the description, and for a name of ours.
void registerOwnPlant(const py::dict& about, const py::object& make, bool steps);

/// `parameters`: of its section in a loop file, with their defaults: numbers, truth values, texts.
/// `make(parameters, context)` gives an object with step(y, setpoint).
void registerOwnController(const std::string& name, const std::string& summary,
                           const py::dict& parameters, const py::object& make);

}  // namespace fpc::python
