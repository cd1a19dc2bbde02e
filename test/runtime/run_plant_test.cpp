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
#include "runtime/loop_ring.hpp"

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
  LoopRing outer(plant.loops[indexOf(plant, "vessel")].loop, options,
                 plant.loops[indexOf(plant, "vessel")].links);
  Measurement at;
  const Vector by_hand = Vector::Constant(1, 61.0);  // of the jacket, in a person's hands
  for (int k = 0; k < 200; ++k) {
    at = outer.measurement();
    for (const int half : {1, 0}) {  // the jacket has two samples in one of the vessel
      StepHeader inner{at.header.time_ns - half * std::int64_t{30'000'000'000}, 1,
                       2 * at.header.step - static_cast<std::uint32_t>(half)};
      if (k > 0 || half == 0) outer.hearMeasurement("jacket", inner, by_hand);
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
           {loops + "links: [{from: a/heat, to: b/T_in}]\n", "links[0].from"},
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
           {loops + "feeds: []\n", "feeds"}}) {
    const std::string error = errorOf(text);
    EXPECT_NE(std::string::npos, error.find(": " + key + ": ")) << text << error;
  }
}

TEST(RunPlant, LinksAsTextAreTheSame) {
  const PlantLoops plant = vessel();
  for (const PlantLoop& one : plant.loops) {
    const auto again = parseLinks(textOf(one.links), "links");
    ASSERT_EQ(one.links.size(), again.size());
    for (std::size_t i = 0; i < again.size(); ++i) {
      const LoopLink &a = one.links[i], &b = again[i];
      EXPECT_EQ(std::tie(a.from, a.action, a.index, a.every_ns, a.reach_ns, a.last_ns, a.to, a.name,
                         a.gain, a.offset, a.lower, a.upper),
                std::tie(b.from, b.action, b.index, b.every_ns, b.reach_ns, b.last_ns, b.to, b.name,
                         b.gain, b.offset, b.lower, b.upper));
    }
  }
}

}  // namespace
}  // namespace fpc
