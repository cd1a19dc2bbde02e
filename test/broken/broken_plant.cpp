// A plant that breaks the contract of plants: test/counting_test.py runs the contract tests over it
// to see that they notice, and that the count does.
#include <limits>

#include "fmbpc/plant/plant.hpp"

namespace fpc {
namespace {

class BrokenPlant : public Plant {
 public:
  BrokenPlant() {
    about_.name = "broken";
    about_.title = "Its derivative is not a number";
    about_.states = {{"x", "m", 0.0, -1.0, 1.0}};
    about_.inputs = {{"u", "m", 0.0, -1.0, 1.0}};
    about_.outputs = {"x"};
    about_.frames = {{"plant", "", 0.0, 0.0, 0.0}};
    about_.output_frames = {{"x", "plant"}};
  }
  const PlantDescription& description() const override { return about_; }
  void derivatives(VectorRef, VectorRef, VectorRef, Eigen::Ref<Vector> dxdt) const override {
    dxdt.setConstant(std::numeric_limits<double>::quiet_NaN());
  }

 private:
  PlantDescription about_;
};

const bool kRegistered =
    registerPlant("broken", [](const PlantParameters&) { return std::make_unique<BrokenPlant>(); });

}  // namespace
}  // namespace fpc
