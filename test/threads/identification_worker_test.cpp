#include "ros/identification_worker.hpp"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "identification/identify_fixture.hpp"

namespace fpc {
namespace identification_worker_test {

IdentificationJob job(Eigen::Index rows, double share = 0.25) {
  return {test::knownRecord(rows, 5), test::knownStructure(), "test", share};
}

/// Asks, as a node's timer does, until the end is there; what was told meanwhile.
IdentificationWorker::Outcome await(IdentificationWorker& worker,
                                    std::vector<RecordProgress>* told = nullptr) {
  while (true) {
    if (const auto progress = worker.progress(); progress && told != nullptr)
      told->push_back(*progress);
    if (auto outcome = worker.outcome()) return *outcome;
    std::this_thread::yield();
  }
}

TEST(IdentificationWorker, FindsWhatTheSameJobFindsOnTheCallersThread) {
  const IdentificationJob asked = job(400);
  const auto here = identifyRecord(asked.values, asked.structure, asked.source, asked.share);
  IdentificationWorker worker;
  for (int turn = 0; turn < 2; ++turn) {
    std::vector<RecordProgress> told;
    worker.start(asked);
    EXPECT_TRUE(worker.busy());
    const auto outcome = await(worker, &told);
    EXPECT_FALSE(worker.busy());
    EXPECT_FALSE(worker.outcome().has_value()) << "the end is told once";
    EXPECT_FALSE(outcome.cancelled);
    EXPECT_EQ(outcome.error, "");
    ASSERT_EQ(outcome.result.found.model.submodels.size(), 1u);
    EXPECT_EQ(outcome.result.found.model.submodels[0].rules.front().coefficients,
              here.found.model.submodels[0].rules.front().coefficients);
    for (const RecordProgress& progress : told) EXPECT_LE(progress.identify.share, 1.0);
  }
}

TEST(IdentificationWorker, CancelledWhileItWorksItSaysSoAndMayStartAgain) {
  IdentificationWorker worker;
  worker.start(job(100000));
  worker.cancel();
  EXPECT_TRUE(await(worker).cancelled);
  worker.start(job(200));
  EXPECT_FALSE(await(worker).cancelled);
}

TEST(IdentificationWorker, AnErrorComesAsWords) {
  IdentificationWorker worker;
  worker.start(job(200, 2.0));
  const auto outcome = await(worker);
  EXPECT_NE(outcome.error, "");
  EXPECT_TRUE(outcome.result.found.model.submodels.empty());
}

TEST(IdentificationWorker, GoesWhileItWorks) {
  IdentificationWorker worker;
  worker.start(job(100000));
}

}  // namespace identification_worker_test
}  // namespace fpc
