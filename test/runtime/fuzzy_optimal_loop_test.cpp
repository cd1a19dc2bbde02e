// Loops of controller type fuzzy_optimal: what is read, and what is refused before anything runs.
#include <gtest/gtest.h>

#include "control/fuzzy_lq/law.hpp"
#include "runtime/loop_fixture.hpp"

namespace fpc {
namespace loop_fuzzy_optimal_loop_test {

LoopFile read(const Overrides& overrides) { return readLoop("mimo_cstr_steps", overrides); }

int predictionSteps(const LoopFile& loop) {
  return loop.controllerParams<FuzzyOptimalParams>().prediction_steps;
}

TEST(FuzzyOptimalLoop, RulesStartFromTheWeightsOfAll) {
  const LoopFile loop =
      read({{"controller.rules", "[{weight_move: {q: 1e-6}}, {}, {weight_output: {T: 2}}, {}]"},
            {"controller.weight_move", "{q: 3, qc: 4}"}});
  const FuzzyOptimalTuning& tuning = loop.controllerParams<FuzzyOptimalParams>().tuning;
  ASSERT_EQ(tuning.rules.size(), 4U);
  EXPECT_EQ(tuning.rules[0].move, (Vector(2) << 1e-6, 4.0).finished());
  EXPECT_EQ(tuning.rules[1].move, (Vector(2) << 3.0, 4.0).finished());
  EXPECT_EQ(tuning.rules[2].output, (Vector(2) << 1.0, 2.0).finished());
  EXPECT_EQ(tuning.input_target, loop.simulation.actuator.initial);
}

TEST(FuzzyOptimalLoop, OneWeightOfOneRuleIsAKeyForTuning) {
  const LoopFile loop = read({{"controller.rules", "[{}, {}, {}, {weight_move: {qc: 5}}]"},
                              {"controller.rules.3.weight_move.qc", "0.25"}});
  EXPECT_EQ(loop.controllerParams<FuzzyOptimalParams>().tuning.rules[3].move[1], 0.25);
}

TEST(FuzzyOptimalLoop, TheOptimizerFixesTheLengthOfThePrediction) {
  EXPECT_EQ(predictionSteps(readLoop("mimo_cstr_steps_clp")), 20);
  EXPECT_EQ(predictionSteps(read({})), 1);
}

TEST(FuzzyOptimalLoop, MistakesAreNamed) {
  const auto error = [](const std::string& key, const std::string& value) {
    return errorOf([&] { read({{key, value}}); });
  };
  expectWords(error("controller.move_steps", "6"), {"controller.move_steps", "horizon_steps"});
  expectWords(error("controller.rules", "[{}, {}]"), {"controller.rules", "4 rules"});
  expectWords(error("controller.rules", "[{weight_moves: 1}]"), {"weight_moves"});
  expectWords(error("controller.disturbance", "aside"), {"controller.disturbance", "inside"});
  expectWords(error("controller.weight_output", "0"), {"controller.weight_output"});
  expectWords(error("model", "{}"), {"model.file", "fuzzy_optimal"});
  expectWords(errorOf([] {
                readLoop("asp_case1_general", {{"controller", "{type: fuzzy_optimal}"}});
              }),
              {"model.file", "submodels.x", "share one premise partition"});
  expectWords(errorOf([] {
                readLoop("column_clp", {{"controller", "{type: fuzzy_optimal, horizon_steps: 1}"}});
              }),
              {"controller.horizon_steps", "effect"});
}

}  // namespace loop_fuzzy_optimal_loop_test
}  // namespace fpc
