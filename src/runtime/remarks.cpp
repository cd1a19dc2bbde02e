// What a person must know of a run besides its indices: everything that did not go as asked.
#include "fmbpc/base/text.hpp"
#include "runtime/report.hpp"

namespace fpc {
namespace {

std::uint64_t countOf(const Summary& summary, ActionSource source) {
  const auto at = static_cast<std::size_t>(source);
  return at < summary.sources.size() ? summary.sources[at] : 0;
}

std::string ofAll(std::uint64_t count, const Summary& summary) {
  return std::to_string(count) + " of " + std::to_string(summary.steps) + " samples";
}

}  // namespace

std::string troubleOf(const Summary& summary) {
  if (summary.failed_samples == 0) return "";
  return summary.loop + ": the plant could not be moved over " +
         ofAll(summary.failed_samples, summary) + " and was held; first " + summary.trouble;
}

bool neverControlled(const Summary& summary) {
  const std::uint64_t lost =
      countOf(summary, ActionSource::kHeld) + countOf(summary, ActionSource::kFallback);
  return summary.steps > 0 && lost == summary.steps;
}

std::vector<std::string> remarksOf(const Summary& summary) {
  std::vector<std::string> remarks;
  const auto add = [&](const std::string& words) {
    remarks.push_back(summary.loop + ": " + words);
  };
  const auto count = [&](ActionSource source, const char* words) {
    const std::uint64_t n = countOf(summary, source);
    if (n > 0) add(ofAll(n, summary) + " " + words);
  };
  if (summary.failed_samples > 0) remarks.push_back(troubleOf(summary));
  if (!summary.complete && summary.failed_samples == 0) add("not complete");
  count(ActionSource::kHeld, "held: the controller had no usable answer");
  count(ActionSource::kFallback,
        "on the fallback: no answer came in time, or the model has no data");
  count(ActionSource::kGuarded, "guarded: the guard left less than the limits");
  count(ActionSource::kClipped, "clipped: the law or the optimizer asked for more than the limits");
  if (neverControlled(summary)) add("the controller never acted");
  for (const RunRemark& remark : summary.remarks)
    if (remark.samples == 0)
      add(remark.words);
    else
      add(ofAll(remark.samples, summary) + ": " + remark.words + " (first sample " +
          std::to_string(remark.first) + ")");
  for (const LockUp& lock : summary.locked)
    add(lock.input + " locked at its " + (lock.upper ? "upper" : "lower") +
        " limit over the last " + ofAll(lock.samples, summary));
  if (summary.outside_model > 0)
    add(ofAll(summary.outside_model, summary) + " outside the model's data");
  if (summary.repaired_cells > 0)
    add(std::to_string(summary.repaired_cells) + " missing cells of the influent record filled");
  if (summary.implausible_cells > 0)
    add(std::to_string(summary.implausible_cells) +
        " implausible cells of the influent record clipped or filled");
  return remarks;
}

}  // namespace fpc
