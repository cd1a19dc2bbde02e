// From where the inputs of a session move on, and what it sends when its law does not run.
#include "runtime/commissioning/plant_tap.hpp"
#include "runtime/session.hpp"

namespace fpc {

void ControllerSession::lookAtMoves(const Measurement& m) {
  const bool known = m.input_applied.allFinite();
  if (needsReset(arrival_) || unreleased_ || !takes_actions_ || !known) moves_.restart();
  if (known) moves_.look(m.input_applied);
}

/// The sample with the input from which the next one moves on.
const Measurement& ControllerSession::seen(const Measurement& m) {
  if (!moves_.displaced()) return m;
  seen_ = m;
  seen_.input_applied = moves_.origin();
  return seen_;
}

/// What a law asks for that may send some inputs only has nothing in between.
void ControllerSession::handOver(const Measurement& m) {
  if (leads_an_optimizer_ || !controller_->followsSetpoint()) return;
  Vector& input = answer_.base.input;
  proposal_ = input;
  if (!transfer_.bridge(m.input_applied, input)) return;
  proposal_ = 0.5 * (proposal_ + input);
  if (controller_->mayBeSent(proposal_)) return;
  input = output_.input;
  transfer_.reset(false);
}

/// What the stages of a commissioning send in the place of the law's input, inside its limits. When
/// they are done, the law moves on from what the plant gets.
void ControllerSession::passToTest(const Measurement& m) {
  Vector& input = answer_.base.input;
  proposal_ = input;
  tap_->pass(m, limits_, moves_.displaced() ? moves_.origin() : m.input_applied, input);
  if (input != proposal_) {
    output_.predictive = false;
    output_.source = ActionSource::kGuarded;
  }
  if (tap_->open()) return;
  tap_.reset();
  transfer_.reset(true);
}

/// The sample at which a law restarts. It begins at the applied input, and a test adds its own part
/// anew: without that part, or each restart would add it once more.
const Measurement& ControllerSession::withoutTest(const Measurement& m) {
  const Vector added = tap_ && tap_->open() ? tap_->difference() : Vector();
  if (added.size() == 0) return m;
  without_test_ = m;
  without_test_.input_applied -= added;
  return without_test_;
}

/// Where somebody else has the inputs; a held sample is only one that is missing.
void ControllerSession::endTest() {
  const bool taken = manual_ || unreleased_ || !takes_actions_ || fell_back_;
  if (taken || arrival_ == Arrival::kNewRun)
    tap_->end(taken ? "somebody else has the inputs" : "a new run has begun");
  if (!tap_->open() && interruption_ != nullptr) tap_.reset();
}

/// Puts the answer inside bounds and move limit, and where it may be sent.
void ControllerSession::limit(const Measurement& m) {
  Vector& input = answer_.base.input;
  limits_.clip(input, moves_.displaced() ? moves_.origin() : m.input_applied);
  moves_.keepNear(input);
  controller_->makeSendable(input);
}

void ControllerSession::answered() {
  last_input_ = answer_.base.input;
  const ActionSource source = answer_.base.source;
  const bool of_law = source == ActionSource::kBase || source == ActionSource::kClipped ||
                      source == ActionSource::kGuarded;
  other_hand_ = other_hand_ || source == ActionSource::kManual || fell_back_ || unreleased_ ||
                !takes_actions_;
  if ((leads_an_optimizer_ && of_law) || unreleased_ || !takes_actions_)
    moves_.restart();  // the plant is told something else
  else
    moves_.sent(last_input_);
}

void ControllerSession::fallBack(const Measurement& m, const Notice& why) {
  Vector& input = answer_.base.input;
  input = plausibility_.params().fallback;
  limits_.clip(input, m.input_applied.allFinite() ? moves_.proven() : m.input_applied);
  controller_->makeSendable(input);
  answer_.base.source = output_.source = ActionSource::kFallback;
  output_.ok = output_.predictive = false;
  output_.events.add(why);
  fell_back_ = true;
}

void ControllerSession::hold(const Measurement& m, const Notice& why) {
  Vector& input = answer_.base.input;
  input = m.input_applied.allFinite() ? moves_.proven() : last_input_;
  limits_.clip(input, input);
  controller_->makeSendable(input);
  answer_.base.source = output_.source = ActionSource::kHeld;
  output_.ok = output_.predictive = false;
  if (why.code != EventCode::kNone) output_.events.add(why);
}

void ControllerSession::sendManual(const Measurement& m) {
  if (!manual_given_) manual_input_ = moves_.proven();
  manual_given_ = true;
  answer_.base.input = manual_input_;
  limits_.clip(answer_.base.input, moves_.proven());
  controller_->makeSendable(answer_.base.input);
  answer_.base.source = output_.source = ActionSource::kManual;
  if (controller_->followsSetpoint()) answer_.tracking.reference = m.outputs;
  output_.ok = true;
  output_.predictive = false;
}

}  // namespace fpc
