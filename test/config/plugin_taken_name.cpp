// A plugin whose controller has a name of ours.
#include "fmbpc/control/registry.hpp"

namespace {

struct Params {};
Params read(fpc::YamlSection&, const fpc::ControllerContext&) { return {}; }
std::unique_ptr<fpc::Controller> make(const Params&, const fpc::ControllerContext&) {
  return nullptr;
}

const bool kRegistered = fpc::registerController<Params>({{"pi", "not ours"}, &read, &make});

}  // namespace
