// A tank with an outlet at its floor, filled by a pump and by an inflow that nobody steers. Put your
// own equations in their place.
//
//   area dh/dt = q + f - outlet sqrt(h)            level h [m], flows [m3/h], area [m2], time in hours
#include <fmbpc/plant/plant.hpp>

#include <algorithm>
#include <cmath>

namespace {

using fpc::Vector;
using fpc::VectorRef;

fpc::PlantDescription describe() {
  fpc::PlantDescription p;
  p.name = "@name@";
  p.title = "A tank with an outlet at its floor";
  p.time_unit_s = 3600.0;  // derivatives are per hour
  // name, unit, nominal, lower, upper: the nominal values are a steady state
  p.states = {{"h", "m", 1.0, 0.0, 4.0}};
  p.inputs = {{"q", "m3/h", 8.0, 0.0, 20.0}};
  p.disturbances = {{"f", "m3/h", 2.0, 0.0, 10.0}};
  p.algebraic = {{"q_out", "m3/h", 10.0, 0.0, 30.0}};  // can be measured, is no state
  p.outputs = {"h"};                                   // measured unless a loop file says otherwise
  p.parameters = {{"area", "m2", 5.0, 0.1, 1000.0}, {"outlet", "m3/(h m^0.5)", 10.0, 0.1, 1000.0}};
  p.frames = {{"plant", "map", 0.0, 0.0, 0.0}};
  return p;
}

class @Name@ final : public fpc::Plant {
 public:
  explicit @Name@(const fpc::PlantParameters& parameters)
      : description_(describe()), values_(fpc::parameterValues(description_, parameters)) {}
  const fpc::PlantDescription& description() const override { return description_; }

  /// Finite for everything inside the ranges.
  void derivatives(VectorRef x, VectorRef u, VectorRef d, Eigen::Ref<Vector> dxdt) const override {
    dxdt[0] = (u[0] + d[0] - outflow(x[0])) / values_[0];
  }
  void algebraic(VectorRef x, VectorRef, VectorRef, Eigen::Ref<Vector> y) const override {
    y[0] = outflow(x[0]);
  }

 private:
  double outflow(double level) const { return values_[1] * std::sqrt(std::max(level, 0.0)); }

  fpc::PlantDescription description_;
  Vector values_;  // in the order of description().parameters
};

const bool kRegistered = fpc::registerPlant("@name@", [](const fpc::PlantParameters& parameters) {
  return std::make_unique<@Name@>(parameters);
});

}  // namespace
