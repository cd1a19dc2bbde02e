// The identified models of the activated-sludge thesis (Vallejo Llamas 2021, article 1): free-run
// VAF of cases A to D, and what tables 5 to 8 print of the rules of case D. Its records were never
// published; those of asp_excite and asp_excite_validation stand for them.
#include <cmath>
#include <map>

#include "fmbpc/config/structure_file.hpp"
#include "fmbpc/fuzzy/identify.hpp"
#include "fmbpc/fuzzy/validation.hpp"
#include "tool/reproduce/experiment.hpp"
#include "tool/reproduce/runs.hpp"

namespace fpc::tool {
namespace {

constexpr char kArticle[] = "Vallejo Llamas 2021, article 1, ";
constexpr char kRecord[] = "the identification record was never published";

/// Row k holds y(k) and the u(k), d(k) that act from then on; the last sample has no action.
DataSet dataOf(const std::string& loop, const Structure& structure,
               const Overrides& overrides = {}) {
  const RunRecord& run = recordOf(loop, overrides);
  const auto rows = static_cast<Eigen::Index>(run.samples.size()) - 1;
  std::vector<Vector> columns;
  const auto take = [&](const std::vector<StructureSignal>& wanted,
                        const std::vector<SignalInfo>& known, auto&& value) {
    for (const auto& signal : wanted)
      for (std::size_t i = 0; i < known.size(); ++i) {
        if (known[i].name != signal.info.name) continue;
        columns.emplace_back(rows);
        for (Eigen::Index k = 0; k < rows; ++k)
          columns.back()[k] = value(static_cast<std::size_t>(k))[static_cast<Eigen::Index>(i)];
      }
  };
  const auto& samples = run.samples;
  take(structure.outputs, run.info.outputs,
       [&](std::size_t k) { return samples[k].measurement.outputs; });
  take(structure.inputs, run.info.inputs,
       [&](std::size_t k) { return samples[k + 1].measurement.input_applied; });
  take(structure.disturbances, run.info.disturbances,
       [&](std::size_t k) { return samples[k].measurement.disturbances; });
  Matrix values(rows, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t c = 0; c < columns.size(); ++c)
    values.col(static_cast<Eigen::Index>(c)) = columns[c];
  return makeDataSet(values, structure, loop);
}

const Identification& identified(const std::string& name) {
  static std::map<std::string, Identification> all;
  const auto known = all.find(name);
  if (known != all.end()) return known->second;
  const Structure structure = readStructure(findStructure(name));
  return all[name] = identify(dataOf("asp_excite", structure), structure);
}

struct Printed {
  double s, x;        // VAF [%]
  bool same_record;   // validated on the identification data
  const char* words;  // instead of a number
};

ReproduceRow vaf(const std::string& what, double paper, double here) {
  ReproduceRow row = compare(what, paper, here, "%", 0.05, kRecord);
  if (here > paper && row.verdict != Verdict::kReproduced) row.verdict = Verdict::kBetter;
  return row;
}

std::vector<ReproduceRow> validated(const std::string& name, const Printed& paper) {
  const Identification& found = identified(name);
  const Structure structure = readStructure(findStructure(name));
  const std::string record = paper.same_record ? "asp_excite" : "asp_excite_validation";
  const auto outputs = validateModel(found.model, found.linear, dataOf(record, structure));
  std::vector<ReproduceRow> rows;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const double here = outputs[i].free_run.vaf, printed = i == 0 ? paper.s : paper.x;
    rows.push_back(vaf("VAF of " + outputs[i].output + " in free run on " + record, printed, here));
    rows.back().note += std::string("; ") + paper.words + "; linear ARX " +
                        std::to_string(std::lround(outputs[i].linear_free_run.vaf)) + " %";
  }
  return rows;
}

/// Case A on a record whose inflow, which its models do not see, swings a quarter as much.
std::vector<ReproduceRow> validatedWithCalmInflow(const Printed& paper) {
  const Overrides calm{{"disturbance.pattern.channels.q_i.lower", "1100"},
                       {"disturbance.pattern.channels.q_i.upper", "1500"}};
  const Structure structure = readStructure(findStructure("asp_a"));
  const DataSet data = dataOf("asp_excite", structure, calm);
  const Identification found = identify(data, structure);
  std::vector<ReproduceRow> rows;
  for (const auto& output : validateModel(found.model, found.linear, data)) {
    const double here = output.free_run.vaf, printed = output.output == "s" ? paper.s : paper.x;
    rows.push_back(
        vaf("the same for " + output.output + ", inflow 1100..1500 m3/h", printed, here));
    rows.back().note += "; the swing of the unseen inflow makes most of the gap";
  }
  return rows;
}

double meanOf(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// One column of a table of rules: the coefficient of a regressor or the centre of its set.
struct Column {
  std::vector<double> coefficients, centres;
};

Column columnOf(const TsModel& model, std::size_t output, const Regressor& wanted) {
  const OutputModel& submodel = model.submodels[output];
  Column column;
  for (std::size_t i = 0; i < submodel.regressors.size(); ++i) {
    if (!(submodel.regressors[i] == wanted)) continue;
    for (const auto& rule : submodel.rules) {
      column.coefficients.push_back(rule.coefficients[static_cast<Eigen::Index>(i)]);
      column.centres.push_back(rule.antecedents[i].parameters[0]);  // antecedents as regressors
    }
  }
  return column;
}

double negativeShare(const std::vector<double>& values) {
  double count = 0.0;
  for (const double value : values) count += value < 0.0 ? 1.0 : 0.0;
  return 100.0 * count / static_cast<double>(values.size());
}

using Values = std::vector<double>;

ReproduceRow means(const std::string& what, const Values& paper, const Values& here,
                   const char* unit) {
  return compare("mean over the rules: " + what, meanOf(paper), meanOf(here), unit, 0.1,
                 std::string("the paper prints ") + std::to_string(paper.size()) + " of " +
                     std::to_string(here.size()) + " rules; " + kRecord);
}

ReproduceRow signs(const std::string& what, const Values& paper, const Values& here) {
  return compare(
      "rules in which " + what, negativeShare(paper), negativeShare(here), "%", 0.1,
      std::string("of the ") + std::to_string(paper.size()) + " printed rules; " + kRecord);
}

// The third printed column of tables 5 and 6 is q_r(k-2), as algorithm 2 shows for rules 1 and 2.
std::vector<ReproduceRow> rulesOfSubstrate() {
  const TsModel& model = identified("asp_d").model;
  const Column s = columnOf(model, 0, {SignalKind::kOutput, 0, 0}),
               x = columnOf(model, 0, {SignalKind::kOutput, 1, 0}),
               q_r = columnOf(model, 0, {SignalKind::kInput, 0, 1});
  const Values of_s{0.874, 0.858, 0.883, 0.870}, of_x{-2.72e-3, -3.87e-3, -3.15e-3, -6.54e-3},
      of_q{-5.98e-3, 3.69e-3, 5.72e-3, -3.04e-2};
  return {means("coefficient of s", of_s, s.coefficients, "-"),
          means("coefficient of x", of_x, x.coefficients, "-"),
          signs("more biomass lowers s", of_x, x.coefficients),
          means("coefficient of q_r(k-2)", of_q, q_r.coefficients, "-"),
          means("centre of s", {57.1, 57.2, 106.0, 166.0}, s.centres, "mg/l"),
          means("centre of x", {1840.0, 1990.0, 1990.0, 1900.0}, x.centres, "mg/l"),
          means("centre of q_r(k-2)", {829.0, 1070.0, 790.0, 1560.0}, q_r.centres, "m3/h")};
}

std::vector<ReproduceRow> rulesOfBiomass() {
  const TsModel& model = identified("asp_d").model;
  const Column x = columnOf(model, 1, {SignalKind::kOutput, 1, 0}),
               q_i = columnOf(model, 1, {SignalKind::kDisturbance, 0, 0}),
               q_r = columnOf(model, 1, {SignalKind::kInput, 0, 0});
  const Values of_i{-2.22e-2, -4.10e-2, -5.22e-2}, of_r{1.33e-2, 3.54e-2, -3.96e-2};
  Values offsets;
  for (const auto& rule : model.submodels[1].rules) offsets.push_back(rule.offset);
  return {means("coefficient of x", {0.958, 1.01, 0.935}, x.coefficients, "-"),
          means("coefficient of q_i", of_i, q_i.coefficients, "-"),
          signs("more inflow lowers x", of_i, q_i.coefficients),
          means("coefficient of q_r", of_r, q_r.coefficients, "-"),
          signs("more recirculation lowers x", of_r, q_r.coefficients),
          means("offset", {102.0, 24.5, 262.0}, offsets, "mg/l"),
          means("centre of x", {1800.0, 1820.0, 2120.0}, x.centres, "mg/l"),
          means("centre of q_r", {568.0, 481.0, 996.0}, q_r.centres, "m3/h")};
}

const bool kRegistered = [] {
  const struct {
    const char *name, *figure;
    Printed paper;
  } cases[] = {
      {"asp_a", "figure 7", {92.0, 92.0, true, "the paper says over 92 %, without the inflow"}},
      {"asp_b", "figure 8", {62.0, 42.0, false, "the paper says around, without the inflow"}},
      {"asp_c", "figure 9", {99.0, 87.0, true, "the paper says around"}},
      {"asp_d", "figure 10", {95.0, 66.0, false, "the paper says around"}}};
  for (const auto& c : cases)
    registerExperiment({std::string(c.name) + "_identification",
                        std::string(kArticle) + c.figure + ", table 9",
                        [name = std::string(c.name), paper = c.paper] {
                          auto rows = validated(name, paper);
                          if (name != "asp_a") return rows;
                          const auto calm = validatedWithCalmInflow(paper);
                          rows.insert(rows.end(), calm.begin(), calm.end());
                          return rows;
                        }});
  registerExperiment({"asp_d_rules_s", std::string(kArticle) + "tables 5, 6", rulesOfSubstrate});
  registerExperiment({"asp_d_rules_x", std::string(kArticle) + "tables 7, 8", rulesOfBiomass});
  return true;
}();

}  // namespace
}  // namespace fpc::tool
