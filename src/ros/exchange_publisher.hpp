// Publisher of what a member of the exchange answers: one for all topics of which a record is made.
#pragma once

#include <ros/ros.h>

#include <string>
#include <utility>

#include "ros/hearers.hpp"
#include "ros/queues.hpp"
#include "ros/shared.hpp"
#include "ros/topics.hpp"
#include "ros/wall_throttle.hpp"
#include "runtime/authority.hpp"
#include "runtime/first_answers.hpp"

namespace fpc {

/// Tells the first answers of a node that came back again to those who connect in the seconds after
/// it and only listen.
template <typename Msg>
class ExchangePublisher {
 public:
  /// `comeback` (of the node) must outlive this.
  ExchangePublisher(ros::NodeHandle node, const char* topic, const Comeback& comeback,
                    Audience audience)
      : comeback_(comeback),
        audience_(std::move(audience)),
        publisher_(node.advertise<Msg>(
            topic, queueOf(ListenerKind::kRecord),
            [this](const ros::SingleSubscriberPublisher& listener) { catchUp(listener); })),
        hearers_(publisher_) {}
  ExchangePublisher(const ExchangePublisher&) = delete;
  ExchangePublisher& operator=(const ExchangePublisher&) = delete;

  /// Whether anybody listens, or may in a moment.
  bool needed() const { return hearers_.any() || comeback_.lately(steadyNow()); }
  /// `repeated`: it was published before.
  void publish(Msg msg, bool repeated) {
    const boost::shared_ptr<const Msg> message = shared(std::move(msg));
    publisher_.publish(message);
    if (!repeated) first_.add(message->run_id, message, comeback_, steadyNow());
  }
  const ros::Publisher& publisher() const { return publisher_; }

 private:
  void catchUp(const ros::SingleSubscriberPublisher& listener) const {
    if (!comeback_.lately(steadyNow()) || !audience_.mayHearOld(listener.getSubscriberName()))
      return;
    for (const auto& message : first_.all()) listener.publish(*message);
  }

  const Comeback& comeback_;
  Audience audience_;
  FirstAnswers<boost::shared_ptr<const Msg>> first_;
  ros::Publisher publisher_;  // its callbacks end before the rest does
  Hearers hearers_;
};

/// Full names, for a node in the namespace of `node`.
inline Audience audienceOf(const ros::NodeHandle& node, const Authority& authority) {
  return {authority.publishersOf(topics::kMeasurement),
          authority.publishersOf(topics::kControlAction), node.resolveName("loop_recorder")};
}

}  // namespace fpc
