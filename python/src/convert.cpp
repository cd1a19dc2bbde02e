#include "convert.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc::python {
namespace {

std::size_t indexOf(py::handle key, const Names& names, const char* what) {
  require(py::isinstance<py::str>(key), what, "names as keys");
  const auto name = key.cast<std::string>();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw InputError(std::string(what) + "[" + name + "]: expected one of " + join(names));
  return static_cast<std::size_t>(found - names.begin());
}

[[noreturn]] void failAtSignal(const char* what, const std::string& name, const char* expected) {
  throw InputError(std::string(what) + "[" + name + "]: expected " + expected);
}

double numberOf(py::handle value, const char* what, const std::string& name) {
  const double number = PyFloat_AsDouble(value.ptr());
  if (!PyErr_Occurred()) return number;
  PyErr_Clear();
  failAtSignal(what, name, "a real number");
}

bool isPlainArray(py::handle value) {
  return std::strcmp(Py_TYPE(value.ptr())->tp_name, "numpy.ndarray") == 0;
}

/// Of real numbers; lists and scalars become one. What a masked array hides is NaN.
Array realArray(py::handle value, const char* what) {
  py::array array = py::array::ensure(value);
  if (array && !isPlainArray(value) && py::hasattr(value, "filled") && py::hasattr(value, "mask"))
    array = py::array::ensure(value.attr("astype")("f8").attr("filled")(kNaN));
  if (!array) PyErr_Clear();
  require(array && std::strchr("fiu", array.dtype().kind()) != nullptr, what,
          "an array of real numbers");
  return py::array_t<double, py::array::forcecast>::ensure(array);
}

}  // namespace

py::object byName(py::handle value) {
  if (PyDict_Check(value.ptr())) return py::reinterpret_borrow<py::object>(value);
  if (isPlainArray(value) || !py::hasattr(value, "keys")) return {};
  py::dict named = py::module_::import("builtins").attr("dict")(value);
  for (const auto& item : named)
    if (!py::isinstance<py::str>(item.first)) return {};
  return named;
}

void readSignals(py::handle value, const Names& names, const char* what, Vector& out,
                 const std::vector<bool>* bad) {
  if (value.is_none()) return;
  thread_local Vector read;
  read = out;
  if (const py::object named = byName(value)) {
    for (const auto& item : py::reinterpret_borrow<py::dict>(named)) {
      const std::size_t i = indexOf(item.first, names, what);
      read[static_cast<Eigen::Index>(i)] = numberOf(item.second, what, names[i]);
    }
  } else {
    const Array numbers = realArray(value, what);
    if (numbers.ndim() > 1 || static_cast<std::size_t>(numbers.size()) != names.size())
      throw InputError(std::string(what) + ": expected " + std::to_string(names.size()) +
                       (names.size() == 1 ? " number (" : " numbers (") + join(names) + "), got " +
                       std::to_string(numbers.size()) +
                       (numbers.ndim() > 1 ? " in rows and columns" : ""));
    if (numbers.ndim() == 0) {
      read[0] = *numbers.data();
    } else {
      const auto view = numbers.unchecked<1>();
      for (Eigen::Index i = 0; i < read.size(); ++i) read[i] = view(i);
    }
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    double& number = read[static_cast<Eigen::Index>(i)];
    if (std::isfinite(number)) continue;
    if (bad != nullptr && !bad->empty() && (*bad)[i])
      number = out[static_cast<Eigen::Index>(i)];
    else
      failAtSignal(what, names[i],
                   bad == nullptr ? "a finite number"
                                  : "a finite number; a reading that is missing has quality False");
  }
  out = read;
}

std::vector<bool> readBad(py::handle quality, const Names& names) {
  if (quality.is_none()) return {};
  std::vector<bool> bad(names.size(), false);
  const auto good = [](py::handle truth) {
    const int is = PyObject_IsTrue(truth.ptr());
    if (is < 0) PyErr_Clear();
    require(is >= 0, "quality", "a truth value for each reading");
    return is == 1;
  };
  if (PyDict_Check(quality.ptr())) {
    for (const auto& item : py::reinterpret_borrow<py::dict>(quality))
      bad[indexOf(item.first, names, "quality")] = !good(item.second);
    return bad;
  }
  require(py::isinstance<py::iterable>(quality) && !py::isinstance<py::str>(quality), "quality",
          "truth values, or a dict by name");
  std::size_t count = 0;
  for (const py::handle truth : quality) {
    if (count < bad.size()) bad[count] = !good(truth);
    ++count;
  }
  require(count == bad.size(), "quality",
          std::to_string(bad.size()) + " truth values (" + join(names) + ")");
  return bad;
}

Matrix readMatrix(py::handle value, Eigen::Index columns, const char* what) {
  const Array numbers = realArray(value, what);
  const bool column = numbers.ndim() == 1 && columns == 1;
  if (!column && (numbers.ndim() != 2 || numbers.shape(1) != columns))
    throw InputError(std::string(what) + ": expected rows of " + std::to_string(columns) +
                     (columns == 1 ? " number" : " numbers"));
  Matrix out(numbers.shape(0), columns);
  if (column) {
    const auto view = numbers.unchecked<1>();
    for (Eigen::Index i = 0; i < out.rows(); ++i) out(i, 0) = view(i);
    return out;
  }
  const auto view = numbers.unchecked<2>();
  for (Eigen::Index i = 0; i < out.rows(); ++i)
    for (Eigen::Index j = 0; j < columns; ++j) out(i, j) = view(i, j);
  return out;
}

Array toArray(const Vector& values) { return Array(values.size(), values.data()); }

Array toArray(const Matrix& values) {
  Array out({values.rows(), values.cols()});
  auto view = out.mutable_unchecked<2>();
  for (Eigen::Index i = 0; i < values.rows(); ++i)
    for (Eigen::Index j = 0; j < values.cols(); ++j) view(i, j) = values(i, j);
  return out;
}

}  // namespace fpc::python
