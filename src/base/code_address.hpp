// Where in memory the code behind a registered function is, to ask which library it came from.
#pragma once

#include <functional>

namespace fpc {

/// The function itself if `call` holds a plain one, else the type of what it holds: both lie in the
/// library that made it.
template <typename R, typename... A>
const void* codeAddress(const std::function<R(A...)>& call) {
  using Plain = R (*)(A...);
  const Plain* plain = call.template target<Plain>();
  return plain ? reinterpret_cast<const void*>(*plain) : &call.target_type();
}

}  // namespace fpc
