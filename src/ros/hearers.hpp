// Whether anybody listens to a topic, for what is asked at every sample: a Publisher looks its
// topic up by name among all of the process, under one lock.
#pragma once

#include <ros/publication.h>
#include <ros/ros.h>
#include <ros/topic_manager.h>

namespace fpc {

class Hearers {
 public:
  Hearers() = default;  ///< of nothing: none
  explicit Hearers(const ros::Publisher& publisher)
      : publication_(ros::TopicManager::instance()->lookupPublication(publisher.getTopic())) {}
  bool any() const { return publication_ && publication_->getNumSubscribers() > 0; }

 private:
  ros::PublicationPtr publication_;  // without links once the topic is no more
};

}  // namespace fpc
