#include "model/shared_partition.hpp"

#include <gtest/gtest.h>

#include "control/fuzzy_lq/fixture.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/model/local_model.hpp"
#include "identification/multivariate_fixture.hpp"

namespace fpc {
namespace fuzzy_shared_partition_test {

TEST(SharedPartition, WeighedRulesAddUpToTheModel) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    std::mt19937_64 generator(seed);
    TsModel model = test::sharedRandomModel(generator, {});
    if (seed % 2 == 0) model = test::multivariate(model);
    const RuleSplit split = splitRules(model);
    ASSERT_EQ(split.rules.size(), 3U);
    LocalModel whole(model);
    const Vector state = test::randomVector(generator, whole.stateSize());
    const Vector d = test::randomVector(generator, 1);
    whole.blend(state, d);
    AffineModel sum(whole.stateSize(), 2, 2);
    for (std::size_t g = 0; g < 3; ++g) {
      LocalModel rule(split.rules[g]);
      ASSERT_EQ(rule.stateSize(), whole.stateSize());
      rule.blend(state, d);
      const double w = whole.firing()[split.partition].weights[static_cast<Eigen::Index>(g)];
      sum.A += w * rule.affine().A;
      sum.B += w * rule.affine().B;
      sum.g += w * rule.affine().g;
    }
    EXPECT_LT((sum.A - whole.affine().A).norm(), 1e-12) << "seed " << seed;
    EXPECT_LT((sum.B - whole.affine().B).norm(), 1e-12) << "seed " << seed;
    EXPECT_LT((sum.g - whole.affine().g).norm(), 1e-12) << "seed " << seed;
  }
}

TEST(SharedPartition, AnOutputWithASingleRuleGoesAlong) {
  std::mt19937_64 generator(1);
  TsModel model = test::sharedRandomModel(generator, {});
  model.submodels[0].rules.resize(1);
  const RuleSplit split = splitRules(model);
  EXPECT_EQ(split.partition, 1U);
  ASSERT_EQ(split.rules.size(), 3U);
  EXPECT_EQ(split.rules[2].submodels[0].rules[0].coefficients,
            model.submodels[0].rules[0].coefficients);
}

TEST(SharedPartition, OtherSetsAreRefusedNamingTheOutput) {
  std::mt19937_64 generator(1);
  const TsModel shared = test::sharedRandomModel(generator, {});
  TsModel moved = shared, other = shared;
  moved.submodels[1].rules[2].antecedents[0].parameters[0] += 1e-3;
  other.submodels[1].rules.pop_back();
  for (const TsModel& model : {moved, other}) try {
      splitRules(model);
      ADD_FAILURE() << "accepted";
    } catch (const InputError& error) {
      const std::string words = error.what();
      EXPECT_NE(words.find("submodels.y2"), std::string::npos) << words;
      EXPECT_NE(words.find("share one premise partition"), std::string::npos) << words;
    }
}

}  // namespace fuzzy_shared_partition_test
}  // namespace fpc
