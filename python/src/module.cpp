// The module `fmbpc._core`: what the package python/fmbpc is made of. Not meant to be used alone.
#include "bind.hpp"
#include "fmbpc/base/input_error.hpp"

PYBIND11_MODULE(_core, m) {
  namespace py = pybind11;
  m.attr("version") = FMBPC_VERSION;
  py::register_exception<fpc::InputError>(m, "InputError", PyExc_ValueError);
  fpc::python::bindLoop(m);
  fpc::python::bindControl(m);
  fpc::python::bindModel(m);
  fpc::python::bindReports(m);
}
