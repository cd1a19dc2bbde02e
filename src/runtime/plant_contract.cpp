#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <set>

#include "analysis/steady_state.hpp"
#include "base/random.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "plant/integrator.hpp"
#include "runtime/contract.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr std::uint64_t kDrawSeed = 5;
constexpr int kDraws = 2000;
constexpr double kSameRest = 1e-4, kSameState = 1e-6;  // relative to 1 + the state

Vector nominalValues(const std::vector<Quantity>& quantities) {
  Vector values(static_cast<Index>(quantities.size()));
  for (std::size_t i = 0; i < quantities.size(); ++i)
    values[static_cast<Index>(i)] = quantities[i].nominal;
  return values;
}

/// Anywhere in the ranges, corners included.
Vector drawnValues(const std::vector<Quantity>& quantities, std::mt19937_64& engine) {
  Vector values(static_cast<Index>(quantities.size()));
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    const Quantity& q = quantities[i];
    const double part = std::clamp(1.4 * uniform(engine) - 0.2, 0.0, 1.0);
    values[static_cast<Index>(i)] = q.lower + part * (q.upper - q.lower);
  }
  return values;
}

std::vector<const std::vector<Quantity>*> groupsOf(const PlantDescription& p) {
  return {&p.states, &p.algebraic, &p.inputs, &p.disturbances, &p.parameters};
}

std::string wrongNames(const PlantDescription& p, const std::string& type) {
  std::set<std::string> seen;
  for (const auto* group : groupsOf(p))
    for (const Quantity& q : *group) {
      if (q.name.empty()) return "a quantity without a name";
      if (q.unit.empty()) return q.name + " has no unit ('-' for none)";
      if (!seen.insert(q.name).second) return q.name + " is there twice";
    }
  if (p.name != type) return "it calls itself '" + p.name + "'";
  if (p.title.empty()) return "it has no title";
  return p.time_unit_s > 0.0 ? "" : "its time unit is not > 0";
}

std::string wrongRanges(const PlantDescription& p) {
  for (const auto* group : groupsOf(p))
    for (const Quantity& q : *group)
      if (!(q.lower < q.upper && q.nominal >= q.lower && q.nominal <= q.upper))
        return q.name + ": " + exactText(q.nominal) + " in " + exactText(q.lower) + " to " +
               exactText(q.upper);
  return p.inputs.empty() ? "it has no input" : "";
}

std::string wrongOutputs(const PlantDescription& p) {
  std::set<std::string> known, frames;
  for (const auto* group : {&p.states, &p.algebraic})
    for (const Quantity& q : *group) known.insert(q.name);
  if (p.outputs.empty()) return "it has no outputs";
  for (const std::string& name : p.outputs)
    if (known.count(name) == 0) return "output " + name + " is neither a state nor algebraic";
  for (const EquipmentFrame& frame : p.frames) {
    if (!frames.empty() && frames.count(frame.parent) == 0)
      return "frame " + frame.name + " has no parent before it";
    if (!frames.insert(frame.name).second) return "frame " + frame.name + " is there twice";
  }
  for (const auto& [output, frame] : p.output_frames)
    if (known.count(output) == 0 || frames.count(frame) == 0)
      return "output_frames: " + output + ", " + frame;
  return "";
}

/// Equations and algebraic outputs.
std::string notFinite(const Plant& plant) {
  const PlantDescription& p = plant.description();
  std::mt19937_64 engine = seededEngine(kDrawSeed, {});
  Vector dxdt(static_cast<Index>(p.states.size())), y(static_cast<Index>(p.algebraic.size()));
  y.setZero();
  for (int i = 0; i < kDraws; ++i) {
    const Vector x = drawnValues(p.states, engine), u = drawnValues(p.inputs, engine),
                 d = drawnValues(p.disturbances, engine);
    plant.derivatives(x, u, d, dxdt);
    plant.algebraic(x, u, d, y);
    if (dxdt.allFinite() && y.allFinite()) continue;
    std::string at;
    for (const Vector* part : {&x, &u, &d})
      for (const double value : *part) at += " " + exactText(value);
    return "not finite at x, u, d =" + at;
  }
  return "";
}

std::string notAtRest(const Plant& plant) {
  const PlantDescription& p = plant.description();
  const Vector x = nominalValues(p.states);
  const auto f = [&](VectorRef state, VectorRef input, VectorRef disturbance,
                     Eigen::Ref<Vector> dxdt) {
    plant.derivatives(state, input, disturbance, dxdt);
  };
  const Vector u = nominalValues(p.inputs), d = nominalValues(p.disturbances);
  Vector rate(x.size());
  f(x, u, d, rate);
  if (rate.isZero(0.0)) return "";  // also where an integrator leaves the place free
  const SteadyState rest = findSteadyState(f, x, u, d);
  if (!rest.ok()) return "no steady state was found near the nominal values";
  for (Index i = 0; i < x.size(); ++i)
    if (!(std::abs(rest.x[i] - x[i]) <= kSameRest * (1.0 + std::abs(x[i]))))
      return p.states[static_cast<std::size_t>(i)].name + " rests at " + exactText(rest.x[i]) +
             ", not at " + exactText(x[i]);
  return "";
}

/// Near the nominal point, as the integrator sees it.
std::string dependsOnTheSplit(const Plant& plant) {
  const PlantDescription& p = plant.description();
  std::mt19937_64 engine = seededEngine(kDrawSeed, {1});
  Integrator integrator(plant, {});
  const Vector x = nominalValues(p.states), u = nominalValues(p.inputs),
               d = nominalValues(p.disturbances);
  const int trials = x.size() > 50 ? 3 : 50;  // a large plant takes its time
  const double hold_s = std::min(0.2 * p.time_unit_s, 720.0);
  for (int i = 0; i < trials; ++i) {
    const auto around = [&](const Vector& v) {
      return Vector(v.unaryExpr([&](double a) { return a * (0.8 + 0.4 * uniform(engine)); }));
    };
    Vector once = around(x);
    const Vector input = around(u), disturbance = around(d);
    Vector half = once;
    for (const auto& [state, seconds] :
         {std::pair{&once, hold_s}, {&half, 0.5 * hold_s}, {&half, 0.5 * hold_s}}) {
      const IntegrationResult done = integrator.advance(*state, input, disturbance, seconds);
      if (!done.ok()) return "the integrator fails: " + done.reason;
    }
    if (!((once - half).norm() < kSameState * (1.0 + once.norm())))
      return "off by " + exactText((once - half).norm());
  }
  return "";
}

/// Of a plant whose sample time is part of it: its stepper says everything. Two of them, from the
/// nominal point, over the same inputs.
class Steppers {
 public:
  explicit Steppers(const Plant& plant) : about_(plant.description()), plant_(plant) {}

  std::string notAtRest() const {
    const auto stepper = begun();
    const Vector nominal = nominalValues(about_.states), u = nominalValues(about_.inputs),
                 d = nominalValues(about_.disturbances);
    Vector x = nominal;
    for (int k = 0; k < kSteps; ++k) stepper->advance(x, u, d);
    for (Index i = 0; i < x.size(); ++i)
      if (!(std::abs(x[i] - nominal[i]) <= kSameRest * (1.0 + std::abs(nominal[i]))))
        return about_.states[static_cast<std::size_t>(i)].name + " goes to " + exactText(x[i]) +
               ", it does not stay at " + exactText(nominal[i]);
    return "";
  }
  std::string notFinite() const {
    std::string found;
    move([&](const Vector& x, const Vector&, const std::string& failure) {
      if (found.empty() && !(failure.empty() && x.allFinite()))
        found = failure.empty() ? "the state after a step is not finite" : failure;
    });
    return found;
  }
  std::string otherwiseAgain() const {
    bool same = true;
    move([&](const Vector& x, const Vector& again, const std::string&) {
      same = same && std::equal(x.data(), x.data() + x.size(), again.data());
    });
    return same ? "" : "two of them differ after the same inputs";
  }

 private:
  static constexpr int kSteps = 50;

  std::unique_ptr<PlantStepper> begun() const {
    auto stepper = plant_.makeStepper(about_.time_unit_s);
    stepper->reset(nominalValues(about_.inputs), nominalValues(about_.disturbances));
    return stepper;
  }
  template <typename Look>
  void move(Look look) const {
    std::mt19937_64 engine = seededEngine(kDrawSeed, {2});
    const auto first = begun(), second = begun();
    Vector x = nominalValues(about_.states), again = x;
    for (int k = 0; k < kSteps; ++k) {
      const Vector u = drawnValues(about_.inputs, engine),
                   d = drawnValues(about_.disturbances, engine);
      first->advance(x, u, d);
      second->advance(again, u, d);
      look(x, again, first->failure());
      if (!x.allFinite()) return;
    }
  }

  const PlantDescription& about_;
  const Plant& plant_;
};

/// Whether derivatives() do not say how it moves.
bool movesBySteps(const Plant& plant) {
  try {
    const auto stepper = plant.makeStepper(plant.description().time_unit_s);
    return stepper && !stepper->divisible();
  } catch (const InputError&) {  // not at this sample time
    return false;
  }
}

}  // namespace

std::vector<Promise> plantPromises(const Plant& plant, const std::string& type) {
  const PlantDescription& p = plant.description();
  std::vector<Promise> promises{{"names are unique, units are given", wrongNames(p, type)},
                                {"nominal values lie inside their ranges", wrongRanges(p)},
                                {"outputs and frames are there", wrongOutputs(p)}};
  const std::string finite = "finite anywhere in the ranges",
                    rest = "the nominal point is a steady state";
  if (movesBySteps(plant)) {
    const Steppers steppers(plant);
    promises.push_back({finite, steppers.notFinite()});
    promises.push_back({rest, steppers.notAtRest()});
    promises.push_back({"the same inputs give the same states", steppers.otherwiseAgain()});
  } else {
    promises.push_back({finite, notFinite(plant)});
    promises.push_back({rest, notAtRest(plant)});
    promises.push_back({"splitting a hold changes nothing", dependsOnTheSplit(plant)});
  }
  return promises;
}

}  // namespace fpc
