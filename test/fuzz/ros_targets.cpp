#include "fuzz/targets.hpp"

namespace fpc::fuzz {

const std::vector<NamedTarget>& targets() {
  static const std::vector<NamedTarget> all{{"message", message}, {"ring", ring}, {"bag", bag}};
  return all;
}

}  // namespace fpc::fuzz
