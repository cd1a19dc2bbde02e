// A plugin that was built against another fmbpc, as its sizes say.
#include "fmbpc/base/layout.hpp"

namespace {

const bool kRegistered = (fpc::requireSameLayout<std::index_sequence<1, 2, 3>>(), true);

}  // namespace
