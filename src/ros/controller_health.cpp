// How a controller over topics is, and what it counts.
#include "ros/controller_node.hpp"
#include "ros/topics.hpp"

namespace fpc {
namespace {
constexpr double kSilence = 1.0;  // [s] without a measurement that is due
constexpr double kNews = 5.0;     // [s] in which a refused model degrades the controller

std::string after(const char* words, const std::string& text) {
  return text.empty() ? "" : words + text;
}

}  // namespace

std::string ControllerNode::plantName() const {
  const auto& names = loop_.exchange.publishers.at(topics::kMeasurement);
  return names.empty() ? "the plant" : names.front();
}

std::string ControllerNode::said() const { return textOf(session_.answer().events); }

// Nothing that waits is "controlling".
Health ControllerNode::health(double now_s) const {
  if (!plant_.problem().empty())
    return {LoopMode::kFailed, EventCode::kPlantDiffers, plant_.problem(), {}};
  if (!plant_.open())
    return {LoopMode::kStarting, EventCode::kWaiting, "waiting for plant_info", {plantName()}};
  if (!session_.ready())
    return {LoopMode::kStarting, EventCode::kWaiting, "waiting for fuzzy_model", {modelName()}};
  const bool behind = parked_ && !inbox_.complete(parked_->header);
  if (behind && now_s - parked_since_s_ > kSilence)
    return {LoopMode::kStalled,
            EventCode::kIdentifierLate,
            "waits for the identifier to be done with the sample before",
            {modelName()}};
  if (session_.counts().accepted == 0)
    return {LoopMode::kStarting,
            EventCode::kWaiting,
            "waiting for the first measurement",
            {plantName()}};
  const std::string step = std::to_string(session_.answer().tracking.header.step);
  if (!session_.answer().has_action) return {LoopMode::kFinished, EventCode::kNone, "finished", {}};
  if (session_.unreleased()) return {LoopMode::kHeld, EventCode::kOperatorUnknown, said(), {}};
  if (standin_ && standin_->watch().waitsInVain(now_s))
    return {LoopMode::kStalled,
            EventCode::kOptimizerLost,
            "no answer of " + standin_->optimizer() + " to sample " + step,
            {standin_->optimizer()}};
  const double period_s = loop_.exchange.pace == Pace::kLockstep
                              ? 0.0
                              : loop_.plant_info.sample_time_s / loop_.exchange.speedup;
  if (const auto rest = summary_.rest()) return *rest;
  if (now_s - heard_s_ > period_s + kSilence)
    return {LoopMode::kStalled,
            EventCode::kNoMeasurement,
            "no measurement since sample " + step,
            {plantName()}};
  if (standin_ && standin_->watch().degraded())
    return {LoopMode::kDegraded,
            EventCode::kOptimizerLost,
            "no answer of " + standin_->optimizer() + ": the base action goes to the plant",
            {standin_->optimizer()}};
  const Event worst = worstOf(session_.answer().events);
  if (session_.isManual())
    return {LoopMode::kManual, worst.code, withRefusal("manual" + after("; ", said()), now_s), {}};
  if (session_.fellBack()) return {LoopMode::kFallback, worst.code, said(), {}};
  if (session_.answer().base.source == ActionSource::kHeld)
    return {LoopMode::kHeld, worst.code, said(), {}};
  if (worst.code != EventCode::kNone && worst.severity() > Severity::kInfo)
    return {LoopMode::kDegraded, worst.code, said(), {}};
  if (!plant_.remark().empty())
    return {LoopMode::kDegraded, EventCode::kPlantDiffers, "controlling; " + plant_.remark(), {}};
  return whileControlling(now_s);
}

// The model in use goes on as before: that another was refused is news for a while, no state.
Health ControllerNode::whileControlling(double now_s) const {
  if (!model_problem_.empty() && now_s - model_refused_s_ < kNews)
    return {LoopMode::kDegraded,
            EventCode::kModelRefused,
            "controlling; refused: " + model_problem_,
            {}};
  std::string words = "controlling";
  if (!session_.modelText().empty()) words += "; " + session_.modelText();
  for (const Event& event : session_.answer().events)
    if (event.text != session_.modelText()) words += "; " + event.text;
  return {LoopMode::kAutomatic, EventCode::kNone, withRefusal(std::move(words), now_s), {}};
}

void ControllerNode::report(Diagnostics::Status& status) const {
  status.add("hand", session_.isManual() ? "manual" : "auto");
  status.add("recipe", session_.setpoint().held() ? "held" : "running");
  status.add("step", session_.answer().tracking.header.step);
  addCounts(status, session_.counts());
  status.add("dropped: run not announced", plant_.foreign());
  if (session_.controller().needsModel()) {
    status.add("model", model_);
    status.add("model source", model_source_);
    status.add("models taken", session_.models());
    status.add("latest model refused", model_problem_);
    status.add("gains turned by the model", session_.modelText());
  }
  status.add("commands dropped: too many", commands_.dropped());
  if (standin_) status.add("samples without the optimizer", standin_->watch().takenOver());
  addRefused(status, refused());
  addRefused(status, desk_.refused());
  addRefused(status, authority().refused());
}

}  // namespace fpc
