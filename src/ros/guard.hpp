// What is called by a timer or a message must not end its node.
#pragma once

#include <exception>

#include "fmbpc/base/input_error.hpp"

namespace fpc {

/// Calls `handler`. What it refuses (InputError) goes to `refused` in words, whatever else it
/// throws to `mishap`; nothing gets through.
template <typename Handler, typename Refused, typename Mishap>
void callGuarded(Handler handler, Refused refused, Mishap mishap) {
  try {
    handler();
  } catch (const InputError& error) {
    refused(error.what());
  } catch (const std::exception& error) {
    mishap(error.what());
  } catch (...) {  // of a user's plant or controller
    mishap("an exception of unknown kind");
  }
}

}  // namespace fpc
