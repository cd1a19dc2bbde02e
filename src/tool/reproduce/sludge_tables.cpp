// The printed models FM_1 and FM_2 of the activated-sludge thesis (vallejo2021a,
// tables 3 to 6, A1, A2), as transcribed in config/model, and what they do on our plant.
#include <algorithm>
#include <cmath>

#include "fmbpc/base/parallel.hpp"
#include "fmbpc/config/structure_file.hpp"
#include "fmbpc/fuzzy/prediction.hpp"
#include "fmbpc/loop/run.hpp"
#include "tool/reproduce/run_data.hpp"
#include "tool/reproduce/runs.hpp"

namespace fpc::tool {
namespace {

constexpr char kPaper[] = "vallejo2021a";

TsModel printed(int number) { return readLoop(number == 1 ? "asp_case1" : "asp_case2").model; }

double setsOf(const TsModel& model) {
  double count = 0.0;
  for (const auto& output : model.submodels)
    for (const auto& rule : output.rules) count += static_cast<double>(rule.antecedents.size());
  return count;
}

/// Sets whose four numbers do not rise from left foot to right foot.
double unsorted(const TsModel& model) {
  double count = 0.0;
  for (const auto& output : model.submodels)
    for (const auto& rule : output.rules)
      for (const auto& set : rule.antecedents)
        if (!std::is_sorted(set.parameters.begin(), set.parameters.end())) count += 1.0;
  return count;
}

Rows structure(int number) {
  const TsModel model = printed(number);
  const char* count = "the table's";
  return {
      check("rules of s", static_cast<double>(model.submodels.at(0).rules.size()),
            Direction::kEqual, 6.0, "-", count),
      check("rules of x", static_cast<double>(model.submodels.at(1).rules.size()),
            Direction::kEqual, 5.0, "-", count),
      check("fuzzy sets", setsOf(model), Direction::kEqual, number == 1 ? 51.0 : 40.0, "-", count)};
}

/// The own past of an output in a rule: its pole, as these models have one lag.
double largestPole(const TsModel& model, int output) {
  const OutputModel& submodel = model.submodels.at(static_cast<std::size_t>(output));
  double largest = 0.0;
  for (const auto& rule : submodel.rules)
    for (std::size_t i = 0; i < submodel.regressors.size(); ++i)
      if (submodel.regressors[i] == Regressor{SignalKind::kOutput, output, 0})
        largest = std::max(largest, std::abs(rule.coefficients[static_cast<Eigen::Index>(i)]));
  return largest;
}

double emptyRules(const TsModel& model) {
  double count = 0.0;
  for (const auto& output : model.submodels)
    for (const auto& rule : output.rules)
      if ((rule.coefficients.array() == 0.0).any()) count += 1.0;
  return count;
}

Rows coefficients(int number) {
  const TsModel model = printed(number);
  return {check("largest pole of a rule of s", largestPole(model, 0), Direction::kLower, 1.0 - 1e-9,
                "-", "a stable plant"),
          check("largest pole of a rule of x", largestPole(model, 1), Direction::kLower, 1.0 - 1e-9,
                "-", "a stable plant"),
          check("rules with zero coefficients", emptyRules(model), Direction::kLower, 0.0, "-",
                "zeros mark fits without enough data"),
          incomparable("largest pole of a rule of x, asp_c identified here", notPrinted(),
                       largestPole(readLoop("asp_case_c_own").model, 1), "-",
                       "other record, other clusters: no rule of ours stands for a printed one")};
}

/// Root mean square of the one-step error of s on open-loop records with q_r 400..1600.
Values oneStepError(int number) {
  const TsModel model = printed(number);
  const Structure structure = readStructure(findStructure("asp_d"));
  std::vector<double> errors(kSeeds, notPrinted());
  parallelFor(errors.size(), 0, [&](std::size_t i) {
    const std::string seed = std::to_string(i + 1);
    const DataSet data =
        dataOf(runLoop(readLoop("asp_excite", {{"disturbance.pattern.seed", seed},
                                               {"controller.seed", seed},
                                               {"sampling.duration_h", "166"},
                                               {"controller.signals.0.lower", "400"},
                                               {"controller.signals.0.upper", "1600"}})),
               structure);
    errors[i] = fitFigures(data.values.col(0), predictOneStep(model, data).col(0)).rmse;
  });
  return errors;
}

Rows sets(int number) {
  const TsModel model = printed(number);
  return {check("sets not sorted as left foot, left shoulder, right shoulder, right foot",
                unsorted(model), Direction::kLower, 0.0, "-",
                "the columns are printed as c_l, c_r, w_l, w_r; every row is sorted"),
          check("one-step rmse of s in this reading", oneStepError(number), Direction::kLower,
                number == 1 ? 2.5 : 25.0, "mg/l",
                "as centres and widths the error is of the order of 1e4; the limit is ours")};
}

template <Rows (*rows)(int)>
Experiment entry(const std::string& item, int model, const char* shows, const char* numbers) {
  std::string name = "asp2_" + item;
  std::replace(name.begin(), name.end(), ' ', '_');
  return {name,
          kPaper,
          item,
          std::string(model == 1 ? "FM_1: " : "FM_2: ") + shows,
          numbers,
          model == 1 ? "config/model/fm_1.yaml" : "config/model/fm_2.yaml",
          [model] { return rows(model); }};
}

const bool kSludgeTablesRegistered =
    registerExperiments({entry<structure>("table 3", 1, "names of the sets", "none"),
                         entry<coefficients>("table 4", 1, "consequents", "62 numbers"),
                         entry<structure>("table 5", 2, "names of the sets", "none"),
                         entry<coefficients>("table 6", 2, "consequents", "51 numbers"),
                         entry<sets>("table A1", 1, "membership functions", "204 numbers"),
                         entry<sets>("table A2", 2, "membership functions", "160 numbers")});

}  // namespace
}  // namespace fpc::tool
