// The identified model of the batch reactor (karer2007, section 5). The plant's parameters are not
// printed; ours were fitted to the printed models, so that their agreement is partly circular.
#include <random>

#include "base/parallel.hpp"
#include "config/structure_file.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/plant/plant.hpp"
#include "identification/identify.hpp"
#include "papers/expression.hpp"
#include "papers/picture.hpp"
#include "papers/runs.hpp"
#include "papers/words.hpp"
#include "plant/integrator.hpp"

namespace fpc::papers {
namespace {

constexpr Eigen::Index kSamples = 5000;

/// Columns T, Tw, kM, kC, kH: mode and mixing valve independent and uniform.
Matrix excite(unsigned seed) {
  std::mt19937_64 generator(seed);
  const auto plant = makePlant("batch_reactor");
  IntegratorParams tight;
  tight.relative_tolerance = tight.absolute_tolerance = 1e-9;
  Integrator integrator(*plant, tight);
  Matrix values(kSamples + 1, 5);
  Vector x = Eigen::Vector2d(20.0, 20.0);
  Eigen::Vector3d u = Eigen::Vector3d::Zero();
  int left = 0;
  for (Eigen::Index k = 0; k <= kSamples; ++k) {
    if (left-- == 0) {
      const bool hot = generator() % 2 == 0;
      const double positions[] = {0.0, 0.01, 0.02, 0.05, 0.1, 1.0};
      u << positions[generator() % 6], (hot ? 0.0 : 1.0), (hot ? 1.0 : 0.0);
      left = static_cast<int>(generator() % 15U);
    }
    values.row(k) << x.transpose(), u.transpose();
    require(integrator.advance(x, u, Eigen::Vector3d(12.0, 75.0, 20.0), 10.0).ok(), "batch_reactor",
            "an integrator that goes on");
  }
  return values;
}

const std::vector<TsModel>& identified() {
  static const std::vector<TsModel> all = [] {
    const Structure structure = readStructure(findStructure("batch_reactor"));
    std::vector<TsModel> models(seeds());
    parallelFor(models.size(), 0, [&](std::size_t i) {
      models[i] =
          identify(makeDataSet(excite(static_cast<unsigned>(i + 1)), structure, "simulated"),
                   structure)
              .model;
    });
    return models;
  }();
  return all;
}

/// batch_coefficient(OUTPUT, RULE, TERM) over 24 records; a term past the last: the offset.
Values coefficient(const Words& w) {
  std::vector<double> values;
  for (const TsModel& model : identified()) {
    const Rule& r = model.submodels.at(toIndex(w[0])).rules.at(toIndex(w[1]));
    const auto term = static_cast<Eigen::Index>(toIndex(w[2]));
    values.push_back(term < r.coefficients.size() ? r.coefficients[term] : r.offset);
  }
  return values;
}

/// batch_samples(RULE): what a record leaves for each set of the jacket.
Values samples(const Words& w) {
  std::vector<double> values;
  for (const TsModel& model : identified())
    values.push_back(static_cast<double>(model.submodels.at(1).rules.at(toIndex(w[0])).data_count));
  return values;
}

/// batch_record(T|Tw, SAMPLES): the first samples of the identification record.
Values record(const Words& w) {
  const Matrix values = excite(1);
  const auto column = static_cast<Eigen::Index>(placeOf(w[0], {"T", "Tw"}));
  return std::vector<double>(values.col(column).data(), values.col(column).data() + toIndex(w[1]));
}

Picture recordPicture(Eigen::Index count) {
  const Matrix values = excite(1).topRows(count);
  Panel panel{"temperature [degC]", {}};
  for (const auto& [column, name] : {std::pair<Eigen::Index, const char*>{0, "T"}, {1, "Tw"}}) {
    Curve curve{name, {}, {}};
    for (Eigen::Index k = 0; k < count; ++k) {
      curve.x.push_back(10.0 * static_cast<double>(k));
      curve.y.push_back(values(k, column));
    }
    panel.curves.push_back(std::move(curve));
  }
  return {"time [s]", {panel}};
}

Picture setsPicture() {
  OutputModel hot = readLoop("batch_fuzzy_eq45").model.submodels.at(1);
  hot.rules.resize(5);
  return pictureOfSets(hot, hot.antecedents.size() - 1, "Tw [degC]", 10.0, 75.0);
}

const bool kPictures = registerPicture("batch_figure_03", [] { return recordPicture(kSamples); }) &&
                       registerPicture("batch_figure_04", [] { return recordPicture(1000); }) &&
                       registerPicture("batch_figure_05", setsPicture);

const bool kRegistered = registerComputation("batch_coefficient", 3, coefficient) &&
                         registerComputation("batch_samples", 1, samples) &&
                         registerComputation("batch_record", 2, record);

}  // namespace
}  // namespace fpc::papers
