// Objects that one call at a time may use.
#pragma once

#include <atomic>
#include <functional>
#include <stdexcept>
#include <utility>

namespace fpc::python {

/// What computes without the GIL. A second thread, or Python code that the computation calls, is
/// refused until it has returned: its numbers would be half old, half new.
class UsedAlone {
 public:
  class Call {
   public:
    /// @throws std::runtime_error if a call has not returned yet.
    explicit Call(const UsedAlone& object) : used_(object.used_) {
      if (used_.exchange(true))
        throw std::runtime_error("in use: a call of this object has not returned yet");
    }
    ~Call() { used_ = false; }
    Call(const Call&) = delete;
    Call& operator=(const Call&) = delete;

   private:
    std::atomic<bool>& used_;
  };

 private:
  mutable std::atomic<bool> used_{false};
};

/// Methods and properties of such an object, for its binding.
template <typename T, typename Result, typename... Arguments>
auto alone(Result (T::*method)(Arguments...)) {
  return [method](T& object, Arguments... arguments) -> Result {
    const UsedAlone::Call call(object);
    return (object.*method)(std::forward<Arguments>(arguments)...);
  };
}
template <typename T, typename Result, typename... Arguments>
auto alone(Result (T::*method)(Arguments...) const) {
  return [method](const T& object, Arguments... arguments) -> Result {
    const UsedAlone::Call call(object);
    return (object.*method)(std::forward<Arguments>(arguments)...);
  };
}
template <typename T, typename Get>
auto alone(Get get) {
  return [get](const T& object) {
    const UsedAlone::Call call(object);
    return get(object);
  };
}

}  // namespace fpc::python
