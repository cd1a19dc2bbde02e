// A law whose model has outputs that nobody measures.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "control/controller_around.hpp"
#include "estimation/output_estimator.hpp"

namespace fpc {

/// The controller `inside` sees estimates in the place of the outputs that are not measured,
/// whatever their measurements hold; the others, inputs and disturbances pass as they are. The
/// estimator follows the process while somebody else has the inputs; after a gap it goes on from
/// its last estimate. signals(): those of `inside`, then NAME_estimate of each.
class EstimatingController final : public ControllerAround {
 public:
  /// @throws InputError naming the field.
  EstimatingController(std::unique_ptr<Controller> inside, EstimatorParams params, PlantInfo plant);
  void reset(const Measurement& start) override;
  void step(const Measurement& now, const SetpointSource& setpoint,
            ControllerOutput& output) override;
  void lookOn(const Measurement& now) override;
  bool needsModel() const override { return true; }
  void setModel(const TsModel& model) override;
  const std::vector<std::pair<std::string, double>>& signals() const override { return signals_; }

 private:
  void look(const Measurement& now);
  void estimate(const Measurement& now);
  void refreshSignals();

  EstimatorParams params_;
  PlantInfo plant_;
  std::optional<OutputEstimator> estimator_;
  Measurement seen_;     // the last measurement, with estimates
  Vector disturbances_;  // d(k-1)
  bool fresh_{true};     // a new filter has seen nothing yet
  std::vector<std::pair<std::string, double>> signals_;
};

}  // namespace fpc
