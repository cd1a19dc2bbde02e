#include "stepped_controller.hpp"

#include <cmath>
#include <utility>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"
#include "runtime/report.hpp"
#include "watch.hpp"

namespace fpc::python {

SteppedController::SteppedController(LoopPtr loop)
    : loop_(std::move(loop)),
      outputs_(namesOf(loop_->plant_info.outputs)),
      inputs_(namesOf(loop_->plant_info.inputs)),
      disturbances_(namesOf(loop_->plant_info.disturbances)),
      measured_(outputs_),
      clock_(loop_->simulation.sample_time_s, loop_->simulation.start_time_s),
      controller_(*loop_) {
  measured_.insert(measured_.end(), disturbances_.begin(), disturbances_.end());
  outputs_good_ = Vector::Zero(countOf(outputs_));
  begin();
}

void SteppedController::begin() {
  step_ = 0;
  applied_ = loop_->simulation.actuator.initial;
  disturbances_good_ = loop_->disturbance_nominal;
  setpoint_ = Vector::Constant(countOf(outputs_), kNaN);
  events_.clear();
}

Array SteppedController::step(py::handle outputs, py::handle setpoint, py::handle disturbance,
                              py::handle applied, py::handle quality) {
  require(!outputs.is_none(), "y", "a measurement");
  const std::vector<bool> bad = readBad(quality, measured_);
  const auto n_y = static_cast<std::ptrdiff_t>(outputs_.size());
  const auto outputs_end = bad.begin() + (bad.empty() ? 0 : n_y);
  const std::vector<bool> bad_outputs(bad.begin(), outputs_end),
      bad_disturbances(outputs_end, bad.end());
  Vector y = outputs_good_, d = disturbances_good_, u = applied_, r = setpoint_;
  readSignals(outputs, outputs_, "y", y, &bad_outputs);
  readSignals(disturbance, disturbances_, "disturbance", d, &bad_disturbances);
  readSignals(applied, inputs_, "applied", u);
  if (!setpoint.is_none()) {
    // Names that are left out of a dict stay with the schedule.
    const py::object named = byName(setpoint);
    Vector asked = r.array().isNaN().select(0.0, r);
    readSignals(setpoint, outputs_, "setpoint", asked);
    Command command;
    for (std::size_t i = 0; i < outputs_.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      const bool given = !named || py::reinterpret_borrow<py::dict>(named).contains(outputs_[i]);
      if (!given || asked[k] == r[k]) continue;
      command.name.push_back(outputs_[i]);
      command.value.push_back(r[k] = asked[k]);
    }
    if (!command.name.empty()) controller_.session().command(command);
  }
  outputs_good_ = y;
  disturbances_good_ = d;
  applied_ = u;
  setpoint_ = r;
  for (std::size_t i = 0; i < bad.size(); ++i)
    if (bad[i])
      (i < outputs_.size() ? y[static_cast<Eigen::Index>(i)]
                           : d[static_cast<Eigen::Index>(i - outputs_.size())]) = kNaN;
  now_.outputs = std::move(y);
  now_.disturbances = std::move(d);
  now_.input_applied = applied_;
  return answer();
}

Array SteppedController::answer() {
  now_.header = {clock_.timeAt(step_), run_id_, step_};
  controller_.turnTo(step_);
  Watch watch{py::none()};
  watch.during([&] {
    controller_.receive(now_);
    applied_ = controller_.optimize().input;
    controller_.learn(now_);
  });
  ++step_;
  events_ = controller_.answer().events;
  for (Event& event : controller_.takeEvents()) events_.push_back(std::move(event));
  return toArray(applied_);
}

Array SteppedController::reset(py::handle outputs, py::handle setpoint, py::handle disturbance,
                               py::handle applied, py::handle quality) {
  const auto before = std::tuple(step_, applied_, disturbances_good_, setpoint_, events_);
  begin();
  ++run_id_;
  try {
    return step(outputs, setpoint, disturbance, applied, quality);
  } catch (...) {
    if (step_ == 0) {
      std::tie(step_, applied_, disturbances_good_, setpoint_, events_) = before;
      --run_id_;
    }
    throw;
  }
}

void SteppedController::manual(py::handle input) {
  Vector asked = applied_;
  readSignals(input, inputs_, "manual", asked);
  const bool was = controller_.session().isManual();
  controller_.session().manual(true);
  try {
    controller_.session().manualInput(asked);
  } catch (...) {
    controller_.session().manual(was);
    throw;
  }
}

void SteppedController::automatic() { controller_.session().manual(false); }

void SteppedController::releaseSetpoint() {
  Command command;
  command.mode = CommandMode::kRelease;
  for (Eigen::Index i = 0; i < setpoint_.size(); ++i) {
    if (std::isnan(setpoint_[i])) continue;
    command.name.push_back(outputs_[static_cast<std::size_t>(i)]);
    command.value.push_back(0.0);
  }
  if (!command.name.empty()) controller_.session().command(command);
  setpoint_.setConstant(kNaN);
}

bool SteppedController::retune(const Settings& settings) {
  return controller_.session().retune(settings);
}

bool SteppedController::adapt(bool on) { return controller_.session().adapt(on); }

void SteppedController::setModel(const ModelHandle& model) {
  require(controller_.session().controller().needsModel(), "model",
          "a law with a model, which " + loop_->controllerType().name + " is not");
  controller_.session().setModel(matchToLoop(model.identified.model, *loop_));
}

Array SteppedController::setpoint() const {
  return toArray(controller_.answer().tracking.setpoint);
}

Array SteppedController::reference() const {
  return toArray(controller_.answer().tracking.reference);
}

std::string SteppedController::source() const {
  if (step_ == 0) return "none";
  return nameOf(controller_.sent().source);
}

py::object SteppedController::prediction() const {
  const ControllerAnswer& answer = controller_.answer();
  if (step_ == 0 || !answer.has_prediction) return py::none();
  const PredictiveAction& p = answer.prediction;
  py::dict found;
  const std::pair<const char*, const Matrix*> matrices[] = {
      {"A", &p.A}, {"B", &p.B}, {"C", &p.C}, {"K", &p.K}};
  const std::pair<const char*, const Vector*> vectors[] = {{"state", &p.state},
                                                           {"offset_state", &p.offset_state},
                                                           {"offset_output", &p.offset_output},
                                                           {"setpoint", &p.setpoint}};
  for (const auto& [name, value] : matrices) found[name] = toArray(*value);
  for (const auto& [name, value] : vectors) found[name] = toArray(*value);
  found["feedforward"] = toArray(Matrix(p.feedforward.transpose()));
  found["reference"] = toArray(Matrix(p.reference.transpose()));
  return found;
}

py::dict SteppedController::signals() const {
  py::dict found;
  for (const auto& [name, value] : controller_.session().controller().signals())
    found[py::str(name)] = value;
  return found;
}

py::dict SteppedController::settings() const {
  py::dict found;
  for (const auto& [name, value] : controller_.session().controller().settings())
    found[py::str(name)] = value;
  return found;
}

py::object SteppedController::report() const {
  if (!controller_.hasOptimizer() || step_ == 0) return py::none();
  const SolverReport& r = controller_.report();
  py::dict found;
  found["perturbation"] = toArray(r.perturbation);
  found["status"] = static_cast<int>(r.status);
  found["iterations"] = r.iterations;
  found["kkt_residual"] = r.kkt_residual;
  found["active_rows"] = r.active_rows;
  return found;
}

}  // namespace fpc::python
