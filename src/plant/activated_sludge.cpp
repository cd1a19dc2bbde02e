// Activated-sludge process: an aerated, perfectly mixed reactor (Monod growth, Maynard-Smith decay)
// and a settler of three layers, from whose bottom sludge is recirculated (q_r, the input) and
// purged (q_p).
//
//   dx/dt = mu Y g - K_d x^2/s - K_c x + (x_i q_i + x_r q_r - q x)/V                     g = s
//   x/(K_s + s) ds/dt = -mu g + f_kd (K_d x^2/s + K_c x) + (s_i q_i + s q_r - q s)/V dc/dt = K_la
//   f_k (c_s - c) - K_01 mu g - q c/V A l_d dx_d/dt = q_out (x_b - x_d) - A v(x_d) v(z) = n z exp(a
//   z) A l_b dx_b/dt = q x - q_out x_b - q_2 x_b + A v(x_d) - A v(x_b) A l_r dx_r/dt = q_2 (x_b -
//   x_r) + A v(x_b) q = q_i + q_r,  q_out = q_i - q_p,  q_2 = q_r + q_p
//
// Source: vallejo2021thesis, article 1, appendix D, eqs. D.1-D.3 and table 12.
// Not as printed: the oxygen equation has the growth term g (printed: x^2/(K_s + s)); q_p and f_k
// are not printed and were chosen so that the nominal point is x = 2000, c = 2 mg/l; nothing reacts
// in the settler, so s_r = s; v is a flux [g/(m2 h)]. No purge can exceed the inflow (q_out >= 0),
// and the decay term divides by at least kSubstrateFloor.
#include <algorithm>
#include <cmath>

#include "fmbpc/plant/plant.hpp"

namespace fpc {
namespace {

/// x^2/s means nothing without substrate; the model itself keeps s above some mg/l, so only trial
/// points of an integrator or an absurd initial state ever come below this [mg/l].
constexpr double kSubstrateFloor = 1e-3;

PlantDescription describeActivatedSludge() {
  PlantDescription p;
  p.name = "activated_sludge";
  p.title = "Activated-sludge wastewater plant, 6 states (vallejo2019, app. D)";
  p.time_unit_s = 3600.0;
  p.states = {{"s", "mg/l", 55.009, 0.0, 5000.0},     {"x", "mg/l", 2000.0, 0.0, 10000.0},
              {"c", "mg/l", 2.0, 0.0, 20.0},          {"x_d", "mg/l", 79.996, 0.0, 10000.0},
              {"x_b", "mg/l", 599.984, 0.0, 10000.0}, {"x_r", "mg/l", 6000.0, 0.0, 50000.0}};
  p.inputs = {{"q_r", "m3/h", 570.0, 0.0, 3000.0}};
  p.disturbances = {{"q_i", "m3/h", 1300.0, 0.0, 10000.0}, {"s_i", "mg/l", 366.67, 0.0, 5000.0}};
  p.outputs = {"s", "x"};
  p.parameters = {
      {"reactor_volume", "m3", 7268.0, 1.0, 1e6},             // V
      {"settler_area", "m2", 2770.9, 1.0, 1e6},               // A
      {"settler_height_top", "m", 2.0, 0.01, 100.0},          // l_d
      {"settler_height_middle", "m", 1.5, 0.01, 100.0},       // l_b
      {"settler_height_bottom", "m", 1.0, 0.01, 100.0},       // l_r
      {"purge_flow", "m3/h", 36.48730242, 0.0, 10000.0},      // q_p
      {"influent_biomass", "mg/l", 80.0, 0.0, 10000.0},       // x_i
      {"growth_rate_max", "1/h", 0.1824, 0.0, 10.0},          // mu_max
      {"yield", "-", 0.5948, 0.0, 1.0},                       // Y, printed y
      {"saturation_constant", "mg/l", 300.0, 1e-3, 1e5},      // K_s
      {"decay_endogenous", "1/h", 5e-5, 0.0, 1.0},            // K_d
      {"decay_cellular", "1/h", 1.3333e-4, 0.0, 1.0},         // K_c
      {"dead_to_substrate", "-", 0.2, 0.0, 1.0},              // f_kd
      {"settling_rate", "m/h", 3.1563, 0.0, 100.0},           // n, printed nnr
      {"settling_exponent", "l/mg", -0.00078567, -0.1, 0.0},  // a, printed aar
      {"oxygen_per_growth", "-", 1e-4, 0.0, 10.0},            // K_01
      {"oxygen_transfer", "1/h", 0.7, 0.0, 100.0},            // K_la
      {"aeration_factor", "-", 0.12387, 0.0, 1.0},            // f_k
      {"oxygen_saturation", "mg/l", 8.0, 0.0, 20.0},          // c_s
  };
  p.frames = {{"plant", "map", 0.0, 0.0, 0.0},
              {"reactor", "plant", 30.0, 0.0, 0.0},
              {"settler", "plant", 110.0, 0.0, 0.0},
              {"settler_top", "settler", 0.0, 0.0, 3.5},
              {"settler_middle", "settler", 0.0, 0.0, 1.75},
              {"settler_bottom", "settler", 0.0, 0.0, 0.5},
              {"recirculation_pump", "plant", 70.0, -15.0, -1.0},
              {"purge_pump", "plant", 112.0, -15.0, -1.0},
              {"substrate_analyzer", "reactor", 20.0, 5.0, 1.5},
              {"biomass_analyzer", "reactor", 20.0, 6.0, 1.5},
              {"oxygen_probe", "reactor", 10.0, 0.0, -1.0},
              {"sludge_analyzer", "recirculation_pump", 2.0, 0.0, 1.5}};
  p.output_frames = {{"s", "substrate_analyzer"}, {"x", "biomass_analyzer"},
                     {"c", "oxygen_probe"},       {"x_d", "settler_top"},
                     {"x_b", "settler_middle"},   {"x_r", "sludge_analyzer"}};
  return p;
}

class ActivatedSludge final : public Plant {
 public:
  explicit ActivatedSludge(const PlantParameters& parameters);
  const PlantDescription& description() const override { return description_; }
  void derivatives(VectorRef state, VectorRef u, VectorRef d,
                   Eigen::Ref<Vector> dxdt) const override;

 private:
  double settlingFlux(double z) const { return n_ * z * std::exp(a_ * z); }  // [g/(m2 h)]

  PlantDescription description_;
  double V_, A_, l_d_, l_b_, l_r_, q_p_, x_i_, mu_, Y_, K_s_, K_d_, K_c_, f_kd_, n_, a_;
  double K_01_, K_la_, f_k_, c_s_;
};

ActivatedSludge::ActivatedSludge(const PlantParameters& parameters)
    : description_(describeActivatedSludge()) {
  const Vector p = parameterValues(description_, parameters);
  Eigen::Index i = 0;
  for (double* value : {&V_, &A_, &l_d_, &l_b_, &l_r_, &q_p_, &x_i_, &mu_, &Y_, &K_s_, &K_d_, &K_c_,
                        &f_kd_, &n_, &a_, &K_01_, &K_la_, &f_k_, &c_s_})
    *value = p[i++];
}

void ActivatedSludge::derivatives(VectorRef state, VectorRef u, VectorRef d,
                                  Eigen::Ref<Vector> dxdt) const {
  const double s = state[0], x = state[1], c = state[2];
  const double x_d = state[3], x_b = state[4], x_r = state[5];
  const double q_r = u[0], q_i = d[0], s_i = d[1];
  const double purge = std::min(q_p_, q_i);
  const double q = q_i + q_r, q_out = q_i - purge, q_2 = q_r + purge;
  const double uptake = mu_ * s * x / (K_s_ + s);
  const double decay = K_d_ * x * x / std::max(s, kSubstrateFloor);
  dxdt[0] = -uptake + f_kd_ * (decay + K_c_ * x) + q_i * (s_i - s) / V_;
  dxdt[1] = Y_ * uptake - decay - K_c_ * x + (x_i_ * q_i + x_r * q_r - q * x) / V_;
  dxdt[2] = K_la_ * f_k_ * (c_s_ - c) - K_01_ * uptake - q * c / V_;
  const double flux_d = settlingFlux(x_d), flux_b = settlingFlux(x_b);
  dxdt[3] = (q_out * (x_b - x_d) / A_ - flux_d) / l_d_;
  dxdt[4] = ((q * x - (q_out + q_2) * x_b) / A_ + flux_d - flux_b) / l_b_;
  dxdt[5] = (q_2 * (x_b - x_r) / A_ + flux_b) / l_r_;
}

const bool kActivatedSludgeRegistered =
    registerPlant("activated_sludge", [](const PlantParameters& parameters) {
      return std::make_unique<ActivatedSludge>(parameters);
    });

}  // namespace
}  // namespace fpc
