// A computation of C++ that Python watches: progress, Ctrl-C, and exceptions of Python code inside.
#pragma once

#include <pybind11/pybind11.h>

#include <chrono>
#include <exception>
#include <string>

namespace fpc::python {
namespace py = pybind11;

/// Of one computation in the calling thread, which has given the GIL away meanwhile.
class Watch {
 public:
  /// `progress(share, words)` is called ten times a second at most, unless it is None.
  explicit Watch(py::object progress);
  ~Watch();
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  /// False: it is to end now.
  bool goOn(double share, const std::string& words = {});
  /// Runs `compute` without the GIL. What it throws is thrown on, as Python code in it threw it.
  template <typename Compute>
  void during(Compute compute) {
    try {
      const py::gil_scoped_release release;
      compute();
    } catch (...) {
      rethrow();
      throw;
    }
  }
  bool interrupted() const { return interrupted_; }  ///< by Ctrl-C
  /// Throws what Python code inside, or a signal handler, has thrown. With the GIL.
  void rethrow();
  /// To be called where an exception of Python code is caught, in the thread of the computation.
  static void keep(std::exception_ptr error);

 private:
  py::object progress_;
  std::chrono::steady_clock::time_point next_;
  std::exception_ptr error_;
  bool interrupted_{false};
  Watch* before_;  // of an outer computation in this thread
};

/// "ZeroDivisionError: division by zero". With the GIL.
std::string wordsOf(const py::error_already_set& error);

}  // namespace fpc::python
