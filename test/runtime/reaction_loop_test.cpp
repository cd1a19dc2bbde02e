// An input that the outputs do not react to.
#include <utility>

#include "runtime/factory.hpp"
#include "runtime/loop_fixture.hpp"

namespace fpc {
namespace loop_reaction_loop_test {

/// The stirred tank with a valve that nobody reads back: the command is taken for what is in force.
class BlindValve {
 public:
  explicit BlindValve(const Overrides& more)
      : loop_(readLoop("cstr_tracking", with(more))),
        plant_(makeSimulation(loop_)),
        session_(makeControllerSession(loop_)) {
    session_.setModel(loop_.model);
    session_.announce(1);
    plant_.reset(1);
    told_ = loop_.simulation.actuator.initial;
  }
  /// Samples until the reaction is missed, or all of them.
  int live(int samples, bool stuck) {
    for (int k = 0; k < samples; ++k) {
      Measurement seen = plant_.measurement();
      seen.input_applied = told_;
      session_.receive(seen);
      told_ = session_.answer().base.input;
      if (stuck) told_where_ = told_where_.size() == 0 ? plant_.actuator().applied() : told_where_;
      plant_.advance(stuck ? told_where_ : told_);
      if (session_.reaction().code != EventCode::kNone) return k + 1;
    }
    return samples;
  }
  ControllerSession& session() { return session_; }

 private:
  static Overrides with(const Overrides& more) {
    Overrides all{{"plausibility.reaction_samples", "60"}, {"actuator.fallback.q_c", "100"}};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  LoopFile loop_;
  Simulation plant_;
  ControllerSession session_;
  Vector told_, told_where_;
};

TEST(Reaction, TheStirredTankIsNotDoubtedAndItsStuckValveIsFound) {
  BlindValve calm(Overrides{});
  EXPECT_EQ(calm.live(399, false), 399);
  EXPECT_EQ(calm.session().reaction().code, EventCode::kNone);
  BlindValve stuck(Overrides{});
  EXPECT_EQ(stuck.live(95, false), 95);
  const int after = stuck.live(150, true);
  EXPECT_LT(after, 120);
  EXPECT_EQ(stuck.session().reaction().code, EventCode::kActuatorIneffective);
  EXPECT_STREQ(stuck.session().reaction().signal, "q_c");
  EXPECT_TRUE(stuck.session().output().events.has(EventCode::kActuatorIneffective));
}

}  // namespace loop_reaction_loop_test
}  // namespace fpc
