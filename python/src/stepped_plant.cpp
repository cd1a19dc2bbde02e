#include "stepped_plant.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"
#include "runtime/factory.hpp"
#include "watch.hpp"

namespace fpc::python {
namespace {

Vector nominal(const std::vector<Quantity>& quantities) {
  Vector values(countOf(quantities));
  for (Eigen::Index i = 0; i < values.size(); ++i)
    values[i] = quantities[static_cast<std::size_t>(i)].nominal;
  return values;
}

void requireInside(const std::vector<Quantity>& quantities, const Vector& values,
                   const char* what) {
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    const Quantity& q = quantities[i];
    const double value = values[static_cast<Eigen::Index>(i)];
    if (value < q.lower || value > q.upper)
      throw InputError(std::string(what) + "[" + q.name + "]: expected " + exactText(q.lower) +
                       ".." + exactText(q.upper) + " " + q.unit + ", got " + exactText(value));
  }
}

}  // namespace

SteppedPlant::SteppedPlant(const std::string& name, const PlantParameters& parameters,
                           double sample_time_s)
    : plant_(makePlant(name, parameters)),
      states_(namesOf(description().states)),
      inputs_(namesOf(description().inputs)),
      disturbances_(namesOf(description().disturbances)),
      sample_time_s_(sample_time_s),
      integrator_(*plant_, {}) {
  require(sample_time_s > 0.0 && sample_time_s < 1e9, "sample_time_s", "a time > 0");
  begin();
}

void SteppedPlant::begin() {
  samples_ = 0;
  x_ = nominal(description().states);
  u_ = nominal(description().inputs);
  d_ = nominal(description().disturbances);
  before_ = x_;
  stepper_ = plant_->makeStepper(sample_time_s_);
  if (stepper_) stepper_->reset(u_, d_);
}

Array SteppedPlant::reset(py::handle state) {
  Vector x = nominal(description().states);
  readSignals(state, states_, "state", x);
  requireInside(description().states, x, "state");
  begin();
  x_ = before_ = x;
  return outputs();
}

std::string SteppedPlant::move(Eigen::Ref<Vector> x, VectorRef u, VectorRef d) {
  Vector passed = u;
  plant_->localLoop(x, before_, passed);
  if (!stepper_) return integrator_.advance(x, passed, d, sample_time_s_).reason;
  stepper_->advance(x, passed, d);
  return x.allFinite() ? stepper_->failure() : "the state is not finite";
}

Array SteppedPlant::step(py::handle input, py::handle disturbance) {
  Vector u = u_, d = d_, x = x_;
  readSignals(input, inputs_, "u", u);
  readSignals(disturbance, disturbances_, "d", d);
  requireInside(description().inputs, u, "u");
  requireInside(description().disturbances, d, "d");
  Watch watch{py::none()};
  std::string failure;
  watch.during([&] { failure = move(x, u, d); });
  if (!failure.empty())
    throw std::runtime_error(description().name + ": could not be moved: " + failure);
  before_ = std::exchange(x_, x);
  u_ = u;
  d_ = d;
  ++samples_;
  return outputs();
}

Array SteppedPlant::derivatives(py::handle state, py::handle input, py::handle disturbance) const {
  Vector x = x_, u = u_, d = d_, dxdt(x_.size());
  readSignals(state, states_, "x", x);
  readSignals(input, inputs_, "u", u);
  readSignals(disturbance, disturbances_, "d", d);
  Watch watch{py::none()};
  watch.during([&] { plant_->derivatives(x, u, d, dxdt); });
  return toArray(dxdt);
}

Array SteppedPlant::outputs() const {
  const PlantDescription& about = description();
  const Names known = namesOf(measurable(about));
  Vector all(countOf(known)), y(countOf(about.outputs));
  all.head(x_.size()) = x_;
  plant_->algebraic(x_, u_, d_, all.tail(all.size() - x_.size()));
  for (Eigen::Index i = 0; i < y.size(); ++i)
    y[i] = all[std::find(known.begin(), known.end(), about.outputs[static_cast<std::size_t>(i)]) -
               known.begin()];
  return toArray(y);
}

LoopPlant::LoopPlant(std::shared_ptr<const LoopFile> loop)
    : LoopPlant(loop, std::make_unique<SimulatedProcess>(makeSimulation(*loop))) {}

LoopPlant::LoopPlant(std::shared_ptr<const LoopFile> loop, std::unique_ptr<SimulatedProcess> made)
    : loop_(std::move(loop)),
      inputs_(namesOf(loop_->plant_info.inputs)),
      simulation_(&made->simulation()),
      session_(std::move(made), lockstepPolicy(*loop_)),
      setpoint_(loop_->setpoint, loop_->plant_info, simulation_->clock()) {
  session_.begin(run_id_);
  session_.start(0.0);
  setpoint_.advance(0);
}

Array LoopPlant::reset() {
  session_.begin(++run_id_);
  session_.start(0.0);
  setpoint_.restart();
  setpoint_.advance(0);
  return toArray(now().outputs);
}

Array LoopPlant::step(py::handle input) {
  require(!now().final, "step", "reset() after the final sample of " + loop_->name);
  require(!input.is_none(), "u", "an input");
  ControlAction action;
  action.header = now().header;
  action.input = now().input_applied;
  readSignals(input, inputs_, "u", action.input);
  action.source = ActionSource::kBase;
  Watch watch{py::none()};
  watch.during([&] {
    session_.receive(action);
    session_.advance(0.0);
    setpoint_.advance(now().header.step);
  });
  return toArray(now().outputs);
}

void LoopPlant::disturb(const py::dict& values) {
  Command command;
  for (const auto& item : values) {
    command.name.push_back(py::str(item.first).cast<std::string>());
    Vector value = Vector::Zero(1);
    readSignals(item.second, {command.name.back()}, "disturb", value);
    command.value.push_back(value[0]);
  }
  simulation_->command(command);
}

}  // namespace fpc::python
