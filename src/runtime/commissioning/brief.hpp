// What an operator says before a plant is commissioned: a short file beside the plant's loop file.
#pragma once

#include <string>

#include "config/loop_file.hpp"

namespace fpc {

/// Read and complete: what the brief leaves out is the loop file's.
struct CommissioningBrief {
  std::string file, text;         ///< as read
  LoopFile loop;                  ///< the plant with its present control
  Vector lower, upper;            ///< n_y, limits that no test may leave
  Vector zone_lower, zone_upper;  ///< n_y, of outputs that may float; infinite: held at a setpoint
  Vector hold;                    ///< n_y, setpoints while the plant is tested
  std::vector<std::string> hold_asked;  ///< outputs whose setpoint the brief itself gives, and
  std::vector<double> hold_values;      ///< these
  Vector move;                          ///< n_u, largest move per sample
  double plant_time_h{};                ///< that watching and testing may use
  std::uint64_t seed{1};
  bool closed{};           ///< the present control follows setpoints
  std::vector<bool> held;  ///< n_y, is to be held at a setpoint

  std::uint32_t samples() const;  ///< of plant_time_h
  /// n_y: held at a setpoint or in a zone. Others may float as far as the limits.
  std::vector<bool> counted() const;
};

/// Keys: loop (name or path, beside the brief or as for `run`), limits {OUTPUT: [low, high]}, moves
/// {INPUT: number}, hold {OUTPUT: number}, zone {OUTPUT: [low, high]}, plant_time_h, seed.
/// @throws InputError naming file and key: of limits, moves or plant time that neither the brief
/// nor the loop file says, of unknown signals, of setpoints beyond the limits.
/// `running`: the loop that runs, of which the brief then speaks; `loop` may be left out and is its
/// name else.
CommissioningBrief readBrief(const std::string& file, const LoopFile* running = nullptr);

}  // namespace fpc
