// Names and equations of the transfer matrix. Its motion with dead times: transfer_stepper.cpp.
#include "plant/transfer_matrix.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "plant/transfer_stepper.hpp"

namespace fpc {
namespace {

constexpr double kWide = 1e6;  // range of what has no physical one

/// Symmetric about zero, and beyond `reach`.
Quantity unlimited(const std::string& name, const std::string& unit, double nominal, double reach) {
  const double wide = std::max(kWide, 10.0 * std::abs(reach));
  return {name, unit, nominal, -wide, wide};
}

Eigen::Index find(const std::vector<Quantity>& quantities, const std::string& name) {
  for (std::size_t i = 0; i < quantities.size(); ++i)
    if (quantities[i].name == name) return static_cast<Eigen::Index>(i);
  return -1;
}

void requireGroup(const std::vector<Quantity>& group, const std::string& key,
                  std::set<std::string>& seen) {
  for (std::size_t i = 0; i < group.size(); ++i) {
    const Quantity& q = group[i];
    const std::string item = "plant.matrix." + key + "[" + std::to_string(i) + "].";
    require(!q.name.empty() && seen.insert(q.name).second, item + "name",
            "a name that no other signal has, got '" + q.name + "'");
    require(std::isfinite(q.lower) && std::isfinite(q.upper) && q.lower < q.upper, item + "upper",
            "lower < upper");
    require(q.nominal >= q.lower && q.nominal <= q.upper, item + "nominal",
            "a number between lower and upper, got " + exactText(q.nominal));
  }
}

void requireSignals(const TransferMatrix& matrix) {
  std::set<std::string> seen;
  require(!matrix.outputs.empty(), "plant.matrix.outputs", "at least one");
  require(!matrix.inputs.empty(), "plant.matrix.inputs", "at least one");
  requireGroup(matrix.outputs, "outputs", seen);
  requireGroup(matrix.inputs, "inputs", seen);
  requireGroup(matrix.disturbances, "disturbances", seen);
}

/// The states that describe() makes of outputs and elements have names of their own.
void requireStates(const TransferMatrix& matrix) {
  std::set<std::string> states, begun;
  for (const auto& output : matrix.outputs) states.insert(output.name);
  for (std::size_t i = 0; i < matrix.elements.size(); ++i) {
    const TransferElement& e = matrix.elements[i];
    const auto add = [&](const std::string& name) {
      require(states.insert(name).second, "plant.matrix.elements[" + std::to_string(i) + "].from",
              "names of outputs and sources that make no state twice; " + e.output + " from " +
                  e.from + " makes '" + name + "' again");
    };
    if (!begun.insert(e.output).second) add(e.output + "_" + e.from);
    if (e.second_time_constant > 0.0) add(e.output + "_" + e.from + "_inner");
  }
}

void requireElement(const TransferMatrix& matrix, const TransferElement& e,
                    const std::string& key) {
  require(find(matrix.outputs, e.output) >= 0, key + "output", "one of the matrix's outputs");
  require(find(matrix.inputs, e.from) >= 0 || find(matrix.disturbances, e.from) >= 0, key + "from",
          "one of the matrix's inputs or disturbances");
  require(std::isfinite(e.gain), key + "gain", "a finite number");
  require(std::isfinite(e.time_constant) && e.time_constant > 0.0, key + "time_constant_min",
          "a time > 0");
  require(std::isfinite(e.dead_time) && e.dead_time >= 0.0, key + "dead_time_min", "a time >= 0");
  require(std::isfinite(e.second_time_constant) && e.second_time_constant >= 0.0,
          key + "second_time_constant_min", "a time >= 0");
}

}  // namespace

void TransferMatrix::validate() const {
  requireSignals(*this);
  require(std::isfinite(time_unit_s) && time_unit_s > 0.0, "plant.matrix: time unit", "a time > 0");
  std::set<std::pair<std::string, std::string>> pairs;
  std::set<std::string> driven;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const std::string key = "plant.matrix.elements[" + std::to_string(i) + "].";
    requireElement(*this, elements[i], key);
    require(pairs.emplace(elements[i].output, elements[i].from).second, key + "from",
            "one element for each pair of output and source");
    driven.insert(elements[i].output);
  }
  requireStates(*this);
  for (const auto& output : outputs)
    require(driven.count(output.name) > 0, "plant.matrix.elements",
            "at least one element for output " + output.name);
}

TransferMatrix woodBerry() {
  TransferMatrix m;
  m.name = "distillation_column";
  m.title = "Binary distillation column, 2x2 lags with dead times and feed (wood1973)";
  m.time_unit_s = 60.0;
  m.outputs = {{"y_D", "mol%", 96.25, 0.0, 200.0}, {"x_B", "mol%", 0.5, -100.0, 100.0}};
  m.inputs = {{"L", "lb/min", 0.0, -2.0, 2.0}, {"V", "lb/min", 0.0, -2.0, 2.0}};
  m.disturbances = {{"F", "lb/min", 0.0, -2.0, 2.0}};
  m.elements = {{"y_D", "L", 12.8, 16.7, 1.0},  {"y_D", "V", -18.9, 21.0, 3.0},
                {"y_D", "F", 3.8, 14.9, 8.0},   {"x_B", "L", 6.6, 10.9, 7.0},
                {"x_B", "V", -19.4, 14.4, 3.0}, {"x_B", "F", 4.9, 13.2, 3.0}};
  return m;
}

TransferMatrixPlant::TransferMatrixPlant(TransferMatrix matrix) : matrix_(std::move(matrix)) {
  matrix_.validate();
  place();
  describe();
}

void TransferMatrixPlant::place() {
  auto next = static_cast<Eigen::Index>(matrix_.outputs.size());
  const auto n_d = static_cast<Eigen::Index>(matrix_.disturbances.size());
  std::set<std::string> begun;
  for (const TransferElement& e : matrix_.elements) {
    Place p;
    p.output = find(matrix_.outputs, e.output);
    p.source = find(matrix_.inputs, e.from);
    p.from_disturbance = p.source < 0;
    if (p.from_disturbance) p.source = find(matrix_.disturbances, e.from);
    const auto& group = p.from_disturbance ? matrix_.disturbances : matrix_.inputs;
    p.source_nominal = group[static_cast<std::size_t>(p.source)].nominal;
    p.output_nominal = matrix_.outputs[static_cast<std::size_t>(p.output)].nominal;
    p.gain = n_d + static_cast<Eigen::Index>(places_.size());
    if (!begun.insert(e.output).second) p.share = next++;
    if (e.second_time_constant > 0.0) p.inner = next++;
    places_.push_back(p);
  }
}

void TransferMatrixPlant::describe() {
  PlantDescription& p = description_;
  p.name = matrix_.name;
  p.title = matrix_.title;
  p.time_unit_s = matrix_.time_unit_s;
  p.states = matrix_.outputs;
  p.inputs = matrix_.inputs;
  p.disturbances = matrix_.disturbances;
  p.frames = {{"plant", "map", 0.0, 0.0, 0.0}, {"column", "plant", 5.0, 0.0, 0.0}};
  for (const auto& output : matrix_.outputs) {
    const std::string analyzer = output.name + "_analyzer";
    p.outputs.push_back(output.name);
    p.frames.push_back({analyzer, "column", 1.0, 0.0, 1.5});
    p.output_frames[output.name] = analyzer;
  }
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const TransferElement& e = matrix_.elements[i];
    const std::string name = e.output + "_" + e.from;
    const std::string& unit = matrix_.outputs[static_cast<std::size_t>(places_[i].output)].unit;
    const auto& group = places_[i].from_disturbance ? matrix_.disturbances : matrix_.inputs;
    const Quantity& source = group[static_cast<std::size_t>(places_[i].source)];
    const double reach = e.gain * (source.upper - source.lower);
    if (places_[i].share >= 0) p.states.push_back(unlimited(name, unit, 0.0, reach));
    if (places_[i].inner >= 0) p.states.push_back(unlimited(name + "_inner", unit, 0.0, reach));
    const std::string gain = "gain/" + e.output + "/" + e.from;
    p.disturbances.push_back(unlimited(gain, unit + "/(" + source.unit + ")", e.gain, e.gain));
    p.hidden_disturbances.push_back(gain);
  }
}

double TransferMatrixPlant::share(std::size_t i, VectorRef x) const {
  const Place& p = places_[i];
  if (p.share >= 0) return x[p.share];
  double rest = x[p.output] - p.output_nominal;
  for (const Place& other : places_)
    if (other.output == p.output && other.share >= 0) rest -= x[other.share];
  return rest;
}

void TransferMatrixPlant::derivatives(VectorRef x, VectorRef u, VectorRef d,
                                      Eigen::Ref<Vector> dxdt) const {
  dxdt.setZero();
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const Place& p = places_[i];
    const TransferElement& e = matrix_.elements[i];
    const double source = p.from_disturbance ? d[p.source] : u[p.source];
    const double drive = d[p.gain] * (source - p.source_nominal);
    const double inner = p.inner >= 0 ? x[p.inner] : drive;
    if (p.inner >= 0) dxdt[p.inner] = (drive - inner) / e.second_time_constant;
    const double rate = (inner - share(i, x)) / e.time_constant;
    if (p.share >= 0) dxdt[p.share] = rate;
    dxdt[p.output] += rate;
  }
}

std::unique_ptr<PlantStepper> TransferMatrixPlant::makeStepper(double sample_time_s) const {
  return std::make_unique<TransferStepper>(*this, sample_time_s);
}

namespace {

const bool kTransferMatrixRegistered =
    registerPlant("distillation_column", [](const PlantParameters& given) {
      auto plant = std::make_unique<TransferMatrixPlant>(woodBerry());
      parameterValues(plant->description(), given);  // has none: refuses every name
      return plant;
    });

}  // namespace
}  // namespace fpc
