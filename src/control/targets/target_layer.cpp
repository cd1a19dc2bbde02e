#include "control/targets/target_layer.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include "control/targets/steady_model.hpp"
#include "control/targets/target_solver.hpp"
#include "estimation/model_observer.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kMoved = 1e-6;    // of a range
constexpr double kSettled = 1e-7;  // of a unit: two linearisations agree
constexpr double kGivenUp = 1e-6;  // of a unit: less is nothing
constexpr double kFarOut = 1e6;    // units: a price drives it where nothing holds it

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

}  // namespace

struct TargetLayer::Workspace {
  /// One row of the problem: what it asks of which unknown or output.
  struct Ask {
    enum Kind { kBalance, kZone, kSetpoint } kind;
    Index index;                    // of the level or the output
    std::string above, below, who;  // texts of what is given up
  };

  TargetParams params;
  InputLimits limits;
  PlantInfo plant;
  Index n_y, n_u;

  std::optional<ModelObserver> observer;
  std::optional<SteadyModel> model;
  std::optional<TargetSolver> solver;
  std::vector<Index> output_rows;  // of the observer's state
  std::vector<Ask> asks;
  TargetProblem problem;

  Vector y, u;            // where the model is linearised, and then the target
  Vector best_y, best_u;  // the last good target
  double cost{};          // of it
  Vector held;            // levels at this sample
  Vector past_disturbances;
  StepHeader seen;
  bool observing{false}, begun_run{false}, known{false};
  Notices said;
  TargetMoves moves;
  double seconds{};

  Workspace(TargetParams p, InputLimits l, PlantInfo info)
      : params(std::move(p)),
        limits(std::move(l)),
        plant(std::move(info)),
        n_y(countOf(plant.outputs)),
        n_u(countOf(plant.inputs)),
        y(Vector::Zero(n_y)),
        u(Vector::Zero(n_u)),
        best_y(y),
        best_u(u),
        held(y),
        past_disturbances(Vector::Zero(countOf(plant.disturbances))) {
    limits.validate(n_u);
    params.validate(plant, limits);
  }

  void ask(Ask::Kind kind, Index index, int rank, std::vector<int>& ranks) {
    const SignalInfo& about = plant.outputs[at(index)];
    const std::string of_rank = rank > 0 ? " of rank " + std::to_string(rank) : "";
    Ask made{kind, index, {}, {}, about.name};
    const auto value = [&](double v) { return " " + exactText(v) + " " + about.unit + of_rank; };
    if (kind == Ask::kZone) {
      made.above = about.name + " rests above its limit" + value(params.outputs[at(index)].upper);
      made.below = about.name + " rests below its limit" + value(params.outputs[at(index)].lower);
    } else if (kind == Ask::kSetpoint) {
      made.above = about.name + " rests above its setpoint" + of_rank;
      made.below = about.name + " rests below its setpoint" + of_rank;
    } else {
      made.above = about.name + " rises: nothing allowed balances it";
      made.below = about.name + " falls: nothing allowed balances it";
    }
    asks.push_back(std::move(made));
    ranks.push_back(rank);
  }

  void setModel(const TsModel& given) {
    std::vector<bool> integrating;
    for (const TargetOutput& output : params.outputs) integrating.push_back(output.integrating);
    SteadyModel steady(given, integrating);
    const LocalModel local(given);
    ModelObserver watching(local, params.observer, 0);
    model.emplace(std::move(steady));
    observer.emplace(std::move(watching));
    output_rows.clear();
    for (Index i = 0; i < n_y; ++i) output_rows.push_back(local.outputState(i));
    observing = false;
    layOut();
  }

  void layOut() {
    const std::vector<Index>& levels = model->levels();
    std::vector<int> ranks;
    asks.clear();
    for (const Index level : levels) ask(Ask::kBalance, level, 0, ranks);
    for (Index i = 0; i < n_y; ++i) {
      const TargetOutput& output = params.outputs[at(i)];
      if (output.hasZone()) ask(Ask::kZone, i, output.rank, ranks);
      if (output.setpoint) ask(Ask::kSetpoint, i, output.rank, ranks);
    }
    const Index n = n_u + countOf(levels);
    problem = TargetProblem(n, countOf(asks));
    problem.rank = ranks;
    problem.band = params.band;
    for (Index j = 0; j < n_u; ++j) {
      const TargetInput& input = params.inputs[at(j)];
      problem.lower[j] = input.lower;
      problem.upper[j] = input.upper;
      if (input.upper > input.lower) problem.unit[j] = input.upper - input.lower;
    }
    for (Index i = 0; i < countOf(levels); ++i) {
      const SignalInfo& about = plant.outputs[at(levels[at(i)])];
      problem.lower[n_u + i] = about.lower;
      problem.upper[n_u + i] = about.upper;
      problem.unit[n_u + i] = params.outputs[at(levels[at(i)])].unit;
    }
    solver.emplace(n, ranks);
  }

  /// d(k-1) moved the model to k, as u(k-1) did.
  void observe(const Measurement& now) {
    const bool next =
        observing && now.header.run_id == seen.run_id && now.header.step == seen.step + 1;
    if (next)
      observer->advance(now.outputs, now.input_applied, past_disturbances);
    else
      observer->rest(now.outputs, now.input_applied, now.disturbances, begun_run);
    observing = begun_run = true;
    seen = now.header;
    past_disturbances = now.disturbances;
    for (Index i = 0; i < n_y; ++i) held[i] = observer->state()[output_rows[at(i)]];
  }

  void fill(VectorRef setpoint) {
    const Matrix& gain = model->gain();
    const Vector& offset = model->offset();
    for (Index i = 0; i < countOf(asks); ++i) {
      const Ask& a = asks[at(i)];
      const TargetOutput& output = params.outputs[at(a.index)];
      problem.row_unit[i] = output.unit;
      if (a.kind == Ask::kBalance) {  // the balances come first, in the order of the levels
        problem.rows.row(i) = model->balance().row(i);
        problem.row_lower[i] = problem.row_upper[i] = -model->imbalance()[i];
        continue;
      }
      problem.rows.row(i) = gain.row(a.index);
      const bool zone = a.kind == Ask::kZone;
      problem.row_lower[i] = (zone ? output.lower : setpoint[a.index]) - offset[a.index];
      problem.row_upper[i] = (zone ? output.upper : setpoint[a.index]) - offset[a.index];
    }
    problem.price.setZero();
    for (Index j = 0; j < n_u; ++j) problem.price[j] = params.inputs[at(j)].price;
    for (Index i = 0; i < n_y; ++i)
      if (params.outputs[at(i)].price != 0.0)
        problem.price += params.outputs[at(i)].price * gain.row(i).transpose();
    for (Index j = 0; j < n_u; ++j) {
      const double rest = params.inputs[at(j)].rest;
      problem.rest[j] = std::isnan(rest) ? best_u[j] : rest;
    }
    for (Index i = 0; i < countOf(model->levels()); ++i)
      problem.rest[n_u + i] = known ? best_y[model->levels()[at(i)]] : held[model->levels()[at(i)]];
  }

  bool runsAway(const Vector& v) const {
    for (Index i = n_u; i < v.size(); ++i)
      if (std::abs(v[i] - problem.rest[i]) > kFarOut * problem.unit[i]) return true;
    return false;
  }

  /// The target of this sample into y, u; why there is none otherwise.
  EventCode find(const Measurement& now, VectorRef setpoint) {
    y = known ? best_y : now.outputs;
    u = known ? best_u : now.input_applied;
    for (Index j = 0; j < n_u; ++j)
      u[j] = std::clamp(u[j], params.inputs[at(j)].lower, params.inputs[at(j)].upper);
    if (!known) best_u = u;
    for (int round = 1; round <= params.iterations; ++round) {
      if (!model->linearise(y, u, now.disturbances, observer->disturbance(), held))
        return EventCode::kTargetNotFound;
      if (round > 1 && model->settled()) return EventCode::kNone;
      fill(setpoint);
      const TargetSolution& found = solver->solve(problem);
      if (!found.usable()) {
        const bool priced = problem.price.tail(problem.price.size() - n_u).any();
        return priced ? EventCode::kTargetUnbounded : EventCode::kTargetNotFound;
      }
      if (runsAway(found.v)) return EventCode::kTargetUnbounded;
      double moved = 0.0;
      for (Index j = 0; j < n_u; ++j) {
        moved = std::max(moved, std::abs(found.v[j] - u[j]) / problem.unit[j]);
        u[j] = found.v[j];
      }
      for (Index i = 0; i < n_y; ++i) {
        const double level = model->gain().row(i).dot(found.v) + model->offset()[i];
        moved = std::max(moved, std::abs(level - y[i]) / params.outputs[at(i)].unit);
        y[i] = level;
      }
      if (!y.allFinite() || !u.allFinite()) return EventCode::kTargetNotFound;
      if (round > 1 && moved <= kSettled) return EventCode::kNone;
    }
    if (model->linearise(y, u, now.disturbances, observer->disturbance(), held) && model->settled())
      return EventCode::kNone;
    return EventCode::kTargetNotSettled;
  }

  void sayGivenUp() {
    const Vector& given_up = solver->solution().given_up;
    for (Index i = 0; i < given_up.size(); ++i) {
      const double beyond = given_up[i];
      if (std::abs(beyond) <= kGivenUp * problem.row_unit[i]) continue;
      const Ask& a = asks[at(i)];
      said.add({EventCode::kTargetGivenUp, beyond > 0.0 ? a.above.c_str() : a.below.c_str(),
                a.who.c_str()});
    }
  }

  void count() {
    bool moved = false;
    for (Index j = 0; known && j < n_u; ++j) {
      const double by = std::abs(u[j] - best_u[j]) / problem.unit[j];
      moved = moved || by > kMoved;
      moves.travel += by;
    }
    if (moved) ++moves.moved;
  }

  void answer(const Measurement& now, Targets& targets) {
    targets.header = now.header;
    targets.outputs = best_y;
    targets.inputs = best_u;
    targets.cost = cost;
    targets.output_lower.resize(n_y);
    targets.output_upper.resize(n_y);
    for (Index i = 0; i < n_y; ++i) {
      const TargetOutput& output = params.outputs[at(i)];
      targets.output_lower[i] = std::min(output.lower, best_y[i]);
      targets.output_upper[i] = std::max(output.upper, best_y[i]);
    }
  }

  void step(const Measurement& now, VectorRef setpoint, Targets& targets) {
    said.clear();
    EventCode trouble = EventCode::kTargetNotFound;
    const bool usable = model && allFinite(now) && setpoint.allFinite();
    if (usable) {
      observe(now);
      trouble = find(now, setpoint);
    } else {
      observing = false;
    }
    const bool found = trouble == EventCode::kNone || trouble == EventCode::kTargetNotSettled;
    if (found) {
      sayGivenUp();
      count();
      best_y = y;
      best_u = u;
      cost = solver->solution().cost;
      known = true;
    } else if (!known) {  // nothing better than where it is
      if (now.outputs.allFinite()) best_y = now.outputs;
      if (now.input_applied.allFinite()) best_u = now.input_applied;
      cost = 0.0;
    }
    if (trouble != EventCode::kNone) said.add({trouble});
    targets.found = found;
    answer(now, targets);
  }
};

TargetLayer::TargetLayer(TargetParams params, InputLimits limits, PlantInfo plant)
    : work_(std::make_unique<Workspace>(std::move(params), std::move(limits), std::move(plant))) {}
TargetLayer::~TargetLayer() = default;
TargetLayer::TargetLayer(TargetLayer&&) noexcept = default;

void TargetLayer::setModel(const TsModel& model) { work_->setModel(model); }

bool TargetLayer::ready() const { return work_->model.has_value(); }

void TargetLayer::reset() {
  work_->observing = false;
  work_->known = false;
}

void TargetLayer::forget() {
  reset();
  work_->begun_run = false;
  work_->moves = {};
  if (work_->observer) work_->observer->forget();
}

void TargetLayer::step(const Measurement& now, VectorRef setpoint, Targets& targets) {
  const auto start = std::chrono::steady_clock::now();
  work_->step(now, setpoint, targets);
  work_->seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

const Notices& TargetLayer::events() const { return work_->said; }
const TargetMoves& TargetLayer::moves() const { return work_->moves; }
double TargetLayer::seconds() const { return work_->seconds; }

}  // namespace fpc
