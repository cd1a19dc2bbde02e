#include "ros/signal_publishers.hpp"
#include "ros/queues.hpp"

#include "ros/conversions.hpp"
#include "ros/topics.hpp"

namespace fpc {

std::size_t SignalPublishers::add(const std::string& name) {
  publishers_.push_back(
      node_.advertise<fmbpc::Signal>(topics::kSignalPrefix + name, queueOf(ListenerKind::kViewer)));
  hearers_.emplace_back(publishers_.back());
  return publishers_.size() - 1;
}

void SignalPublishers::publish(std::size_t index, std::int64_t time_ns, double value) {
  if (!hearers_[index].any()) return;
  msg_.header.stamp = toStamp(time_ns);
  msg_.data = value;
  publishers_[index].publish(msg_);
}

}  // namespace fpc
