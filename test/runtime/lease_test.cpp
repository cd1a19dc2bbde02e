#include "runtime/lease.hpp"

#include <gtest/gtest.h>

namespace fpc {
namespace loop_lease_test {

constexpr std::uint16_t kOurs = 567, kOther = 1234, kNobody = 0;

TEST(Lease, IsClaimedWhileNobodyHasItAndCountsOnceItIsReadBack) {
  Lease lease(kOurs, "register 22");
  EXPECT_FALSE(lease.toWrite(true));  // nothing has been read
  lease.held(kNobody, 0.0);
  EXPECT_FALSE(lease.toWrite(false));
  EXPECT_EQ(lease.toWrite(true), kOurs);
  EXPECT_FALSE(lease.leads());
  lease.held(kOurs, 0.1);
  EXPECT_TRUE(lease.leads());
  EXPECT_EQ(lease.toWrite(true), kOurs);  // renewed
  EXPECT_EQ(lease.problem(0.1), "");
}

TEST(Lease, AnothersIsLeftAloneAndNamed) {
  Lease lease(kOurs, "register 22");
  lease.held(kOther, 0.0);
  EXPECT_FALSE(lease.toWrite(true));
  EXPECT_FALSE(lease.toWrite(false));
  EXPECT_TRUE(lease.another());
  EXPECT_EQ(lease.problem(99.0), "register 22 holds 1234, the word of another master, not 567");
  lease.held(kNobody, 100.0);
  EXPECT_EQ(lease.toWrite(true), kOurs);
  EXPECT_EQ(lease.losses(), 0U);
}

TEST(Lease, ItsLossIsCountedAndSaidForAWhile) {
  for (const std::uint16_t word : {kNobody, kOther}) {
    Lease lease(kOurs, "register 22");
    lease.held(kOurs, 0.0);
    lease.held(word, 1.0);
    EXPECT_FALSE(lease.leads());
    EXPECT_EQ(lease.losses(), 1U);
    EXPECT_NE(lease.problem(2.9), "");
    EXPECT_EQ(lease.problem(3.1).empty(), word == kNobody);
  }
}

TEST(Lease, GivingItBackAndALostConnectionAreNoLoss) {
  Lease lease(kOurs, "register 22");
  lease.held(kOurs, 0.0);
  EXPECT_EQ(lease.toWrite(false), kNobody);
  lease.held(kNobody, 1.0);
  lease.held(kOurs, 2.0);
  lease.forget();
  lease.held(kNobody, 3.0);
  EXPECT_EQ(lease.losses(), 0U);
}

}  // namespace loop_lease_test
}  // namespace fpc
