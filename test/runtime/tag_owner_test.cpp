#include "runtime/tag_owner.hpp"

#include <gtest/gtest.h>

namespace fpc {
namespace loop_tag_owner_test {

TEST(TagOwner, ASecondPublisherIsRefusedAndNamedWhileTheFirstSpeaks) {
  TagOwner tag("/tank/state", 1.0);
  EXPECT_TRUE(tag.admits("/tank", 0.0));
  EXPECT_EQ(tag.problem(0.0), "");
  for (int i = 1; i <= 100; ++i) {
    EXPECT_FALSE(tag.admits("/rostopic_7", 0.02 * i));
    if (i % 5 == 0) {
      EXPECT_TRUE(tag.admits("/tank", 0.02 * i));
    }
  }
  EXPECT_EQ(tag.problem(2.0),
            "/tank/state has two publishers: /tank counts, /rostopic_7 is refused");
  EXPECT_NE(tag.problem(3.9), "");
  EXPECT_EQ(tag.problem(4.1), "");  // it has stopped
}

TEST(TagOwner, APlantThatComesBackUnderAnotherNameOwnsItsTagAfterTheTimeOut) {
  TagOwner tag("/tank/state", 1.0);
  EXPECT_TRUE(tag.admits("/tank_1", 0.0));
  EXPECT_FALSE(tag.admits("/tank_2", 0.9));
  EXPECT_TRUE(tag.admits("/tank_2", 1.1));
  EXPECT_EQ(tag.problem(1.1), "");
  EXPECT_FALSE(tag.admits("/tank_1", 1.2));  // and the old one does not take it back
  EXPECT_EQ(tag.problem(1.2), "/tank/state has two publishers: /tank_2 counts, /tank_1 is refused");
}

TEST(TagOwner, AValueThatIsNoNumberIsHeardButOwnsNothing) {
  TagOwner tag("/tank/state", 1.0);
  EXPECT_TRUE(tag.admits("/liar", 0.0, false));
  EXPECT_TRUE(tag.admits("/tank", 0.1));
  EXPECT_FALSE(tag.admits("/liar", 0.2, false));
  EXPECT_TRUE(tag.admits("/tank", 0.3, false));  // the owner's own
  EXPECT_FALSE(tag.admits("/other", 1.2));
}

TEST(TagOwner, ATagOfOursStaysOursAndWhoElsePublishesItIsNamed) {
  TagOwner tag("/tank/control_effort", 1.0, "/plant_gateway");
  EXPECT_EQ(tag.problem(0.0), "");
  EXPECT_FALSE(tag.admits("/stranger", 50.0));
  EXPECT_EQ(tag.problem(50.0),
            "/tank/control_effort is published by /stranger as well: the plant hears it");
  EXPECT_EQ(tag.problem(53.0), "");
}

}  // namespace loop_tag_owner_test
}  // namespace fpc
