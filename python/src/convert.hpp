// Numbers of Python to vectors of named signals, and back.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc::python {
namespace py = pybind11;
using Names = std::vector<std::string>;
using Array = py::array_t<double>;

/// A dict where the value names its numbers: a dict, another mapping, a Series of pandas with names
/// as its index; else nothing.
py::object byName(py::handle value);
/// Writes `value` over `out` (names.size() numbers): an array, a list, a number where there is one
/// name, or a dict or Series by name, which leaves the others as they are; None leaves all. Any
/// strides, any real type.
/// @throws InputError naming `what` and the signal: wrong size or type, an unknown name; a number
/// that is not finite, but for a `bad` signal (empty: none is), which stays as it was. Then `out`
/// is as before.
void readSignals(py::handle value, const Names& names, const char* what, Vector& out,
                 const std::vector<bool>* bad = nullptr);
/// True for the signals whose quality is False: an array of truth values, or a dict by name.
std::vector<bool> readBad(py::handle quality, const Names& names);
/// A matrix of real numbers, n columns; a vector is one column. NaN passes.
Matrix readMatrix(py::handle value, Eigen::Index columns, const char* what);
Array toArray(const Vector& values);
Array toArray(const Matrix& values);  ///< rows x columns

}  // namespace fpc::python
