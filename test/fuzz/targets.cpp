#include "fuzz/targets.hpp"

namespace fpc::fuzz {

const std::vector<NamedTarget>& targets() {
  static const std::vector<NamedTarget> all{
      {"loop", loopFile},     {"model", modelFile}, {"structure", structureFile},
      {"tuning", tuningFile}, {"csv", csvTable},    {"qp", qp, true}};
  return all;
}

}  // namespace fpc::fuzz
