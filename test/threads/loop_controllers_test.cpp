// Controllers of a hundred different loops in one process, all there at once, stepped by eight
// threads: nothing is shared, so each gives the inputs that it gives alone.
#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <thread>
#include <vector>

#include "config/loop_file.hpp"
#include "runtime/factory.hpp"
#include "runtime/loop_controller.hpp"
#include "runtime/loop_fixture.hpp"

namespace fpc {
namespace loop_controllers_test {

constexpr std::size_t kLoops = 100, kThreads = 8;
constexpr std::uint32_t kSamples = 15;

/// Of the first measurement, which drifts.
std::vector<Vector> inputsOf(LoopController& controller, const LoopFile& loop,
                             const Measurement& first) {
  const SampleClock clock(loop.simulation.sample_time_s, loop.simulation.start_time_s);
  std::vector<Vector> inputs;
  for (std::uint32_t k = 0; k < kSamples; ++k) {
    Measurement now = first;
    now.header = {clock.timeAt(k), 1, k};
    now.outputs *= 1.0 + 1e-3 * k;
    if (k > 0) now.input_applied = inputs.back();
    controller.turnTo(k);
    controller.receive(now);
    inputs.push_back(controller.optimize().input);
    controller.learn(now);
  }
  return inputs;
}

TEST(ControllersInThreads, GiveTheInputsThatTheyGiveAlone) {
  std::vector<LoopFile> loops;
  std::vector<Measurement> first;
  std::vector<std::vector<Vector>> alone, together(kLoops);
  std::vector<std::unique_ptr<LoopController>> controllers;
  for (const std::string& name : loopNames()) {
    if (needsRecords(name) || loops.size() == kLoops) continue;
    LoopFile loop = readLoop(name);
    if (loop.external_plant) continue;
    first.push_back(makeSimulation(loop).reset(1));
    loops.push_back(std::move(loop));
  }
  ASSERT_EQ(loops.size(), kLoops);
  for (std::size_t i = 0; i < kLoops; ++i) {
    LoopController controller(loops[i]);
    alone.push_back(inputsOf(controller, loops[i], first[i]));
    controllers.push_back(std::make_unique<LoopController>(loops[i]));
  }
  std::atomic<std::size_t> next{0};
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < kThreads; ++t)
    threads.emplace_back([&] {
      for (std::size_t i = next++; i < kLoops; i = next++)
        together[i] = inputsOf(*controllers[i], loops[i], first[i]);
    });
  for (std::thread& thread : threads) thread.join();
  for (std::size_t i = 0; i < kLoops; ++i) EXPECT_TRUE(together[i] == alone[i]) << loops[i].name;
}

}  // namespace loop_controllers_test
}  // namespace fpc
