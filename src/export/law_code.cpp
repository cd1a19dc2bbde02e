// Which laws are exported.
#include "export/block.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {

std::unique_ptr<LawCode> makeLawCode(BlockParts& parts) {
  const LoopFile& loop = parts.loop;
  require(!loop.targets.enabled, loop.name + ": targets",
          "targets: false; the target layer is not exported, its law alone would follow other "
          "setpoints");
  for (const auto make : {&makePiCode, &makeFmbpcCode, &makeOptimalCode})
    if (std::unique_ptr<LawCode> code = make(parts)) {
      require(!loop.has_clp || code->optimizer() != nullptr, loop.name + ": clp",
              "clp: false; the law predicts nothing for the constraint optimizer");
      return code;
    }
  const std::string& type = loop.controllerType().name;
  require(false, loop.name + ": controller.type",
          "pi, fmbpc or fuzzy_optimal; " + type +
              " is not exported: its work per sample is not fixed, or it learns while it runs");
  return nullptr;
}

}  // namespace fpc
