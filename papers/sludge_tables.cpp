// The printed models FM_1 and FM_2 of the activated-sludge thesis (vallejo2021a, tables 3 to 6, A1,
// A2): beside what our records give with the same structure, as transcribed in config/model, and as
// predictors of our plant.
#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "config/structure_file.hpp"
#include "identification/prediction.hpp"
#include "papers/runs.hpp"
#include "papers/sludge_printed.hpp"
#include "papers/sludge_records.hpp"

namespace fpc::tool {
namespace {

constexpr char kPaper[] = "vallejo2021a";

TsModel shipped(int number) { return readLoop(number == 1 ? "asp_case1" : "asp_case2").model; }

/// Structures with the regressors and the numbers of rules of the printed model.
const char* structureOf(int number) { return number == 1 ? "asp_c" : "asp_a"; }

/// Tables 3 and 5.
Rows names(int number) {
  const std::string reason = number == 1 ? "names only; the numbers of the sets are in table A1"
                                         : "names only; the numbers of the sets are in table A2";
  double sets = 0.0;
  for (const auto& output : shipped(number).submodels)
    for (const auto& rule : output.rules) sets += static_cast<double>(rule.antecedents.size());
  return {incomparable("fuzzy sets", notPrinted(), sets, "-", reason)};
}

/// Coefficients, then the offset, of every rule of s, then of x.
std::vector<std::vector<double>> consequentsOf(const TsModel& model) {
  std::vector<std::vector<double>> all;
  for (const auto& output : model.submodels)
    for (const auto& rule : output.rules) {
      all.emplace_back(rule.coefficients.data(),
                       rule.coefficients.data() + rule.coefficients.size());
      all.back().push_back(rule.offset);
    }
  return all;
}

/// In the order of tables A1 and A2.
std::vector<std::vector<double>> setsOf(const TsModel& model) {
  std::vector<std::vector<double>> all;
  for (const auto& output : model.submodels)
    for (std::size_t i = 0; i < output.antecedents.size(); ++i)
      for (const auto& rule : output.rules) all.push_back(rule.antecedents.at(i).parameters);
  return all;
}

ReproduceRow transcription(const std::vector<std::vector<double>>& printed,
                           const std::vector<std::vector<double>>& held) {
  std::size_t numbers = 0;
  for (const auto& row : printed) numbers += row.size();
  return check("numbers of the table that the model file does not hold", unlike(printed, held),
               Direction::kLower, 0.0, "of " + std::to_string(numbers), "transcription");
}

/// Of one column of a printed table over `count` rules from `first` on.
double middle(const std::vector<std::vector<double>>& rows, std::size_t first, std::size_t count,
              std::size_t column) {
  std::vector<double> values;
  for (std::size_t r = first; r < first + count; ++r) values.push_back(rows.at(r).at(column));
  return Values(values).median();
}

/// Of an output's rules, by the name of the regressor, whatever its place in the model; empty: the
/// offset. NaN without such a regressor.
double middle(const TsModel& model, std::size_t output, const std::string& regressor) {
  const OutputModel& submodel = model.submodels.at(output);
  std::size_t place = 0;
  while (place < submodel.regressors.size() && model.text(submodel.regressors[place]) != regressor)
    ++place;
  if (!regressor.empty() && place == submodel.regressors.size()) return notPrinted();
  std::vector<double> values;
  for (const Rule& rule : submodel.rules)
    values.push_back(regressor.empty() ? rule.offset
                                       : rule.coefficients[static_cast<Eigen::Index>(place)]);
  return Values(values).median();
}

/// Column by column the median over the rules, printed and identified: clusters lie where the
/// record is, so that no rule of ours stands for a printed one.
Rows identifiedBeside(int number) {
  const TsModel shape = shipped(number);
  Rows rows;
  std::vector<double> off;
  std::size_t first = 0;
  for (std::size_t o = 0; o < shape.submodels.size(); ++o) {
    const OutputModel& submodel = shape.submodels[o];
    for (std::size_t i = 0; i <= submodel.regressors.size(); ++i) {
      const bool offset = i == submodel.regressors.size();
      const std::string regressor = offset ? "" : shape.text(submodel.regressors[i]);
      const double paper = middle(printedConsequents(number), first, submodel.rules.size(), i);
      std::vector<double> here;
      for (const TsModel& model : modelsOver(structureOf(number)))
        here.push_back(middle(model, o, regressor));
      rows.push_back(
          figure(shape.outputs[o].name + "(k+1), " +
                     (offset ? "offset" : "coefficient of " + regressor) + ", median of the rules",
                 paper, here, offset ? "mg/l" : "per unit", {0.1}, "our records and clusters"));
      if (paper != 0.0) off.push_back(100.0 * std::abs(Values(here).median() / paper - 1.0));
    }
    first += submodel.rules.size();
  }
  rows.push_back(check("median deviation of these medians (those printed as 0 apart)",
                       Values(off).median(), Direction::kLower, 10.0, "%", "the limit is ours"));
  return rows;
}

/// Records with q_r 400..1600 and all signals of the loops, run once.
const std::vector<DataSet>& records() {
  static std::vector<DataSet> data;
  if (!data.empty()) return data;
  const Structure structure = readStructure(findStructure("asp_d"));
  std::vector<DataSet> fresh(kSeeds);
  parallelFor(fresh.size(), 0, [&](std::size_t i) {
    fresh[i] = excited("asp_excite", structure, static_cast<int>(i) + 1,
                       {{"sampling.duration_h", "166"},
                        {"controller.signals.0.lower", "400"},
                        {"controller.signals.0.upper", "1600"}});
  });
  return data = std::move(fresh);
}

/// Root mean square of the error over one sample.
Values oneStepError(const TsModel& model, Eigen::Index output) {
  std::vector<double> errors;
  for (const DataSet& data : records())
    errors.push_back(
        fitFigures(data.values.col(output), predictOneStep(model, data).col(output)).rmse);
  return errors;
}

/// The model that says that nothing changes, with the signals of another.
TsModel persistence(TsModel model) {
  for (std::size_t o = 0; o < model.submodels.size(); ++o) {
    Rule rule;
    rule.coefficients = Vector::Ones(1);
    model.submodels[o] = {{}, {{SignalKind::kOutput, static_cast<int>(o), 0}}, {rule}};
  }
  return model;
}

/// Tables 4 and 6.
Rows coefficients(int number) {
  const TsModel model = shipped(number), still = persistence(model);
  Rows rows{transcription(printedConsequents(number), consequentsOf(model))};
  for (const auto& row : identifiedBeside(number)) rows.push_back(row);
  for (const Eigen::Index i : {0, 1}) {
    rows.push_back(check(
        std::string("one-step error of ") + (i == 0 ? "s" : "x") + ", printed model / no change",
        ratio(oneStepError(model, i), oneStepError(still, i)), Direction::kLower, 1.0, "-",
        "rms on our plant; ours"));
  }
  return rows;
}

/// The numbers of the appendix as its head reads them: centres c_l, c_r and widths w_l, w_r of
/// exp(-((x - c) / (2 w))^2), in the sets of the model file, exp(-7 ((x - p) / width)^2).
TsModel asHeaded(TsModel model) {
  const double stretch = 2.0 * std::sqrt(7.0);
  for (auto& output : model.submodels)
    for (auto& rule : output.rules)
      for (auto& set : rule.antecedents) {
        const std::vector<double> p = set.parameters;
        set.parameters = {p[0] - stretch * p[2], p[0], p[1], p[1] + stretch * p[3]};
      }
  return model;
}

/// Tables A1 and A2.
Rows sets(int number) {
  const TsModel model = shipped(number);
  const Values error = oneStepError(model, 0);
  return {transcription(printedSets(number), setsOf(model)),
          check("one-step rms error of s, sets read as feet and shoulders", error,
                Direction::kLower, number == 1 ? 2.5 : 25.0, "mg/l", "the limit is ours"),
          check("the same, read as the head says (centres, widths), over it",
                ratio(oneStepError(asHeaded(model), 0), error), Direction::kHigher, 1.0, "-",
                "why the model file reads them otherwise")};
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
          std::string(model == 1 ? "config/model/fm_1.yaml" : "config/model/fm_2.yaml") +
              ", asp_excite, structure " + structureOf(model),
          [model] { return rows(model); }};
}

const bool kRegistered =
    registerExperiments({entry<names>("table 3", 1, "names of the sets", "none"),
                         entry<coefficients>("table 4", 1, "consequents", "62 numbers"),
                         entry<names>("table 5", 2, "names of the sets", "none"),
                         entry<coefficients>("table 6", 2, "consequents", "51 numbers"),
                         entry<sets>("table A1", 1, "membership functions", "204 numbers"),
                         entry<sets>("table A2", 2, "membership functions", "160 numbers")});

}  // namespace
}  // namespace fpc::tool
