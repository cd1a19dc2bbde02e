// Loops of the hybrid law: lists of inputs, windows and consumption as people write them,
// and what is refused.
#include <cmath>

#include "control/hybrid/hybrid_mpc.hpp"
#include "runtime/loop_fixture.hpp"
#include "runtime/report.hpp"
#include "runtime/run.hpp"

namespace fpc {
namespace loop_hybrid_loop_test {

LoopFile read(const Overrides& overrides) { return readLoop("batch_fuzzy_eq45", overrides); }

TEST(HybridLoop, WindowsAndConsumptionAreSumsOverTheRecord) {
  const LoopFile loop =
      read({{"sampling.duration_h", "0.5"},
            {"report.windows", "[{name: w, output: T, between_s: [600, 1200]}, {name: v}]"},
            {"report.windows.1.between_s", "[0, 0]"}});
  const RunRecord record = runLoop(loop);
  const Summary summary = summarize(loop, record, 0.0);
  ASSERT_EQ(summary.windows.size(), 3U);  // w of T, v of T, v of Tw
  double sum = 0.0, water = 0.0;
  for (std::size_t k = 60; k <= 120; ++k)
    sum += std::pow(record.samples[k].measurement.outputs[0] - 62.0, 2);
  for (std::size_t k = 1; k <= 180; ++k)
    water += 37.4 * record.samples[k].measurement.input_applied[0];
  EXPECT_EQ(summary.windows[0].samples, 61U);
  EXPECT_NEAR(summary.windows[0].rmse, std::sqrt(sum / 61.0), 1e-9);
  EXPECT_LT(summary.windows[0].mean_error, 0.0);
  EXPECT_EQ(summary.windows[1].samples, 1U);
  ASSERT_EQ(summary.consumption.size(), 1U);
  EXPECT_NEAR(summary.consumption[0].second, water, 1e-9 * water);
  const std::string json = toJson(summary);
  for (const char* key : {"\"windows\"", "\"water_kg\"", "\"switches\"", "\"travel\""})
    EXPECT_NE(json.find(key), std::string::npos) << key;
}

TEST(HybridLoop, MistakesAreNamed) {
  const auto error = [](const std::string& key, const std::string& value) {
    return errorOf([&] { read({{key, value}}); });
  };
  expectWords(error("controller.inputs", "[]"), {"controller.inputs", "a list"});
  expectWords(error("controller.inputs", "[{kM: 0, kC: 0}]"), {"controller.inputs[0]", "kH"});
  expectWords(error("controller.inputs.1.kM", "0"), {"controller.inputs", "only once"});
  expectWords(error("controller.inputs.0.kM", "2"), {"inputs", "bounds"});
  expectWords(error("controller.cost.switching.0.before", "kX"), {"one of kM, kC, kH"});
  expectWords(error("controller.cost.tracking", "{T: -1}"), {"controller.cost.tracking.T"});
  expectWords(error("actuator.fallback", "{kM: 0.5}"), {"fallback", "controller.inputs"});
  expectWords(error("report.windows", "[{name: w, between_s: [2, 1]}]"),
              {"report.windows[0].between_s"});
  expectWords(error("report.consumption", "{steps: {kM: 1}}"), {"report.consumption.steps"});
  expectWords(error("model", "{}"), {"model.file", "hybrid_mpc"});
}

}  // namespace loop_hybrid_loop_test
}  // namespace fpc
