// The printed models FM_1 and FM_2 of the activated-sludge thesis (vallejo2021a, tables 3 to 6, A1,
// A2): beside what our records give with the same structure, as transcribed in config/model, and as
// predictors of our plant.
#include <cmath>

#include "base/parallel.hpp"
#include "config/structure_file.hpp"
#include "identification/prediction.hpp"
#include "papers/expression.hpp"
#include "papers/runs.hpp"
#include "papers/sludge_printed.hpp"
#include "papers/sludge_records.hpp"
#include "papers/words.hpp"

namespace fpc::papers {
namespace {

/// Models are named 1 and 2.
int numberOf(const std::string& word) { return static_cast<int>(placeOf(word, {"1", "2"})) + 1; }

TsModel shipped(int number) { return readLoop(number == 1 ? "asp_case1" : "asp_case2").model; }

/// fuzzy_sets(MODEL): how many the model has.
Values fuzzySets(const Words& w) {
  double sets = 0.0;
  for (const auto& output : shipped(numberOf(w[0])).submodels)
    for (const auto& rule : output.rules) sets += static_cast<double>(rule.antecedents.size());
  return sets;
}

/// not_held(MODEL, consequents|sets): how many numbers of the table the model file does not hold.
Values notHeld(const Words& w) {
  const int number = numberOf(w[0]);
  const TsModel model = shipped(number);
  std::vector<std::vector<double>> held;
  if (placeOf(w[1], {"consequents", "sets"}) == 0) {
    for (const auto& output : model.submodels)
      for (const auto& rule : output.rules) {
        held.emplace_back(rule.coefficients.data(),
                          rule.coefficients.data() + rule.coefficients.size());
        held.back().push_back(rule.offset);
      }
    return unlike(printedConsequents(number), held);
  }
  for (const auto& output : model.submodels)
    for (std::size_t i = 0; i < output.antecedents.size(); ++i)
      for (const auto& rule : output.rules) held.push_back(rule.antecedents.at(i).parameters);
  return unlike(printedSets(number), held);
}

/// printed_middle(MODEL, s|x, TERM): the median over the printed rules.
Values printedMiddle(const Words& w) {
  const int number = numberOf(w[0]);
  const TsModel shape = shipped(number);
  const std::size_t output = placeOf(w[1], {"s", "x"}), term = toIndex(w[2]);
  const std::size_t first = output == 0 ? 0 : shape.submodels[0].rules.size();
  std::vector<double> values;
  for (std::size_t r = 0; r < shape.submodels[output].rules.size(); ++r)
    values.push_back(printedConsequents(number).at(first + r).at(term));
  return Values(values).median();
}

/// The median over the rules of an output's coefficient, by the name of the regressor, whatever its
/// place in the model. NaN without such a regressor.
double middle(const TsModel& model, std::size_t output, const std::string& regressor) {
  const OutputModel& submodel = model.submodels.at(output);
  std::size_t place = 0;
  while (place < submodel.regressors.size() && model.text(submodel.regressors[place]) != regressor)
    ++place;
  const bool offset = regressor == "offset";
  if (!offset && place == submodel.regressors.size()) return kNotPrinted;
  std::vector<double> values;
  for (const Rule& rule : submodel.rules)
    values.push_back(offset ? rule.offset : rule.coefficients[static_cast<Eigen::Index>(place)]);
  return Values(values).median();
}

/// middle_term(MODEL, s|x, TERM): of the models that our records give with the printed structure.
/// Clusters lie where the record is, so that no rule of ours stands for a printed one.
Values middleTerm(const Words& w) {
  const int number = numberOf(w[0]);
  const std::size_t output = placeOf(w[1], {"s", "x"}), term = toIndex(w[2]);
  const TsModel shape = shipped(number);
  const auto& regressors = shape.submodels[output].regressors;
  const std::string name = term < regressors.size() ? shape.text(regressors[term]) : "offset";
  std::vector<double> values;
  for (const TsModel& model : modelsOver(number == 1 ? "asp_c" : "asp_a"))
    values.push_back(middle(model, output, name));
  return values;
}

/// Records with q_r 400..1600 and all signals of the loops, run once.
const std::vector<DataSet>& records() {
  static const std::vector<DataSet> data = [] {
    const Structure structure = readStructure(findStructure("asp_d"));
    std::vector<DataSet> fresh(seeds());
    parallelFor(fresh.size(), 0, [&](std::size_t i) {
      fresh[i] =
          excited("asp_excite", structure, static_cast<int>(i) + 1,
                  {{"sampling.duration_h", "166"}, {"controller.signals.0.range", "[400, 1600]"}});
    });
    return fresh;
  }();
  return data;
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

/// one_step(MODEL, s|x, printed|still|headed): rms error over one sample; still: nothing changes;
/// headed: the sets read as the head of the appendix says.
Values oneStep(const Words& w) {
  const TsModel shipped_model = shipped(numberOf(w[0]));
  const auto output = static_cast<Eigen::Index>(placeOf(w[1], {"s", "x"}));
  const std::size_t kind = placeOf(w[2], {"printed", "still", "headed"});
  const TsModel model = kind == 0   ? shipped_model
                        : kind == 1 ? persistence(shipped_model)
                                    : asHeaded(shipped_model);
  std::vector<double> errors;
  for (const DataSet& data : records())
    errors.push_back(
        fitFigures(data.values.col(output), predictOneStep(model, data).col(output)).rmse);
  return errors;
}

const bool kRegistered = registerComputation("fuzzy_sets", 1, fuzzySets) &&
                         registerComputation("not_held", 2, notHeld) &&
                         registerComputation("printed_middle", 3, printedMiddle) &&
                         registerComputation("middle_term", 3, middleTerm) &&
                         registerComputation("one_step", 3, oneStep);

}  // namespace
}  // namespace fpc::papers
