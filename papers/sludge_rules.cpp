// The printed rules of case D of the activated-sludge thesis (vallejo2021thesis, article 1,
// tables 5 to 8 and figure 6) beside those of our record. Clusters are matched by their centres
// first; where ours lie elsewhere, coefficients cannot be compared.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "config/structure_file.hpp"
#include "fmbpc/base/input_error.hpp"
#include "identification/identify.hpp"
#include "papers/picture.hpp"
#include "papers/run_data.hpp"
#include "papers/runs.hpp"

namespace fpc::tool {
namespace {

constexpr char kPaper[] = "vallejo2019";

/// One printed rule: what it prints of the centre of its cluster and of its consequent.
struct PrintedRule {
  int number;
  std::vector<double> centre, consequent;
};

/// A table of rules: regressors of the columns, their ranges for distances.
struct PrintedModel {
  std::size_t output;
  std::vector<Regressor> columns;
  std::vector<std::string> names, units;
  std::vector<double> spans;
  std::vector<PrintedRule> rules;
  std::vector<std::string> terms;  ///< of the consequents: a column's name, or "offset"
};

const TsModel& modelD() {
  static const TsModel model = [] {
    const Structure structure = readStructure(findStructure("asp_d"));
    return identify(dataOf(recordOf("asp_excite"), structure), structure).model;
  }();
  return model;
}

// The third printed column of tables 5 and 6 is q_r(k-2), as algorithm 2 shows for rules 1 and 2.
PrintedModel substrate() {
  return {0,
          {{SignalKind::kOutput, 0, 0}, {SignalKind::kOutput, 1, 0}, {SignalKind::kInput, 0, 1}},
          {"s(k-1)", "x(k-1)", "q_r(k-2)"},
          {"mg/l", "mg/l", "m3/h"},
          {150.0, 600.0, 2000.0},
          {{1, {57.1, 1840.0, 829.0}, {0.874, -2.72e-3, -5.98e-3}},
           {2, {57.2, 1990.0, 1070.0}, {0.858, -3.87e-3, 3.69e-3}},
           {5, {106.0, 1990.0, 790.0}, {0.883, -3.15e-3, 5.72e-3}},
           {6, {166.0, 1900.0, 1560.0}, {0.870, -6.54e-3, -3.04e-2}}},
          {"s(k-1)", "x(k-1)", "q_r(k-2)"}};
}

PrintedModel biomass() {
  return {1,
          {{SignalKind::kOutput, 1, 0}, {SignalKind::kInput, 0, 0}},
          {"x(k-1)", "q_r(k-1)"},
          {"mg/l", "m3/h"},
          {600.0, 2000.0},
          {{1, {1800.0, 568.0}, {0.958, 1.33e-2, 102.0}},
           {2, {1820.0, 481.0}, {1.01, 3.54e-2, 24.5}},
           {5, {2120.0, 996.0}, {0.935, -3.96e-2, 262.0}}},
          {"x(k-1)", "q_r(k-1)", "offset"}};
}

double centreOf(const OutputModel& model, const Rule& rule, const Regressor& column) {
  for (std::size_t i = 0; i < model.antecedents.size(); ++i)
    if (model.antecedents[i] == column) return rule.antecedents[i].parameters[0];
  return notPrinted();
}

double coefficientOf(const OutputModel& model, const Rule& rule, const Regressor& column) {
  for (std::size_t i = 0; i < model.regressors.size(); ++i)
    if (model.regressors[i] == column) return rule.coefficients[static_cast<Eigen::Index>(i)];
  return notPrinted();
}

/// Distance of a printed centre from one of ours, in shares of the ranges.
double distance(const PrintedModel& table, const PrintedRule& printed, const Rule& rule) {
  const OutputModel& model = modelD().submodels[table.output];
  double sum = 0.0;
  for (std::size_t i = 0; i < table.columns.size(); ++i)
    sum +=
        std::pow((centreOf(model, rule, table.columns[i]) - printed.centre[i]) / table.spans[i], 2);
  return std::sqrt(sum);
}

/// Which of our rules stands for each printed one: the assignment of least distance in all.
std::vector<std::size_t> matched(const PrintedModel& table) {
  const auto& rules = modelD().submodels[table.output].rules;
  require(rules.size() >= table.rules.size(), "asp_d", "as many rules as are printed");
  std::vector<std::size_t> order(rules.size()), best;
  std::iota(order.begin(), order.end(), std::size_t{0});
  double least = INFINITY;
  do {
    double sum = 0.0;
    for (std::size_t i = 0; i < table.rules.size(); ++i)
      sum += distance(table, table.rules[i], rules[order[i]]);
    if (!(sum < least)) continue;
    least = sum;
    best = order;
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

Rows centres(const PrintedModel& table) {
  const OutputModel& model = modelD().submodels[table.output];
  const auto match = matched(table);
  Rows rows;
  for (std::size_t r = 0; r < table.rules.size(); ++r)
    for (std::size_t i = 0; i < table.columns.size(); ++i)
      rows.push_back(incomparable(
          "centre of " + table.names[i] + ", rule " + std::to_string(table.rules[r].number),
          table.rules[r].centre[i], centreOf(model, model.rules[match[r]], table.columns[i]),
          table.units[i], "centres lie where the record is, and the paper's was never published"));
  return rows;
}

Rows consequents(const PrintedModel& table) {
  const OutputModel& model = modelD().submodels[table.output];
  const auto match = matched(table);
  Rows rows;
  for (std::size_t r = 0; r < table.rules.size(); ++r) {
    const PrintedRule& printed = table.rules[r];
    const Rule& rule = model.rules[match[r]];
    const double away = distance(table, printed, rule);
    char reason[100];
    std::snprintf(reason, sizeof reason, "our nearest cluster lies %.2f of the range away", away);
    for (std::size_t i = 0; i < table.terms.size(); ++i) {
      const bool offset = table.terms[i] == "offset";
      const double here = offset ? rule.offset : coefficientOf(model, rule, table.columns[i]);
      rows.push_back(figure(table.terms[i] + " of rule " + std::to_string(printed.number),
                            printed.consequent[i], here, offset ? "mg/l" : "-"));
      if (away > 0.2) rows.back().incomparable = reason;
    }
  }
  return rows;
}

/// Figure 6: the sets of q_r(k-1).
Rows sets() {
  const OutputModel& model = modelD().submodels[0];
  Rows rows;
  for (std::size_t r = 0; r < model.rules.size(); ++r)
    rows.push_back(incomparable("centre of q_r(k-1), rule " + std::to_string(r + 1), notPrinted(),
                                centreOf(model, model.rules[r], {SignalKind::kInput, 0, 0}), "m3/h",
                                "curves only; the identification record was never published"));
  return rows;
}

constexpr char kBehind[] = "asp_excite, structure asp_d";

Picture setsPicture() {
  const OutputModel& model = modelD().submodels[0];
  std::size_t variable = 0;
  while (!(model.antecedents.at(variable) == Regressor{SignalKind::kInput, 0, 0})) ++variable;
  return pictureOfSets(model, variable, "q_r(k-1) [m3/h]", 0.0, 2400.0);
}

const bool kPicture = registerPicture("asp1_figure_06", setsPicture);

const bool kRegistered = registerExperiments(
    {{"asp1_figure_06", kPaper, "figure 6", "case D, sets of q_r", "curves", kBehind, sets},
     {"asp1_table_05", kPaper, "table 5", "case D, consequents of s", "12 numbers", kBehind,
      [] { return consequents(substrate()); }},
     {"asp1_table_06", kPaper, "table 6", "case D, cluster centres of s", "12 numbers", kBehind,
      [] { return centres(substrate()); }},
     {"asp1_table_07", kPaper, "table 7", "case D, consequents of x", "9 of 12 numbers", kBehind,
      [] { return consequents(biomass()); }},
     {"asp1_table_08", kPaper, "table 8", "case D, cluster centres of x", "6 numbers", kBehind,
      [] { return centres(biomass()); }}});

}  // namespace
}  // namespace fpc::tool
