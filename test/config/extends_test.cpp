// Loop files that extend others, overrides, and the one text that comes of them.
#include <gtest/gtest.h>

#include "control/fmbpc/law.hpp"
#include "control/pi/pi.hpp"
#include "runtime/loop_fixture.hpp"

namespace fpc {
namespace config_extends_test {

using Extends = LoopFolder;
using Resolve = LoopFolder;

TEST_F(Extends, MappingsMergeListsAndScalarsReplace) {
  write("parent.yaml", smallLoop() + "seed: 5\nnoise: {std: {s: 1, x: 2}}\n");
  const std::string child =
      write("child.yaml",
            "extends: parent\nnoise: {std: {x: 3}}\nsetpoint: {schedule: [{time_h: 1, s: 60}]}\n");
  const LoopFile loop = readLoop(child);
  EXPECT_EQ(loop.simulation.noise_seed, 5U);
  EXPECT_EQ(loop.simulation.noise_std, (Vector(2) << 1, 3).finished());
  EXPECT_EQ(loop.setpoint.schedule.size(), 1U);
  const LoopFile other =
      readLoop(child, {{"setpoint.schedule", "[{time_h: 2, x: 1}, {time_h: 3, x: 2}]"}});
  EXPECT_EQ(other.setpoint.schedule.size(), 2U);
}

TEST_F(Extends, ASectionWhoseTypeChangesIsReplacedAsAWhole) {
  write("parent.yaml", smallLoop());
  const std::string child = write("child.yaml",
                                  "extends: parent\nmodel: {file: fm_1.yaml}\n"
                                  "controller: {type: fmbpc, coincidence_steps: 4}\n");
  const LoopFile loop = readLoop(child);
  EXPECT_EQ(loop.controllerType().name, "fmbpc");
  EXPECT_EQ(loop.controllerParams<FmbpcParams>().coincidence_steps, 4);
  EXPECT_THROW(loop.controllerParams<PiParams>(), InputError);
}

TEST_F(Extends, GoesThroughSeveralFilesAndTheConfigFolders) {
  write("a.yaml", "extends: asp_case1\nsampling: {duration_h: 4}\n");
  write("b.yaml", "extends: a.yaml\ntitle: b\n");
  const LoopFile loop = readLoop(path("b.yaml"));
  EXPECT_EQ(loop.report.title, "b");
  EXPECT_EQ(loop.simulation.samples, 20U);
  EXPECT_EQ(loop.controllerParams<FmbpcParams>().coincidence_steps, 6);
}

TEST_F(Extends, AnOverrideChangesThePlaceThatItNamesAndNoAliasOfIt) {
  const std::string file = write("alias.yaml", smallLoop() +
                                                   "noise: {std: &both {s: 1, x: 2}}\n"
                                                   "report: {output_lower: *both}\n");
  const LoopFile plain = readLoop(file);
  EXPECT_EQ(plain.report.output_lower, (std::vector<double>{1, 2}));
  const LoopFile changed = readLoop(file, {{"noise.std.s", "7"}});
  EXPECT_EQ(changed.simulation.noise_std, (Vector(2) << 7, 2).finished());
  EXPECT_EQ(changed.report.output_lower, (std::vector<double>{1, 2}));
  EXPECT_EQ(changed.resolved.find('*'), std::string::npos) << changed.resolved;
  const LoopFile again = parseLoop(smallLoop() +
                                       "noise: {std: &both {s: 1, x: 2}}\n"
                                       "report: {output_lower: *both}\n",
                                   "text", {{"noise.std.x", "5"}});
  EXPECT_EQ(again.report.output_lower, (std::vector<double>{1, 2}));
}

TEST_F(Extends, ASecondDocumentIsAnError) {
  const std::string file = write("two.yaml", smallLoop() + "---\nnoise: {std: {s: 1}}\n");
  expectWords(errorOf([&] { readLoop(file); }), {"two.yaml:1", "one YAML document"});
  EXPECT_EQ(readLoop(write("end.yaml", smallLoop() + "...\n")).name, "end");
  const std::string stray = write("stray.yaml", "plant: {type: cstr}\n---\n,  type: cstr}\n");
  expectWords(errorOf([&] { readLoop(stray); }), {"stray.yaml", "one YAML document"});
}

TEST_F(Extends, AliasesWithoutEndAreErrors) {
  const std::string own = write("own.yaml", smallLoop() + "noise: &n {std: *n}\n");
  expectWords(errorOf([&] { readLoop(own); }), {"own.yaml", "alias"});
  std::string bomb = smallLoop() + "noise:\n  a: &a [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]\n";
  for (char c = 'b'; c < 'k'; ++c) {
    const std::string before(1, static_cast<char>(c - 1));
    bomb += std::string("  ") + c + ": &" + c + " [";
    for (int i = 0; i < 10; ++i) bomb += (i > 0 ? ", *" : "*") + before;
    bomb += "]\n";
  }
  const std::string file = write("bomb.yaml", bomb);
  expectWords(errorOf([&] { readLoop(file); }), {"bomb.yaml", "1000000 values"});
}

TEST_F(Extends, CirclesAreErrors) {
  const std::string a = write("a.yaml", "extends: b\n");
  write("b.yaml", "extends: a\n");
  expectWords(errorOf([&] { readLoop(a); }), {path("b.yaml") + ":1: extends", "no cycle"});
  const std::string own = write("own.yaml", "title: x\nextends: own\n");
  expectWords(errorOf([&] { readLoop(own); }), {own + ":2: extends", "no cycle"});
}

TEST_F(Extends, AMissingParentIsNamed) {
  const std::string file = write("a.yaml", "extends: nobody\n");
  expectWords(errorOf([&] { readLoop(file); }),
              {file + ":1: extends", "got 'nobody'", "asp_case1"});
  const std::string list = write("l.yaml", "extends: [a, b]\n");
  expectWords(errorOf([&] { readLoop(list); }), {list + ":1: extends", "one loop file"});
}

/// Read as nothing, a section whose lines are commented out would lose the limits it inherits.
TEST_F(Extends, AKeyWithoutAValueOverASectionIsAnError) {
  const std::string file = write("a.yaml", "extends: heated_tank\nactuator:\n  # move_upper: 3\n");
  expectWords(errorOf([&] { readLoop(file); }),
              {file + ":2: actuator: ", "expected a mapping", "got nothing", "leave the key out"});
  const std::string inner = write("b.yaml", "extends: heated_tank\nactuator:\n  move_upper: ~\n");
  expectWords(errorOf([&] { readLoop(inner); }), {inner + ":3: actuator.move_upper: "});
  for (const char* nothing : {"null", "~"})
    expectWords(errorOf([&] {
                  readLoop("heated_tank", {{"actuator", nothing}});
                }),
                {"--set actuator: ", "got nothing", "leave it out", "actuator={}"});
  const std::string grandchild = write("c.yaml", "extends: a\ntitle: c\n");
  expectWords(errorOf([&] { readLoop(grandchild); }), {file + ":2: actuator: "});
}

TEST_F(Extends, AnEmptyMappingKeepsAndAnEmptySectionOverNothingIsNone) {
  const LoopFile tank = readLoop("heated_tank");
  const auto same = [&](const LoopFile& loop) {
    return loop.simulation.actuator.limits.move == tank.simulation.actuator.limits.move;
  };
  EXPECT_TRUE(same(readLoop(write("a.yaml", "extends: heated_tank\nactuator: {}\n"))));
  EXPECT_TRUE(same(readLoop(write("b.yaml", "extends: heated_tank\nguard:\nclp:\n"))));
  for (const char* none : {"", "guard:\n  # lock_samples: 6\n", "guard: ~\n"})
    EXPECT_EQ(
        readLoop(write("g.yaml", "extends: heated_tank\n" + std::string(none))).guard.lock_samples,
        0)
        << none;
  EXPECT_EQ(readLoop("heated_tank", {{"guard", "{}"}}).guard.lock_samples, 0);
  EXPECT_FALSE(same(readLoop("heated_tank", {{"actuator", "{}"}}))) << "begins with the defaults";
  EXPECT_TRUE(readLoop("asp_case1_clp").has_clp);
  EXPECT_FALSE(readLoop(write("c.yaml", "extends: asp_case1_clp\nclp: false\n")).has_clp);
  EXPECT_FALSE(readLoop("asp_case1_clp", {{"clp", "false"}}).has_clp);
}

TEST_F(Resolve, OverridesReachScalarsItemsAndNewKeys) {
  const std::string file = write("loop.yaml", smallLoop());
  const LoopFile loop = readLoop(file, {{"controller.loops.0.kp", "2.5"},
                                        {"noise.std.x", "1.5"},
                                        {"actuator", "{move_upper: {q_r: 20}}"},
                                        {"loop.wait_for", "[]"}});
  EXPECT_EQ(loop.controllerParams<PiParams>().loops.at(0).kp, 2.5);
  EXPECT_EQ(loop.simulation.noise_std[1], 1.5);
  EXPECT_EQ(loop.simulation.actuator.limits.move[0], 20.0);
  EXPECT_TRUE(loop.exchange.wait_for.empty());
}

TEST_F(Resolve, ALaterOverrideWinsAndATypeTakesTheOldKeysAway) {
  const Overrides twice = {{"controller.coincidence_steps", "3"},
                           {"controller.coincidence_steps", "4"}};
  EXPECT_EQ(readLoop("asp_case1", twice).controllerParams<FmbpcParams>().coincidence_steps, 4);
  const Overrides pi = {{"controller.type", "pi"},
                        {"controller.loops", "[{input: q_r, output: s, kp: 1}]"}};
  EXPECT_EQ(readLoop("asp_case1", pi).controllerType().name, "pi");
}

TEST_F(Resolve, NumbersStayAsTheyWereWritten) {
  const std::string text =
      resolveLoop("asp_case1", {{"plant.integrator.relative_tolerance", "1e-6"}});
  EXPECT_NE(text.find("relative_tolerance: 1e-6\n"), std::string::npos) << text;
  EXPECT_NE(text.find("absolute_tolerance: 1e-8\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("extends"), std::string::npos);
}

TEST_F(Resolve, TheTextNamesFilesSoThatAnotherMachineFindsThem) {
  const std::string text = resolveLoop(
      "asp_case1", {{"model.identify.structure", "asp_d.yaml"}, {"model.identify.after", "200"}});
  EXPECT_NE(text.find("file: fm_1.yaml\n"), std::string::npos) << text;
  EXPECT_NE(text.find("structure: asp_d.yaml\n"), std::string::npos) << text;
  EXPECT_TRUE(std::filesystem::path(parseLoop(text, "here").model_file).is_absolute());
}

TEST_F(Resolve, AFileOfAPersonKeepsItsPlace) {
  const std::string model = path("mine.yaml");
  std::filesystem::copy(readLoop("asp_case1").model_file, model);
  const std::string text = resolveLoop("asp_case1", {{"model.file", model}});
  EXPECT_NE(text.find("file: " + model + "\n"), std::string::npos) << text;
  EXPECT_EQ(parseLoop(text, "here").model_file, model);
}

TEST_F(Resolve, TheTextReadsBackToItself) {
  const LoopFile loop = readLoop("asp_clp_1c");
  const std::string file = write("again.yaml", loop.resolved);
  EXPECT_EQ(resolveLoop(file), loop.resolved);
  const LoopFile again = parseLoop(loop.resolved, "again");
  EXPECT_EQ(again.clp.increment_upper, loop.clp.increment_upper);
  EXPECT_EQ(again.simulation.initial_state, loop.simulation.initial_state);
  EXPECT_EQ(again.model_file, loop.model_file);
}

TEST_F(Resolve, FilesAreFoundBesideTheFileThatNamesThem) {
  write("week.csv", "t,q\n0,1000\n1,1200\n2,1100\n3,1000\n4,900\n");
  const std::string csv =
      "disturbance:\n  source: csv\n  csv:\n    file: week.csv\n    time_column: t\n"
      "    channels: {q_i: {column: q}}\n";
  write("parent.yaml", smallLoop() + csv);
  std::filesystem::create_directory(path("below"));
  const std::string child = write("below/child.yaml", "extends: ../parent.yaml\n");
  EXPECT_EQ(readLoop(child).disturbance.csv.file, path("week.csv"));
}

TEST_F(Resolve, VariablesAreExpandedInFileKeys) {
  write("week.csv", "t,q\n0,1000\n1,1200\n2,1100\n3,1000\n4,900\n");
  setenv("FMBPC_TEST_FOLDER", folder_.c_str(), 1);
  const std::string file =
      write("loop.yaml", smallLoop() +
                             "disturbance:\n  source: csv\n  csv:\n    file: "
                             "${FMBPC_TEST_FOLDER}/week.csv\n    time_column: t\n"
                             "    channels: {q_i: {column: q}}\n");
  EXPECT_EQ(readLoop(file).disturbance.csv.file, path("week.csv"));
  unsetenv("FMBPC_TEST_FOLDER");
  expectWords(errorOf([&] { readLoop(file); }),
              {file + ":15: disturbance.csv.file", "FMBPC_TEST_FOLDER to be set"});
}

TEST_F(Resolve, AMistakeInTheRecordNamesLoopAndRecord) {
  write("week.csv", "t,q\n0,1000\n1,\n2,1100\n3,1000\n4,900\n");
  const std::string csv =
      "disturbance:\n  source: csv\n  csv:\n    file: week.csv\n    time_column: t\n"
      "    channels: {q_i: {column: q}}\n";
  const std::string file = write("loop.yaml", smallLoop() + csv);
  expectWords(errorOf([&] { readLoop(file); }),
              {file + ":12: disturbance", path("week.csv"), "column 'q'", "missing"});
  EXPECT_EQ(readLoop(file, {{"disturbance.csv.missing", "hold"}}).disturbance.csv.missing,
            MissingCells::kHold);
}

TEST_F(Resolve, UserFoldersComeFirst) {
  std::filesystem::create_directory(path("loop"));
  write("loop/asp_case1.yaml", smallLoop() + "title: mine\n");
  setenv("FMBPC_CONFIG_PATH", folder_.c_str(), 1);
  EXPECT_EQ(readLoop("asp_case1").report.title, "mine");
  unsetenv("FMBPC_CONFIG_PATH");
  EXPECT_NE(readLoop("asp_case1").report.title, "mine");
}

TEST_F(Resolve, SampleLinesGiveTheTransportDelay) {
  const std::string file =
      write("loop.yaml",
            smallLoop() +
                "tf:\n  frames:\n    lab: {parent: reactor, position: [3, 4, 0]}\n"
                "  sample_lines:\n    - {output: x, from: reactor, to: lab, velocity_m_s: 0.5}\n");
  const LoopFile loop = readLoop(file);
  EXPECT_EQ(loop.simulation.output_delay_s, (std::vector<double>{0.0, 10.0}));
  EXPECT_EQ(loop.tf.sample_lines.at(0).to, "lab");
}

TEST_F(Resolve, TheExchangeWaitsForTheNodesTheLoopNeeds) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(readLoop("asp_case1_clp").exchange.wait_for,
            (Names{"loop_recorder", "fmbpc_controller", "fuzzy_identifier", "clp_optimizer"}));
  EXPECT_EQ(readLoop("asp_case1_pi_x").exchange.wait_for,
            (Names{"loop_recorder", "fmbpc_controller"}));
}

}  // namespace config_extends_test
}  // namespace fpc
