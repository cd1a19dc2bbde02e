// The pages docs/loop_*.md list every key the reader knows and no other, with the structs'
// defaults.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>

#include "base/yaml_node.hpp"
#include "config/read.hpp"
#include "control/excitation/excitation.hpp"
#include "control/fmbpc/law.hpp"
#include "control/fuzzy_lq/law.hpp"
#include "control/mpc/swarm_mpc.hpp"
#include "control/pi/pi.hpp"
#include "fmbpc/base/option.hpp"
#include "fmbpc/base/text.hpp"
#include "paths.hpp"
#include "runtime/loops_of_type.hpp"

namespace fpc {
namespace config_loop_doc_test {

struct Row {
  std::string unit, fallback, meaning;
};

std::string trimmed(const std::string& cell) {
  const auto from = cell.find_first_not_of(' ');
  return from == std::string::npos ? "" : cell.substr(from, cell.find_last_not_of(' ') - from + 1);
}

/// Rows "| `key` | unit | default | meaning |" of the pages.
std::map<std::string, Row> documented() {
  std::map<std::string, Row> rows;
  const std::regex row(R"(\| `([^`]+)` \|([^|]*)\|([^|]*)\|([^|]*)\|)");
  for (const auto& page : std::filesystem::directory_iterator(sourceDir() + "/docs")) {
    if (page.path().filename().string().rfind("loop_", 0) != 0) continue;
    std::ifstream stream(page.path());
    for (std::string line; std::getline(stream, line);) {
      std::smatch match;
      if (!std::regex_match(line, match, row)) continue;
      EXPECT_EQ(rows.count(match[1]), 0U) << match[1];
      rows[match[1]] = {trimmed(match[2]), trimmed(match[3]), trimmed(match[4])};
    }
  }
  return rows;
}

/// Names of signals and numbers of items are not keys.
std::string general(std::string path) {
  path = std::regex_replace(path, std::regex(R"(\[\d+\])"), "[]");
  const std::regex named(
      R"(^(plant\.parameters|plant\.initial_state|disturbance\.\w+\.channels|tf\.frames|actuator\.lag|)"
      R"(controller\.inputs\[\]|controller\.observer\.estimated|report\.consumption|gateway\.tags|targets\.outputs|targets\.inputs|plausibility\.signals|standstill\.signals)\.[\w/]+)");
  path = std::regex_replace(path, named, "$1.NAME");
  path = std::regex_replace(path, std::regex(R"(^sensors\.(?!step_s$)\w+)"), "sensors.NAME");
  path = std::regex_replace(path, std::regex(R"(^(guard|standstill)\.fallback\.)"), "controller.");
  path = std::regex_replace(path, std::regex(R"(^targets\.observer\.)"), "controller.observer.");
  path = std::regex_replace(path, std::regex(R"(^setpoint\.commands)"), "disturbance.commands");
  path =
      std::regex_replace(path, std::regex(R"(^controller\.model\[\])"), "plant.matrix.elements[]");
  path = std::regex_replace(path, std::regex(R"(^loop\.publishers\.\w+)"), "loop.publishers.TOPIC");
  const std::regex signals(R"(^plant\.(?:matrix\.)?(?:outputs|inputs|disturbances)\[\]\.)");
  path = std::regex_replace(path, signals, "plant.SIGNALS[].");
  const std::regex outputs(R"(^setpoint\.schedule\[\]\.(?!\w+_h$)\w+$)");
  return std::regex_replace(path, outputs, "setpoint.schedule[].NAME");
}

std::set<std::string> asked(const std::string& text) {
  const auto trace = std::make_shared<YamlTrace>();
  const std::regex model(R"(\bfile: (\w+\.yaml))");
  const auto here = std::regex_replace(text, model, "file: " + sourceDir() + "/config/model/$1");
  YamlSection root(YamlNode(YAML::Load(here)), "text", "", trace);
  readSections(root, "text");
  return trace->asked;
}

std::string controlled(const std::string& rest) {
  return "sampling: {sample_time_s: 720, duration_h: 4}\n" + rest;
}

/// All paths that any kind of loop makes the reader ask for.
std::set<std::string> readerKeys() {
  const std::string lists =
      "setpoint:\n  schedule: [{time_h: 0, s: 1}]\n  commands: [{time_h: 0, name: s, value: 1}]\n"
      "disturbance:\n  source: constant\n  commands: [{time_h: 0, name: q_i, value: 1}]\n"
      "  pattern: {channels: {q_i: {shape: flow, range: [1, 3], mean: 2}}}\n"
      "  csv: {channels: {q_i: {column: a, plausible: [0, 1]}}}\n"
      "sensors: {s: {class: A}}\nactuator: {lag: {q_r: {t90_s: 6}}}\ntf:\n  frames: {plant: "
      "{position: [1, 0, 0]}}\n"
      "  sample_lines: [{output: s, from: plant, to: reactor, velocity_m_s: 1}]\n";
  const std::string fmbpc =
      "plant: {type: activated_sludge}\ncontroller: {type: fmbpc}\nmodel: {file: " + sourceDir() +
      "/config/model/fm_1.yaml}\n";
  const std::string external =
      "plant:\n  type: external\n  name: p\n  outputs: [{name: y}]\n  inputs: [{name: u, lower: 0, "
      "upper: 1}]\n"
      "  disturbances: [{name: d}]\nsetpoint: {initial: {y: 1}}\n"
      "controller: {type: pi, loops: [{input: u, output: y, kp: 1, gain_schedule: [[0, 1]], "
      "static_input: [[0, 1]], feedforward: [{disturbance: d, gain: "
      "1}]}]}\n";
  const std::string excitation =
      "plant: {type: activated_sludge}\ncontroller:\n  type: excitation\n  signals: [{input: q_r, "
      "signal: ";
  const std::string prbs =
      controlled(excitation + "prbs}]\n  feedback: [{input: q_r, output: s, gain: 1}]\n");
  const std::string levels = controlled(excitation + "multi_level, hold_s: [720, 720]}]\n");
  const std::string steps = controlled(excitation + "steps, schedule: [{time_h: 1, value: 2}]}]\n");
  const std::string batch =
      "plant: {type: batch_reactor}\nsampling: {sample_time_s: 10, duration_h: 1}\n"
      "setpoint: {schedule: [{time_h: 0, T: 30}]}\nmodel: {file: " +
      sourceDir() + "/config/model/batch_fuzzy.yaml}\n" +
      "actuator: {initial: {kM: 0}}\ncontroller:\n  type: hybrid_mpc\n  horizon_blocks: 1\n  ";
  const std::string rest =
      "\n  forbidden_transitions: [{from: {kM: 0}, to: {kM: 2}}]\n"
      "  cost: {switching: [{before: kH, after: kC, weight: 1}], travel: [{input: kM, weight: "
      "1}]}\n"
      "report: {windows: [{name: w, between_s: [0, 3600]}], consumption: {water_kg: {kM: 1}}}\n";
  const std::string signal = "[{name: NAME, unit: g, nominal: 0, lower: -1, upper: 1}]";
  const auto named = [&](const std::string& name) {
    return std::regex_replace(signal, std::regex("NAME"), name);
  };
  const std::string column = "plant: {type: transfer_matrix, matrix: {outputs: " + named("a") +
                             ", inputs: " + named("b") + ", disturbances: " + named("c") +
                             ", elements: [{output: a, from: b, gain: 1, time_constant_min: 1}]}}\n"
                             "controller: {type: pi, loops: [{input: b, output: a, kp: 1}]}\n";
  const std::string optimal =
      "plant: {type: distillation_column}\nsampling: {sample_time_s: 60, duration_h: 1}\nmodel: "
      "{file: " +
      sourceDir() +
      "/config/model/wood_berry.yaml}\ncontroller: {type: fuzzy_optimal, rules: [{}]}\n";
  const std::string adaptive =
      "plant: {type: distillation_column}\ncontroller: {type: adaptive_pi, decoupling: false, "
      "loops: "
      "[{input: L, output: y_D, kp: 1, ki_per_h: 1}, {input: V, output: x_B, kp: 1, "
      "ki_per_h: 1}], model: [{output: y_D, from: L, gain: 1, time_constant_min: 1}]}\n";
  std::vector<std::string> texts{controlled(fmbpc + lists),
                                 controlled(external),
                                 controlled(column),
                                 controlled(adaptive),
                                 optimal,
                                 prbs,
                                 levels,
                                 steps,
                                 batch + "inputs: [{kM: 0, kC: 0, kH: 1}]" + rest};
  for (const char* loop : {"example_external", "cstr_modbus", "cstr_tracking_rate"})
    texts.push_back(resolveLoop(loop));
  for (const auto& type : controllerNames())
    for (const auto& loop : loopsOfType(type))
      texts.push_back(resolveLoop(loop, withoutRecords(loop)));
  std::set<std::string> paths, parents, keys, sections;
  for (const auto& text : texts) paths.merge(asked(text));
  for (const auto& path : paths) {
    keys.insert(general(path));
    for (auto cut = path.find('.'); cut != std::string::npos; cut = path.find('.', cut + 1))
      parents.insert(path.substr(0, cut));
  }
  for (const auto& parent : parents) sections.insert(general(parent));
  for (const auto& section : sections) {  // a row only if a list, of mappings or names
    keys.erase(section);
    if (section.size() > 2 && section.substr(section.size() - 2) == "[]")
      keys.erase(section.substr(0, section.size() - 2));
  }
  for (const char* either : {"plant.outputs", "guard.fallback", "standstill.fallback",
                             "plant.model", "plant.ranges.NAME"})
    keys.insert(either);  // or a mapping
  for (const char* other : {"clp", "disturbance.pattern.channels", "disturbance.csv.channels"})
    keys.erase(other);
  return keys;
}

TEST(LoopDocs, EveryKeyOfTheReaderIsDocumented) {
  const auto rows = documented();
  for (const auto& key : readerKeys()) EXPECT_EQ(rows.count(key), 1U) << key;
}

TEST(LoopDocs, EveryDocumentedKeyIsKnownToTheReader) {
  const auto keys = readerKeys();
  const auto rows = documented();
  ASSERT_GT(rows.size(), 100U);
  for (const auto& [key, row] : rows) {
    EXPECT_EQ(keys.count(key), 1U) << key;
    EXPECT_FALSE(row.fallback.empty() || row.meaning.empty()) << key;
  }
}

TEST(LoopDocs, KeysWithAUnitInTheirNameStateIt) {
  const std::map<std::string, std::string> endings = {
      {"_s", "s"}, {"_h", "h"}, {"_steps", "s"}, {"_m_s", "m/s"}};
  for (const auto& [key, row] : documented())
    for (const auto& [ending, unit] : endings) {
      const bool ends =
          key.size() > ending.size() && key.substr(key.size() - ending.size()) == ending;
      EXPECT_TRUE(!ends || row.unit.find(unit) != std::string::npos) << key;
    }
}

std::string word(bool value) { return value ? "true" : "false"; }

/// The defaults as the structs have them.
std::map<std::string, std::string> structDefaults() {
  const LoopFile loop;
  const ClpParams& clp = loop.clp;
  const FmbpcParams law;
  const FuzzyOptimalParams optimal;
  const SwarmParams swarm = SwarmMpcParams{}.swarm;
  const IntegratorParams& integrator = loop.simulation.integrator;
  const CsvDisturbanceParams& csv = loop.disturbance.csv;
  const PiLoop pi;
  return {{"plant.integrator.relative_tolerance", exactText(integrator.relative_tolerance)},
          {"plant.integrator.absolute_tolerance", exactText(integrator.absolute_tolerance)},
          {"plant.integrator.max_steps", std::to_string(integrator.max_steps)},
          {"plant.integrator.method", wordOf(integrator.method)},
          {"disturbance.source", wordOf(loop.disturbance.source)},
          {"seed", std::to_string(loop.simulation.noise_seed)},
          {"disturbance.csv.time_unit", csv.time_unit},
          {"disturbance.csv.missing", csv.missing == MissingCells::kError ? "error" : "another"},
          {"disturbance.csv.interpolation", wordOf(csv.interpolation)},
          {"disturbance.csv.end", wordOf(csv.end)},
          {"disturbance.csv.channels.NAME.scale", exactText(CsvChannel{}.scale)},
          {"disturbance.csv.channels.NAME.offset", exactText(CsvChannel{}.offset)},
          {"controller.law", wordOf(law.law)},
          {"controller.coincidence_steps", std::to_string(law.coincidence_steps)},
          {"controller.preview", word(law.preview)},
          {"controller.swarm.particles", std::to_string(swarm.particles)},
          {"controller.swarm.iterations", std::to_string(swarm.iterations)},
          {"controller.horizon_steps", std::to_string(law.horizon_steps)},
          {"controller.iterations", std::to_string(law.iterations)},
          {"controller.realisation", wordOf(law.realisation)},
          {"controller.delay_steps", std::to_string(law.delay_steps)},
          {"controller.reference_lead_steps", std::to_string(law.reference_lead_steps)},
          {"controller.move_steps", std::to_string(optimal.tuning.move_steps)},
          {"controller.solve", wordOf(optimal.solve)},
          {"controller.disturbance", wordOf(optimal.disturbance)},
          {"controller.loops[].ki_per_h", exactText(pi.ki_per_h)},
          {"controller.loops[].reverse", word(pi.reverse)},
          {"guard.return_samples", std::to_string(loop.guard.return_samples)},
          {"guard.lock_samples", std::to_string(loop.guard.lock_samples)},
          {"guard.growing_swings", std::to_string(loop.guard.growing_swings)},
          {"controller.loops[].anti_windup", wordOf(pi.anti_windup)},
          {"controller.loops[].start", wordOf(pi.start)},
          {"model.max_pole", exactText(loop.max_pole)},
          {"model.identify.after", std::to_string(loop.identify.after)},
          {"model.identify.online.every", std::to_string(loop.identify.online.every)},
          {"model.identify.online.forgetting", exactText(loop.identify.online.rls.forgetting)},
          {"clp.perturbation_steps", std::to_string(clp.perturbation_steps)},
          {"clp.cost", wordOf(clp.cost)},
          {"clp.bounds", wordOf(clp.bounds)},
          {"clp.output_penalty", exactText(clp.output_penalty)},
          {"clp.qp.max_iterations", std::to_string(clp.qp.max_iterations)},
          {"actuator.hold_samples", std::to_string(loop.simulation.actuator.hold_samples)},
          {"loop.speedup", exactText(loop.exchange.speedup)},
          {"loop.ready_timeout_s", exactText(loop.exchange.ready_timeout_s)},
          {"loop.publish_clock", word(loop.exchange.publish_clock)},
          {"tf.broadcast", word(loop.tf.broadcast)}};
}

double asNumber(const std::string& text) { return YAML::Load(text).as<double>(std::nan("")); }

TEST(LoopDocs, DefaultsAreThoseOfTheStructs) {
  const auto rows = documented();
  for (const auto& [key, value] : structDefaults()) {
    ASSERT_EQ(rows.count(key), 1U) << key;
    const std::string& written = rows.at(key).fallback;
    EXPECT_TRUE(written == value || asNumber(written) == asNumber(value))
        << key << ": documented " << written << ", struct " << value;
  }
}

}  // namespace config_loop_doc_test
}  // namespace fpc
