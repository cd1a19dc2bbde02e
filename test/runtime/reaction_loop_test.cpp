// Doubts that concern no single signal: an input that the outputs do not react to, a plant that
// announces other bounds.
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

TEST(Reaction, TheLoopFileSaysWhatIsDone) {
  for (const auto& [word, source] :
       {std::pair{"hold", ActionSource::kHeld}, std::pair{"fallback", ActionSource::kFallback}}) {
    BlindValve valve(Overrides{{"plausibility.reaction", word}});
    valve.live(95, false);
    valve.live(150, true);
    EXPECT_EQ(valve.session().answer().base.source, source) << word;
    EXPECT_TRUE(valve.session().output().events.has(EventCode::kActuatorIneffective));
    valve.session().manual(true);
    valve.session().manual(false);
    EXPECT_EQ(valve.session().reaction().code, EventCode::kNone);
  }
}

bool acts(const ControllerSession& session) {
  const ActionSource source = session.answer().base.source;
  return source == ActionSource::kBase || source == ActionSource::kClipped;
}

TEST(PlantBounds, AreHeldAgainstTheLoopFileAsItSays) {
  for (const std::string word : {"say", "hold", "fallback"}) {
    const LoopFile loop = readLoop(
        "asp_case1", {{"plausibility.plant_bounds", word}, {"actuator.fallback.q_r", "300"}});
    ControllerSession session = makeControllerSession(loop);
    session.setModel(loop.model);
    session.doubtPlant("plant_info: q_r may be 0..900, the loop file says 0..1600");
    Measurement m = makeSimulation(loop).measurement();
    ASSERT_EQ(session.receive(m), Receipt::kAnswered);
    EXPECT_EQ(acts(session), word == "say") << word;
    EXPECT_EQ(session.fellBack(), word == "fallback") << word;
    session.doubtPlant("");
    ++m.header.step;
    m.header.time_ns += 720'000'000'000;
    ASSERT_EQ(session.receive(m), Receipt::kAnswered);
    EXPECT_TRUE(acts(session)) << word;
  }
}

TEST(PlantBounds, AFallbackMustBeThere) {
  PlausibilityParams params;
  EXPECT_NO_THROW(params.validate(1, 0, 1));
  params.plant_bounds = DoubtAction::kFallback;
  expectWords(errorOf([&] { params.validate(1, 0, 1); }),
              {"plausibility.plant_bounds", "actuator.fallback"});
  params.fallback = Vector::Zero(1);
  EXPECT_NO_THROW(params.validate(1, 0, 1));
}

}  // namespace loop_reaction_loop_test
}  // namespace fpc
