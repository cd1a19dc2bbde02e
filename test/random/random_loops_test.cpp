// Properties of every loop that a user could write, on seeded random loops (random_loop.hpp). A few
// hundred run in every test; FMBPC_LONG_TESTS runs thousands, FMBPC_RANDOM_FIRST=N begins with seed
// N, FMBPC_RANDOM_SEED=N is one alone, and FMBPC_RANDOM_DIR=folder leaves them all there as files.
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <sstream>

#include "fmbpc/base/text.hpp"
#include "fmbpc/control/registry.hpp"
#include "random/random_parts.hpp"
#include "random/run_checks.hpp"
#include "runtime/loop_fixture.hpp"
#include "runtime/report.hpp"
#include "runtime/run.hpp"
#include "study/run_judgement.hpp"

namespace fpc {
namespace random_random_loops_test {

constexpr std::uint64_t kQuick = 120;
constexpr std::uint64_t kLong = 6000;

std::vector<std::uint64_t> seeds(std::uint64_t quick = kQuick) {
  if (const char* one = std::getenv("FMBPC_RANDOM_SEED")) return {std::stoull(one)};
  std::vector<std::uint64_t> all(std::getenv("FMBPC_LONG_TESTS") != nullptr ? kLong * quick / kQuick
                                                                            : quick);
  const char* first = std::getenv("FMBPC_RANDOM_FIRST");
  std::iota(all.begin(), all.end(), first != nullptr ? std::stoull(first) : 0);
  return all;
}

class RandomLoops : public LoopFolder {
 protected:
  LoopFile read(const RandomLoop& random, const Overrides& overrides = {}) const {
    for (const auto& [name, content] : random.files) write(name, content);
    return readLoop(write("random_" + std::to_string(random.seed) + ".yaml", random.text),
                    overrides);
  }

  /// Calls `check` with every loop that is read, and its run. What is thrown beyond reading is a
  /// failure: a file that was accepted runs.
  template <typename Check>
  void each(const std::vector<std::uint64_t>& all, Check check) {
    for (const std::uint64_t seed : all) {
      one(randomLoop(seed), check);
      if (HasFailure()) return;  // one loop is enough to look at
    }
  }

  template <typename Check>
  void one(const RandomLoop& random, Check check) {
    std::string stage = "reading";
    try {
      const LoopFile loop = read(random);
      stage = "running";
      check(random, loop, runLoop(loop));
    } catch (const InputError& e) {
      if (stage == "reading")
        refused_[random.plant + " under " + random.controller].push_back(e.what());
      else
        ADD_FAILURE() << stage << ": " << e.what() << "\n" << random.told();
    } catch (const std::exception& e) {
      ADD_FAILURE() << stage << ": " << e.what() << "\n" << random.told();
    }
  }

  std::map<std::string, std::vector<std::string>> refused_;
};

TEST_F(RandomLoops, EndWithFiniteFiguresOrANamedFailureInsideAllLimits) {
  std::map<std::string, int> ran, plants;
  std::size_t plain = 0;
  each(seeds(), [&](const RandomLoop& random, const LoopFile& loop, const RunRecord& record) {
    ++ran[random.controller];
    ++plants[loop.simulation.plant];
    const Summary summary = summarize(loop, record, 0.0);
    EXPECT_EQ(record.samples.size(), loop.simulation.samples + std::size_t{1}) << random.told();
    EXPECT_TRUE(record.complete || !troubleOf(summary).empty()) << random.told();
    EXPECT_EQ(notFinite(record), "") << random.told();
    EXPECT_EQ(beyondLimits(loop, record), "") << random.told();
    EXPECT_EQ(summary.input_violations + summary.move_violations, 0U) << random.told();
    if (isPlain(loop, record)) {
      ++plain;
      EXPECT_EQ(beyondMoves(loop, record), "") << random.told();
    }
    for (const auto& u : summary.inputs) EXPECT_TRUE(std::isfinite(u.travel)) << random.told();
    for (const auto& y : summary.outputs)
      EXPECT_TRUE(std::isfinite(y.rmse) || loop.controllerType().open_loop) << random.told();
  });
  std::size_t refused = 0;
  for (const auto& [kind, errors] : refused_) {
    refused += errors.size();
    std::cout << errors.size() << " refused, " << kind << ": " << errors.front() << "\n";
  }
  for (const auto& [controller, count] : ran) std::cout << controller << ": " << count << " runs\n";
  std::cout << plain << " runs in which nothing but the law acted\n";
  if (seeds().size() < kQuick) return;
  EXPECT_GT(plain, seeds().size() / 10) << "moves by commands alone are checked in too few runs";
  EXPECT_LT(refused, seeds().size() / 20) << "the generator writes files that a user would not";
  for (const auto& type : controllerNames()) EXPECT_GT(ran[type], 0) << type;
  for (const auto& type : plantNames()) EXPECT_GT(plants[type], 0) << type;
}

// A new type needs no line in this folder: its first shipped loop is enough.
TEST_F(RandomLoops, OfATypeWithoutAGeneratorAreItsShippedOnesShortened) {
  for (const std::string& type : controllerNames())
    for (const std::uint64_t seed : {0, 1, 2}) {
      const auto check = [&](const RandomLoop& random, const LoopFile& loop, const RunRecord& run) {
        EXPECT_EQ(loop.controllerType().name, type);
        EXPECT_EQ(run.samples.size(), loop.simulation.samples + std::size_t{1}) << random.told();
        EXPECT_LE(loop.simulation.samples, 40U);
        EXPECT_EQ(notFinite(run) + beyondLimits(loop, run), "") << random.told();
      };
      one(randomShippedLoop(type, seed), check);
    }
  EXPECT_TRUE(refused_.empty()) << refused_.begin()->first << ": "
                                << refused_.begin()->second.front();
}

TEST_F(RandomLoops, OfTypesWithoutAGeneratorAreDrawnOftenEnough) {
  const std::vector<std::string> types{"nmpc", "pi"};
  std::map<std::string, int> drawn;
  for (std::uint64_t seed = 0; seed < kQuick; ++seed)
    for (const std::string& type : types)
      if (randomLoop(seed, types).text == randomShippedLoop(type, seed).text) ++drawn[type];
  for (const std::string& type : types) EXPECT_GT(drawn[type], 3) << type;
}

TEST_F(RandomLoops, OfAPlantWithoutARowAreSampledAsItsShippedOne) {
  EXPECT_EQ(shippedSampleTime("surge_tank"), 0.1);
  EXPECT_EQ(shippedSampleTime("nobody ships this"), 0.0);
}

TEST_F(RandomLoops, GiveTheSameBitsAgainFromTheirPrintedTextAndAtAnotherTime) {
  each(seeds(40), [&](const RandomLoop& random, const LoopFile& loop, const RunRecord& record) {
    EXPECT_EQ(firstDifference(record, runLoop(loop)), -1) << "again\n" << random.told();
    EXPECT_EQ(firstDifference(record, runLoop(parseLoop(loop.resolved, loop.name))), -1)
        << "printed\n"
        << random.told();
    LoopFile later = loop;
    later.simulation.start_time_s = 86400.25;
    EXPECT_EQ(firstDifference(record, runLoop(later)), -1) << "later\n" << random.told();
  });
}

/// Values of `from` put in the order of `to`.
Vector reordered(const Vector& values, const std::vector<std::string>& from,
                 const std::vector<std::string>& to) {
  Vector result(values.size());
  for (std::size_t i = 0; i < to.size(); ++i)
    result[static_cast<Eigen::Index>(i)] =
        values[std::find(from.begin(), from.end(), to[i]) - from.begin()];
  return result;
}

/// Without noise, that of the sensors included.
Overrides calm(const RandomLoop& random) {
  Overrides overrides{{"noise", "{}"}};
  const std::size_t sensors = random.text.find("\nsensors:\n");
  if (sensors == std::string::npos) return overrides;
  std::istringstream lines(random.text.substr(sensors + 10));
  for (std::string line; std::getline(lines, line) && line.rfind("  ", 0) == 0;)
    if (line.find("noise_std") != std::string::npos)
      overrides.emplace_back("sensors." + line.substr(2, line.find(':') - 2) + ".noise_std", "0");
  return overrides;
}

// Left out: noise, which is drawn in the order of the outputs; a particle swarm and a search over
// sequences, which may take another of two equal answers; the law `published`, which follows the
// last output by definition.
TEST_F(RandomLoops, DoNotDependOnTheOrderOfTheOutputs) {
  int compared = 0;
  for (const std::uint64_t seed : seeds(40)) {
    const RandomLoop random = randomLoop(seed);
    const std::set<std::string> unordered{"swarm_mpc", "hybrid_mpc"};
    const bool last = random.text.find("law: published") != std::string::npos;
    if (random.outputs.size() < 2 || unordered.count(random.controller) > 0 || last) continue;
    const std::vector<std::string> turned(random.outputs.rbegin(), random.outputs.rend());
    const Overrides given = calm(random);
    Overrides other = given;
    other.emplace_back("plant.outputs", "[" + join(turned) + "]");
    std::string error;
    try {
      const RunRecord a = runLoop(read(random, given));
      const RunRecord b = runLoop(read(random, other));
      for (std::size_t k = 0; k < a.samples.size(); ++k) {
        const Vector &u = a.samples[k].measurement.input_applied,
                     &v = b.samples[k].measurement.input_applied;
        const Vector y = a.samples[k].measurement.outputs;
        const Vector z = reordered(b.samples[k].measurement.outputs, turned, random.outputs);
        ASSERT_LE((u - v).norm(), 1e-6 * (1e-3 + u.norm())) << k << "\n" << random.told();
        ASSERT_LE((y - z).norm(), 1e-6 * (1e-3 + y.norm())) << k << "\n" << random.told();
      }
      ++compared;
    } catch (const InputError& e) {
      error = e.what();  // the first property tells what is refused
    }
  }
  if (seeds(40).size() >= 40) EXPECT_GT(compared, 8);
}

/// `other`, of which the first is in `unit`, bit for bit; what is no number is none in both.
bool sameBits(const Vector& plain, Vector other, double unit) {
  other[0] *= unit;
  return ((plain.array() == other.array()) || (plain.array().isNaN() && other.array().isNaN()))
      .all();
}

// Powers of two, so that not a single bit may differ.
TEST_F(RandomLoops, DoNotDependOnTheUnitsOfAnOutputOrAnInput) {
  for (const std::uint64_t seed : seeds(40)) {
    const RandomLoop random = randomMatrixLoop(seed);
    const RunRecord plain = runLoop(read(random));
    for (const auto& [output, input] :
         {std::pair{1024.0, 1.0}, {0.125, 1.0}, {1.0, 64.0}, {0.25, 0.5}}) {
      const RandomLoop other = randomMatrixLoop(seed, output, input);
      const RunRecord scaled = runLoop(read(other));
      for (std::size_t k = 0; k < plain.samples.size(); ++k) {
        const Measurement &a = plain.samples[k].measurement, &b = scaled.samples[k].measurement;
        ASSERT_TRUE(sameBits(a.outputs, b.outputs, output)) << k << ", unit " << output << "\n"
                                                            << other.told();
        ASSERT_TRUE(sameBits(a.input_applied, b.input_applied, input))
            << k << ", unit " << input << "\n"
            << other.told();
      }
    }
  }
}

// As degrees Celsius and kelvin: a setpoint of 0 is like any other, for laws, guards and indices.
TEST_F(RandomLoops, DoNotDependOnWhereAnOutputHasItsZero) {
  for (const std::uint64_t seed : seeds(60)) {
    const LoopFile loop = read(randomMatrixLoop(seed));
    const double zero = loop.setpoint.initial[0];
    const RandomLoop other = randomMatrixLoop(seed, 1.0, 1.0, zero);
    const LoopFile moved = read(other);
    ASSERT_EQ(moved.setpoint.initial[0], 0.0) << other.told();
    const RunRecord plain = runLoop(loop), shifted = runLoop(moved);
    for (std::size_t k = 0; k < plain.samples.size(); ++k) {
      const Measurement &a = plain.samples[k].measurement, &b = shifted.samples[k].measurement;
      ASSERT_NEAR(a.outputs[0], b.outputs[0] + zero, 1e-6 * (1.0 + std::abs(a.outputs[0])))
          << k << "\n"
          << other.told();
      ASSERT_LE((a.input_applied - b.input_applied).norm(), 1e-6 * (1.0 + a.input_applied.norm()))
          << k << "\n"
          << other.told();
    }
    const Summary here = summarize(loop, plain, 0.0), there = summarize(moved, shifted, 0.0);
    ASSERT_NEAR(here.outputs[0].ise, there.outputs[0].ise, 1e-4 * (1.0 + here.outputs[0].ise))
        << other.told();
    EXPECT_EQ(lockedSamples(loop, plain, 4), lockedSamples(moved, shifted, 4)) << other.told();
    EXPECT_EQ(contains(here.events, EventCode::kInputAtLimit),
              contains(there.events, EventCode::kInputAtLimit))
        << other.told();
  }
}

TEST_F(RandomLoops, CanBeWrittenToAFolder) {
  const char* folder = std::getenv("FMBPC_RANDOM_DIR");
  const std::filesystem::path target = folder != nullptr ? folder : path("all");
  for (const std::uint64_t seed : seeds(20)) {
    const RandomLoop random = randomLoop(seed);
    const auto place = target / ("random_" + std::to_string(seed));
    std::filesystem::create_directories(place);
    std::ofstream(place / "loop.yaml") << random.text;
    for (const auto& [name, content] : random.files) std::ofstream(place / name) << content;
    EXPECT_EQ(randomLoop(seed).told(), random.told()) << "the same seed, the same text";
  }
}

}  // namespace random_random_loops_test
}  // namespace fpc
