// The identified models of the activated-sludge thesis (article 1): free-run VAF of cases A to D
// over many records. Its records were never published; those of asp_excite and
// asp_excite_validation with other seeds stand for them.
#include <cmath>
#include <map>

#include "base/parallel.hpp"
#include "config/structure_file.hpp"
#include "fmbpc/base/text.hpp"
#include "identification/identify.hpp"
#include "identification/prediction.hpp"
#include "identification/validation.hpp"
#include "papers/expression.hpp"
#include "papers/picture.hpp"
#include "papers/runs.hpp"
#include "papers/sludge_records.hpp"
#include "papers/words.hpp"

namespace fpc::papers {
namespace {

/// VAF of s and x in free run [%], of the fuzzy and of the linear model.
struct Vaf {
  double fuzzy[2]{kNotPrinted, kNotPrinted}, linear[2]{kNotPrinted, kNotPrinted};
};

/// calm: our option, an inflow that swings a quarter as much.
Vaf judged(const std::string& structure_name, bool own_record, bool calm, int seed) {
  Overrides inflow;
  if (calm) inflow = {{"disturbance.pattern.channels.q_i.range", "[1100, 1500]"}};
  const Structure structure = readStructure(findStructure(structure_name));
  const DataSet data = excited("asp_excite", structure, seed, inflow);
  const Identification found = identify(data, structure);
  const DataSet judge =
      own_record ? data : excited("asp_excite_validation", structure, seed + 1, inflow);
  const auto outputs = validateModel(found.model, found.linear, judge);
  Vaf vaf;
  for (std::size_t i = 0; i < 2; ++i) {
    vaf.fuzzy[i] = outputs.at(i).free_run.vaf;
    vaf.linear[i] = outputs.at(i).linear_free_run.vaf;
  }
  return vaf;
}

/// vaf(STRUCTURE, s|x, fuzzy|linear, own|other, usual|calm): over seeds() pairs of records; own:
/// judged on the identification data.
Values vaf(const Words& w) {
  static std::map<Words, std::vector<Vaf>> done;
  const bool own = placeOf(w[3], {"own", "other"}) == 0,
             calm = placeOf(w[4], {"usual", "calm"}) == 1;
  auto& all = done[{w[0], w[3], w[4]}];
  if (all.empty()) {
    all.resize(seeds());
    parallelFor(all.size(), 0,
                [&](std::size_t i) { all[i] = judged(w[0], own, calm, static_cast<int>(i) + 1); });
  }
  const std::size_t output = placeOf(w[1], {"s", "x"});
  const bool fuzzy = placeOf(w[2], {"fuzzy", "linear"}) == 0;
  std::vector<double> values;
  for (const Vaf& one : all) values.push_back(fuzzy ? one.fuzzy[output] : one.linear[output]);
  return values;
}

struct Case {
  const char *figure, *structure;
  bool own_record;
  double printed[2];
};

/// Measured and predicted in free run, seed 1.
Picture validationPicture(const Case& c) {
  const Structure structure = readStructure(findStructure(c.structure));
  const DataSet data = excited("asp_excite", structure, 1);
  const TsModel model = identify(data, structure).model;
  const DataSet judge = c.own_record ? data : excited("asp_excite_validation", structure, 2);
  const Matrix free_run = predictFreeRun(model, judge);
  Picture picture{"time [h]", {}};
  for (const Eigen::Index i : {0, 1}) {
    Curve measured{"plant", {}, {}}, predicted{"model, free run", {}, {}};
    for (Eigen::Index k = 0; k < judge.rows(); ++k) {
      if (!std::isfinite(free_run(k, i))) continue;
      measured.x.push_back(0.2 * static_cast<double>(k));
      measured.y.push_back(judge.values(k, i));
      predicted.y.push_back(free_run(k, i));
    }
    predicted.x = measured.x;
    predicted.label = "model, free run: VAF " +
                      shortText(fitFigures(judge.values.col(i), free_run.col(i)).vaf) +
                      " %, printed " + shortText(c.printed[i]) + " %";
    picture.panels.push_back({i == 0 ? "s [mg/l]" : "x [mg/l]", {measured, predicted}});
  }
  return picture;
}

const bool kPictures = [] {
  for (const Case& c : {Case{"asp1_figure_07", "asp_a", true, {92.0, 92.0}},
                        {"asp1_figure_08", "asp_b", false, {62.0, 42.0}},
                        {"asp1_figure_09", "asp_c", true, {99.0, 87.0}},
                        {"asp1_figure_10", "asp_d", false, {95.0, 66.0}}})
    registerPicture(c.figure, [c] { return validationPicture(c); });
  return registerComputation("vaf", 5, vaf);
}();

}  // namespace
}  // namespace fpc::papers
