// What is built of evaluations of a fuzzy model, each beside the evaluations it needs, in pairs: a
// plan of the iterated law, a decision by branch and bound, a fit to free runs.
#include <random>

#include "control/fmbpc/input_limited_ilqr.hpp"
#include "control/hybrid/fixture.hpp"
#include "identification/consequents.hpp"
#include "identification/free_run_fit.hpp"
#include "identification/model_fixture.hpp"
#include "identification/prediction.hpp"
#include "model/choice_model.hpp"
#include "pairs.hpp"
#include "runtime/factory.hpp"

namespace fpc::bench {
namespace {

/// The planner of asp_best, 50 samples ahead, with a setpoint of x that steps up and down so that
/// every plan is a new one.
class Plans {
 public:
  Plans()
      : loop_(readLoop("asp_best")),
        model_(loop_.model),
        planner_(model_, {kHorizon, 3, Eigen::Vector3d(0.0, 0.0, 1.0), Vector::Constant(1, 0.03)},
                 {Vector::Zero(1), Vector::Constant(1, 3000.0), Vector::Constant(1, kInfinity)}),
        start_(makeSimulation(loop_).measurement()),
        state_(model_.stateSize()),
        correction_(Vector::Zero(model_.stateSize())),
        offset_(Vector::Zero(3)),
        disturbances_(start_.disturbances.replicate(1, kHorizon)) {
    model_.restState(start_.outputs, start_.input_applied, start_.disturbances, state_);
  }

  /// Rules evaluated for this plan.
  long plan() {
    up_ = !up_;
    Vector setpoint = start_.outputs;
    setpoint[2] += up_ ? 50.0 : -50.0;
    planner_.plan(state_, correction_, offset_, disturbances_, setpoint.replicate(1, kHorizon),
                  start_.input_applied);
    return planner_.evaluations();
  }
  void evaluate(long times) {
    for (long i = 0; i < times; ++i)
      model_.advance(state_, start_.input_applied, start_.disturbances, next_);
  }

 private:
  static constexpr int kHorizon = 50;
  LoopFile loop_;
  LocalModel model_;
  InputLimitedIlqr planner_;
  Measurement start_;
  Vector state_, correction_, offset_, next_;
  Matrix disturbances_;
  bool up_{false};
};

void iteratedLaw() {
  Plans plans;
  long needed = 0;
  for (int i = 0; i < 10; ++i) needed += plans.plan();
  printPairs(
      "ten plans of the iterated law, 50 samples ahead",
      std::to_string(needed) + " model evaluations", "0.5",
      [&] {
        for (int i = 0; i < 10; ++i) plans.plan();
      },
      [&] { plans.evaluate(needed); });
}

/// Decisions of the batch reactor's law over random states.
void branchAndBound() {
  std::mt19937_64 generator(20070);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<Eigen::Vector2d> starts;
  for (int i = 0; i < 20; ++i)
    starts.emplace_back(15.0 + 51.0 * unit(generator), 13.0 + 60.0 * unit(generator));
  const HybridMpcParams params = test::batchReactorParams(45, BranchBound::kCost);
  const auto mpc = test::batchReactorMpc(params);
  const Matrix reference =
      Eigen::Vector2d(40.0, 0.0).replicate(1, params.hold_samples * params.horizon_blocks);
  const auto decide = [&] {
    std::uint64_t nodes = 0;
    for (const auto& start : starts)
      nodes += mpc->decide(start, params.choices.col(0), Vector(0), reference).nodes;
    return nodes;
  };
  const std::uint64_t samples = decide() * static_cast<std::uint64_t>(params.hold_samples);
  ChoiceModel model(test::batchModel("batch_fuzzy"), params.choices);
  Vector state(model.stateSize());
  printPairs("20 decisions by branch and bound, bound by cost",
             std::to_string(samples) + " samples of its model", "0.5", decide, [&] {
               state = starts.front();
               for (std::uint64_t i = 0; i < samples; ++i)
                 model.step(static_cast<int>(i / 15 % 7), Vector(0), state);
             });
}

/// 1000 rows of a random model of two lags with noise.
DataSet recordOf(const TsModel& model, std::mt19937_64& generator) {
  std::normal_distribution<double> noise(0.0, 0.02);
  LocalModel local(model);
  DataSet data;
  data.sample_time_s = model.sample_time_s;
  data.outputs = model.outputs;
  data.inputs = model.inputs;
  data.constant = {false, false};
  data.values.resize(1000, 2);
  Vector state = Vector::Zero(local.stateSize()), u = Vector::Zero(1), next;
  for (Eigen::Index k = 0; k < data.rows(); ++k) {
    if (k % 7 == 0) u = test::randomVector(generator, 1, 2.0);
    data.values.row(k) << state[0] + noise(generator), u[0];
    local.advance(state, u, Vector(0), next);
    state = next;
  }
  data.outputs[0].lower = data.values.col(0).minCoeff();
  data.outputs[0].upper = data.values.col(0).maxCoeff();
  return data;
}

void freeRunFit() {
  std::mt19937_64 generator(3);
  const TsModel truth = test::randomModel(generator, {1, 1, 0, 4, 2, 0, 2, 0});
  const DataSet data = recordOf(truth, generator);
  const OutputModel& shape = truth.submodels.front();
  const Regression rows = makeRegression(data, shape.regressors, shape.antecedents, 0);
  RuleFit fit;
  const OutputModel linear = fitLinear(rows, shape.regressors, fit);
  ConsequentParams params;
  params.free_run_iterations = 10;
  int iterations = 0;
  const auto fitted = [&] {
    OutputModel model = shape;
    iterations = fitFreeRun(data, 0, linear, params, model).iterations;
  };
  fitted();
  const int runs = 4 * iterations;  // free and one step, with derivatives and without
  printPairs(
      "fit to free runs, 1000 rows, 4 rules, 24 unknowns, " + std::to_string(iterations) + " steps",
      std::to_string(runs) + " free runs of its model", "0.5", fitted, [&] {
        for (int i = 0; i < runs; ++i) predictFreeRun(truth, data);
      });
}

}  // namespace
}  // namespace fpc::bench

int main() {
  fpc::bench::iteratedLaw();
  fpc::bench::branchAndBound();
  fpc::bench::freeRunFit();
  return 0;
}
