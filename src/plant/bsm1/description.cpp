#include "plant/bsm1/description.hpp"

#include <string>

namespace fpc::bsm1 {
namespace {

using Quantities = std::vector<Quantity>;

std::string numbered(const std::string& stem, int number) { return stem + std::to_string(number); }

const char* unitOf(Component c) { return c == kSALK ? "mol/m3" : "g/m3"; }

Quantities tankStates(const WorksState& rest) {
  Quantities states;
  for (int t = 0; t < kTanks; ++t)
    for (int c = 0; c < kComponents; ++c)
      states.push_back({numbered(kComponentNames[c], t + 1), unitOf(static_cast<Component>(c)),
                        rest.z[c][t], 0.0, 20000.0});
  for (int i = 0; i < kLayers; ++i)
    states.push_back({numbered("TSS_L", i + 1), "g/m3", rest.settler.solids[i], 0.0, 50000.0});
  for (std::size_t s = 0; s < kSolubles.size(); ++s)
    for (int i = 0; i < kLayers; ++i)
      states.push_back({numbered(kComponentNames[kSolubles[s]] + std::string("_L"), i + 1),
                        unitOf(kSolubles[s]), rest.settler.solubles[s][i], 0.0, 20000.0});
  return states;
}

constexpr double kWide = 1e9;

void addLoopStates(const WorksState& rest, Quantities& states) {
  int next = 0;
  const auto add = [&](const std::string& name, const char* unit, double lower, double upper) {
    states.push_back({name, unit, rest.loops[next++], lower, upper});
  };
  for (int t = kFirstAerated + 1; t <= kTanks; ++t) {
    const std::string S_O = numbered("DO", t), KLa = numbered("KLa", t);
    add(S_O + "_sensor", "g/m3", 0.0, 20000.0);
    add(S_O + "_shown", "g/m3", 0.0, 20000.0);
    add(KLa + "_drive", "1/d", 0.0, 360.0);
    add(KLa, "1/d", 0.0, 360.0);
    add(S_O + "_integral", "1/d", -kWide, kWide);
  }
  for (int i = 1; i < kNitrateLags; ++i) add(numbered("NO2_sensor", i), "g/m3", 0.0, 20000.0);
  add("NO2_shown", "g/m3", 0.0, 20000.0);
  add("Qintr", "m3/d", 0.0, 92230.0);
  add("NO2_integral", "m3/d", -kWide, kWide);
  for (int i = 1; i < kNitrateLags; ++i) add(numbered("NO5_sensor", i), "g/m3", 0.0, 20000.0);
  add("NO5_shown", "g/m3", 0.0, 20000.0);
}

Quantities inputsOf(Front front) {
  Quantities inputs;
  if (front == Front::kValves)
    inputs = {{"KLa3", "1/d", 240.0, 0.0, 360.0},
              {"KLa4", "1/d", 240.0, 0.0, 360.0},
              {"KLa5", "1/d", 84.0, 0.0, 360.0},
              {"Qintr", "m3/d", 55338.0, 0.0, 92230.0}};
  if (front == Front::kSetpoints)
    inputs = {{"DO3", "g/m3", 8.0, 0.0, 10.0},  // beyond reach: the blower stands at its bound
              {"DO4", "g/m3", 8.0, 0.0, 10.0},
              {"DO5", "g/m3", 2.0, 0.0, 10.0},
              {"NO2", "g/m3", 1.0, 0.0, 20.0}};
  if (front == Front::kAir)
    inputs = {{"air", "-", 1.0, -2.0, 4.0}, {"NO2", "g/m3", 2.0, 0.0, 20.0}};
  inputs.push_back({"Qr", "m3/d", 18446.0, 0.0, 36892.0});
  inputs.push_back({"Qw", "m3/d", 385.0, 0.0, 1844.6});
  for (int t = 1; t <= kTanks; ++t) inputs.push_back({numbered("dose", t), "m3/d", 0.0, 0.0, 5.0});
  return inputs;
}

Quantities disturbances() {
  const Components constant{30.0, 69.5, 51.2,  202.32, 28.17, 0.0, 0.0,
                            0.0,  0.0,  31.56, 6.95,   10.59, 7.0};
  Quantities all;
  for (int c = 0; c < kComponents; ++c)
    all.push_back({std::string(kComponentNames[c]) + "_in", unitOf(static_cast<Component>(c)),
                   constant[c], 0.0, 20000.0});
  all.push_back({"Q_in", "m3/d", 18446.0, 1000.0, 200000.0});
  all.push_back({"blower", "-", 1.0, 0.0, 1.0});  // share of the blowers' bounds at hand
  return all;
}

void addFrames(PlantDescription& p) {
  p.frames = {{"plant", "map", 0.0, 0.0, 0.0}};
  for (int t = 1; t <= kTanks; ++t)
    p.frames.push_back({numbered("tank_", t), "plant", 20.0 * t, 0.0, 0.0});
  p.frames.push_back({"settler", "plant", 140.0, 0.0, 0.0});
  for (int i = 1; i <= kLayers; ++i)
    p.frames.push_back({numbered("layer_", i), "settler", 0.0, 0.0, 4.0 - 0.4 * (i - 0.5)});
  for (const auto& [name, tank, analyser] : {std::tuple{"S_NO2", 2, "nitrate_analyser"},
                                             {"S_O5", 5, "oxygen_probe"},
                                             {"S_NH5", 5, "ammonium_analyser"},
                                             {"S_NO5", 5, "outlet_nitrate_analyser"}}) {
    p.frames.push_back({analyser, numbered("tank_", tank), 2.0, 3.0, 1.0});
    p.output_frames[name] = analyser;
  }
}

/// The parameters in one order: their descriptions and, with `values`, where they go.
class Listing {
 public:
  explicit Listing(Parameters& p) : p_(p) {}
  void works();
  void loops();
  void air();
  const Quantities& quantities() const { return quantities_; }
  const std::vector<double*>& places() const { return places_; }

 private:
  void add(const std::string& name, const char* unit, double& place, double lower, double upper) {
    quantities_.push_back({name, unit, place, lower, upper});
    places_.push_back(&place);
  }
  Parameters& p_;
  Quantities quantities_;
  std::vector<double*> places_;
};

void Listing::works() {
  Asm1& a = p_.works.asm1;
  for (const auto& [name, unit, place] : {std::tuple{"mu_H", "1/d", &a.mu_H},
                                          {"b_H", "1/d", &a.b_H},
                                          {"mu_A", "1/d", &a.mu_A},
                                          {"b_A", "1/d", &a.b_A},
                                          {"k_a", "m3/(g d)", &a.k_a},
                                          {"k_h", "1/d", &a.k_h},
                                          {"K_X", "-", &a.K_X},
                                          {"eta_g", "-", &a.eta_g},
                                          {"eta_h", "-", &a.eta_h},
                                          {"f_P", "-", &a.f_P},
                                          {"i_XB", "-", &a.i_XB},
                                          {"i_XP", "-", &a.i_XP}})
    add(name, unit, *place, 0.0, 100.0);
  for (const auto& [name, place] : {std::pair{"K_S", &a.K_S},
                                    {"K_OH", &a.K_OH},
                                    {"K_NO", &a.K_NO},
                                    {"K_NH", &a.K_NH},
                                    {"K_OA", &a.K_OA}})
    add(name, "g/m3", *place, 1e-6, 1000.0);
  add("Y_H", "-", a.Y_H, 0.01, 0.99);
  add("Y_A", "-", a.Y_A, 0.01, 4.0);
  add("oxygen_saturation", "g/m3", p_.works.oxygen_saturation, 0.1, 100.0);
  SettlerParams& s = p_.works.settler;
  add("settler_area", "m2", s.area, 1.0, 1e6);
  add("layer_height", "m", s.layer_height, 0.01, 10.0);
  add("settling_max", "m/d", s.v_max, 0.0, 1e4);
  add("settling_0", "m/d", s.v_0, 0.0, 1e4);
  add("settling_hindered", "m3/g", s.r_hindered, 0.0, 1.0);
  add("settling_low", "m3/g", s.r_low, 0.0, 1.0);
  add("not_settling", "-", s.not_settling, 0.0, 1.0);
}

void Listing::loops() {
  LocalLoopParams& l = p_.loops;
  for (int i = 0; i < kAerated; ++i)
    add(numbered("KLa", kFirstAerated + 1 + i) + "_upper", "1/d", l.oxygen[i].upper, 0.0, 360.0);
  add("Qintr_upper", "m3/d", l.nitrate.upper, 0.0, 92230.0);
  add("NO2_per_NO5", "-", l.outlet.slope, -10.0, 10.0);
  add("NO2_about_NO5", "g/m3", l.outlet.about, 0.0, 100.0);
  add("NO2_lower", "g/m3", l.outlet.lower, 0.0, 20.0);
  add("NO2_upper", "g/m3", l.outlet.upper, 0.0, 20.0);
  add("local_lags", "-", p_.lags, 0.0, 1.0);
  add("local_noise", "-", l.noise, 0.0, 1.0);
  add("local_noise_seed", "-", p_.noise_seed, 0.0, 1e9);
}

void Listing::air() {
  for (int i = 0; i < kAerated; ++i) {
    AirLine& line = p_.air[i];
    const std::string S_O = numbered("DO", kFirstAerated + 1 + i);
    add(S_O + "_at_air_0", "g/m3", line.offset, -100.0, 100.0);
    add(S_O + "_per_air", "g/m3", line.slope, -100.0, 100.0);
    add(S_O + "_lower", "g/m3", line.lower, 0.0, 10.0);
    add(S_O + "_upper", "g/m3", line.upper, 0.0, 10.0);
  }
  add("NO2_per_DO4", "-", p_.nitrate_lean.slope, -10.0, 10.0);
  add("NO2_about_DO4", "g/m3", p_.nitrate_lean.about, 0.0, 10.0);
}

Listing listing(Front front, Parameters& p) {
  Listing all(p);
  all.works();
  if (front != Front::kValves) all.loops();
  if (front == Front::kAir) all.air();
  return all;
}

/// The default control of the benchmark lets the last blower run higher than the others.
Parameters usual(Front front) {
  Parameters p;
  if (front == Front::kSetpoints) p.loops.oxygen[kAerated - 1].upper = 360.0;
  return p;
}

}  // namespace

PlantDescription describe(Front front) {
  static const char* const names[] = {"bsm1", "bsm1_pi", "bsm1_air"};
  static const char* const what[] = {"valves", "setpoints of local loops", "degree of aeration"};
  PlantDescription p;
  Parameters parameters = usual(front);
  p.name = names[static_cast<int>(front)];
  p.title = std::string("Benchmark simulation model no. 1, wastewater plant, inputs: ") +
            what[static_cast<int>(front)] + " (copp2002, alex2008)";
  p.time_unit_s = 86400.0;
  const WorksState rest = nominalState(front, parameters.loops);
  p.states = tankStates(rest);
  if (front != Front::kValves) addLoopStates(rest, p.states);
  p.inputs = inputsOf(front);
  p.disturbances = disturbances();
  p.hidden_disturbances = {"blower"};
  p.outputs = {"S_NO2", "S_O5", "S_NH5", "S_NO5"};
  p.parameters = listing(front, parameters).quantities();
  addFrames(p);
  return p;
}

Parameters readParameters(Front front, const PlantDescription& description,
                          const PlantParameters& given) {
  Parameters p = usual(front);
  const auto places = listing(front, p).places();
  const Vector values = parameterValues(description, given);
  for (std::size_t i = 0; i < places.size(); ++i) *places[i] = values[static_cast<Eigen::Index>(i)];
  p.loops.lags = p.lags >= 0.5;
  return p;
}

}  // namespace fpc::bsm1
