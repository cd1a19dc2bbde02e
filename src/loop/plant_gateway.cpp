#include "fmbpc/loop/plant_gateway.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

using Index = Eigen::Index;

constexpr double kRounding = 1e-9;

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
      positions_(info_.inputs.size()) {
  require(params_.enabled(), loop.name + ": gateway.type", "a gateway");
  measurement_.outputs.resize(static_cast<Index>(info_.outputs.size()));
  measurement_.disturbances.resize(static_cast<Index>(info_.disturbances.size()));
  quality_.resize(signals_.size());
  age_s_.resize(static_cast<Index>(signals_.size()));
  position_known_ = !params_.reads_back;
  exact_ = params_.reads_back;
  command_ = actuator_.applied();
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
  if (stood) doubtPosition(now_s);
  beat_ = value;
  beat_s_ = now_s;
  beaten_ = true;
}

void PlantGateway::remote(bool on, double now_s) {
  if (on != remote_) doubtPosition(now_s);
  remote_ = on;
}

void PlantGateway::link(bool up, double now_s) {
  if (up != link_) doubtPosition(now_s);
  link_ = up;
}

/// Only what is read back from now on says where the inputs are, to the last digit. A command on
/// its way was made for another place.
void PlantGateway::doubtPosition(double now_s) {
  told_s_ = now_s;
  if (!params_.reads_back) return;
  if (unconfirmed()) voided_ = number_;
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
  if (!remote_) return FieldState::kLocal;
  return position_known_ ? FieldState::kRunning : FieldState::kUnknown;
}

/// Where the inputs are: what is read back, unless it is what was commanded. After a doubt the
/// plant is taken to hold its command register where its input is.
void PlantGateway::followReadings() {
  if (!params_.reads_back || unconfirmed()) return;
  const InputLimits& limits = actuator_.params().limits;
  const bool exact = exact_ && position_known_;
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    const Reading& position = positions_[i];
    const auto row = static_cast<Index>(i);
    if (!position.come || position.at_s <= told_s_) continue;
    const double range = limits.upper[row] - limits.lower[row];
    const double tolerated = std::isfinite(range) ? params_.readback_tolerance * range : 0.0;
    if (exact) command_[row] = position.value;
    const bool away = exact || std::abs(position.value - command_[row]) > tolerated;
    actuator_.disturb(row, away ? position.value : command_[row]);
  }
  if (exact) actuator_.apply(Vector(actuator_.applied()));  // held from here on
  if (exact) exact_ = false;
}

/// What element i may be told: inside the bounds, one move from the last command and one move from
/// where it is; where both cannot be it is told nothing new.
PlantGateway::Span PlantGateway::spanOf(Index i) const {
  const InputLimits& limits = actuator_.params().limits;
  const double move = limits.move[i];
  Span span{std::max(limits.lower[i], command_[i] - move),
            std::min(limits.upper[i], command_[i] + move)};
  if (span.lower > span.upper) return {limits.lower[i], limits.upper[i]};  // the bound wins
  const Reading& position = positions_[static_cast<std::size_t>(i)];
  if (!params_.reads_back || !position.come || position.at_s <= told_s_) return span;
  const double from = position.value - move, to = position.value + move;
  if (from > span.upper || to < span.lower) return {command_[i], command_[i]};
  return {std::max(span.lower, from), std::min(span.upper, to)};
}

/// Further from its command than a move ahead and a move behind explain: it lies, is stuck, or
/// somebody else moves it. A command that runs after it would drive the plant by whatever is read.
bool PlantGateway::strays(Index i) const {
  const Reading& position = positions_[static_cast<std::size_t>(i)];
  if (!params_.reads_back || exact_ || !position.come || position.at_s <= told_s_) return false;
  const double tolerated = 2.0 * actuator_.params().limits.move[i];
  return std::abs(position.value - command_[i]) > tolerated * (1.0 + kRounding);
}

/// Whether no input is left that follows.
bool PlantGateway::allStray() const {
  Index stray = 0;
  for (Index i = 0; i < command_.size(); ++i) stray += strays(i) ? 1 : 0;
  return stray == command_.size();
}

/// The command as the field can carry it.
void PlantGateway::tell() {
  for (Index i = 0; i < command_.size(); ++i) {
    const Span span = spanOf(i);
    double value = std::clamp(actuator_.applied()[i], span.lower, span.upper);
    if (rounding_) value = rounding_(i, value, span.lower, span.upper).value_or(command_[i]);
    command_[i] = value;
    actuator_.disturb(i, value);
  }
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
  takes_ = field() == FieldState::kRunning && !allStray() && (!unconfirmed() || just_told_);
  measurement_.final = samples_ > 0 && measurement_.header.step == samples_;
}

std::vector<std::string> PlantGateway::missing() const {
  std::vector<std::string> names;
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
    case FieldState::kUnknown:
      return "where the inputs are is not known yet";
    case FieldState::kRunning:
      break;
  }
  if (unconfirmed() && now_s_ - asked_s_ > params_.stale_s)  // before that it is on its way
    return "the plant has not confirmed the last command";
  for (Index i = 0; i < command_.size(); ++i)
    if (strays(i))
      return info_.inputs[static_cast<std::size_t>(i)].name + " is not where it was told";
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
