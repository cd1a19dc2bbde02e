#include "fuzz/targets.hpp"

namespace fpc::fuzz {

const std::vector<NamedTarget>& targets() {
  static const std::vector<NamedTarget> all{
      {"message", message, true}, {"exchange", exchange, true}, {"bag", bag, true}};
  return all;
}

}  // namespace fpc::fuzz
