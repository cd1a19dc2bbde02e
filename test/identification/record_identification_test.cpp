#include "identification/record_identification.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "fmbpc/base/input_error.hpp"
#include "identification/identify_fixture.hpp"

namespace fpc {
namespace fuzzy_record_identification_test {

const std::string kGrid = "partition: {method: grid}\nconsequents: {method: global, ridge: 0}\n";

TEST(IdentifyRecord, AKnownProcessIsRecoveredAndJudgedOnRowsItNeverSaw) {
  const auto structure = test::knownStructure(test::kKnownGrid, kGrid);
  Matrix record = test::knownRecord(1000, 3);
  const auto result = identifyRecord(record, structure, "test", 0.3);
  ASSERT_FALSE(result.cancelled);
  EXPECT_TRUE(result.held_out);
  ASSERT_EQ(result.validation.size(), 1u);
  EXPECT_EQ(result.validation[0].one_step.samples, 299);  // 300 rows, the first has no past
  EXPECT_GT(result.validation[0].free_run.vaf, 99.99);
  EXPECT_LT(result.validation[0].linear_free_run.vaf, 99.9);
  const auto alone = identify(makeDataSet(record.topRows(700), structure, "test"), structure);
  EXPECT_EQ(result.found.model.submodels[0].rules[0].coefficients,
            alone.model.submodels[0].rules[0].coefficients);
}

TEST(IdentifyRecord, WithoutAShareTheWholeRecordIsUsedAndJudged) {
  const auto result = identifyRecord(test::knownRecord(500, 3),
                                     test::knownStructure(test::kKnownGrid, kGrid), "test", 0.0);
  EXPECT_FALSE(result.held_out);
  EXPECT_EQ(result.found.outputs[0].samples, 499);
  EXPECT_EQ(result.validation[0].one_step.samples, 499);
  for (const double share : {-0.1, 1.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(identifyRecord(test::knownRecord(500, 3), test::knownStructure(), "test", share),
                 InputError);
}

TEST(IdentifyRecord, MissingSamplesAreSteppedOverAndCounted) {
  Matrix record = test::knownRecord(600, 5);
  for (const Eigen::Index k : {50, 51, 300})
    record.row(k).setConstant(std::numeric_limits<double>::quiet_NaN());
  const auto result =
      identifyRecord(record, test::knownStructure(test::kKnownGrid, kGrid), "test", 0.0);
  EXPECT_EQ(result.found.outputs[0].samples, 599 - 5);
  ASSERT_FALSE(result.found.remarks.empty());
  EXPECT_NE(result.found.remarks[0].find("3 missing cells"), std::string::npos)
      << result.found.remarks[0];
}

TEST(IdentifyRecord, ProgressGoesFromReadingToDoneAndEndsWithTheValidation) {
  std::vector<RecordProgress> told;
  identifyRecord(test::knownRecord(400, 5), test::knownStructure(), "test", 0.25,
                 [&](const RecordProgress& p) {
                   told.push_back(p);
                   return true;
                 });
  ASSERT_GT(told.size(), 4u);
  EXPECT_EQ(told.front().identify.stage, "reading");
  EXPECT_EQ(told.front().identify.samples, 400);
  EXPECT_TRUE(told[told.size() - 2].validation.empty());
  EXPECT_EQ(told[told.size() - 2].identify.stage, "validation");
  EXPECT_EQ(told.back().identify.stage, "done");
  EXPECT_EQ(told.back().identify.share, 1.0);
  ASSERT_EQ(told.back().validation.size(), 1u);
  for (std::size_t i = 1; i < told.size(); ++i) EXPECT_GE(told[i].identify.share, 0.0);
}

TEST(IdentifyRecord, CancelledWhereverTheCallbackSaysSo) {
  const Matrix record = test::knownRecord(400, 5);
  int calls = 0;
  const auto count = [&](const RecordProgress&) { return ++calls > 0; };
  identifyRecord(record, test::knownStructure(), "test", 0.25, count);
  for (const int last : {1, 2, calls / 2, calls - 1, calls}) {
    int told = 0;
    const auto result = identifyRecord(record, test::knownStructure(), "test", 0.25,
                                       [&](const RecordProgress&) { return ++told < last; });
    EXPECT_TRUE(result.cancelled) << last;
    EXPECT_EQ(told, last);
  }
}

}  // namespace fuzzy_record_identification_test
}  // namespace fpc
