#include "runtime/report.hpp"
#include "events.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/csv.hpp"
#include "fmbpc/base/text.hpp"
#include "runtime/loop_fixture.hpp"
#include "runtime/recorder_session.hpp"
#include "runtime/run.hpp"

namespace fpc {
namespace loop_report_test {

using Report = LoopFolder;

/// What shortLoop() plays of the schedule of case 1: no entry lies beyond the run.
const std::string kInRun = "[{time_h: 30, x: 2200}]";

LoopFile shortLoop(const std::string& name, Overrides overrides = {}) {
  overrides.emplace_back("sampling.duration_h", "40");
  return readLoop(name, overrides);
}

/// Two samples of one output, whose indices fit on a finger.
RunRecord smallRecord(const LoopFile& loop) {
  RunRecord record = runLoop(loop);
  record.samples.resize(3);
  for (std::size_t k = 0; k < 3; ++k) {
    record.samples[k].measurement.outputs << 55.0 + static_cast<double>(k), 2000.0;
    record.samples[k].tracking.setpoint << 55.0, 2001.0;
    record.samples[k].tracking.reference << 55.0, 2003.0;
    record.samples[k].measurement.input_applied << 700.0 + 10.0 * static_cast<double>(k * k);
  }
  return record;
}

TEST_F(Report, IndicesAreThoseOfTheFormulas) {
  const LoopFile loop = shortLoop("asp_case1_pi_s");
  const Summary summary = summarize(loop, smallRecord(loop), 0.5);
  EXPECT_EQ(summary.outputs[0].ise, 0.0 + 1.0 + 4.0);
  EXPECT_EQ(summary.outputs[0].iae, 3.0);
  EXPECT_NEAR(summary.outputs[0].itae, 0.2 * 1.0 + 0.4 * 2.0, 1e-15);
  EXPECT_EQ(summary.outputs[1].ise_reference, 27.0);
  EXPECT_EQ(summary.outputs[1].rmse, 1.0);
  EXPECT_EQ(summary.inputs[0].max, 740.0);
  EXPECT_EQ(summary.inputs[0].min, 710.0);
  EXPECT_EQ(summary.inputs[0].mean_abs_move, 20.0);
  EXPECT_EQ(summary.wall_s, 0.5);
}

TEST_F(Report, ViolationsCountCommandsBeyondTheirLimits) {
  const LoopFile loop = shortLoop(
      "asp_case1_pi_s", {{"actuator.move_upper.q_r", "100"}, {"report.output_upper.x", "2050"}});
  RunRecord record = smallRecord(loop);
  record.samples[0].action.input << 1600.0 + 1e-7;  // inside 1e-9 of the range, but a move of 900
  record.samples[1].action.input << 1600.1;         // beyond both
  record.samples[2].action.input << 740.0;
  record.samples[2].state.outputs << 55.0, 2050.1;
  record.samples[0].state.outputs << 55.0, 2050.0;
  record.samples[1].state.outputs << 55.0, 2000.0;
  const Summary summary = summarize(loop, record, 0.0);
  EXPECT_EQ(summary.input_violations, 1U);
  EXPECT_EQ(summary.move_violations, 2U);
  EXPECT_EQ(summary.output_violations, 1U);
}

TEST_F(Report, TrajectoryReadsBackToTheSameNumbers) {
  const LoopFile loop = shortLoop("asp_case1_clp", {{"noise.std", "{s: 1, x: 5}"}});
  const RunRecord record = runLoop(loop);
  writeRun(loop, record, summarize(loop, record, 0.0), path("deep/er"));
  const CsvTable table = readCsv(path("deep/er/trajectory.csv"));
  ASSERT_EQ(table.rows(), 201);
  const auto cell = [&](std::size_t k, const char* name) {
    return table.values(static_cast<Eigen::Index>(k), table.column(name));
  };
  for (std::size_t k = 0; k < 201; ++k) {
    const SampleRecord& sample = record.samples[k];
    EXPECT_EQ(cell(k, "x"), sample.measurement.outputs[1]);
    EXPECT_EQ(cell(k, "x_true"), sample.state.outputs[1]);
    EXPECT_EQ(cell(k, "x_reference"), sample.tracking.reference[1]);
    EXPECT_EQ(cell(k, "s_i"), sample.state.disturbances[1]);
    EXPECT_EQ(cell(k, "x_r"), sample.state.state[5]);
    if (k == 200) continue;
    EXPECT_EQ(cell(k, "q_r"), record.samples[k + 1].measurement.input_applied[0]);
    EXPECT_EQ(cell(k, "q_r_commanded"), sample.action.input[0]);
    EXPECT_EQ(cell(k, "q_r_perturbation"), sample.report.perturbation[0]);
  }
  EXPECT_TRUE(std::isnan(cell(200, "q_r")));
  EXPECT_EQ(cell(5, "time"), 1.0);
  EXPECT_EQ(table.units[static_cast<std::size_t>(table.column("time"))], "h");
  EXPECT_EQ(table.units[static_cast<std::size_t>(table.column("q_r"))], "m3/h");
}

TEST_F(Report, SummaryHasTheKeysThatScriptsRead) {
  const LoopFile loop = shortLoop("asp_case1_clp");
  const RunRecord record = runLoop(loop);
  const auto json = nlohmann::json::parse(toJson(summarize(loop, record, 1.5)));
  EXPECT_EQ(json["loop"], "asp_case1_clp");
  EXPECT_EQ(json["steps"], 200);
  EXPECT_EQ(json["wall_s"], 1.5);
  EXPECT_EQ(json["complete"], true);
  for (const char* key : {"ise", "iae", "itae", "itse", "rmse", "ise_reference"})
    for (const char* output : {"s", "x"})
      EXPECT_TRUE(json["outputs"][output][key].is_number()) << key;
  for (const char* key : {"min", "max", "mean_abs_move"})
    EXPECT_TRUE(json["inputs"]["q_r"][key].is_number()) << key;
  for (const char* key : {"input", "move", "output"}) EXPECT_EQ(json["violations"][key], 0) << key;
  EXPECT_EQ(json["actuator_clips"], 0);
  EXPECT_EQ(json["clp"]["solves"], 200);
  EXPECT_EQ(json["clp"]["infeasible"], 0);
  EXPECT_TRUE(json["clp"]["median_us"].is_number());
  EXPECT_EQ(json["limits"]["inputs"]["q_r"]["upper"], 1600.0);
  EXPECT_TRUE(json["limits"]["inputs"]["q_r"]["move"].is_null());
  EXPECT_FALSE(nlohmann::json::parse(toJson(summarize(shortLoop("asp_case1"), record, 0.0)))
                   .contains("clp"));
}

TEST_F(Report, MissingCellsOfTheInfluentAreCounted) {
  const LoopFile loop = readLoop("asp_influent_csv");
  const Summary summary = summarize(loop, runLoop(loop), 0.0);
  const Event* filled = test::find(summary.events, EventCode::kCellsFilled);
  ASSERT_NE(filled, nullptr);
  expectWords(filled->text, {"3 "});
  EXPECT_NE(toTable({summary}).find(filled->text), std::string::npos);
}

TEST_F(Report, APlantThatCannotBeMovedIsTold) {
  const LoopFile loop = shortLoop("asp_case1_pi_x", {{"plant.integrator.max_steps", "1"}});
  const RunRecord record = runLoop(loop);
  const Summary summary = summarize(loop, record, 0.0);
  const auto json = nlohmann::json::parse(toJson(summary));
  EXPECT_EQ(json["complete"], false);
  EXPECT_EQ(json["failed_samples"], 200);
  const Event* failed = test::find(summary.events, EventCode::kPlantFailed);
  ASSERT_NE(failed, nullptr);
  EXPECT_EQ(failed->count, 200U);
  const std::string words = "plant_failed";
  EXPECT_NE(toTable({summary}).find(words), std::string::npos) << toTable({summary});
  writeRun(loop, record, summary, path("failed"));
  EXPECT_NE(toTable({readSummary(path("failed/summary.json"))}).find(words), std::string::npos);
}

TEST_F(Report, HeldFallbackAndLockedSamplesAreEventsOfSummaryAndTable) {
  const LoopFile loop = shortLoop(
      "asp_case1_pi_s", {{"actuator.input_upper", "{q_r: 800}"}, {"setpoint.schedule", kInRun}});
  RunRecord record = runLoop(loop);
  for (std::size_t k = 0; k < 200; ++k) {
    record.samples[k].action.input << (k < 170 ? 700.0 : 800.0);
    record.samples[k].action.source = ActionSource::kBase;
    record.samples[k + 1].measurement.input_applied = record.samples[k].action.input;
  }
  EXPECT_EQ(test::shown(summarize(loop, record, 0.0).events),
            std::vector<std::string>{"input_at_limit q_r 170..199 (30)"});
  record.samples[199].action.input << 799.0;  // it came back
  record.samples[200].measurement.input_applied << 799.0;
  record.samples[3].action.source = record.samples[4].action.source = ActionSource::kHeld;
  record.samples[5].action.source = ActionSource::kFallback;
  record.samples[6].action.source = ActionSource::kClipped;
  const Summary summary = summarize(loop, record, 0.0);
  const std::string table = toTable({summary});
  for (const char* code : {"input_held", "fallback_acts"})
    EXPECT_NE(table.find(code), std::string::npos) << code << table;
  EXPECT_EQ(test::shown(summary.events),
            (std::vector<std::string>{"input_held  3..4 (2)", "fallback_acts  5..5 (1)"}));
  writeRun(loop, record, summary, path("told"));
  EXPECT_EQ(eventLines(readSummary(path("told/summary.json"))), eventLines(summary));
  EXPECT_FALSE(neverControlled(summary));
}

/// Inputs that are told locked in a run in which all inputs stand at their lower limits.
std::vector<std::string> lockedAtTheLowerLimits(const LoopFile& loop) {
  RunRecord record = recordLayout(loop).emptyRecord();
  record.samples.resize(20);
  for (SampleRecord& sample : record.samples) {
    sample.has_action = true;
    sample.action.source = ActionSource::kBase;
    sample.action.input = loop.simulation.actuator.limits.lower;
  }
  std::vector<std::string> names;
  for (const Event& event : summarize(loop, record, 0.0).events)
    if (event.code == EventCode::kInputAtLimit) names.push_back(event.signal);
  return names;
}

TEST_F(Report, AnInputThatNobodyMovesIsNotLocked) {
  using Names = std::vector<std::string>;
  const char* both = "mimo_cstr_steps_pi";
  EXPECT_EQ(lockedAtTheLowerLimits(readLoop(both)), (Names{"q", "qc"}));
  EXPECT_EQ(lockedAtTheLowerLimits(readLoop(
                both, {{"controller.loops", "[{input: qc, output: T, kp: 100, reverse: true}]"}})),
            Names{"qc"});
  EXPECT_EQ(lockedAtTheLowerLimits(readLoop("column_excite")), (Names{"L", "V"}));
  EXPECT_EQ(lockedAtTheLowerLimits(
                readLoop("column_excite", {{"controller.signals", "[{input: L, signal: none}]"}})),
            Names{});
  EXPECT_EQ(lockedAtTheLowerLimits(readLoop("bsm1_own_fmbpc")), Names{"air"}) << "by its model";
  EXPECT_EQ(lockedAtTheLowerLimits(readLoop("bsm1_own_supervisor")), Names{"air"});
  EXPECT_EQ(lockedAtTheLowerLimits(readLoop("bsm1_own_open")), Names{"Qintr"}) << "its one signal";
}

TEST_F(Report, WhatTheLoopFileAsksAfterTheEndIsTold) {
  write("d.csv", "t[h],v[degC]\n0,15\n0.5,16\n");
  const std::string csv = "{file: " + path("d.csv") +
                          ", time_column: t, end: hold, channels: {T_in: {column: v}}, lead_in_h: ";
  const auto told = [&](Overrides overrides) {
    const LoopFile loop = readLoop("heated_tank", overrides);
    const RunRecord record = recordLayout(loop).emptyRecord();
    std::string all;
    for (const Event& event : summarize(loop, record, 0.0).events)
      if (event.code == EventCode::kBeyondRun) all += event.text + "|";
    return all;
  };
  EXPECT_EQ(told({}), "");
  EXPECT_EQ(told({{"sampling.duration_h", "0.25"}, {"disturbance.commands", "[]"}}), "");
  expectWords(told({{"sampling.duration_h", "0.2"}}),
              {"1 of 1 entries of the setpoint's schedule", "0.25 h",
               "1 of 1 entries of disturbance.commands", "1.5 h", "ends at 0.2 h"});
  expectWords(told({{"setpoint.commands",
                     "[{time_h: 1, name: T, value: 50}, {time_h: 4, name: T, value: 50}]"}}),
              {"1 of 2 entries of setpoint.commands", "4 h", "ends at 3 h"});
  const Overrides record{{"disturbance.source", "csv"}, {"disturbance.commands", "[]"}};
  const auto with = [&](const std::string& more) {
    Overrides all = record;
    all.emplace_back("disturbance.csv", csv + more + "}");
    return told(all);
  };
  EXPECT_EQ(with("2"), "");
  expectWords(with("4"), {"record of disturbance.csv never acts", "4 h"});
  expectWords(with("1, next: {file: " + path("d.csv") + ", after_h: 2.5}"),
              {"disturbance.csv.next never acts", "3.5 h"});
}

TEST_F(Report, AValveThatIsStuckBeyondTheActuatorsLimitsIsToldWhereItIs) {
  const auto stuck = [](double position, const char* duration_h) {
    return readLoop("heated_tank",
                    {{"actuator.input_upper.heat", "10"},
                     {"setpoint.schedule", "[]"},
                     {"sampling.duration_h", duration_h},
                     {"disturbance.commands",
                      "[{time_h: 0.1, name: input/heat, value: " + exactText(position) + "}]"}});
  };
  const LoopFile beyond = stuck(15.0, "0.2");
  const RunRecord record = runLoop(beyond);
  EXPECT_EQ(record.samples.back().measurement.input_applied[0], 10.0);
  const std::vector<Event> events = test::eventsOf(record);
  const Event* clamped = test::find(events, EventCode::kInputClamped, "input/heat");
  ASSERT_NE(clamped, nullptr);
  EXPECT_EQ(clamped->first, beyond.simulation.samples / 2);
  EXPECT_EQ(clamped->count, beyond.simulation.samples / 2 + 1) << "from there to the end";
  EXPECT_FALSE(contains(test::eventsOf(runLoop(stuck(10.0, "0.2"))), EventCode::kInputClamped));
}

TEST_F(Report, TrajectoryHasTheColumnsOfAMatrixOfTheLoopFile) {
  const LoopFile loop = readLoop("heated_tank");
  const RunRecord record = runLoop(loop);
  writeRun(loop, record, summarize(loop, record, 0.0), path("matrix"));
  const CsvTable table = readCsv(path("matrix/trajectory.csv"));
  EXPECT_EQ(table.values(359, table.column("T_in")), 8.0);
  EXPECT_EQ(table.values(0, table.column("T_in")), 15.0);
  for (const auto& name : table.names) EXPECT_NE(name, "F") << "of the Wood-Berry column";
}

TEST_F(Report, SourcesAddUpToTheSteps) {
  const LoopFile loop = shortLoop("asp_case1_clp");
  const Summary summary = summarize(loop, runLoop(loop), 0.0);
  std::uint64_t all = 0;
  for (const auto count : summary.sources) all += count;
  EXPECT_EQ(all, summary.steps);
}

TEST_F(Report, AFolderThatCannotBeMadeIsAnError) {
  const LoopFile loop = shortLoop("asp_case1_pi_s");
  const RunRecord record = runLoop(loop);
  const std::string file = write("file", "");
  expectWords(
      errorOf([&] { writeRun(loop, record, summarize(loop, record, 0.0), file + "/below"); }),
      {file});
}

TEST_F(Report, TheTableHasALinePerOutputAndPerInput) {
  const LoopFile loop = shortLoop("asp_case1_clp", {{"setpoint.schedule", kInRun}});
  const Summary summary = summarize(loop, runLoop(loop), 0.0);
  const std::string table = toTable({summary, summary});
  EXPECT_EQ(
      std::count(table.begin(), table.end(), '\n'),
      1 + 6 + 1 + 1 + 2 + 1 + 1 + 2 + 1 + 5 + 1 + 2);  // the legend has five, the titles come last
  EXPECT_NE(table.find("mean move"), std::string::npos);
}

}  // namespace loop_report_test
}  // namespace fpc
