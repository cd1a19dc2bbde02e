#include "fmbpc/loop/cut_offsets.hpp"

#include <algorithm>
#include <cmath>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"
#include "fmbpc/config/disturbance_source.hpp"
#include "loop/remark_lines.hpp"

namespace fpc {
namespace {

using Eigen::Index;

std::string wordsOf(const SignalInfo& of) {
  return "an offset of " + of.name + " was asked beyond its range, " + exactText(of.lower) + ".." +
         exactText(of.upper) + (of.unit.empty() ? "" : " [" + of.unit + "]") + ", and clamped";
}

/// Read when it is needed first. A record that has gone since the run began: NaN, beyond no range.
Matrix valuesOf(const LoopFile& loop) {
  try {
    return makeDisturbance(loop).values;
  } catch (const InputError&) {
    return Matrix::Constant(countOf(disturbancesOf(loop)), 1, std::nan(""));
  }
}

}  // namespace

CutOffsets::CutOffsets(const LoopFile& loop) : loop_(loop) {
  if (loop.external_plant) return;
  for (const Quantity& q : disturbancesOf(loop)) all_.push_back({q.name, q.unit, q.lower, q.upper});
  offsets_.resize(all_.size());
}

void CutOffsets::look(const Measurement& now, const std::vector<CommandEffect>& effects) {
  if (now.header.step == 0) offsets_.assign(all_.size(), {});
  for (const CommandEffect& effect : effects) take(effect.command);
  lines_.clear();
  if (now.final) return;
  for (std::size_t i = 0; i < all_.size(); ++i) {
    if (!offsets_[i].active) continue;
    const double asked = scheduled(i, now.header.step) + offsets_[i].value;
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

double CutOffsets::scheduled(std::size_t index, std::uint32_t step) {
  if (!values_) values_ = valuesOf(loop_);
  const auto row = static_cast<Index>(index);
  return values_->size() == 0 ? loop_.simulation.disturbance_nominal[row]
                              : (*values_)(row, std::min<Index>(step, values_->cols() - 1));
}

}  // namespace fpc
