// The printed rules of case D of the activated-sludge thesis (article 1, tables 5 to 8 and figure
// 6) beside those of our record: clusters are matched by their centres.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "config/structure_file.hpp"
#include "fmbpc/base/input_error.hpp"
#include "identification/identify.hpp"
#include "papers/expression.hpp"
#include "papers/picture.hpp"
#include "papers/run_data.hpp"
#include "papers/runs.hpp"
#include "papers/words.hpp"

namespace fpc::papers {
namespace {

/// Centres of a table, a row a rule; the spans are for distances.
struct PrintedCentres {
  std::vector<Regressor> columns;
  std::vector<double> spans;
  std::vector<std::vector<double>> rules;
};

// The third printed column of tables 5 and 6 is q_r(k-2), as algorithm 2 shows for rules 1 and 2.
const PrintedCentres kTables[] = {
    {{{SignalKind::kOutput, 0, 0}, {SignalKind::kOutput, 1, 0}, {SignalKind::kInput, 0, 1}},
     {150.0, 600.0, 2000.0},
     {{57.1, 1840.0, 829.0},
      {57.2, 1990.0, 1070.0},
      {106.0, 1990.0, 790.0},
      {166.0, 1900.0, 1560.0}}},
    {{{SignalKind::kOutput, 1, 0}, {SignalKind::kInput, 0, 0}},
     {600.0, 2000.0},
     {{1800.0, 568.0}, {1820.0, 481.0}, {2120.0, 996.0}}}};

const OutputModel& modelD(std::size_t output) {
  static const TsModel model = [] {
    const Structure structure = readStructure(findStructure("asp_d"));
    return identify(dataOf(recordOf("asp_excite"), structure), structure).model;
  }();
  return model.submodels[output];
}

double centreOf(const OutputModel& model, const Rule& rule, const Regressor& column) {
  for (std::size_t i = 0; i < model.antecedents.size(); ++i)
    if (model.antecedents[i] == column) return rule.antecedents[i].parameters[0];
  return kNotPrinted;
}

/// Distance of a printed centre from one of ours, in shares of the ranges.
double distance(std::size_t output, std::size_t printed, const Rule& rule) {
  const PrintedCentres& table = kTables[output];
  double sum = 0.0;
  for (std::size_t i = 0; i < table.columns.size(); ++i)
    sum += std::pow((centreOf(modelD(output), rule, table.columns[i]) - table.rules[printed][i]) /
                        table.spans[i],
                    2);
  return std::sqrt(sum);
}

/// Which of our rules stands for each printed one: the assignment of least distance in all.
std::vector<std::size_t> matched(std::size_t output) {
  const auto& rules = modelD(output).rules;
  const std::size_t printed = kTables[output].rules.size();
  require(rules.size() >= printed, "asp_d", "as many rules as are printed");
  std::vector<std::size_t> order(rules.size()), best;
  std::iota(order.begin(), order.end(), std::size_t{0});
  double least = INFINITY;
  do {
    double sum = 0.0;
    for (std::size_t i = 0; i < printed; ++i) sum += distance(output, i, rules[order[i]]);
    if (!(sum < least)) continue;
    least = sum;
    best = order;
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

const Rule& matchOf(std::size_t output, const std::string& printed) {
  return modelD(output).rules[matched(output).at(toIndex(printed))];
}

/// matched_centre(s|x, PRINTED RULE, COLUMN), matched_term(s|x, PRINTED RULE, COLUMN or offset),
/// matched_distance(s|x, PRINTED RULE): of our rule that stands for a printed one.
Values matchedCentre(const Words& w) {
  const std::size_t output = placeOf(w[0], {"s", "x"});
  return centreOf(modelD(output), matchOf(output, w[1]), kTables[output].columns.at(toIndex(w[2])));
}

Values matchedTerm(const Words& w) {
  const std::size_t output = placeOf(w[0], {"s", "x"});
  const OutputModel& model = modelD(output);
  const Rule& rule = matchOf(output, w[1]);
  if (w[2] == "offset") return rule.offset;
  const Regressor& column = kTables[output].columns.at(toIndex(w[2]));
  for (std::size_t i = 0; i < model.regressors.size(); ++i)
    if (model.regressors[i] == column) return rule.coefficients[static_cast<Eigen::Index>(i)];
  return kNotPrinted;
}

Values matchedDistance(const Words& w) {
  const std::size_t output = placeOf(w[0], {"s", "x"});
  return distance(output, toIndex(w[1]), matchOf(output, w[1]));
}

/// recirculation_centre(RULE): of the sets of q_r(k-1) in the model of s, in our order.
Values recirculationCentre(const Words& w) {
  return centreOf(modelD(0), modelD(0).rules.at(toIndex(w[0])), {SignalKind::kInput, 0, 0});
}

Picture setsPicture() {
  const OutputModel& model = modelD(0);
  std::size_t variable = 0;
  while (!(model.antecedents.at(variable) == Regressor{SignalKind::kInput, 0, 0})) ++variable;
  return pictureOfSets(model, variable, "q_r(k-1) [m3/h]", 0.0, 2400.0);
}

const bool kPicture = registerPicture("asp1_figure_06", setsPicture);

const bool kRegistered = registerComputation("matched_centre", 3, matchedCentre) &&
                         registerComputation("matched_term", 3, matchedTerm) &&
                         registerComputation("matched_distance", 2, matchedDistance) &&
                         registerComputation("recirculation_centre", 1, recirculationCentre);

}  // namespace
}  // namespace fpc::papers
