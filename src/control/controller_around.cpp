#include "control/controller_around.hpp"

#include "fmbpc/base/input_error.hpp"

namespace fpc {

ControllerAround::ControllerAround(std::unique_ptr<Controller> inside, const char* section)
    : inside_(std::move(inside)) {
  require(inside_ != nullptr, section, "a law inside");
}

}  // namespace fpc
