#include "identification/auto_confirm.hpp"

#include <algorithm>

#include "identification/auto_choice.hpp"

namespace fpc {
namespace {

/// The same judgements scored on the blocks of `data`, the best first.
StructureSearch rescored(const AutoData& data, StructureSearch found) {
  for (auto* judged : {&found.linear, &found.regressors})
    for (auto& j : *judged) j.score = scoreOf(data, j);
  for (auto& group : found.state) {
    for (auto& j : group.members) j.score = scoreOf(data, j);
    group.score =
        meanBlockError(data, group.free_run) * penalty(group.members.front().parameters, data);
  }
  const auto better = [](const auto& a, const auto& b) { return a.score < b.score; };
  std::stable_sort(found.linear.begin(), found.linear.end(), better);
  std::stable_sort(found.regressors.begin(), found.regressors.end(), better);
  std::stable_sort(found.state.begin(), found.state.end(), better);
  return found;
}

void take(const Vector& from, const Stretch& block, Vector& into) {
  if (from.size() == 0) return;
  if (into.size() == 0) into = Vector::Constant(from.size(), kNaN);
  const auto length = block.last - block.first;
  into.segment(block.first, length) = from.segment(block.first, length);
}

}  // namespace

Confirmation confirmChoices(const AutoData& data, const StructureSearch& found) {
  Confirmation confirmed;
  for (std::size_t b = 0; b < data.windows.size(); ++b) {
    AutoData others = data;
    others.windows.erase(others.windows.begin() + static_cast<std::ptrdiff_t>(b));
    const StructureSearch chosen = rescored(others, found);
    const auto line = std::find_if(chosen.linear.begin(), chosen.linear.end(),
                                   [](const Judgement& j) { return !j.candidate.hidden; });
    if (line != chosen.linear.end()) take(line->free_run, data.windows[b], confirmed.linear);
    if (!chosen.regressors.empty())
      take(chosen.regressors.front().free_run, data.windows[b], confirmed.regressors);
    take(chooseCommittee(others, chosen).free_run, data.windows[b], confirmed.state);
  }
  return confirmed;
}

}  // namespace fpc
