// A controller around another one: what it does not change itself is the inner law's.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "fmbpc/control/controller.hpp"

namespace fpc {

/// The action is what a law proposed, inside the limits of the inputs.
inline bool isLawsOwn(ActionSource source) {
  return source == ActionSource::kBase || source == ActionSource::kClipped;
}

/// Base of guards: reset() and step() are theirs, everything else is handed on.
class ControllerAround : public Controller {
 public:
  void forget() override { inside_->forget(); }
  void lookOn(const Measurement& now) override { inside_->lookOn(now); }
  bool foresee(const Measurement& now, Eigen::Ref<Vector> outputs) override {
    return inside_->foresee(now, outputs);
  }
  bool expect(std::uint32_t k, Eigen::Index disturbance, VectorRef ahead) override {
    return inside_->expect(k, disturbance, ahead);
  }
  bool needsModel() const override { return inside_->needsModel(); }
  bool followsSetpoint() const override { return inside_->followsSetpoint(); }
  void setModel(const TsModel& model) override { inside_->setModel(model); }
  bool mayBeSent(VectorRef input) const override { return inside_->mayBeSent(input); }
  void makeSendable(Eigen::Ref<Vector> input) const override { inside_->makeSendable(input); }
  bool adapt(bool on) override { return inside_->adapt(on); }
  Settings settings() const override { return inside_->settings(); }
  bool retune(const Settings& settings) override { return inside_->retune(settings); }
  const std::vector<std::pair<std::string, double>>& signals() const override {
    return inside_->signals();
  }
  const Controller& inside() const { return *inside_; }

 protected:
  /// @throws InputError naming `section` without a law.
  ControllerAround(std::unique_ptr<Controller> inside, const char* section);

  std::unique_ptr<Controller> inside_;
};

}  // namespace fpc
