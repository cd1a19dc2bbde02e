// A plant behind Modbus/TCP. All input and output happens in a thread of its own, so that a slow
// or silent plant never holds up the exchange.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "ros/field.hpp"
#include "ros/modbus_link.hpp"
#include "runtime/lease.hpp"

namespace fpc {

/// Each round of poll_s, and at once when there is a command: the command is written, leadership
/// (the owner's word, the coil) is claimed, or renewed every tenth of a second, then everything is
/// read, the inputs last. Who does not lead writes nothing. The heartbeat towards the plant counts
/// rounds and stops when exchange() has not been called for kPatience: a plant that watches it
/// notices a node that hangs.
class ModbusField : public Field {
 public:
  static constexpr double kPatience = 1.0;  ///< [s]

  explicit ModbusField(const LoopFile& loop);
  ~ModbusField() override;
  PlantGateway::Rounding rounding() const override;
  void exchange(PlantGateway& gateway, bool automatic, double now_s) override;
  void release() override;
  std::string problem() const override;
  std::vector<std::pair<std::string, std::uint64_t>> counts() const override;

 private:
  struct Reading {
    double value{}, at_s{-1.0};
  };
  /// What the thread has seen; copied whole.
  struct Seen {
    bool up{false};
    std::uint64_t drops{}, rounds{}, errors{}, exceptions{}, lost{};
    std::vector<Reading> signals, positions;
    bool remote{true}, remote_seen{false}, another_leads{false};
    std::uint64_t beat{}, confirmed{}, failed{};
    bool beaten{false};
    double at_s{}, beat_s{}, confirmed_s{}, failed_s{};
    std::string problem;
  };
  /// What the thread is to tell the plant.
  struct Wish {
    Vector input;
    std::uint64_t number{}, drops{};  ///< made when so many connections had been lost
    bool commands{false}, automatic{false};
    double asked_s{};
  };
  void work();
  void round(ModbusLink& link, const Wish& wish);
  void readAll(ModbusLink& link);
  void readPositions(ModbusLink& link);
  bool hasInputs() const;
  void renew(ModbusLink& link, bool claims);
  bool leads(ModbusLink& link, bool claims);
  void renewAutomatic(ModbusLink& link, bool claims);
  void tell(ModbusLink& link, const Wish& wish);
  void command(ModbusLink& link, const Wish& wish);
  void dropped(const std::string& why);

  GatewayParams params_;
  Seen seen_;  // of the thread
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  Seen shown_;  // guarded by mutex_, as all that follows
  Wish wish_;
  bool stop_{false};
  std::uint64_t handed_drops_{};  // of exchange()
  std::uint16_t heartbeat_{};
  int automatic_told_{-1};        // on this connection; -1: nothing yet
  std::uint64_t switched_off_{};  // so often somebody else has
  double switched_off_s_{};       // and when last
  double renewed_s_{};            // leadership
  Lease lease_;
  std::thread thread_;
};

}  // namespace fpc
