// Exothermic reaction in a cooled stirred tank, dimensionless. Between a cold and a hot steady
// state it rests at states that it leaves by itself.
//
//   dc/dt = (1 - c) / theta - k c exp(-M / T)
//   dT/dt = (Tf - T) / theta + k c exp(-M / T) - alpha u (T - Tc) + w
//
// Source: hicks1971 in the form of kameswaran2006; the nominal point is the unstable state of
// rawlings2017, example 3.22, and w the disturbance there. Times are taken as minutes.
#include "arena_plant.hpp"

#include <algorithm>
#include <cmath>

namespace {

using fpc::Vector;
using fpc::VectorRef;

// At T = 0.6519 the balance of c gives c, that of T gives u.
constexpr double kRestT = 0.6519;

double reactionRate(double k, double M, double T) { return k * std::exp(-M / std::max(T, 1e-3)); }

fpc::PlantDescription describe() {
  const double rate = reactionRate(300.0, 5.0, kRestT);
  const double c = 0.05 / (0.05 + rate);
  const double u = (0.05 * (0.3947 - kRestT) + rate * c) / (0.117 * (kRestT - 0.3816));
  fpc::PlantDescription p;
  p.name = "hicks_ray";
  p.title = "Exothermic reactor at an unstable state (hicks1971)";
  p.time_unit_s = 60.0;
  p.states = {{"c", "-", c, 0.0, 2.0}, {"T", "-", kRestT, 0.01, 2.0}};
  p.inputs = {{"u", "-", u, 0.0, 2.0}};
  p.disturbances = {{"w", "1/min", 0.0, -0.01, 0.01}};
  p.hidden_disturbances = {"w"};
  p.outputs = {"T"};
  p.parameters = {{"theta", "min", 20.0, 0.1, 1e3},
                  {"rate", "1/min", 300.0, 0.0, 1e6},
                  {"activation", "-", 5.0, 0.1, 1e2},
                  {"feed_temperature", "-", 0.3947, 0.0, 2.0},
                  {"coolant_temperature", "-", 0.3816, 0.0, 2.0},
                  {"cooling", "1/min", 0.117, 0.0, 10.0}};
  return p;
}

class HicksRay final : public arena::ArenaPlant {
 public:
  explicit HicksRay(const fpc::PlantParameters& given) : ArenaPlant(describe(), given) {}
  void derivatives(VectorRef x, VectorRef u, VectorRef d, Eigen::Ref<Vector> dxdt) const override {
    const double reaction = reactionRate(p_[1], p_[2], x[1]) * x[0];
    dxdt[0] = (1.0 - x[0]) / p_[0] - reaction;
    dxdt[1] = (p_[3] - x[1]) / p_[0] + reaction - p_[5] * u[0] * (x[1] - p_[4]) + d[0];
  }
};

const bool kRegistered = arena::registered<HicksRay>("hicks_ray");

}  // namespace
