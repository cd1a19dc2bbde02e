// What a person gets for a loop file with a mistake: one line with file, line, key and what was
// expected.
#include <gtest/gtest.h>

#include "runtime/loop_fixture.hpp"

namespace fpc {
namespace config_loop_errors_test {

using LoopErrors = LoopFolder;

TEST_F(LoopErrors, TheSmallLoopHasNone) {
  const LoopFile loop = readLoop(write("small.yaml", smallLoop()));
  EXPECT_EQ(loop.name, "small");
  EXPECT_EQ(loop.controllerType().name, "pi");
  EXPECT_EQ(loop.simulation.samples, 20U);
  EXPECT_FALSE(loop.has_clp);
  EXPECT_FALSE(loop.has_model);
}

TEST_F(LoopErrors, AnIdentifierNeedsNoModelAndIsWaitedFor) {
  const LoopFile loop = readLoop(write(
      "i.yaml", smallLoop() + "model: {identify: {structure: asp_d.yaml, online: {every: 7}}}\n"));
  EXPECT_FALSE(loop.has_model);
  ASSERT_TRUE(loop.has_identify);
  EXPECT_EQ(loop.identify.structure.name, "asp_d");
  EXPECT_TRUE(loop.identify.online.enabled);
  EXPECT_EQ(loop.identify.online.every, 7);
  EXPECT_EQ(loop.exchange.wait_for.back(), "fuzzy_identifier");
}

/// A mistake, written below the small loop or by an override, and the words of its error.
struct Mistake {
  std::string name;
  std::string text;  ///< appended to the file
  std::string set;   ///< "path=value", may be empty
  std::vector<std::string> words;
};

void PrintTo(const Mistake& mistake, std::ostream* stream) { *stream << mistake.name; }

class EveryMistake : public LoopFolder, public ::testing::WithParamInterface<Mistake> {};

TEST_P(EveryMistake, IsNamedInOneLine) {
  const Mistake& mistake = GetParam();
  const std::string file = write("loop.yaml", smallLoop() + mistake.text);
  Overrides overrides;
  if (!mistake.set.empty()) overrides.push_back(parseOverride(mistake.set));
  const std::string error = errorOf([&] { readLoop(file, overrides); });
  for (const auto& word : mistake.words) expectWords(error, {word});
  if (mistake.set.empty()) expectWords(error, {file + ":"});
}

// The small loop has 11 lines; the appended text starts at line 12.
const Mistake kMistakes[] = {
    {"UnknownSection", "actuators: {}\n", "", {":12: actuators: unknown key", "actuator,"}},
    {"UnknownKey", "loop:\n  pacing: fast\n", "", {":13: loop.pacing: unknown key", "pace"}},
    {"UnknownKeyInList",
     "disturbance:\n  commands:\n    - {time_h: 1, name: q_i, value: 2, until: 3}\n",
     "",
     {":14: disturbance.commands[0].until: unknown key", "mode"}},
    {"UnknownSignal", "noise:\n  std: {y: 1}\n", "", {":13: noise.std.y", "one of s, x"}},
    {"WrongSize", "noise:\n  std: [1, 2, 3]\n", "", {":13: noise.std", "a list of 2 numbers"}},
    {"NotANumber",
     "loop:\n  speedup: fast\n",
     "",
     {":13: loop.speedup", "a finite number > 0", "'fast'"}},
    {"NotFinite",
     "actuator:\n  initial: {q_r: .nan}\n",
     "",
     {":13: actuator.initial.q_r", "finite number"}},
    {"InfiniteValue",
     "",
     "setpoint.initial.x=.inf",
     {"--set setpoint.initial.x: expected a finite number"}},
    {"SetpointOutOfRange",
     "",
     "setpoint.initial.x=99999",
     {"--set setpoint.initial.x: expected a setpoint of x", "the range of the plant, got 99999"}},
    {"SetpointOutOfRangeLater",
     "",
     "setpoint.schedule=[{time_h: 1, x: -5}]",
     {"--set setpoint.schedule[0].x: expected a setpoint of x >= 0", "got -5"}},
    {"SetpointOutOfRangeByCommand",
     "",
     "setpoint.commands=[{time_h: 1, name: x, value: 1e6}]",
     {"--set setpoint.commands[0].value: expected a setpoint of x", "got 1e+06"}},
    {"OutOfRange", "", "plant.parameters.yield=2", {"--set plant.parameters.yield", "<= 1"}},
    {"TimeOfACommand",
     "",
     "disturbance.commands=[{time_h: 2e6, name: q_i, value: 1500}]",
     {"--set disturbance.commands[0].time_h", "<= 1e+06"}},
    {"NegativeTime", "", "sampling.sample_time_s=-1", {"--set sampling.sample_time_s", "got '-1'"}},
    {"PartOfASample",
     "",
     "sampling.duration_h=4.1",
     {"--set sampling.duration_h", "whole number of samples of 720 s"}},
    {"NoChoice",
     "",
     "loop.pace=brisk",
     {"--set loop.pace", "lockstep, paced, realtime", "'brisk'"}},
    {"UnknownPlant",
     "",
     "plant.type=reactor",
     {"--set plant.type", "activated_sludge", "external"}},
    {"MissingKey",
     "",
     "controller={type: pi, loops: [{input: q_r, output: x}]}",
     {"controller.loops[0].kp", "a number"}},
    {"UnknownOutput",
     "",
     "controller.loops.0.output=z",
     {"--set controller.loops[0].output", "one of s, x", "'z'"}},
    {"NoSuchItem",
     "",
     "controller.loops.1.kp=1",
     {"--set controller.loops.1.kp", "a number below 1"}},
    {"LowerAboveUpper",
     "actuator:\n  input_lower: {q_r: 900}\n  input_upper: {q_r: 800}\n",
     "",
     {"actuator.input_"}},
    {"MeanOutside",
     "disturbance:\n  source: pattern\n  pattern:\n    channels:\n"
     "      q_i: {shape: flow, range: [700, 2300], mean: 3000}\n",
     "",
     {":16: disturbance.pattern.channels.q_i.mean", "> 700"}},
    {"TimesDecrease",
     "",
     "setpoint.schedule=[{time_h: 2, x: 1}, {time_h: 1, x: 2}]",
     {"--set setpoint.schedule[1].time_h", "do not decrease"}},
    {"CsvWithoutFile",
     "disturbance:\n  source: csv\n",
     "",
     {"disturbance", "csv.file", "CSV file"}},
    {"MissingFile",
     "model: {file: nowhere.yaml}\n",
     "",
     {":12: model.file", "existing file", "'nowhere.yaml'"}},
    {"UnsetVariable",
     "model: {file: '${FMBPC_NOT_SET}/m.yaml'}\n",
     "",
     {":12: model.file", "FMBPC_NOT_SET to be set"}},
    {"OptimizerWithoutPrediction", "clp: {}\n", "", {"controller.type", "fmbpc", "clp: false"}},
    {"MissingStructure",
     "model: {identify: {structure: nowhere.yaml}}\n",
     "",
     {":12: model.identify.structure", "existing file", "'nowhere.yaml'"}},
    {"BadStructure",
     "model: {identify: {structure: loop.yaml}}\n",
     "",
     {":12: model.identify.structure", "loop.yaml"}},
    {"IdentifyWithoutStructure",
     "model: {identify: {after: 100}}\n",
     "",
     {"model.identify.structure", "identify.after"}},
    {"OnlineNever",
     "model: {identify: {online: {every: 0}}}\n",
     "",
     {":12: model.identify.online.every", ">= 1"}},
    {"KeyThatWent",
     "guard: {enabled: false}\n",
     "",
     {":12: guard.enabled", "went", "guard: false"}},
    {"UnitThatWent",
     "",
     "report.windows=[{name: w, to_h: 1}]",
     {"report.windows[0].to_h", "expected between_s"}},
    {"KeyThatWentFromASignal",
     "targets: {outputs: {x: {setpoint_rank: 2}}}\n",
     "",
     {":12: targets.outputs.x.setpoint_rank", "NAME.rank"}},
    {"NoPoleAllowed", "model: {max_pole: 0}\n", "", {":12: model.max_pole", "0"}},
    {"ModelNeeded", "", "controller={type: fmbpc}", {"model.file", "a model file"}},
    {"FramesInACircle",
     "tf:\n  frames:\n    reactor: {parent: settler}\n    settler: {parent: reactor}\n",
     "",
     {"tf.frames", "without a cycle"}},
    {"UnknownFrame",
     "tf:\n  sample_lines:\n    - {output: s, from: reactor, to: moon, velocity_m_s: 1}\n",
     "",
     {":14: tf.sample_lines[0].to", "one of", "'moon'"}},
    {"KeyTwice", "title: a\ntitle: b\n", "", {":13: title", "only once"}},
    {"SectionIsAWord", "noise: loud\n", "", {":12: noise", "a mapping"}},
    {"BadYaml", "noise: [1, 2\n", "", {"valid YAML"}},
};

std::string nameOf(const ::testing::TestParamInfo<Mistake>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Loop, EveryMistake, ::testing::ValuesIn(kMistakes), nameOf);

TEST_F(LoopErrors, APairThatLacksInAModelIsNamed) {
  const auto error = [](const char* key, const char* value) {
    return errorOf([&] { readLoop("column_adaptive", {{key, value}}); });
  };
  expectWords(error("controller.model", "[]"),
              {"--set controller.model: expected an item", "y_D from L lacks", "got []"});
  expectWords(error("controller.model.3.from", "L"), {"controller.model[3].output", "only once"});
  expectWords(error("controller.model.3.gain", "0"), {"controller.model", "x_B from V lacks"});
}

TEST_F(LoopErrors, ARecordWithoutItsSourceIsNoConstant) {
  const std::string csv = "disturbance: {csv: {file: r.csv, time_column: t, channels: ";
  expectWords(
      errorOf([&] {
        readLoop(write("a.yaml", "extends: heated_tank\n" + csv + "{T_in: {column: v}}}}\n"));
      }),
      {"disturbance.csv: expected disturbance.source: csv with it"});
  write("r.csv", "t,v\n0,15\n3,15\n6,15\n");
  const auto channel = [&](const std::string& text) {
    return errorOf([&] {
      readLoop(write("b.yaml", "extends: heated_tank\n" + csv + "{T_in: {" + text + "}}}}\n"),
               {{"disturbance.source", "csv"}});
    });
  };
  expectWords(channel("column: t"), {"T_in.column", "another column", "got 't'"});
  expectWords(channel("column: v, scale: 0"), {"T_in.scale", "other than 0"});
}

TEST_F(LoopErrors, OneSetpointOfAnOutputAtOneTime) {
  const auto error = [](const char* schedule) {
    return errorOf([&] { readLoop("asp_case1_pi_x", {{"setpoint.schedule", schedule}}); });
  };
  expectWords(error("[{time_h: 1, x: 1900}, {time_h: 1, s: 50}, {time_h: 1, x: 2000}]"),
              {"setpoint.schedule[2].x", "one setpoint of x at one time", "got '2000'"});
  EXPECT_EQ(error("[{time_h: 1, x: 1900}, {time_h: 1, s: 50}, {time_h: 2, x: 2000}]"),
            "nothing was thrown");
  EXPECT_EQ(error("[{time_h: 1, x: 1900}, {time_h: 1, x: 2000, ramp_h: 5}]"),
            "nothing was thrown");  // a jump, then a ramp
}

TEST_F(LoopErrors, AValueOfACommandBeyondTheRangeIsRepeated) {
  const auto error = [](const char* command) {
    return errorOf([&] { readLoop("heated_tank", {{"disturbance.commands", command}}); });
  };
  expectWords(error("[{time_h: 0.5, name: T_in, value: 50}]"),
              {"disturbance.commands[0].value", "<= 40 [degC], got 50"});
  expectWords(error("[{time_h: 0.5, name: T_in, value: -60, mode: offset}]"),
              {"disturbance.commands[0].value", "width of its range, got -60"});
}

TEST_F(LoopErrors, ARecordForYearsOfSamplesIsRefusedBeforeItIsMade) {
  const std::string file =
      write("long.yaml", smallLoop() +
                             "disturbance: {source: pattern, pattern: {channels: "
                             "{q_i: {shape: flow, range: [1, 3], mean: 2}}}}\n");
  const Overrides years{{"sampling.duration_h", "9000000"}};
  expectWords(errorOf([&] { readLoop(file, years); }),
              {"sampling.duration_h", "at most 10000000 samples"});
}

TEST_F(LoopErrors, AnEndlessRunNeedsConstantDisturbances) {
  const std::string file = write("loop.yaml", smallLoop());
  EXPECT_EQ(readLoop(file, {{"sampling.duration_h", "0"}}).simulation.samples, 0U);
  const std::string error = errorOf([] { readLoop("asp_case1", {{"sampling.duration_h", "0"}}); });
  expectWords(error, {"asp_case1", "sampling.duration_h", "constant"});
}

TEST_F(LoopErrors, ARecordThatBeginsAfterTheEndIsRefused) {
  const std::string file = write("loop.yaml", smallLoop() + "report:\n  record_from_h: 4\n");
  EXPECT_EQ(readLoop(file).report.record_from_h, 4.0);
  EXPECT_EQ(readLoop(file, {{"sampling.duration_h", "0"}}).report.record_from_h, 4.0);
  expectWords(errorOf([&] {
                readLoop(file, {{"sampling.duration_h", "3"}});
              }),
              {file + ":13: report.record_from_h", "3 h (sampling.duration_h)", "0 records all"});
}

TEST_F(LoopErrors, UnknownLoopsNameTheNearest) {
  expectWords(errorOf([] { readLoop("asp_case_one"); }),
              {"'asp_case_one'", "near:", "asp_case1_own"});
  expectWords(errorOf([&] { readLoop(path("absent.yaml")); }),
              {"absent.yaml", "an existing loop file"});
}

TEST_F(LoopErrors, OverridesNeedAPathAndAValue) {
  expectWords(errorOf([] { parseOverride("loop.pace"); }), {"--set loop.pace", "path=value"});
  expectWords(errorOf([] { parseOverride("=3"); }), {"path=value"});
  EXPECT_EQ(parseOverride("a.b=c=d"), (std::pair<std::string, std::string>("a.b", "c=d")));
}

TEST_F(LoopErrors, AMistakeInAnExtendedFileNamesThatFile) {
  const std::string parent = write("parent.yaml", smallLoop() + "loop:\n  speedup: -3\n");
  const std::string child = write("child.yaml", "extends: parent\ntitle: child\n");
  expectWords(errorOf([&] { readLoop(child); }), {parent + ":13: loop.speedup", "got '-3'"});
}

}  // namespace config_loop_errors_test
}  // namespace fpc
