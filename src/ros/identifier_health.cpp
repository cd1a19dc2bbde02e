// How an identifier over topics is, and what it counts.
#include "ros/fuzzy_identifier.hpp"

#include <utility>

namespace fpc {
namespace {

constexpr double kModelNews =
    5.0;  // [s] in which a model that could not be had degrades the identifier

}  // namespace

Health FuzzyIdentifier::health(double now_s) const {
  const std::string& problem = plant_.problem().empty() ? problem_ : plant_.problem();
  if (!problem.empty()) return {LoopMode::kFailed, EventCode::kModelRefused, problem, {}};
  if (!plant_.open())
    return {
        LoopMode::kStarting, EventCode::kWaiting, "waiting for plant_info", {"plant_simulator"}};
  if (worker_.busy())
    return {LoopMode::kAutomatic, EventCode::kNone, "identifying: " + progress_, {}};
  std::string words =
      session_.published() == 0 ? "collecting, no model yet" : "published " + session_.model().name;
  if (!failure_.empty()) words += "; " + failure_;
  const bool news = !failure_.empty() && now_s - failed_s_ < kModelNews;
  return {news ? LoopMode::kDegraded : LoopMode::kAutomatic,
          news ? failure_code_ : EventCode::kNone,
          std::move(words),
          {}};
}

void FuzzyIdentifier::report(Diagnostics::Status& status) const {
  const CollectorCounts& counts = session_.collector().counts();
  status.add("source", session_.model().source);
  status.add("models published", session_.published());
  status.add("models refused", session_.refused());
  status.add("last identification", last_identification_);
  status.add("samples collected", counts.samples);
  status.add("samples missing", counts.missing);
  status.add("samples incomplete", counts.incomplete);
  status.add("runs", counts.runs);
  status.add("rows in the window", session_.collector().size());
  if (session_.learned() > 0) status.add("samples learned online", session_.learned());
  if (session_.published() > 0)
    for (const RuleRemark& remark : reportModel(session_.model()))
      status.add(remark.output + ", rule " + std::to_string(remark.rule), remark.text);
  addRefused(status, refused());
  addRefused(status, authority().refused());
}

}  // namespace fpc
