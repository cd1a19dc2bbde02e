// Plants of taieb2017: models identified from their own records (fuzzy c-means, weighted
// recursive least squares), and how fast the tank can be at all.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "config/model_file.hpp"
#include "config/structure_file.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "identification/identify.hpp"
#include "identification/validation.hpp"
#include "papers/shortest_step.hpp"
#include "paths.hpp"
#include "plant/integrator.hpp"
#include "runtime/report.hpp"
#include "runtime/run.hpp"

namespace fpc {
namespace paper_taieb_plants_test {

std::string config(const std::string& file) { return sourceDir() + "/config/" + file; }

DataSet recordOf(const std::string& name, const std::string& structure,
                 const Overrides& overrides = {}) {
  const LoopFile loop = readLoop(name, overrides);
  const RunRecord record = runLoop(loop);
  std::string folder = resultsDir() + "/" + name;
  for (const auto& [key, value] : overrides) folder += "_" + value;
  writeRun(loop, record, summarize(loop, record, 0.0), folder);
  return makeDataSet(readCsv(folder + "/trajectory.csv"),
                     readStructure(config("structure/" + structure + ".yaml")));
}

TsModel identified(const DataSet& data, const std::string& structure) {
  const Identification found =
      identify(data, readStructure(config("structure/" + structure + ".yaml")));
  EXPECT_TRUE(found.remarks.empty()) << found.remarks.front();
  return found.model;
}

void expectSame(const TsModel& shipped, const TsModel& model) {
  ASSERT_EQ(shipped.submodels.size(), model.submodels.size());
  for (std::size_t j = 0; j < model.submodels.size(); ++j) {
    ASSERT_EQ(shipped.submodels[j].rules.size(), model.submodels[j].rules.size());
    for (std::size_t i = 0; i < model.submodels[j].rules.size(); ++i) {
      const Rule &a = shipped.submodels[j].rules[i], &b = model.submodels[j].rules[i];
      EXPECT_LT((a.coefficients - b.coefficients).norm(), 1e-6 * b.coefficients.norm()) << i;
      EXPECT_NEAR(a.offset, b.offset, 1e-6 * (1e-3 + std::abs(b.offset))) << i;
    }
  }
}

TEST(SurgeTankModel, FindsARelativeDegreeOfTwoAndRunsFree) {
  const DataSet data = recordOf("surge_tank_excite", "surge_tank");
  EXPECT_EQ(data.rows(), 1003);
  const auto level = data.values.col(0);
  EXPECT_TRUE(level.minCoeff() >= 0.1 && level.maxCoeff() <= 0.4) << "of the page's range";
  const TsModel model = identified(data, "surge_tank");
  expectSame(readModel(config("model/surge_tank.yaml")), model);
  ASSERT_EQ(model.submodels[0].rules.size(), 2U);
  for (const Rule& rule : model.submodels[0].rules) {
    const double b1 = rule.coefficients[3], b2 = rule.coefficients[4];
    std::printf("a %.4f %.4f %.4f, b %.2e %.5f\n", rule.coefficients[0], rule.coefficients[1],
                rule.coefficients[2], b1, b2);
    EXPECT_LT(std::abs(b1), 5e-4);
    const double printed = std::round(1e4 * b2) / 1e4;  // the Euler step's own b2 is 0.025 exactly
    EXPECT_TRUE(printed >= 0.025 && printed <= 0.027) << b2;
  }
  for (int seed = 2; seed <= 8; ++seed) {
    const DataSet other =
        recordOf("surge_tank_excite", "surge_tank", {{"seed", std::to_string(seed)}});
    const double fit = validateModel(model, model, other)[0].free_run.fit;
    std::printf("free run on the record of seed %d: fit %.3f %%\n", seed, fit);
    EXPECT_GE(fit, 99.5) << "seed " << seed;
  }
}

/// Model and plant from sample to sample at (Ca, T) and its steady inputs: y+ = A y + B u.
struct Local {
  Eigen::Matrix2d A, B;
  Eigen::Matrix2d steadyInputs() const {  ///< the inverse of the steady-state gain
    return B.inverse() * (Eigen::Matrix2d::Identity() - A);
  }
};

struct Point {
  double Ca, T, q, qc;
};
constexpr Point kPoints[] = {{0.1, 441.0, 113.53834294353697, 111.24888166241804},
                             {0.05, 450.0, 84.64287547717261, 76.18637873176176},
                             {0.15, 430.0, 100.9562377231301, 113.81856348845041},
                             {0.25, 416.0, 87.18465274732229, 111.16707034135737}};

/// Sum of the consequents weighed by their firing, at a point.
Vector predicted(const TsModel& model, const Vector& y, const Vector& u) {
  Vector next(2), x(4);
  x << y, u;
  FiringResult firing;
  for (std::size_t j = 0; j < 2; ++j) {
    const OutputModel& submodel = model.submodels[j];
    firingWeights(submodel, y, firing);
    next[static_cast<Eigen::Index>(j)] = 0.0;
    for (std::size_t i = 0; i < submodel.rules.size(); ++i)
      next[static_cast<Eigen::Index>(j)] +=
          firing.weights[static_cast<Eigen::Index>(i)] *
          (submodel.rules[i].coefficients.dot(x) + submodel.rules[i].offset);
  }
  return next;
}

Local modelAt(const TsModel& model, const Point& p) {
  Local local;
  FiringResult firing;
  for (std::size_t j = 0; j < 2; ++j) {
    const OutputModel& submodel = model.submodels[j];
    firingWeights(submodel, Eigen::Vector2d(p.Ca, p.T), firing);
    Vector sum = Vector::Zero(4);
    for (std::size_t i = 0; i < submodel.rules.size(); ++i)
      sum += firing.weights[static_cast<Eigen::Index>(i)] * submodel.rules[i].coefficients;
    local.A.row(static_cast<Eigen::Index>(j)) = sum.head(2).transpose();
    local.B.row(static_cast<Eigen::Index>(j)) = sum.tail(2).transpose();
  }
  return local;
}

Local plantAt(const Point& p) {
  const auto plant = makePlant("mimo_cstr");
  IntegratorParams tight;
  tight.relative_tolerance = tight.absolute_tolerance = 1e-12;
  Integrator cvode(*plant, tight);
  const Vector feed = Eigen::Vector3d(1.0, 350.0, 350.0);
  const Eigen::Vector4d at(p.Ca, p.T, p.q, p.qc), step(1e-4, 1e-2, 1e-1, 1e-1);
  Local local;
  for (Eigen::Index i = 0; i < 4; ++i) {
    Eigen::Vector4d up = at, down = at;
    up[i] += step[i];
    down[i] -= step[i];
    Vector after_up = up.head(2), after_down = down.head(2);
    EXPECT_TRUE(cvode.advance(after_up, up.tail(2), feed, 0.6).ok());
    EXPECT_TRUE(cvode.advance(after_down, down.tail(2), feed, 0.6).ok());
    const Eigen::Vector2d slope = (after_up - after_down) / (2.0 * step[i]);
    (i < 2 ? local.A.col(i) : local.B.col(i - 2)) = slope;
  }
  return local;
}

/// Relative difference, rows and columns counted in 0.1 mol/l, 20 K and 50 l/min.
double difference(const Eigen::Matrix2d& a, const Eigen::Matrix2d& b, const Eigen::Vector2d& row,
                  const Eigen::Vector2d& column) {
  const auto scaled = [&](const Eigen::Matrix2d& m) {
    return Eigen::Matrix2d(row.cwiseInverse().asDiagonal() * m * column.asDiagonal());
  };
  return (scaled(a) - scaled(b)).norm() / scaled(b).norm();
}

/// Fit [%] of free runs of `length` samples, begun anew one after the other.
Eigen::Vector2d shortRunFit(const TsModel& model, const DataSet& data, Eigen::Index length) {
  Eigen::Vector2d error = Eigen::Vector2d::Zero(), spread = Eigen::Vector2d::Zero();
  const Eigen::Vector2d mean = data.values.leftCols(2).colwise().mean().transpose();
  Vector y = data.values.row(0).head(2).transpose();
  for (Eigen::Index k = 0; k + 1 < data.rows(); ++k) {
    if (k % length == 0) y = data.values.row(k).head(2).transpose();
    y = predicted(model, y, data.values.row(k).segment(2, 2).transpose());
    const Eigen::Vector2d measured = data.values.row(k + 1).head(2).transpose();
    error += (measured - y).cwiseAbs2();
    spread += (measured - mean).cwiseAbs2();
  }
  return (100.0 * (1.0 - error.cwiseQuotient(spread).cwiseSqrt().array())).matrix();
}

TEST(MimoCstrModel, SharesItsPartitionAndKnowsTheReactorAtTheSetpoints) {
  const DataSet data = recordOf("mimo_cstr_excite", "mimo_cstr");
  const TsModel model = identified(data, "mimo_cstr");
  expectSame(readModel(config("model/mimo_cstr.yaml")), model);
  const auto &of_Ca = model.submodels[0].rules, &of_T = model.submodels[1].rules;
  ASSERT_EQ(of_Ca.size(), 4U);
  ASSERT_EQ(of_T.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(of_Ca[i].antecedents, of_T[i].antecedents) << i;
  const Eigen::Vector2d outputs(0.1, 20.0), inputs(50.0, 50.0);
  for (const Point& p : kPoints) {
    const Local ours = modelAt(model, p), plant = plantAt(p);
    const double B = difference(ours.B, plant.B, outputs, inputs);
    const double steady = difference(ours.steadyInputs(), plant.steadyInputs(), inputs, outputs);
    const Eigen::Matrix2d gain = ours.steadyInputs().inverse(),
                          plant_gain = plant.steadyInputs().inverse();
    std::printf(
        "(%.2f, %.0f): input matrix off by %.1f %%, steady inputs by %.1f %%, gain by %.0f %%\n",
        p.Ca, p.T, 100.0 * B, 100.0 * steady,
        100.0 * difference(gain, plant_gain, outputs, inputs));
    EXPECT_LT(B, 0.05);
    EXPECT_LT(steady, 0.10);
  }
}

TEST(MimoCstrModel, PredictsARecordThatItDoesNotKnow) {
  const TsModel model = readModel(config("model/mimo_cstr.yaml"));
  const DataSet other = recordOf("mimo_cstr_excite_validation", "mimo_cstr");
  const auto validation = validateModel(model, model, other);
  const Eigen::Vector2d half_a_minute = shortRunFit(model, other, 50);
  std::printf("fit of Ca, T: one step %.2f, %.2f %%; runs of 50 samples %.2f, %.2f %%\n",
              validation[0].one_step.fit, validation[1].one_step.fit, half_a_minute[0],
              half_a_minute[1]);
  EXPECT_GE(validation[0].one_step.fit, 99.5);
  EXPECT_GE(validation[1].one_step.fit, 99.5);
  EXPECT_GE(half_a_minute.minCoeff(), 95.0);
}

TEST(SurgeTankBound, NoControllerRisesFasterThanThePumpAllows) {
  const std::pair<double, double> steps[] = {{0.15, 0.20}, {0.20, 0.25}, {0.25, 0.30}};
  for (const auto& [from, to] : steps) {
    const double flow = 6e-5 * std::sqrt(2.0 * 9.81 * (from - 0.015));
    const LoopFile loop =
        readLoop("surge_tank_up", {{"plant.initial_state.H", exactText(from)},
                                   {"plant.initial_state.Q", exactText(flow)},
                                   {"actuator.initial.I", exactText(10.0 * flow)}});
    const ShortestStep bound = shortestStep(loop, to, 0.5);
    std::printf("%.2f to %.2f m: at least %.3f s, pump on for %.3f s\n", from, to, bound.rise_s,
                bound.pulse_s);
    EXPECT_GE(bound.rise_s, 1.53);
    EXPECT_LE(bound.rise_s, 1.7);
    EXPECT_NEAR(bound.overshoot_percent, 0.5, 1e-6);
  }
}

TEST(SurgeTankBound, TheOutletSetsThePaceOfAStepDown) {
  const ShortestStep bound = shortestStep(readLoop("surge_tank_down"), 0.25, 0.5);
  std::printf("0.30 to 0.25 m: at least %.3f s\n", bound.rise_s);
  EXPECT_GE(bound.rise_s, 11.82) << "Torricelli's time, without the rest of the pump's flow";
  EXPECT_LE(bound.rise_s, 12.0);
}

TEST(SurgeTankBound, MoreOvershootAndMoreCurrentAllowAFasterStep) {
  const LoopFile loop = readLoop("surge_tank_up"),
                 strong = readLoop("surge_tank_up", {{"actuator.input_upper", "{I: 1}"}});
  const double rise_s = shortestStep(loop, 0.20, 0.5).rise_s;
  EXPECT_LT(shortestStep(loop, 0.20, 10.0).rise_s, rise_s);
  EXPECT_LT(shortestStep(strong, 0.20, 0.5).rise_s, rise_s);
  EXPECT_GT(shortestStep(strong, 0.20, 0.5).rise_s, 1.4) << "the paper has 0.74 s";
}

TEST(SurgeTankBound, ATargetThatCannotBeReachedIsRefused) {
  EXPECT_THROW(shortestStep(readLoop("surge_tank_up"), 0.15, 0.5), InputError);
  EXPECT_THROW(shortestStep(readLoop("surge_tank_up"), 5.0, 0.5), InputError);
  EXPECT_THROW(shortestStep(readLoop("mimo_cstr_steps"), 0.2, 0.5), InputError);
}

}  // namespace paper_taieb_plants_test
}  // namespace fpc
