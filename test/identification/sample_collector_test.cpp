#include "identification/sample_collector.hpp"
#include "config/structure_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "fmbpc/base/input_error.hpp"
#include "identification/identify_fixture.hpp"
#include "identification/model_fixture.hpp"

namespace fpc {
namespace fuzzy_sample_collector_test {

Vector of(std::initializer_list<double> values) {
  Vector v(static_cast<Eigen::Index>(values.size()));
  std::copy(values.begin(), values.end(), v.data());
  return v;
}

/// Sample k of a plant with y = 10 k, d = 100 k and u(k) = k + 0.5.
Measurement sample(std::uint32_t step, std::uint64_t run_id = 1) {
  Measurement m;
  m.header.step = step;
  m.header.run_id = run_id;
  m.outputs = of({10.0 * step});
  m.disturbances = of({100.0 * step});
  m.input_applied = of({step - 0.5});
  return m;
}

PlantInfo plant() {
  PlantInfo info;
  info.sample_time_s = 1.0;
  info.outputs = {test::signal("y")};
  info.inputs = {test::signal("u")};
  info.disturbances = {test::signal("d")};
  return info;
}

/// Other order than the plant's would be possible for several signals of a kind; lags up to 3.
Structure structure(
    const std::string& signals = "outputs: {y: {}}\ninputs: {u: {}}\ndisturbances: {d: {}}") {
  return parseStructure(
      "name: s\nsample_time_s: 1\n" + signals + "\nsubmodels:\n  y: {regressors: [y(k), u(k-3)]}\n",
      "s.yaml");
}

void expectRow(const Matrix& rows, Eigen::Index k, double y, double u, double d) {
  const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
  EXPECT_TRUE(same(rows(k, 0), y) && same(rows(k, 1), u) && same(rows(k, 2), d))
      << "row " << k << ": " << rows.row(k);
}

TEST(SampleCollector, InputAppliedBelongsToTheRowBefore) {
  SampleCollector collector(plant(), 0);
  for (std::uint32_t k = 0; k < 4; ++k) EXPECT_TRUE(isNew(collector.take(sample(k))));
  const Matrix rows = collector.rows(structure());
  ASSERT_EQ(rows.rows(), 4);
  for (Eigen::Index k = 0; k < 3; ++k)
    expectRow(rows, k, 10.0 * static_cast<double>(k), static_cast<double>(k) + 0.5,
              100.0 * static_cast<double>(k));
  expectRow(rows, 3, 30.0, 2.5, 300.0);  // u(3) is not known: nothing is predicted from it
}

TEST(SampleCollector, RepeatedOldAndForeignSamplesAreLeftOut) {
  SampleCollector collector(plant(), 0);
  for (const std::uint32_t k : {5u, 6u, 6u, 5u, 7u}) collector.take(sample(k, 3));
  collector.take(sample(8, 2));
  EXPECT_EQ(collector.size(), 3u);
  EXPECT_EQ(collector.counts().samples, 3u);
  EXPECT_EQ(collector.arrivals().repeated, 1u);
  EXPECT_EQ(collector.arrivals().old, 1u);
  EXPECT_EQ(collector.arrivals().other_run, 1u);
}

TEST(SampleCollector, SamplesThatNeverCameAreRowsOfNaNAndCounted) {
  SampleCollector collector(plant(), 0);
  collector.take(sample(0));
  collector.take(sample(1));
  collector.take(sample(4));
  EXPECT_EQ(collector.counts().missing, 2u);
  const Matrix rows = collector.rows(structure());
  ASSERT_EQ(rows.rows(), 5);
  expectRow(rows, 1, 10.0, kNaN, 100.0);  // u(1) would have come with sample 2
  expectRow(rows, 2, kNaN, kNaN, kNaN);
  expectRow(rows, 3, kNaN, 3.5, kNaN);  // u(3) came with sample 4
  EXPECT_EQ(rows(4, 0), 40.0);
}

TEST(SampleCollector, NoRegressionReachesAcrossTwoRunsOrALongGap) {
  SampleCollector collector(plant(), 0);
  for (std::uint32_t k = 0; k < 20; ++k) collector.take(sample(k, 1));
  for (std::uint32_t k = 0; k < 20; ++k) collector.take(sample(k, 2));
  for (std::uint32_t k = 500; k < 520; ++k) collector.take(sample(k, 2));
  EXPECT_EQ(collector.counts().runs, 2u);
  EXPECT_EQ(collector.counts().missing, 480u);
  Structure s = structure();
  s.repair.missing = MissingCells::kDrop;
  const Matrix rows = collector.rows(s);
  EXPECT_LT(rows.rows(), 80);  // breaks are no longer than the lags need
  const DataSet data = makeDataSet(rows, s, "test");
  const Regression regression = makeRegression(data, s.submodels[0].regressors, {}, 0);
  EXPECT_EQ(regression.rows(), 16 + 16 + 17);  // u(499) came with sample 500
  for (Eigen::Index i = 0; i < regression.rows(); ++i) {
    const double y = regression.regressors(i, 0), k = y / 10.0;
    EXPECT_EQ(regression.target[i], y + 10.0);
    EXPECT_EQ(regression.regressors(i, 1), k - 3.0 + 0.5);
  }
}

TEST(SampleCollector, ValuesThatAreNotFiniteAreMissingCellsAndThePresentStays) {
  SampleCollector collector(plant(), 0);
  EXPECT_EQ(collector.present().outputs.size(), 0);
  collector.take(sample(0));
  Measurement bad = sample(1);
  bad.outputs[0] = std::numeric_limits<double>::infinity();
  collector.take(bad);
  EXPECT_EQ(collector.counts().incomplete, 1u);
  EXPECT_EQ(collector.counts().missing, 0u);
  EXPECT_EQ(collector.present().header.step, 0u);
  EXPECT_TRUE(std::isnan(collector.rows(structure())(1, 0)));
}

TEST(SampleCollector, TheWindowKeepsTheNewestRowsAndRowsMayBeFewer) {
  SampleCollector collector(plant(), 10);
  for (std::uint32_t k = 0; k < 100; ++k) collector.take(sample(k));
  EXPECT_EQ(collector.size(), 10u);
  EXPECT_EQ(collector.rows(structure())(0, 0), 900.0);
  const Matrix rows = collector.rows(structure(), 4);
  ASSERT_EQ(rows.rows(), 4);
  EXPECT_EQ(rows(0, 0), 960.0);
  EXPECT_EQ(collector.rows(structure(), 1000).rows(), 10);
}

TEST(SampleCollector, SignalsThatThePlantLacksAreNamed) {
  SampleCollector collector(plant(), 0);
  collector.take(sample(0));
  const auto message = [&](const Structure& s) -> std::string {
    try {
      collector.rows(s);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message(structure()), "");
  EXPECT_NE(message(structure("outputs: {y: {}}\ninputs: {u: {}, z: {}}")).find("inputs.z"),
            std::string::npos);
  EXPECT_NE(message(structure("outputs: {y: {unit: m}}\ninputs: {u: {}}")).find("unit '1'"),
            std::string::npos);
  Structure slow = structure();
  slow.sample_time_s = 2.0;
  EXPECT_NE(message(slow).find("sample_time_s"), std::string::npos);
  Measurement wrong = sample(1);
  wrong.outputs = of({1.0, 2.0});
  EXPECT_THROW(collector.take(wrong), InputError);
}

}  // namespace fuzzy_sample_collector_test
}  // namespace fpc
