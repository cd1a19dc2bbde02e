#include "runtime/plant_gateway.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

using Index = Eigen::Index;

const SignalInfo& signalOf(const PlantInfo& info, std::size_t signal) {
  const std::size_t n_y = info.outputs.size();
  return signal < n_y ? info.outputs[signal] : info.disturbances[signal - n_y];
}

}  // namespace

PlantGateway::PlantGateway(const LoopFile& loop, Rounding rounding)
    : params_(loop.gateway),
      info_(loop.plant_info),
      clock_(info_.sample_time_s, loop.simulation.start_time_s),
      actuator_(loop.simulation.actuator),
      rounding_(std::move(rounding)),
      samples_(loop.simulation.samples),
      signals_(info_.outputs.size() + info_.disturbances.size()),
      positions_(info_.inputs.size()),
      tolerance_(loop.stuck.tolerance) {
  require(params_.enabled(), loop.name + ": gateway.type", "a gateway");
  measurement_.outputs.resize(static_cast<Index>(info_.outputs.size()));
  measurement_.disturbances.resize(static_cast<Index>(info_.disturbances.size()));
  quality_.resize(signals_.size());
  age_s_.resize(static_cast<Index>(signals_.size()));
  position_known_ = !params_.reads_back;
  exact_ = params_.reads_back;
  command_ = seen_ = actuator_.applied();
  astray_ = lying_ = Vector::Constant(command_.size(), std::nan(""));
  reset(1);
}

void PlantGateway::sense(std::size_t signal, double value, double now_s) {
  signals_[signal] = {value, now_s, true};
}

void PlantGateway::readBack(Index input, double value, double now_s) {
  if (!std::isfinite(value)) return;
  positions_[static_cast<std::size_t>(input)] = {value, now_s, true};
  const bool all = std::all_of(positions_.begin(), positions_.end(),
                               [this](const Reading& p) { return p.come && p.at_s > told_s_; });
  if (!all) return;
  if (voided_ == number_) confirmed_ = number_;  // what is there now counts, whatever was written
  position_known_ = true;
}

void PlantGateway::beat(std::uint64_t value, double now_s) {
  if (beaten_ && value == beat_) return;
  const bool stood = beaten_ && params_.heartbeat_s > 0.0 && now_s - beat_s_ > params_.heartbeat_s;
  if (stood) doubtPosition(now_s, true);
  beat_ = value;
  beat_s_ = now_s;
  beaten_ = true;
}

void PlantGateway::remote(bool on, double now_s) {
  if (on != remote_) doubtPosition(now_s, true);
  remote_ = on;
}

void PlantGateway::lead(bool on, double now_s) {
  if (on != lead_) doubtPosition(now_s, true);
  lead_ = on;
}

void PlantGateway::link(bool up, double now_s) {
  if (up != link_) doubtPosition(now_s);
  link_ = up;
}

/// Only what is read back from now on says where the inputs are, to the last digit. A command on
/// its way was made for another place. `moved`: somebody else has had the inputs.
void PlantGateway::doubtPosition(double now_s, bool moved) {
  told_s_ = now_s;
  if (!params_.reads_back) return;
  if (unconfirmed()) voided_ = number_;
  if (moved)
    lying_.setConstant(std::nan(""));
  else if (!exact_)
    lying_ = astray_;
  position_known_ = false;
  exact_ = true;
}

void PlantGateway::confirm(std::uint64_t number, double now_s) {
  if (number != number_) return;
  confirmed_ = number;
  told_s_ = now_s;
  if (!waits_ || !mayCommand()) return;
  waits_ = false;
  command(waiting_);
}

void PlantGateway::fail(std::uint64_t number, double now_s) {
  if (number == number_ && unconfirmed()) doubtPosition(now_s);
}

FieldState PlantGateway::field() const {
  if (!link_) return FieldState::kLost;
  if (params_.heartbeat_s > 0.0 && (!beaten_ || now_s_ - beat_s_ > params_.heartbeat_s))
    return FieldState::kFrozen;
  if (!lead_) return FieldState::kLed;
  if (!remote_) return FieldState::kLocal;
  return position_known_ ? FieldState::kRunning : FieldState::kUnknown;
}

bool PlantGateway::agrees(Index i, double reading, double with) const {
  const InputLimits& limits = actuator_.params().limits;
  return std::abs(reading - with) <= tolerance_ * (limits.upper[i] - limits.lower[i]);
}

/// After a doubt commands begin where the inputs are; until the field runs they go with them. The
/// plant is taken to hold its command register there.
void PlantGateway::followReadings() {
  if (!exact_ || unconfirmed()) return;
  for (Index i = 0; i < command_.size(); ++i) {
    const Reading& position = positions_[static_cast<std::size_t>(i)];
    if (!position.come || position.at_s <= told_s_) continue;
    if (agrees(i, position.value, lying_[i])) continue;
    lying_[i] = std::nan("");
    actuator_.disturb(i, position.value);
    command_[i] = actuator_.applied()[i];
  }
  if (field() != FieldState::kRunning) return;
  actuator_.apply(Vector(command_));  // held from here on
  exact_ = false;
}

/// Where input i is, if it has been read since it was told; where it was told, if it is too early;
/// NaN if nothing comes any more.
double PlantGateway::positionOf(Index i) const {
  const Reading& position = positions_[static_cast<std::size_t>(i)];
  if (!params_.reads_back || !position.come) return command_[i];
  if (now_s_ - position.at_s > params_.stale_s) return std::nan("");
  return unconfirmed() || position.at_s <= told_s_ ? command_[i] : position.value;
}

/// The command as the field can carry it.
void PlantGateway::tell() {
  const InputLimits& limits = actuator_.params().limits;
  for (Index i = 0; rounding_ && i < command_.size(); ++i) {
    const double lower = std::max(limits.lower[i], command_[i] - limits.move[i]);
    const double upper = std::min(limits.upper[i], command_[i] + limits.move[i]);
    const auto rounded = rounding_(i, actuator_.applied()[i], lower, upper);
    actuator_.disturb(i, rounded.value_or(command_[i]));
  }
  command_ = actuator_.applied();
  if (!unconfirmed()) asked_s_ = now_s_;
  ++number_;
  commanded_ = true;
}

const Measurement& PlantGateway::reset(std::uint64_t run_id) {
  info_.header = clock_.header(run_id, 0);
  measurement_.header = info_.header;
  trouble_.clear();
  measure();
  return measurement_;
}

void PlantGateway::take(VectorRef input) {
  if (measurement_.final) return;
  followReadings();
  if (mayCommand()) return command(input);
  waits_ = field() == FieldState::kRunning && unconfirmed();  // for the command ahead of it
  if (waits_)
    waiting_ = input;
  else
    ++skipped_;
}

void PlantGateway::command(VectorRef input) {
  actuator_.apply(input);
  tell();
}

const Measurement& PlantGateway::advance(VectorRef /*input: taken when it came*/) {
  if (measurement_.final) return measurement_;
  if (waits_) ++skipped_;
  waits_ = false;
  measurement_.header = clock_.header(measurement_.header.run_id, measurement_.header.step + 1);
  measure();
  just_told_ = false;
  return measurement_;
}

const Measurement& PlantGateway::advanceWithoutAction() {
  if (measurement_.final) return measurement_;
  followReadings();
  if (mayCommand()) {
    actuator_.miss();
    tell();
    just_told_ = true;
  } else {
    ++skipped_;
  }
  return advance(command_);
}

Quality PlantGateway::qualityOf(const Reading& reading) const {
  if (!reading.come) return Quality::kMissing;
  if (!std::isfinite(reading.value)) return Quality::kBad;
  const bool stale = now_s_ - reading.at_s > params_.stale_s || field() == FieldState::kFrozen;
  return stale ? Quality::kStale : Quality::kGood;
}

void PlantGateway::measure() {
  followReadings();
  const auto n_y = static_cast<Index>(info_.outputs.size());
  for (std::size_t i = 0; i < signals_.size(); ++i) {
    const Reading& reading = signals_[i];
    const auto row = static_cast<Index>(i);
    double& value = row < n_y ? measurement_.outputs[row] : measurement_.disturbances[row - n_y];
    quality_[i] = qualityOf(reading);
    value = quality_[i] == Quality::kGood ? reading.value : std::nan("");
    age_s_[row] = reading.come ? now_s_ - reading.at_s : std::numeric_limits<double>::infinity();
  }
  measurement_.input_applied = actuator_.applied();
  for (Index i = 0; i < seen_.size(); ++i) {
    seen_[i] = positionOf(i);
    if (!unconfirmed()) astray_[i] = agrees(i, seen_[i], command_[i]) ? std::nan("") : seen_[i];
  }
  takes_ = field() == FieldState::kRunning && (!unconfirmed() || just_told_);
  measurement_.final = samples_ > 0 && measurement_.header.step == samples_;
}

std::vector<std::string> PlantGateway::missing() const {
  std::vector<std::string> names;
  if (!lead_) names.push_back("the plant's leadership");
  for (std::size_t i = 0; i < signals_.size(); ++i)
    if (!signals_[i].come) names.push_back(signalOf(info_, i).name);
  for (std::size_t i = 0; i < positions_.size(); ++i)
    if (params_.reads_back && !positions_[i].come)
      names.push_back(info_.inputs[i].name + " read back");
  return names;
}

std::string PlantGateway::problem() const {
  switch (field()) {
    case FieldState::kLost:
      return "the link to the plant is down";
    case FieldState::kFrozen:
      return "the plant's heartbeat stands still";
    case FieldState::kLocal:
      return "the plant's own hand has the inputs";
    case FieldState::kLed:
      return "another master leads the plant";
    case FieldState::kUnknown:
      return "where the inputs are is not known yet";
    case FieldState::kRunning:
      break;
  }
  if (unconfirmed() && now_s_ - asked_s_ > params_.stale_s)  // before that it is on its way
    return "the plant has not confirmed the last command";
  for (std::size_t i = 0; i < signals_.size(); ++i) {
    const Quality quality = qualityOf(signals_[i]);
    if (quality == Quality::kGood) continue;
    return signalOf(info_, i).name + (quality == Quality::kStale     ? " is stale"
                                      : quality == Quality::kMissing ? " has not come"
                                                                     : " is no number");
  }
  return "";
}

}  // namespace fpc
