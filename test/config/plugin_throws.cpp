// A plugin whose plant throws in the middle of a run: a loop with it must end alone.
#include <memory>
#include <stdexcept>

#include "fmbpc/plant/plant.hpp"

namespace {

using fpc::PlantParameters;
using fpc::VectorRef;

/// Stands still until its time has come.
class Thrower final : public fpc::PlantStepper {
 public:
  void reset(VectorRef, VectorRef) override { left_ = kGood; }
  void advance(Eigen::Ref<fpc::Vector>, VectorRef, VectorRef) override {
    if (left_-- == 0) throw std::runtime_error("thrown by the plugin");
  }

 private:
  static constexpr int kGood = 100;  // samples
  int left_{kGood};
};

class ThrowingPlant final : public fpc::Plant {
 public:
  ThrowingPlant() {
    description_.name = "throwing";
    description_.title = "Throws after 100 samples";
    description_.states = {{"x", "-", 0.0, -1.0, 1.0}};
    description_.inputs = {{"u", "-", 0.0, -1.0, 1.0}};
    description_.outputs = {"x"};
  }
  const fpc::PlantDescription& description() const override { return description_; }
  void derivatives(VectorRef, VectorRef, VectorRef, Eigen::Ref<fpc::Vector> dxdt) const override {
    dxdt.setZero();
  }
  std::unique_ptr<fpc::PlantStepper> makeStepper(double) const override {
    return std::make_unique<Thrower>();
  }

 private:
  fpc::PlantDescription description_;
};

const bool kThrowerRegistered = fpc::registerPlant(
    "throwing", [](const PlantParameters&) { return std::make_unique<ThrowingPlant>(); });

}  // namespace
