#include "ros/plant_publishers.hpp"

#include "base/text_hash.hpp"
#include "ros/conversions.hpp"
#include "ros/queues.hpp"
#include "ros/shared.hpp"
#include "ros/topics.hpp"

namespace fpc {

PlantPublishers::PlantPublishers(ros::NodeHandle node, const LoopFile& loop, const PlantInfo& info,
                                 const std::vector<std::string>& disturbances)
    : steps_(info.sample_time_s, static_cast<double>(info.header.time_ns) / 1e9),
      loop_digest_(textHash(loop.resolved)),
      info_(node.advertise<fmbpc::PlantInfo>(topics::kPlantInfo, 1, true)),
      measurement_(node.advertise<fmbpc::Measurement>(topics::kMeasurement,
                                                      queueOf(ListenerKind::kRecord), true)),
      signals_(node) {
  // Told to whoever connects, so that tools which start while sample 0 is held already have a time
  // that is not 0. Not latched: roscpp would wake its thread at every sample though nobody listens.
  if (loop.exchange.publish_clock) {
    clock_ = node.advertise<rosgraph_msgs::Clock>(
        topics::kClock, queueOf(ListenerKind::kViewer),
        [this](const ros::SingleSubscriberPublisher& listener) {
          if (!now_.clock.isZero()) listener.publish(now_);
        });
    clock_hearers_ = Hearers(clock_);
  }
  for (const SignalInfo& output : info.outputs) signals_.add(output.name);
  for (const std::string& disturbance : disturbances) signals_.add(disturbance);
  for (const SignalInfo& input : info.inputs) signals_.add(input.name);
}

void PlantPublishers::begin(const Process& process) {
  introduce(process);
  clock(process.info().header.time_ns);
}

void PlantPublishers::introduce(const Process& process) {
  fmbpc::PlantInfo msg = toMsg(process.info());
  msg.loop_digest = loop_digest_;
  info_.publish(msg);
}

void PlantPublishers::sample(const Process& process, VectorRef disturbances,
                             const std::function<void(fmbpc::Measurement&)>& mark) {
  fmbpc::Measurement msg = toMsg(process.measurement());
  msg.header.frame_id = process.info().frame_id;
  mark(msg);
  last_ = shared(std::move(msg));
  measurement_.publish(last_);
  clock(process.measurement().header.time_ns);
  signals(process.measurement(), disturbances);
}

void PlantPublishers::resend() {
  ++resent_;
  measurement_.publish(last_);
}

void PlantPublishers::clock(std::int64_t time_ns) {
  now_.clock = toStamp(time_ns);
  if (clock_hearers_.any()) clock_.publish(now_);
}

// Outputs and disturbances of sample k; the input that acted until then, at the time from which it
// did.
void PlantPublishers::signals(const Measurement& now, VectorRef disturbances) {
  std::size_t index = 0;
  for (const double value : now.outputs) signals_.publish(index++, now.header.time_ns, value);
  for (const double value : disturbances) signals_.publish(index++, now.header.time_ns, value);
  if (now.header.step == 0) return;
  const std::int64_t before = steps_.timeAt(now.header.step - 1);
  for (const double value : now.input_applied) signals_.publish(index++, before, value);
}

}  // namespace fpc
