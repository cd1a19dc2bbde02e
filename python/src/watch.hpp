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
  /// `keeps`: what keep() is given ends the computation as that exception; a study of many runs
  /// does not, it says what ended a run.
  explicit Watch(py::object progress, bool keeps = true);
  ~Watch();
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  /// False: it is to end now.
  bool goOn(double share, const std::string& words = {});
  /// Runs `compute` without the GIL. Throws what Python code in it, or a signal handler, has
  /// thrown, even where C++ went on or made words of it; else what `compute` throws.
  template <typename Compute>
  void during(Compute compute) {
    try {
      const py::gil_scoped_release release;
      compute();
    } catch (...) {
      rethrow();
      throw;
    }
    rethrow();
  }
  bool interrupted() const { return interrupted_; }  ///< by Ctrl-C
  /// To be called where an exception of Python code is caught, in the thread of the computation.
  static void keep(std::exception_ptr error);

 private:
  void rethrow();

  py::object progress_;
  std::chrono::steady_clock::time_point next_;
  std::exception_ptr error_;
  bool interrupted_{false};
  Watch* before_;  // of an outer computation in this thread
};

/// What `compute` returns, computed without the GIL.
template <typename Compute>
auto withoutGil(Compute compute) {
  Watch watch{py::none()};
  decltype(compute()) found;
  watch.during([&] { found = compute(); });
  return found;
}

/// "ZeroDivisionError: division by zero". With the GIL.
std::string wordsOf(const py::error_already_set& error);

}  // namespace fpc::python
