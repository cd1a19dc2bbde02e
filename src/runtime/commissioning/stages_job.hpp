// The stages of a commissioning as a controller node runs them, beside its loop.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "config/loop_file.hpp"
#include "runtime/commissioning/plant_tap.hpp"

namespace fpc {

struct StagesWish {
  std::string brief, folder, until, again;  ///< again: empty, or a stage that is gone through anew
  int evaluations{}, members{};             ///< 0: as many as `fmbpc commission` takes
  std::shared_ptr<PlantTap> plant;
  const LoopFile* loop{nullptr};
  std::function<void(const std::string& stage, const std::string& text)> show;
};

class StagesJob {
 public:
  virtual ~StagesJob() = default;
  /// Whether a stage that is not done yet moves the plant.
  virtual bool needsPlant() const = 0;
  /// Outputs whose setpoint the brief gives, and the setpoints.
  virtual const std::vector<std::string>& held() const = 0;
  virtual const std::vector<double>& heldValues() const = 0;
  /// @throws InputError where a stage cannot be gone through.
  virtual void run() = 0;
  virtual std::string figures() const = 0;  ///< of all stages, in JSON
};

}  // namespace fpc
