// What every type of controller promises, whatever it is: checked on the first shipped loop of each
// registered type.
#include <gtest/gtest.h>

#include "allocation_counter.hpp"
#include "config/plugins.hpp"
#include "paths.hpp"
#include "runtime/contract.hpp"
#include "runtime/factory.hpp"
#include "runtime/loops_of_type.hpp"

namespace fpc {
namespace loop_controller_contract_test {

constexpr std::uint32_t kSettle = 30, kRun = 60;  // samples

class ControllerContract : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    const auto loops = loopsOfType(GetParam());
    ASSERT_FALSE(loops.empty()) << "a shipped loop with controller.type " << GetParam();
    loop_ = readLoop(loops.front(), withoutRecords(loops.front()));
    ASSERT_GT(loop_.simulation.samples, kRun) << loop_.name;
  }
  ControllerSession makeSession() const {
    ControllerSession session = makeControllerSession(loop_);
    if (session.controller().needsModel()) session.setModel(loop_.model);
    return session;
  }
  LoopFile loop_;
};

/// Runs the plant under one session; `also` sees every sample before its answer is applied.
template <typename Also>
void run(Simulation& plant, ControllerSession& session, std::uint32_t samples, Also also) {
  while (plant.measurement().header.step < samples) {
    const Measurement& now = plant.measurement();
    ASSERT_EQ(session.receive(now), Receipt::kAnswered);
    also(now);
    plant.advance(session.answer().base.input);
  }
}

TEST_P(ControllerContract, KeepsWhatEveryTypePromises) {
  for (const Promise& promise : controllerPromises(loop_))
    EXPECT_EQ(promise.broken, "") << promise.name;
}

TEST_P(ControllerContract, AStepDoesNotAllocate) {
  if (!testing::AllocationCounter::works()) GTEST_SKIP() << "a sanitizer owns malloc";
  ControllerSession session = makeSession();
  Simulation plant = makeSimulation(loop_);
  plant.reset(1);
  run(plant, session, kSettle, [](const Measurement&) {});
  std::size_t allocations = 0;
  for (std::uint32_t k = kSettle; k < kRun; ++k) {
    const Measurement now = plant.measurement();
    testing::AllocationCounter counter;
    session.receive(now);
    allocations += counter.count();
    plant.advance(session.answer().base.input);
  }
  EXPECT_EQ(allocations, 0U);
}

std::string nameOf(const ::testing::TestParamInfo<std::string>& type) { return type.param; }

/// Ours, and those of the example of a user's package.
std::vector<std::string> everyType() {
  setenv("FMBPC_CONFIG_PATH", (sourceDir() + "/examples/two_tanks/config").c_str(), 1);
  setenv("FMBPC_PLUGIN_PATH", FMBPC_TEST_PLUGINS, 1);
  loadPlugin("two_tanks", "test");
  return controllerNames();
}

INSTANTIATE_TEST_SUITE_P(Types, ControllerContract, ::testing::ValuesIn(everyType()), nameOf);

TEST(ControllerRegistry, HoldsTheTypesThatShip) {
  for (const char* type : {"fmbpc", "fuzzy_optimal", "pi", "excitation"})
    EXPECT_EQ(controllerType(type).name, type);
  EXPECT_GE(controllerNames().size(), 9U);
  expectWords(errorOf([] { controllerType("magic"); }), {"controller.type 'magic'", "fmbpc"});
}

TEST(ControllerRegistry, ANameIsTakenOnlyOnce) {
  EXPECT_FALSE(registerControllerReader({"pi", "another"}, nullptr));
  EXPECT_NE(controllerType("pi").summary, "another");
}

TEST(ControllerRegistry, ParametersOfAnotherTypeAreNotGuessed) {
  struct Other {};
  const LoopFile loop = readLoop(loopsOfType("pi").front());
  expectWords(errorOf([&] { loop.controllerParams<Other>(); }),
              {loop.name, "controller.type", "pi"});
  EXPECT_EQ(findParams<Other>(*loop.controller), nullptr);
}

}  // namespace loop_controller_contract_test
}  // namespace fpc
