#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "base/random.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "runtime/contract.hpp"
#include "runtime/factory.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr std::uint32_t kSettled = 30, kWhole = 60;  // samples
constexpr double kSameInput = 1e-9;                  // of an input's range
constexpr double kBump = 1e-6;                       // likewise

std::string atSample(std::uint32_t k, const std::string& words) {
  return "sample " + std::to_string(k) + ": " + words;
}

/// What breaks a promise.
struct Broken {
  std::string words;
};
void expect(bool holds, const std::string& words) {
  if (!holds) throw Broken{words};
}

/// Any value, also far outside of what the sensor can show.
Vector anywhere(const std::vector<SignalInfo>& signals, std::mt19937_64& engine) {
  Vector values(static_cast<Index>(signals.size()));
  for (std::size_t i = 0; i < signals.size(); ++i) {
    const bool bounded = std::isfinite(signals[i].lower) && std::isfinite(signals[i].upper);
    const double lower = bounded ? signals[i].lower : -1e3,
                 upper = bounded ? signals[i].upper : 1e3;
    values[static_cast<Index>(i)] = lower + (2.0 * uniform(engine) - 0.5) * (upper - lower);
  }
  return values;
}

class ControllerContract {
 public:
  explicit ControllerContract(const LoopFile& loop) : loop_(loop) {}

  void isWhatItsRegistrationSays() {
    const ControllerType& type = loop_.controllerType();
    expect(!type.summary.empty(), "it has no summary");
    ControllerSession session = makeSession(loop_);
    expect(session.controller().needsModel() == type.needs_model, "needsModel()");
    expect(session.controller().followsSetpoint() == !type.open_loop, "followsSetpoint()");
    bool predicted = false;
    run(session, loop_, 5, [&](const Measurement& now) {
      predicted = predicted || session.answer().has_prediction;
      expect(session.output().ok, atSample(now.header.step, "no answer of the law"));
    });
    expect(predicted == type.predicts, type.predicts ? "no prediction came" : "it predicts");
  }

  void keepsItsLimits() {
    LoopFile loop = loop_;
    const InputLimits& limits = loop.simulation.actuator.limits;
    const bool any_input =
        makeSession(loop).controller().mayBeSent(0.5 * (limits.lower + limits.upper));
    const Vector range = ranges();
    if (any_input) loop.simulation.actuator.limits.move = 0.1 * range;
    ControllerSession session = makeSession(loop);
    Measurement now = makeSimulation(loop).measurement();
    now.header.run_id = 1;
    std::mt19937_64 engine = seededEngine(7, {});
    const Vector slack = kSameInput * range;
    for (std::uint32_t k = 0; k < kWhole; ++k) {
      now.header.step = k;
      now.header.time_ns += 1;
      now.outputs = anywhere(loop.plant_info.outputs, engine);
      now.disturbances = anywhere(loop.plant_info.disturbances, engine);
      expect(session.receive(now) == Receipt::kAnswered, atSample(k, "no answer"));
      const Vector& sent = session.answer().base.input;
      expect(sent.allFinite(), atSample(k, "an input that is not finite"));
      const Vector& given = session.output().ok ? session.output().input : sent;
      for (const Vector& u :
           {given, sent}) {  // the law itself, before the session's net; and behind
        expect((u.array() >= (limits.lower - slack).array()).all() &&
                   (u.array() <= (limits.upper + slack).array()).all(),
               atSample(k, "an input beyond its bounds"));
        expect(
            !any_input ||
                ((u - now.input_applied).cwiseAbs().array() <= (limits.move + slack).array()).all(),
            atSample(k, "a move beyond its limit"));
      }
      expect(session.controller().mayBeSent(sent), atSample(k, "an input that may not be sent"));
      now.input_applied = sent;
    }
  }

  void holdsWithoutData() {
    LoopFile loop = loop_;
    loop.plausibility.bridge_samples = 0;
    ControllerSession session = makeSession(loop);
    Simulation plant = makeSimulation(loop);
    plant.reset(1);
    play(plant, session, kSettled, [](const Measurement&) {});
    Measurement bad = plant.measurement();
    const auto& needs = loop.plausibility.needs;
    const auto needed = std::find(needs.begin(), needs.end(), true) - needs.begin();
    expect(needed < bad.outputs.size(), "it needs no output (signal_use)");
    bad.outputs[needed] = std::nan("");
    expect(session.receive(bad) == Receipt::kAnswered, "no answer without data");
    expect(session.answer().base.input == bad.input_applied &&
               session.answer().base.source == ActionSource::kHeld &&
               !session.answer().has_prediction,
           "the input is not held without data");
    plant.advance(bad.input_applied);
    session.receive(plant.measurement());
    expect(session.output().ok, "after missing data: no answer of the law");
    for (int missed = 0; missed < 3; ++missed) plant.advance(session.answer().base.input);
    session.receive(plant.measurement());
    expect(session.output().ok, "after missed samples: no answer of the law");
  }

  /// A person moves the inputs for five samples, beside a twin that sees the same samples and was
  /// never interrupted: back from manual the input stays where the person left it, or goes where
  /// the twin's goes.
  void handsOverWithoutABump() {
    ControllerSession session = makeSession(loop_), twin = makeSession(loop_);
    const InputLimits& limits = loop_.simulation.actuator.limits;
    double bump = 0.0;
    run(session, loop_, kSettled + 6, [&](const Measurement& now) {
      const std::uint32_t k = now.header.step;
      twin.receive(now);
      if (k + 1 == kSettled) {
        session.manual(true);
        Vector elsewhere = (now.input_applied + 0.05 * (limits.upper - limits.lower).cwiseMin(1e6))
                               .cwiseMin(limits.upper)
                               .cwiseMax(limits.lower);
        session.controller().makeSendable(elsewhere);
        session.manualInput(elsewhere);
      }
      if (k + 1 == kSettled + 5) session.manual(false);
      const Vector& sent = session.answer().base.input;
      if (k == kSettled + 5)
        bump =
            std::min(distance(sent, now.input_applied), distance(sent, twin.answer().base.input));
    });
    expect(bump <= kBump, "back from manual it bumps by " + exactText(bump) + " of the range");
  }

  void repeatsItself() {
    ControllerSession session = makeSession(loop_), twin = makeSession(loop_);
    run(session, loop_, kWhole, [&](const Measurement& now) {
      twin.receive(now);
      expect(twin.answer().base.input == session.answer().base.input,
             atSample(now.header.step, "a twin sends something else"));
    });
  }

  void showsItsSettings() {
    const ControllerType& type = loop_.controllerType();
    ControllerSession session = makeSession(loop_), twin = makeSession(loop_);
    const Settings shown = session.controller().settings();
    expect(shown.size() == type.settings.size(), "settings() has other keys than the table");
    for (std::size_t i = 0; i < shown.size(); ++i)
      expect(shown[i].first == type.settings[i].key && !type.settings[i].description.empty(),
             shown[i].first + " is not the key of the table, or has no description");
    if (shown.empty()) return expect(!session.retune({{"kp", "1"}}), "it retunes without settings");
    run(twin, loop_, kWhole, [&](const Measurement& now) {
      expect(now.header.step != kSettled || session.retune(shown), "its own settings are refused");
      session.receive(now);
      expect(distance(session.answer().base.input, twin.answer().base.input) <= kSameInput,
             atSample(now.header.step, "its own settings move the input"));
    });
    expect(session.controller().settings() == shown, "its own settings change when taken");
  }

  void refusesNonsense() {
    ControllerSession session = makeSession(loop_);
    const Settings shown = session.controller().settings();
    if (shown.empty()) return;
    const auto refused = [&](const std::string& key, const std::string& text) {
      try {
        session.retune({{key, text}});
        return false;
      } catch (const InputError&) {
        return true;
      }
    };
    expect(refused("no_such_key", "1"), "a key that it does not have is taken");
    for (const auto& [key, text] : shown)
      expect(refused(key, "much") && refused(key, ""), key + ": words are taken for a number");
    expect(session.controller().settings() == shown, "what was refused changed something");
  }

 private:
  static ControllerSession makeSession(const LoopFile& loop) {
    ControllerSession session = makeControllerSession(loop);
    if (session.controller().needsModel()) session.setModel(loop.model);
    return session;
  }
  Vector ranges() const {
    const InputLimits& limits = loop_.simulation.actuator.limits;
    return (limits.upper - limits.lower).unaryExpr([](double w) {
      return std::isfinite(w) && w > 0.0 ? w : 1.0;
    });
  }
  double distance(const Vector& a, const Vector& b) const {
    return ((a - b).array() / ranges().array()).abs().maxCoeff();
  }
  /// `also` sees every sample before its answer is applied.
  template <typename Also>
  static void play(Simulation& plant, ControllerSession& session, std::uint32_t samples,
                   Also also) {
    while (plant.measurement().header.step < samples) {
      const Measurement& now = plant.measurement();
      expect(session.receive(now) == Receipt::kAnswered, atSample(now.header.step, "no answer"));
      also(now);
      plant.advance(session.answer().base.input);
    }
  }
  template <typename Also>
  static void run(ControllerSession& session, const LoopFile& loop, std::uint32_t samples,
                  Also also) {
    Simulation plant = makeSimulation(loop);
    plant.reset(1);
    play(plant, session, samples, also);
  }

  const LoopFile& loop_;
};

}  // namespace

std::vector<Promise> controllerPromises(const LoopFile& loop) {
  require(!loop.external_plant && loop.simulation.samples > kWhole, loop.name,
          "a simulated plant and more than 60 samples");
  const std::pair<const char*, void (ControllerContract::*)()> all[] = {
      {"the object is what its registration says", &ControllerContract::isWhatItsRegistrationSays},
      {"limits hold whatever is measured", &ControllerContract::keepsItsLimits},
      {"missing data hold the input, and it goes on", &ControllerContract::holdsWithoutData},
      {"back from manual without a bump", &ControllerContract::handsOverWithoutABump},
      {"the same samples give the same bits", &ControllerContract::repeatsItself},
      {"settings are those of the table", &ControllerContract::showsItsSettings},
      {"settings without sense are refused", &ControllerContract::refusesNonsense}};
  std::vector<Promise> promises;
  for (const auto& [name, ask] : all) {
    ControllerContract contract(loop);
    std::string broken;
    try {
      (contract.*ask)();
    } catch (const Broken& b) {
      broken = b.words;
    } catch (const std::exception& e) {
      broken = std::string("it throws: ") + e.what();
    }
    promises.push_back({name, broken});
  }
  return promises;
}

}  // namespace fpc
