// The plant and the controller by themselves: no loop file, no tool, only headers that fmbpc
// installs. Ends with the number of things that are not so.
#include <fmbpc/base/signals.hpp>
#include <fmbpc/control/registry.hpp>
#include <fmbpc/plant/plant.hpp>

#include <cmath>
#include <cstdio>

namespace {

using fpc::Vector;

constexpr double kSampleTime = 20.0;  // [s]
constexpr double kMove = 2.0;         // [l/s] per sample

int failures = 0;

void expect(bool holds, const char* what) {
  if (holds) return;
  std::printf("not so: %s\n", what);
  ++failures;
}

Vector nominal(const std::vector<fpc::Quantity>& quantities) {
  Vector values(fpc::countOf(quantities));
  for (Eigen::Index i = 0; i < values.size(); ++i)
    values[i] = quantities[static_cast<std::size_t>(i)].nominal;
  return values;
}

std::vector<fpc::SignalInfo> signalsOf(const std::vector<fpc::Quantity>& quantities) {
  std::vector<fpc::SignalInfo> signals;
  for (const auto& q : quantities) signals.push_back({q.name, q.unit, q.lower, q.upper});
  return signals;
}

/// What a loop file would tell the controller.
fpc::ControllerContext contextOf(const fpc::PlantDescription& plant) {
  fpc::ControllerContext loop;
  loop.plant.name = plant.name;
  loop.plant.sample_time_s = kSampleTime;
  loop.plant.outputs = signalsOf(plant.states);
  loop.plant.inputs = signalsOf(plant.inputs);
  loop.plant.disturbances = signalsOf(plant.disturbances);
  loop.limits = {Vector::Zero(1), Vector::Constant(1, 20.0), Vector::Constant(1, kMove)};
  loop.initial_input = nominal(plant.inputs);
  loop.fallback_input = loop.initial_input;
  loop.disturbance_nominal = nominal(plant.disturbances);
  loop.noise_std = Vector::Zero(2);
  return loop;
}

void restsAtItsNominalValues(const fpc::Plant& plant) {
  const fpc::PlantDescription& p = plant.description();
  Vector rate(fpc::countOf(p.states));
  plant.derivatives(nominal(p.states), nominal(p.inputs), nominal(p.disturbances), rate);
  expect(rate.norm() < 1e-12, "the plant rests at its nominal values");
}

/// Explicit Euler steps of a second: the tanks' time constants are 200 s.
void movePlant(const fpc::Plant& plant, const Vector& u, const Vector& d, Vector& x) {
  Vector rate(x.size());
  for (int second = 0; second < static_cast<int>(kSampleTime); ++second) {
    plant.derivatives(x, u, d, rate);
    x += rate;
  }
}

void bringsTheLevelToItsSetpoint(const fpc::Plant& plant) {
  const fpc::ControllerContext loop = contextOf(plant.description());
  auto section = fpc::YamlSection::parse("{type: outflow, output: h2, kp: 4}", "test");
  const auto config = fpc::readController(section, loop);
  const auto controller = config->make(loop);
  fpc::SetpointParams asked;
  asked.initial = Vector::Constant(2, 1.2);
  const fpc::SampleClock clock(kSampleTime, 1.0);
  fpc::SetpointSource setpoint(asked, loop.outputs(), clock);

  Vector x = nominal(plant.description().states);
  fpc::Measurement now;
  now.disturbances = loop.disturbance_nominal;
  now.input_applied = loop.initial_input;
  fpc::ControllerOutput output;
  bool inside = true;
  for (std::uint32_t k = 0; k < 540; ++k) {  // three hours
    now.header = clock.header(1, k);
    now.outputs = x;
    if (k == 0) controller->reset(now);
    setpoint.advance(k);
    output.begin();
    controller->step(now, setpoint, output);
    const double u = output.input[0];
    inside = inside && u >= 0.0 && u <= 20.0 && std::abs(u - now.input_applied[0]) <= kMove + 1e-12;
    now.input_applied = output.input;
    movePlant(plant, output.input, now.disturbances, x);
  }
  expect(inside, "bounds and move limit hold at every sample");
  expect(std::abs(x[1] - 1.2) < 1e-3, "the level comes to its setpoint");
}

void refusesAMisspeltKey(const fpc::Plant& plant) {
  std::string words;
  try {
    auto section = fpc::YamlSection::parse("{type: outflow, output: h2, gain: 4}", "test");
    fpc::readController(section, contextOf(plant.description()));
  } catch (const fpc::InputError& error) {
    words = error.what();
  }
  expect(words.find("gain") != std::string::npos, "a misspelt key is an error that names it");
}

}  // namespace

int main() {
  const auto plant = fpc::makePlant("two_tanks");
  restsAtItsNominalValues(*plant);
  bringsTheLevelToItsSetpoint(*plant);
  refusesAMisspeltKey(*plant);
  return failures;
}
