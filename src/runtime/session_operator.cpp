// What an operator asks of a controller: manual, adaptation, settings; kept by others for one that
// comes back.
#include <algorithm>
#include <utility>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "runtime/commissioning/plant_tap.hpp"
#include "runtime/session.hpp"
#include "runtime/watched_law.hpp"
#include "supervision/actuator_effectiveness.hpp"

namespace fpc {

void ControllerSession::manual(bool on) {
  if (on && !manual_) {
    manual_given_ = false;
    manual_texts_.assign(manual_texts_.size(), "");
  }
  if (!on && manual_ && reaction_) reaction_->reset();  // a person has seen to it
  manual_ = on;
  manual_asked_ = true;
  unreleased_ = false;
}

void ControllerSession::holdRecipe(bool on) {
  setpoint_.hold(on);
  recipe_asked_ = true;
}

void ControllerSession::manualInput(VectorRef input) {
  require(manual_, "manual input", "manual mode: switch to manual first");
  require(input.size() == last_input_.size(), "manual input",
          std::to_string(last_input_.size()) + " numbers");
  require(input.allFinite(), "manual input", "finite numbers");
  require(controller_->mayBeSent(input), "manual input", "an input that the controller may send");
  manual_input_ = input.cwiseMax(limits_.lower).cwiseMin(limits_.upper);
  for (std::size_t i = 0; i < manual_texts_.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const SignalInfo& of = plant_.inputs[i];
    manual_texts_[i] = manual_input_[k] == input[k]
                           ? ""
                           : of.name + " was asked by hand to be " + exactText(input[k]) +
                                 ", beyond its limits, " +
                                 rangeText(limits_.lower[k], limits_.upper[k], of.unit) +
                                 ", and clamped";
  }
  manual_given_ = true;
}

std::string ControllerSession::manualClamped() const {
  std::vector<std::string> texts;
  for (const std::string& text : manual_texts_)
    if (manual_ && !text.empty()) texts.push_back(text);
  return join(texts, "; ");
}

bool ControllerSession::adapt(bool on) {
  const bool done = controller_->adapt(on);
  if (done) adapt_ = on;
  return done;
}

bool ControllerSession::retune(const Settings& settings) {
  if (!controller_->retune(settings)) return false;
  for (const auto& [key, value] : settings) {
    const auto known = std::find_if(settings_.begin(), settings_.end(),
                                    [&name = key](const auto& s) { return s.first == name; });
    if (known == settings_.end())
      settings_.emplace_back(key, value);
    else
      known->second = value;
  }
  return true;
}

void ControllerSession::watch(CandidateLaw candidate) {
  if (watched_ == nullptr) {
    auto watched = std::make_unique<WatchedLaw>(std::move(controller_), model_, limits_, plant_,
                                                leads_an_optimizer_);
    watched_ = watched.get();
    controller_ = std::move(watched);
  }
  watched_->watch(std::move(candidate));
}

void ControllerSession::handOver(bool on) {
  require(watched_ != nullptr, "candidate", "one that is watched; there is none");
  if (on)
    watched_->handOver();
  else
    watched_->back();
}

void ControllerSession::test(std::shared_ptr<PlantTap> tap) {
  require(!tap_ || !tap_->open(), "test", "no other one that goes on");
  require(!leads_an_optimizer_, "test",
          "a loop without a constraint optimizer, whose plan would undo it: clp: false");
  tap_ = std::move(tap);
}

OperatorState ControllerSession::operator_state() const {
  return {manual_, manual_given_, manual_input_,       setpoint_.recipe(),
          adapt_,  settings_,     setpoint_.standing()};
}

void ControllerSession::restore(const OperatorState& operator_state) {
  if (gate_.counts().accepted > 0) return;
  if (!manual_asked_) restoreManual(operator_state);
  const bool hold = recipe_asked_ ? setpoint_.held() : operator_state.recipe.held;
  setpoint_.restore(operator_state.recipe);
  setpoint_.hold(hold);
  for (const Command& command : operator_state.setpoints) setpoint_.restore(command);
  if (operator_state.adapt && !adapt_) adapt(*operator_state.adapt);
  Settings older;
  for (const auto& setting : operator_state.settings)
    if (std::none_of(settings_.begin(), settings_.end(),
                     [&](const auto& asked) { return asked.first == setting.first; }))
      older.push_back(setting);
  if (!older.empty()) retune(older);
}

void ControllerSession::beginAnew() {
  if (std::exchange(carries_, false))
    setpoint_.carryOver();
  else
    setpoint_.restart();
}

void ControllerSession::restoreManual(const OperatorState& operator_state) {
  manual_ = operator_state.manual;
  manual_given_ = operator_state.manual_given &&
                  operator_state.manual_input.size() == last_input_.size() &&
                  operator_state.manual_input.allFinite();
  if (manual_given_)
    manual_input_ = operator_state.manual_input.cwiseMax(limits_.lower).cwiseMin(limits_.upper);
}

}  // namespace fpc
