#include "runtime/run_plant.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "fmbpc/base/input_error.hpp"
#include "runtime/loop_exchange.hpp"
#include "runtime/plan.hpp"

namespace fpc {
namespace {

namespace fs = std::filesystem;

Eigen::Index stepsOf(const RunRecord& record) {
  return static_cast<Eigen::Index>(record.samples.size());
}

double outputOf(const RunRecord& record, std::size_t step) {
  return record.samples.at(step).measurement.outputs[0];
}

double integralOfError(const RunRecord& record, double setpoint, std::size_t from) {
  double sum = 0.0;
  for (std::size_t k = from; k < record.samples.size(); ++k)
    sum += std::abs(outputOf(record, k) - setpoint);
  return sum;
}

/// The shipped plant with keys over all loops.
PlantLoops vessel(const Overrides& set = {}) { return readPlantLoops("jacketed_vessel", set); }

LoopFile& loopOf(PlantLoops& plant, const std::string& name) {
  for (PlantLoop& one : plant.loops)
    if (one.name == name) return one.loop;
  throw std::out_of_range(name);
}

void setJacket(PlantLoops& plant, const Overrides& set) {
  LoopFile& jacket = loopOf(plant, "jacket");
  jacket = parseLoop(jacket.resolved, "jacket", set);
}

std::size_t indexOf(const PlantLoops& plant, const std::string& name) {
  for (std::size_t i = 0; i < plant.loops.size(); ++i)
    if (plant.loops[i].name == name) return i;
  return plant.loops.size();
}

std::string errorOf(const std::string& text) {
  const fs::path file =
      fs::temp_directory_path() / ("plant_" + std::to_string(::getpid()) + ".yaml");
  std::ofstream(file) << text;
  std::string words;
  try {
    readPlantLoops(file.string());
  } catch (const InputError& error) {
    words = error.what();
  }
  fs::remove(file);
  EXPECT_EQ(words.substr(0, file.string().size()), file.string()) << words;
  return words;
}

TEST(RunPlant, LoopsWithoutLinksAreTheRunsOfEach) {
  PlantLoops plant = vessel();
  for (PlantLoop& one : plant.loops) one.links.clear();
  const auto records = runPlant(plant);
  for (std::size_t i = 0; i < records.size(); ++i) {
    const RunRecord alone = runLoop(plant.loops[i].loop);
    ASSERT_EQ(alone.samples.size(), records[i].samples.size());
    for (std::size_t k = 0; k < alone.samples.size(); ++k)
      ASSERT_EQ(outputOf(alone, k), outputOf(records[i], k)) << plant.loops[i].name << " " << k;
  }
}

// The preheater's sample j is at the time of the jacket's; what it says there is in force a sample
// later.
TEST(RunPlant, AnOutputOfOneLoopDisturbsAnotherOneSampleLater) {
  const PlantLoops plant = vessel();
  const auto records = runPlant(plant);
  const RunRecord& jacket = records[indexOf(plant, "jacket")];
  const RunRecord& preheater = records[indexOf(plant, "preheater")];
  ASSERT_GT(stepsOf(jacket), 100);
  for (std::size_t k = 1; k < jacket.samples.size(); ++k)
    ASSERT_EQ(0.375 * outputOf(preheater, k - 1), jacket.samples[k].state.disturbances[0]) << k;
}

TEST(RunPlant, TheOuterLoopsInputIsTheInnerOnesSetpointAndItsPlantGetsTheInnerOutput) {
  const PlantLoops plant = vessel();
  const auto records = runPlant(plant);
  const RunRecord& outer = records[indexOf(plant, "vessel")];
  const RunRecord& inner = records[indexOf(plant, "jacket")];
  for (std::size_t k = 0; k + 1 < outer.samples.size(); ++k) {  // two inner samples in an outer one
    ASSERT_EQ(outer.samples[k].base.input[0], inner.samples[2 * k].tracking.setpoint[0]) << k;
    ASSERT_EQ(outer.samples[k].base.input[0], inner.samples[2 * k + 1].tracking.setpoint[0]) << k;
    ASSERT_EQ(outputOf(inner, 2 * k), outer.samples[k + 1].measurement.input_applied[0]) << k;
  }
  EXPECT_NEAR(45.0, outputOf(outer, 295), 0.1);
  EXPECT_NEAR(40.0, outputOf(outer, 600), 0.1);
}

// The jacket's heater is so small that 45 degrees are out of reach. The outer law goes on from
// where the inner loop is, or from its last command where that one moved along (MoveOrigin): what
// it asks for stays within two move limits, and is below the jacket as soon as 40 are asked.
TEST(RunPlant, AnOuterLoopDoesNotWindUpAgainstTheLimitsOfTheInnerOne) {
  PlantLoops plant = vessel();
  setJacket(plant, {{"actuator.input_upper", "{heat: 6}"}});
  const auto records = runPlant(plant);
  const RunRecord& outer = records[indexOf(plant, "vessel")];
  const RunRecord& inner = records[indexOf(plant, "jacket")];
  constexpr std::size_t kBack = 300;                                           // 5 h
  ASSERT_EQ(6.0, inner.samples[2 * kBack - 40].measurement.input_applied[0]);  // at its limit
  ASSERT_LT(outputOf(outer, kBack - 1), 44.0);
  for (std::size_t k = kBack - 60; k < kBack; ++k)
    ASSERT_NEAR(outputOf(inner, 2 * k), outer.samples[k].base.input[0], 2 * 4.0 + 1e-9) << k;
  EXPECT_LT(outer.samples[kBack].base.input[0], outputOf(inner, 2 * kBack));
  EXPECT_LT(integralOfError(outer, 40.0, 540), 60 * 0.1);  // the last hour
}

// While a person has the inner loop, the outer one is where the inner output is; what it asks for
// first when the inner loop follows again is no further away than its move limit.
TEST(RunPlant, AnOuterLoopStartsWhereTheInnerOneIs) {
  PlantLoops plant = vessel();
  RunOptions options;
  LoopExchange outer(plant.loops[indexOf(plant, "vessel")].loop, options,
                     plant.loops[indexOf(plant, "vessel")].links);
  Measurement at;
  const Vector by_hand = Vector::Constant(1, 61.0);  // of the jacket, in a person's hands
  for (int k = 0; k < 200; ++k) {
    at = outer.measurement();
    for (const int half : {1, 0}) {  // the jacket has two samples in one of the vessel
      StepHeader inner{at.header.time_ns - half * std::int64_t{30'000'000'000}, 1,
                       2 * at.header.step - static_cast<std::uint32_t>(half)};
      if (k > 0 || half == 0) outer.hear("jacket", LoopLink::Of::kOutputs, inner, by_hand);
    }
    ASSERT_TRUE(outer.mayAnswer() && outer.mayAdvance());
    outer.step();
  }
  const RunRecord record = outer.take();
  const SampleRecord& last = record.samples.at(150);
  EXPECT_EQ(61.0, last.measurement.input_applied[0]);
  EXPECT_NEAR(61.0, last.base.input[0], 4.0 + 1e-9);
}

TEST(RunPlant, BadFilesNameFileKeyAndWhatWasExpected) {
  const std::string loops = "loops: {a: {loop: heated_tank}, b: {loop: heated_tank}}\n";
  // c: does not look ahead; d: no disturbance of the name; e: another sample time
  const std::string tanks =
      "loops: {a: {loop: four_tanks_left}, b: {loop: four_tanks_right}, c: {loop: four_tanks_left, "
      "set: {controller: {type: fmbpc, law: general}}}, d: {loop: four_on_two}, e: {loop: "
      "heated_tank}, f: {loop: four_tanks_left, set: {clp.perturbation_steps: 60}}}\n";
  for (const auto& [text, key] : std::vector<std::pair<std::string, std::string>>{
           {"title: nothing\n", "loops"},
           {"loops: {a b: {loop: heated_tank}}\n", "loops.a b"},
           {"loops: {a: {}}\n", "loops.a.loop"},
           {"loops: {a: {loop: nowhere}}\n", "loops.a.loop"},
           {"loops: {a: {loop: heated_tank, set: {sampling.sample_time_s: -1}}}\n", "loops.a.loop"},
           {"loops: {a: {loop: heated_tank, isolated: true}}\n", "loops.a.isolated"},
           {"pace: slow\n" + loops, "pace"},
           {"speedup: 0\n" + loops, "speedup"},
           {loops + "links: [{from: a/T}]\n", "links[0].to"},
           {loops + "links: [{from: c/T, to: b/T_in}]\n", "links[0].from"},
           {loops + "links: [{from: a/none, to: b/T_in}]\n", "links[0].from"},
           {loops + "links: [{from: a/T, to: b/T}]\n", "links[0].to"},
           {loops + "links: [{from: a/T, to: a/T_in}]\n", "links[0].to"},
           {loops + "links: [{from: a/T, to: b/T_in, gain: .inf}]\n", "links[0].gain"},
           {loops + "links: [{from: a/T, to: b/T_in}, {from: a/T, to: b/T_in}]\n", "links[1].to"},
           {loops + "cascades: [{outer: a/heat, inner: b/T_in}]\n", "cascades[0].inner"},
           {loops + "cascades: [{outer: a/T, inner: b/T}]\n", "cascades[0].outer"},
           {"loops: {a: {loop: asp_case1_clp, set: {actuator.move_upper: {q_r: .inf}}}, b: {loop: "
            "heated_tank}}\n"
            "cascades: [{outer: a/q_r, inner: b/T}]\n",
            "cascades[0].outer"},
           {loops + "cascades: [{outer: a/heat, inner: a/T}]\n", "cascades[0].inner"},
           {"loops: {a: {loop: jacketed_vessel}, b: {loop: heated_tank, set: {setpoint.upper: {T: "
            "70}}}}\n"
            "cascades: [{outer: a/T_jacket, inner: b/T}]\n",
            "cascades[0].outer"},
           {tanks + "links: [{from: a/h1, to: b/v1, plan: true}]\n", "links[0].plan"},
           {tanks + "links: [{from: d/q1, to: b/v1, plan: true}]\n", "links[0].plan"},
           {tanks + "links: [{from: e/heat, to: b/v1, plan: true}]\n", "links[0].plan"},
           {tanks + "links: [{from: b/v2, to: c/v2, plan: true}]\n", "links[0].plan"},
           {tanks + "links: [{from: f/v1, to: b/v1, plan: true}]\n", "links[0].plan"},
           {tanks + "links: [{from: a/v1, to: b/v1, plan: true, plan_until_h: -1}]\n",
            "links[0].plan_until_h"},
           {tanks + "links: [{from: a/v1, to: b/v1, plan_until_h: 1}]\n", "links[0].plan_until_h"},
           {loops + "feeds: []\n", "feeds"}}) {
    const std::string error = errorOf(text);
    EXPECT_NE(std::string::npos, error.find(": " + key + ": ")) << text << error;
  }
}

// Row 1 of a plan of three samples, times 2 plus 1, at most 8.
TEST(RunPlant, APlanCountsAtTheSampleAfterItAndNoOther) {
  LoopLink link;
  link.from = "other";
  link.of = LoopLink::Of::kPlan;
  link.to = LoopLink::To::kForecast;
  link.index = 1;
  link.every_ns = 10;
  link.first_ns = 0;
  link.last_ns = 50;
  link.name = "d";
  link.gain = 2.0;
  link.offset = 1.0;
  link.upper = 8.0;
  Matrix plan(2, 3), nan = plan;
  plan << 9.0, 9.0, 9.0, 1.0, 2.0, 4.0;
  nan << 9.0, 9.0, 9.0, 1.0, std::nan(""), 4.0;
  const Vector expected = (Vector(3) << 3.0, 5.0, 8.0).finished();
  for (const bool lockstep : {true, false}) {
    LinkInbox inbox({link}, LinkInbox::Of::kController, lockstep);
    const auto headerAt = [](std::int64_t time_ns) {
      return StepHeader{time_ns, 1, static_cast<std::uint32_t>(time_ns / 10)};
    };
    const auto hear = [&](std::int64_t time_ns, const Matrix& said) {
      inbox.hear("other", LoopLink::Of::kPlan, headerAt(time_ns), said);
    };
    const auto ask = [&](std::int64_t time_ns, bool planned = true) {
      inbox.hear("other", LoopLink::Of::kInputs, headerAt(time_ns), Vector::Ones(2), planned);
    };
    const auto plans = [&](std::int64_t time_ns) {
      std::vector<Vector> found;
      inbox.plans(time_ns, [&](const std::string& name, VectorRef ahead) {
        EXPECT_EQ("d", name);
        found.emplace_back(ahead);
      });
      return found;
    };
    EXPECT_TRUE(inbox.ready(0)) << "there is no plan before the first sample";
    EXPECT_EQ(!lockstep, inbox.ready(10));
    EXPECT_TRUE(plans(0).empty());
    hear(0, plan);
    EXPECT_EQ(!lockstep, inbox.ready(10)) << "its action may be of another hand";
    ask(0);
    EXPECT_TRUE(inbox.ready(10));
    EXPECT_EQ(std::vector<Vector>{expected}, plans(10));
    EXPECT_TRUE(plans(20).empty()) << "an old one";
    ask(10);
    EXPECT_EQ(!lockstep, inbox.ready(20));
    hear(10, nan);
    EXPECT_TRUE(inbox.ready(20));
    EXPECT_TRUE(plans(20).empty());
    ask(20, false);
    EXPECT_TRUE(inbox.ready(30)) << "a person has the input: there is no plan";
    hear(20, plan);
    EXPECT_TRUE(plans(30).empty());
    ask(30);
    hear(30, plan.topRows(1));
    EXPECT_TRUE(inbox.ready(40));
    EXPECT_TRUE(plans(40).empty());
    for (const std::int64_t time_ns : {40, 50}) {
      hear(time_ns, plan);
      ask(time_ns);
    }
    EXPECT_EQ(1u, plans(60).size());
    if (!lockstep) {  // whoever does not look for long finds the latest one
      for (const std::int64_t time_ns : {41, 43, 42}) {
        hear(time_ns, time_ns == 43 ? plan : nan);
        ask(time_ns);
      }
      EXPECT_EQ(std::vector<Vector>{expected}, plans(60));
    }
    hear(60, plan);  // after the last one that counts
    ask(60);
    EXPECT_TRUE(plans(70).empty());
    EXPECT_TRUE(inbox.ready(90));
    EXPECT_FALSE(inbox.command(90).has_value()) << "a plan is no command";
  }
}

TEST(RunPlant, PlansOfALawWithFeedbackAreRolledOut) {
  PredictiveAction action;
  action.state = (Vector(1) << 2.0).finished();
  action.A = (Matrix(1, 1) << 0.5).finished();
  action.B = action.K = (Matrix(1, 1) << 1.0).finished();
  action.offset_state = (Vector(1) << 0.25).finished();
  action.feedforward = (Matrix(1, 3) << 1.0, 2.0, 3.0).finished();
  // u = ff - x: -1, then x = 1 - 1 + 0.25, u = 1.75, x = 0.125 + 1.75 + 0.25
  EXPECT_EQ((Matrix(1, 3) << -1.0, 1.75, 0.875).finished(), planOf(action));
  action.K.setZero();
  EXPECT_EQ(action.feedforward, planOf(action));
}

TEST(RunPlant, PlansOfTheOtherSideLowerTheErrorAndEndWhenTheyAreCut) {
  const auto run = [](const std::string& rest) {
    const fs::path file =
        fs::temp_directory_path() / ("pair_" + std::to_string(::getpid()) + ".yaml");
    std::ofstream(file)
        << "loops: {left: {loop: four_tanks_left}, right: {loop: four_tanks_right}}\n"
           "links: [{from: right/v2, to: left/v2" +
               rest + "}, {from: left/v1, to: right/v1" + rest + "}]\n";
    auto records = runPlant(readPlantLoops(file.string(), {{"loop.pace", "lockstep"}}));
    fs::remove(file);
    return records;
  };
  const auto input = [](const std::vector<RunRecord>& of, std::size_t k) {
    return of[1].samples.at(k).base.input[0];
  };
  const auto talk = run(", plan: true"), silent = run(""),
             cut = run(", plan: true, plan_until_h: 0.26");
  const auto error = [](const std::vector<RunRecord>& of) {
    double sum = 0.0;
    for (std::size_t side = 0; side < 2; ++side)
      for (const SampleRecord& sample : of[side].samples)
        sum += std::pow(sample.measurement.outputs[0] - sample.tracking.setpoint[0], 2.0);
    return sum;
  };
  EXPECT_LT(error(talk), 0.95 * error(silent));
  // The last plan that counts is that of sample 187.
  for (std::size_t k = 0; k <= 188; ++k) EXPECT_EQ(input(talk, k), input(cut, k)) << k;
  EXPECT_NE(input(talk, 189), input(cut, 189));
}

TEST(RunPlant, LinksAsTextAreTheSame) {
  std::vector<PlantLoop> loops = vessel().loops;
  for (PlantLoop& one : readPlantLoops("four_tanks").loops) loops.push_back(std::move(one));
  for (const PlantLoop& one : loops) {
    const auto again = parseLinks(textOf(one.links), "links");
    ASSERT_EQ(one.links.size(), again.size());
    for (std::size_t i = 0; i < again.size(); ++i) {
      const LoopLink &a = one.links[i], &b = again[i];
      EXPECT_EQ(std::tie(a.from, a.of, a.index, a.every_ns, a.reach_ns, a.first_ns, a.last_ns, a.to,
                         a.name, a.gain, a.offset, a.lower, a.upper),
                std::tie(b.from, b.of, b.index, b.every_ns, b.reach_ns, b.first_ns, b.last_ns, b.to,
                         b.name, b.gain, b.offset, b.lower, b.upper));
    }
  }
}

}  // namespace
}  // namespace fpc
