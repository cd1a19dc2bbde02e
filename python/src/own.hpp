// What plants and controllers of Python have in common.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "fmbpc/base/input_error.hpp"
#include "watch.hpp"

namespace fpc::python {

/// An object of Python in C++ objects that may die anywhere.
using Held = std::shared_ptr<py::object>;
inline Held held(py::object object) {
  return {new py::object(std::move(object)), [](py::object* owned) {
            const py::gil_scoped_acquire gil;
            delete owned;
          }};
}

/// What `call` throws in Python becomes words here, and is kept for who asked for the computation.
template <typename Call>
void calling(const std::string& where, Call call) {
  try {
    call();
  } catch (py::error_already_set& error) {
    const std::string words = where + ": " + wordsOf(error);
    Watch::keep(std::current_exception());
    throw std::runtime_error(words);
  } catch (const InputError& error) {
    Watch::keep(std::current_exception());
    throw;
  }
}

}  // namespace fpc::python
