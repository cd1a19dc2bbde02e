// Messages that listeners in the same process get as they are, without a copy.
#pragma once

#include <boost/make_shared.hpp>
#include <type_traits>
#include <utility>

namespace fpc {

/// To be given to publish(): nobody may change the message from then on.
template <typename Msg>
boost::shared_ptr<const std::decay_t<Msg>> shared(Msg&& msg) {
  return boost::make_shared<const std::decay_t<Msg>>(std::forward<Msg>(msg));
}

}  // namespace fpc
