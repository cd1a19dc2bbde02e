#include "own_plant.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <utility>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/plant/plant.hpp"
#include "own.hpp"

namespace fpc::python {
namespace {

struct OwnPlantType {
  PlantDescription about;
  Held make;
  bool steps{};
};

/// By name. With the GIL only; never destroyed, as the interpreter may end before.
std::map<std::string, std::shared_ptr<const OwnPlantType>>& ownPlantTypes() {
  static auto* types = new std::map<std::string, std::shared_ptr<const OwnPlantType>>;
  return *types;
}

py::dict dictOf(const PlantParameters& parameters) {
  py::dict values;
  for (const auto& [name, value] : parameters) values[py::str(name)] = value;
  return values;
}

class OwnStepper final : public PlantStepper {
 public:
  OwnStepper(std::shared_ptr<const OwnPlantType> type, PlantParameters parameters)
      : type_(std::move(type)),
        parameters_(std::move(parameters)),
        names_(namesOf(type_->about.states)) {}
  void reset(VectorRef, VectorRef) override {
    const py::gil_scoped_acquire gil;
    calling(type_->about.name, [&] { object_ = held((*type_->make)(dictOf(parameters_))); });
  }
  void advance(Eigen::Ref<Vector> x, VectorRef u, VectorRef d) override {
    const py::gil_scoped_acquire gil;
    failure_.clear();
    try {
      calling(type_->about.name + ": step()", [&] {
        Vector next = x;
        const py::object result = object_->attr("step")(toArray(Vector(u)), toArray(Vector(d)));
        require(!result.is_none(), type_->about.name + ": step()", "the outputs as its result");
        readSignals(result, names_, "step()", next);
        x = next;
      });
    } catch (const std::exception& error) {
      failure_ = error.what();
    }
  }
  bool divisible() const override { return false; }
  std::string failure() const override { return failure_; }

 private:
  std::shared_ptr<const OwnPlantType> type_;
  PlantParameters parameters_;
  Names names_;
  Held object_;
  std::string failure_;
};

class OwnPlant final : public Plant {
 public:
  OwnPlant(std::shared_ptr<const OwnPlantType> type, const PlantParameters& parameters)
      : type_(std::move(type)), names_(namesOf(type_->about.states)) {
    const Vector values = parameterValues(type_->about, parameters);
    for (std::size_t i = 0; i < type_->about.parameters.size(); ++i)
      parameters_[type_->about.parameters[i].name] = values[static_cast<Eigen::Index>(i)];
  }
  const PlantDescription& description() const override { return type_->about; }
  void derivatives(VectorRef x, VectorRef u, VectorRef d, Eigen::Ref<Vector> dxdt) const override {
    dxdt.setZero();
    if (type_->steps) return;  // its stepper moves it
    const py::gil_scoped_acquire gil;
    calling(type_->about.name + ": derivatives()", [&] {
      // Not before: every plant is made where only its description is asked for.
      if (!object_) object_ = held((*type_->make)(dictOf(parameters_)));
      Vector rate = Vector::Zero(x.size());
      const py::object result =
          object_->attr("derivatives")(toArray(Vector(x)), toArray(Vector(u)), toArray(Vector(d)));
      require(!result.is_none(), type_->about.name + ": derivatives()",
              "the derivatives as its result");
      readSignals(result, names_, "derivatives()", rate);
      dxdt = rate;
    });
  }
  std::unique_ptr<PlantStepper> makeStepper(double) const override {
    if (!type_->steps) return nullptr;
    return std::make_unique<OwnStepper>(type_, parameters_);
  }

 private:
  std::shared_ptr<const OwnPlantType> type_;
  Names names_;
  PlantParameters parameters_;
  mutable Held object_;
};

std::vector<Quantity> quantitiesOf(const py::dict& about, const char* key) {
  std::vector<Quantity> list;
  for (const py::handle entry : about[key]) {
    const auto q = entry.cast<std::tuple<std::string, std::string, double, double, double>>();
    list.push_back(
        {std::get<0>(q), std::get<1>(q), std::get<2>(q), std::get<3>(q), std::get<4>(q)});
  }
  return list;
}

PlantDescription descriptionOf(const py::dict& about) {
  PlantDescription p;
  p.name = about["name"].cast<std::string>();
  p.title = about["title"].cast<std::string>();
  p.time_unit_s = about["time_unit_s"].cast<double>();
  p.states = quantitiesOf(about, "states");
  p.inputs = quantitiesOf(about, "inputs");
  p.disturbances = quantitiesOf(about, "disturbances");
  p.parameters = quantitiesOf(about, "parameters");
  for (const py::handle output : about["outputs"]) p.outputs.push_back(output.cast<std::string>());
  p.frames = {{p.name, "map", 0.0, 0.0, 0.0}};
  for (const std::string& output : p.outputs) p.output_frames[output] = p.name;
  return p;
}

void requireWhole(const PlantDescription& p) {
  require(!p.name.empty(), "plant", "a name");
  require(p.time_unit_s > 0.0, p.name + ": time_unit_s", "a time > 0");
  require(!p.states.empty(), p.name + ": states", "at least one");
  require(!p.outputs.empty(), p.name + ": outputs", "at least one");
  std::set<std::string> seen;
  for (const auto* group : {&p.states, &p.inputs, &p.disturbances, &p.parameters})
    for (const Quantity& q : *group) {
      const std::string where = p.name + ": " + q.name;
      require(!q.name.empty() && seen.insert(q.name).second, where, "every name only once");
      require(q.lower < q.upper && q.nominal >= q.lower && q.nominal <= q.upper, where,
              "lower <= nominal <= upper, lower < upper");
    }
  const Names states = namesOf(p.states);
  for (const std::string& output : p.outputs)
    require(std::find(states.begin(), states.end(), output) != states.end(),
            p.name + ": outputs '" + output + "'", "a state");
}

}  // namespace

void registerOwnPlant(const py::dict& about, const py::object& make, bool steps) {
  auto type = std::make_shared<OwnPlantType>(OwnPlantType{descriptionOf(about), held(make), steps});
  requireWhole(type->about);
  const std::string name = type->about.name;
  auto& known = ownPlantTypes();
  if (known.count(name) == 0) {
    const auto names = plantNames();
    require(std::find(names.begin(), names.end(), name) == names.end(), "plant '" + name + "'",
            "a name that no plant has");
    registerPlant(name, [name](const PlantParameters& parameters) -> std::unique_ptr<Plant> {
      const py::gil_scoped_acquire gil;
      return std::make_unique<OwnPlant>(ownPlantTypes().at(name), parameters);
    });
  }
  known[name] = std::move(type);
}

}  // namespace fpc::python
