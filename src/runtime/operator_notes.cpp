#include "runtime/operator_notes.hpp"

#include <algorithm>

namespace fpc {
namespace {

constexpr std::size_t kMostRefused = 20;

}  // namespace

void OperatorNotes::refused(std::uint32_t step, const std::string& words) {
  keep(step, "command refused: " + words);
}

void OperatorNotes::failed(std::uint32_t step, const std::string& words) { keep(step, words); }

void OperatorNotes::keep(std::uint32_t step, const std::string& remark) {
  const auto known = std::find_if(refused_.begin(), refused_.end(),
                                  [&](const RunRemark& r) { return r.words == remark; });
  if (known != refused_.end())
    ++known->samples;
  else if (refused_.size() < kMostRefused)
    refused_.push_back({remark, 1, step});
  else
    ++more_;
}

std::vector<RunRemark> OperatorNotes::remarks() const {
  std::vector<RunRemark> all = refused_;
  if (more_ > 0) all.push_back({std::to_string(more_) + " more refused", 0, 0});
  return all;
}

}  // namespace fpc
