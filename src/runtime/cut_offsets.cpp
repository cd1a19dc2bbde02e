#include "runtime/cut_offsets.hpp"

#include <utility>

#include "fmbpc/base/text.hpp"
#include "runtime/remark_lines.hpp"

namespace fpc {
namespace {

std::string wordsOf(const Quantity& of) {
  return "an offset of " + of.name + " was asked beyond its range, " + exactText(of.lower) + ".." +
         exactText(of.upper) + (of.unit.empty() ? "" : " [" + of.unit + "]") + ", and clamped";
}

}  // namespace

CutOffsets::CutOffsets(std::vector<Quantity> disturbances)
    : all_(std::move(disturbances)), offsets_(all_.size()) {}

void CutOffsets::look(const Measurement& now, const std::vector<CommandEffect>& effects,
                      VectorRef scheduled) {
  if (now.header.step == 0) offsets_.assign(all_.size(), {});
  for (const CommandEffect& effect : effects) take(effect.command);
  lines_.clear();
  if (now.final) return;
  for (std::size_t i = 0; i < all_.size(); ++i) {
    if (!offsets_[i].active) continue;
    const double asked = scheduled[static_cast<Eigen::Index>(i)] + offsets_[i].value;
    if (asked < all_[i].lower || asked > all_[i].upper)
      lines_ = joinedLines(lines_, wordsOf(all_[i]));
  }
  if (!lines_.empty()) ++samples_;
}

void CutOffsets::take(const Command& command) {
  for (std::size_t i = 0; i < command.name.size(); ++i)
    for (std::size_t j = 0; j < all_.size(); ++j) {
      if (command.name[i] != all_[j].name) continue;
      const bool offset = command.mode == CommandMode::kOffset && i < command.value.size();
      offsets_[j] = {offset, command.mode, offset ? command.value[i] : 0.0};
    }
}

}  // namespace fpc
