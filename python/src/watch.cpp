#include "watch.hpp"

#include <utility>

namespace fpc::python {
namespace {

thread_local Watch* watch_of_thread = nullptr;

constexpr auto kPause = std::chrono::milliseconds(100);

}  // namespace

Watch::Watch(py::object progress, bool keeps)
    : progress_(std::move(progress)),
      next_(std::chrono::steady_clock::now() + kPause),
      before_(std::exchange(watch_of_thread, keeps ? this : nullptr)) {}

Watch::~Watch() { watch_of_thread = before_; }

bool Watch::goOn(double share, const std::string& words) {
  if (error_ || interrupted_) return false;
  const auto now = std::chrono::steady_clock::now();
  if (now < next_) return true;
  next_ = now + kPause;
  const py::gil_scoped_acquire gil;
  try {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (!progress_.is_none()) progress_(share, words);
  } catch (py::error_already_set& error) {
    if (error.matches(PyExc_KeyboardInterrupt))
      interrupted_ = true;
    else
      error_ = std::current_exception();
  }
  return !error_ && !interrupted_;
}

void Watch::rethrow() {
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

void Watch::keep(std::exception_ptr error) {
  if (watch_of_thread != nullptr && !watch_of_thread->error_)
    watch_of_thread->error_ = std::move(error);
}

std::string wordsOf(const py::error_already_set& error) {
  const std::string type = error.type().attr("__name__").cast<std::string>();
  const std::string text = py::str(error.value()).cast<std::string>();
  return text.empty() ? type : type + ": " + text;
}

}  // namespace fpc::python
