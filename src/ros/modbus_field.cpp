#include "ros/modbus_field.hpp"

#include <algorithm>
#include <chrono>
#include <random>

#include "ros/wall_throttle.hpp"

namespace fpc {
namespace {

constexpr double kReconnectPolls = 5.0, kReconnect = 1.0;  // polls between two attempts, most [s]
constexpr double kRenew = 0.1;  // [s] between two renewals of what is held already
constexpr double kShown = 2.0;  // [s] that a coil which somebody else has written is told

std::chrono::duration<double> seconds(double value) { return std::chrono::duration<double>(value); }

/// Two gateways of one loop file are two masters.
std::uint16_t ownWord() {
  std::random_device device;
  return static_cast<std::uint16_t>(1U + device() % 0xFFFFU);
}

}  // namespace

ModbusField::ModbusField(const LoopFile& loop)
    : params_(loop.gateway),
      switched_off_s_(-kShown),
      lease_(ownWord(), "register " + std::to_string(params_.modbus.owner)) {
  seen_.signals.resize(params_.outputs.size() + params_.disturbances.size());
  seen_.positions.resize(params_.inputs.size());
  seen_.problem = "not connected yet";
  shown_ = seen_;
  thread_ = std::thread([this] { work(); });
}

ModbusField::~ModbusField() {
  release();
  if (thread_.joinable()) thread_.join();
}

/// The thread gives the plant its inputs back, and ends.
void ModbusField::release() {
  const std::lock_guard<std::mutex> lock(mutex_);
  stop_ = true;
  wish_.automatic = wish_.commands = false;
  wake_.notify_all();
}

PlantGateway::Rounding ModbusField::rounding() const {
  return [inputs = params_.inputs](Eigen::Index i, double value, double lower, double upper) {
    return representable(inputs[static_cast<std::size_t>(i)].modbus.format, value, lower, upper);
  };
}

void ModbusField::exchange(PlantGateway& gateway, bool automatic, double now_s) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const Seen& seen = shown_;
  if (seen.drops != handed_drops_) gateway.link(false, seen.at_s);
  handed_drops_ = seen.drops;
  gateway.link(seen.up, seen.at_s);
  gateway.lead(!seen.another_leads, seen.at_s);
  if (seen.remote_seen) gateway.remote(seen.remote, seen.at_s);
  if (seen.beaten) gateway.beat(seen.beat, seen.beat_s);
  if (seen.failed == gateway.commandNumber() && seen.failed > seen.confirmed)
    gateway.fail(seen.failed, seen.failed_s);
  gateway.confirm(seen.confirmed, seen.confirmed_s);
  for (std::size_t i = 0; i < seen.signals.size(); ++i)
    if (seen.signals[i].at_s >= 0.0) gateway.sense(i, seen.signals[i].value, seen.signals[i].at_s);
  for (std::size_t i = 0; i < seen.positions.size(); ++i)
    if (seen.positions[i].at_s >= 0.0)
      gateway.readBack(static_cast<Eigen::Index>(i), seen.positions[i].value,
                       seen.positions[i].at_s);
  wish_.asked_s = now_s;
  if (stop_) return;
  wish_.automatic = automatic;
  wish_.commands = automatic && gateway.commands();
  if (wish_.number == gateway.commandNumber()) return;
  wish_.number = gateway.commandNumber();
  wish_.drops = seen.drops;
  wish_.input = gateway.command();
  wake_.notify_all();
}

std::string ModbusField::problem() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return shown_.problem;
}

std::vector<std::pair<std::string, std::uint64_t>> ModbusField::counts() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return {{"rounds of polling", shown_.rounds},
          {"connections lost", shown_.drops},
          {"requests failed", shown_.errors},
          {"requests refused by the plant", shown_.exceptions},
          {"times that leadership was lost", shown_.lost}};
}

void ModbusField::work() {
  std::unique_ptr<ModbusLink> link;
  std::unique_lock<std::mutex> lock(mutex_);
  for (bool last = false; !last;) {
    last = stop_;
    const Wish wish = wish_;
    lock.unlock();
    try {
      if (!link && !last) {
        auto fresh = std::make_unique<ModbusLink>(params_.modbus);
        fresh->connect();
        link = std::move(fresh);
        automatic_told_ = -1;
        lease_.forget();
      }
      if (link) round(*link, wish);
    } catch (const std::exception& error) {
      link.reset();
      dropped(error.what());
    }
    lock.lock();
    shown_ = seen_;
    const double poll_s = params_.modbus.poll_s,
                 pause_s = link ? poll_s : std::min(kReconnectPolls * poll_s, kReconnect);
    const std::uint64_t told = wish.number;
    if (!last)
      wake_.wait_for(lock, seconds(pause_s),
                     [&] { return stop_ || (link && wish_.commands && wish_.number != told); });
  }
}

void ModbusField::dropped(const std::string& why) {
  ++seen_.errors;
  if (seen_.up) ++seen_.drops;
  seen_.up = false;
  seen_.at_s = steadyNow();
  seen_.problem = why;
}

void ModbusField::round(ModbusLink& link, const Wish& wish) {
  const std::uint64_t refused = seen_.exceptions;
  tell(link, wish);
  readAll(link);
  readPositions(link);
  ++seen_.rounds;
  if (!seen_.up) seen_.at_s = steadyNow();
  seen_.up = true;
  seen_.another_leads = lease_.another();
  seen_.lost = lease_.losses() + switched_off_;
  const double now_s = steadyNow();
  seen_.problem = seen_.exceptions > refused ? link.refusal() : lease_.problem(now_s);
  if (seen_.problem.empty() && now_s - switched_off_s_ <= kShown)
    seen_.problem =
        "somebody has switched coil " + std::to_string(params_.modbus.automatic.address) + " off";
}

void ModbusField::readAll(ModbusLink& link) {
  const ModbusParams& modbus = params_.modbus;
  for (std::size_t i = 0; i < seen_.signals.size(); ++i) {
    const std::size_t n_y = params_.outputs.size();
    const GatewayTag& tag = i < n_y ? params_.outputs[i] : params_.disturbances[i - n_y];
    const double at_s = steadyNow();
    if (const auto value = link.read(tag.modbus))
      seen_.signals[i] = {*value, at_s};
    else
      ++seen_.exceptions;
  }
  if (modbus.remote.address >= 0) {
    const auto remote = link.readBit(modbus.remote);
    if (remote) seen_.remote = *remote;
    seen_.remote_seen = seen_.remote_seen || remote.has_value();
    if (!remote) ++seen_.exceptions;
  }
  if (modbus.heartbeat_in < 0) return;
  const double at_s = steadyNow();
  const auto beat = link.readRegister(modbus.heartbeat_in);
  if (!beat) ++seen_.exceptions;
  if (!beat || (seen_.beaten && seen_.beat == *beat)) return;
  seen_.beat = *beat;
  seen_.beat_s = at_s;
  seen_.beaten = true;
}

void ModbusField::readPositions(ModbusLink& link) {
  for (std::size_t i = 0; i < seen_.positions.size(); ++i) {
    const double at_s = steadyNow();
    if (const auto value = link.read(params_.inputs[i].readback))
      seen_.positions[i] = {*value, at_s};
    else
      ++seen_.exceptions;
  }
}

/// Renewing shows as well who has written there meanwhile.
bool ModbusField::leads(ModbusLink& link, bool claims) {
  const int address = params_.modbus.owner;
  if (address < 0) return true;
  const auto found = link.readRegister(address);
  if (found)
    lease_.held(*found, steadyNow());
  else
    ++seen_.exceptions;
  const bool led = lease_.leads();
  const auto word = lease_.toWrite(claims);
  if (word && !link.writeRegister(address, *word)) ++seen_.exceptions;
  return led;
}

void ModbusField::renewAutomatic(ModbusLink& link, bool claims) {
  const ModbusBit& coil = params_.modbus.automatic;
  if (coil.address < 0 || (!claims && automatic_told_ == 0)) return;
  const auto found = link.readBit(coil);
  const bool done = found && link.writeCoil(coil.address, claims);
  if (!done) ++seen_.exceptions;
  if (automatic_told_ == 1 && found && !*found) {
    ++switched_off_;
    switched_off_s_ = steadyNow();
  }
  automatic_told_ = !done ? -1 : claims ? 1 : 0;
}

/// What is held is renewed after kRenew, what is not is asked for in each round.
void ModbusField::renew(ModbusLink& link, bool claims) {
  const double now_s = steadyNow();
  if (hasInputs() && claims && now_s - renewed_s_ < kRenew) return;
  renewed_s_ = now_s;
  if (leads(link, claims)) renewAutomatic(link, claims);
}

bool ModbusField::hasInputs() const {
  const ModbusParams& modbus = params_.modbus;
  return (modbus.owner < 0 || lease_.leads()) &&
         (modbus.automatic.address < 0 || automatic_told_ == 1);
}

/// The command goes first: the plant is to have it before its sample ends.
void ModbusField::tell(ModbusLink& link, const Wish& wish) {
  if (hasInputs()) command(link, wish);
  renew(link, wish.automatic);
  const int heartbeat = params_.modbus.heartbeat_out;
  if (heartbeat < 0 || (params_.modbus.owner >= 0 && !lease_.leads())) return;
  if (steadyNow() - wish.asked_s < kPatience && !link.writeRegister(heartbeat, ++heartbeat_))
    ++seen_.exceptions;
}

/// A command is written once; one that failed, or was made before the connection was lost, waits
/// for what is read back.
void ModbusField::command(ModbusLink& link, const Wish& wish) {
  if (!wish.commands || wish.number == seen_.confirmed || wish.number == seen_.failed) return;
  seen_.failed = wish.number;  // unless all of it arrives
  seen_.failed_s = steadyNow();
  if (wish.drops != seen_.drops) return;
  bool done = true;
  for (std::size_t i = 0; i < params_.inputs.size(); ++i) {
    seen_.failed_s = steadyNow();
    done = link.write(params_.inputs[i].modbus, wish.input[static_cast<Eigen::Index>(i)]) && done;
  }
  seen_.failed_s = steadyNow();
  if (!done) ++seen_.exceptions;
  if (!done) return;
  seen_.confirmed = wish.number;
  seen_.confirmed_s = steadyNow();
}

std::unique_ptr<Field> makeModbusField(const LoopFile& loop) {
  return std::make_unique<ModbusField>(loop);
}

}  // namespace fpc
