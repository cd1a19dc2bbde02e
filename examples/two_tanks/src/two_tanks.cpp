// Two tanks in series, each with an outlet at its floor; a pump and an unsteered feed fill the
// first.
//
//   1000 A1 dh1/dt = q + f - c1 sqrt(h1)
//   1000 A2 dh2/dt = c1 sqrt(h1) - c2 sqrt(h2)            flows in l/s, levels in m, areas in m2
#include <fmbpc/plant/plant.hpp>

#include <algorithm>
#include <cmath>

namespace {

using fpc::Vector;
using fpc::VectorRef;

constexpr double kLitres = 1000.0;  // in a cubic metre

fpc::PlantDescription describe() {
  fpc::PlantDescription p;
  p.name = "two_tanks";
  p.title = "Two tanks in series, filled by a pump and a feed";
  p.time_unit_s = 1.0;
  p.states = {{"h1", "m", 1.0, 0.0, 4.0}, {"h2", "m", 1.0, 0.0, 4.0}};
  p.inputs = {{"q", "l/s", 8.0, 0.0, 20.0}};
  p.disturbances = {{"f", "l/s", 2.0, 0.0, 10.0}};
  p.outputs = {"h1", "h2"};
  p.parameters = {{"area_1", "m2", 1.0, 0.01, 100.0},
                  {"area_2", "m2", 1.0, 0.01, 100.0},
                  {"outlet_1", "l/(s m^0.5)", 10.0, 0.1, 1000.0},
                  {"outlet_2", "l/(s m^0.5)", 10.0, 0.1, 1000.0}};
  p.frames = {{"plant", "map", 0.0, 0.0, 0.0}};
  return p;
}

class TwoTanks final : public fpc::Plant {
 public:
  explicit TwoTanks(const fpc::PlantParameters& parameters)
      : description_(describe()), values_(fpc::parameterValues(description_, parameters)) {}
  const fpc::PlantDescription& description() const override { return description_; }
  void derivatives(VectorRef x, VectorRef u, VectorRef d, Eigen::Ref<Vector> dxdt) const override {
    const double first = values_[2] * std::sqrt(std::max(x[0], 0.0));
    const double second = values_[3] * std::sqrt(std::max(x[1], 0.0));
    dxdt[0] = (u[0] + d[0] - first) / (kLitres * values_[0]);
    dxdt[1] = (first - second) / (kLitres * values_[1]);
  }

 private:
  fpc::PlantDescription description_;
  Vector values_;
};

const bool kRegistered = fpc::registerPlant(
    "two_tanks",
    [](const fpc::PlantParameters& parameters) { return std::make_unique<TwoTanks>(parameters); });

}  // namespace
