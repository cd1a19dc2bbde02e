// The far side of the gateway: how readings come from the plant and commands go to it.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "runtime/plant_gateway.hpp"

namespace fpc {

class Field {
 public:
  virtual ~Field() = default;
  /// How commands are rounded on their way; empty: not at all.
  virtual PlantGateway::Rounding rounding() const { return nullptr; }
  /// Hands over what has come since the last call, and takes the command. `automatic`: the loop
  /// wants the inputs. Returns at once.
  virtual void exchange(PlantGateway& gateway, bool automatic, double now_s) = 0;
  /// The run is over: the plant gets its inputs back.
  virtual void release() {}
  /// What is wrong with the link, in words; empty if nothing is.
  virtual std::string problem() const { return ""; }
  /// Counters, for diagnostics.
  virtual std::vector<std::pair<std::string, std::uint64_t>> counts() const { return {}; }
};

/// @throws InputError if this build has no libmodbus.
std::unique_ptr<Field> makeModbusField(const LoopFile& loop);

}  // namespace fpc
