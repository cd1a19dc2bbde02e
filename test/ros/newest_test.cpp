// A law in realtime answers the newest of what waits.
#include "ros/newest.hpp"

#include <gtest/gtest.h>
#include <ros/callback_queue.h>

#include <vector>

namespace fpc {
namespace ros_newest_test {

/// Calls put(item) in its turn, as a subscriber's message does.
class Arriving : public ros::CallbackInterface {
 public:
  Arriving(Newest<int>& newest, int item) : newest_(newest), item_(item) {}
  CallResult call() override {
    newest_.put(item_);
    return Success;
  }

 private:
  Newest<int>& newest_;
  int item_;
};

class NewestOfTheQueue : public ::testing::Test {
 protected:
  void arrive(Newest<int>& newest, std::vector<int> items) {
    for (const int item : items) queue_.addCallback(boost::make_shared<Arriving>(newest, item));
  }
  void spin() {
    while (!queue_.isEmpty()) queue_.callAvailable();
  }

  ros::CallbackQueue queue_;
  std::vector<int> answered_;
};

TEST_F(NewestOfTheQueue, OfAllThatWaitOnlyTheLastIsAnswered) {
  Newest<int> newest(queue_, [this](int item) { answered_.push_back(item); });
  arrive(newest, {1, 2, 3});
  spin();
  EXPECT_EQ(answered_, std::vector<int>({3}));
}

TEST_F(NewestOfTheQueue, WhoKeepsUpAnswersAll) {
  Newest<int> newest(queue_, [this](int item) { answered_.push_back(item); });
  for (const int item : {1, 2, 3}) {
    arrive(newest, {item});
    spin();
  }
  EXPECT_EQ(answered_, std::vector<int>({1, 2, 3}));
}

TEST_F(NewestOfTheQueue, WhatComesWhileItAnswersIsNotLost) {
  Newest<int> newest(queue_, [&](int item) {
    answered_.push_back(item);
    if (item == 1) arrive(newest, {2, 3});
  });
  arrive(newest, {1});
  spin();
  EXPECT_EQ(answered_, std::vector<int>({1, 3}));
}

TEST_F(NewestOfTheQueue, TheQueueMayEndFirst) {
  auto queue = std::make_unique<ros::CallbackQueue>();
  Newest<int> newest(*queue, [this](int item) { answered_.push_back(item); });
  newest.put(1);
  queue.reset();
  EXPECT_TRUE(answered_.empty());
}

TEST_F(NewestOfTheQueue, NothingIsCalledOnceItIsGone) {
  {
    Newest<int> newest(queue_, [this](int item) { answered_.push_back(item); });
    newest.put(1);
  }
  spin();
  EXPECT_TRUE(answered_.empty());
}

}  // namespace ros_newest_test
}  // namespace fpc
