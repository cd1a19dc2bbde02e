#include "runtime/bag_reader.hpp"

#include <fmbpc/Measurement.h>
#include <fmbpc/PlantInfo.h>
#include <rosbag/bag.h>
#include <rosbag/query.h>
#include <rosbag/view.h>

#include <limits>
#include <map>
#include <set>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/sample_clock.hpp"
#include "fmbpc/base/text.hpp"
#include "ros/conversions.hpp"
#include "ros/open_bag.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr std::size_t kMostGaps = 1000000;  // steps absent: a stray number, not a gap

/// All messages of one type, which must come from one topic.
template <typename Message>
std::vector<typename Message::ConstPtr> messagesOf(const rosbag::Bag& bag,
                                                   const std::string& file) {
  const std::string type = ros::message_traits::datatype<Message>();
  rosbag::View view(bag, rosbag::TypeQuery(type));
  std::set<std::string> topics;
  for (const auto* connection : view.getConnections()) topics.insert(connection->topic);
  require(!topics.empty(), file, "a recorded loop: a topic of type " + type);
  require(topics.size() == 1, file,
          "one plant, got " + type + " on " + join({topics.begin(), topics.end()}));
  std::vector<typename Message::ConstPtr> messages;
  for (const auto& item : view) {
    messages.push_back(item.template instantiate<Message>());
    require(messages.back() != nullptr, file,
            "the messages of this version, got another definition of " + type);
  }
  return messages;
}

/// Of one run, by step.
std::map<std::uint32_t, Measurement> measurementsOf(const rosbag::Bag& bag,
                                                    const std::string& file) {
  std::map<std::uint32_t, Measurement> by_step;
  std::set<std::uint64_t> runs;
  for (const auto& msg : messagesOf<fmbpc::Measurement>(bag, file)) {
    runs.insert(msg->run_id);
    by_step.emplace(msg->step, fromMsg(*msg));
  }
  require(!by_step.empty(), file, "at least one measurement");
  require(runs.size() == 1, file,
          "one run, got " + std::to_string(runs.size()) +
              " (the plant was started or reset while recording)");
  const std::size_t steps = by_step.rbegin()->first - by_step.begin()->first + std::size_t{1};
  require(steps - by_step.size() <= kMostGaps, file, "measurements without such long gaps");
  return by_step;
}

PlantInfo infoOf(const rosbag::Bag& bag, const std::string& file, std::uint64_t run_id) {
  for (const auto& msg : messagesOf<fmbpc::PlantInfo>(bag, file))
    if (msg->run_id == run_id) return fromMsg(*msg);
  throw InputError(file + ": expected plant_info of the run that was measured");
}

void checkSizes(const Measurement& m, const PlantInfo& info, const std::string& file) {
  const auto same = [](const Vector& values, const std::vector<SignalInfo>& signals) {
    return values.size() == static_cast<Index>(signals.size());
  };
  require(same(m.outputs, info.outputs) && same(m.input_applied, info.inputs) &&
              same(m.disturbances, info.disturbances),
          file + ": measurement " + std::to_string(m.header.step), "the sizes of plant_info");
}

CsvTable emptyTable(const PlantInfo& info, const std::string& file, Index rows) {
  CsvTable table;
  table.file = file;
  table.names = {"time"};
  table.units = {"h"};
  for (const auto* signals : {&info.outputs, &info.inputs, &info.disturbances})
    for (const auto& signal : *signals) {
      table.names.push_back(signal.name);
      table.units.push_back(signal.unit);
    }
  table.is_date.assign(table.names.size(), false);
  table.texts.resize(table.names.size());
  table.values = Matrix::Constant(rows, static_cast<Index>(table.names.size()),
                                  std::numeric_limits<double>::quiet_NaN());
  return table;
}

CsvTable tableOf(const rosbag::Bag& bag, const std::string& file) {
  const auto measured = measurementsOf(bag, file);
  const PlantInfo info = infoOf(bag, file, measured.begin()->second.header.run_id);
  const std::uint32_t first = measured.begin()->first, last = measured.rbegin()->first;
  CsvTable table = emptyTable(info, file, static_cast<Index>(last - first) + 1);
  const SampleClock clock(info.sample_time_s, static_cast<double>(info.header.time_ns) * 1e-9);
  const auto n_y = static_cast<Index>(info.outputs.size());
  const auto n_u = static_cast<Index>(info.inputs.size());
  for (std::uint32_t step = first; step <= last; ++step)
    table.values(step - first, 0) = clock.hoursAt(step);
  for (const auto& [step, m] : measured) {
    checkSizes(m, info, file);
    const auto row = static_cast<Index>(step - first);
    table.values.row(row).segment(1, n_y) = m.outputs.transpose();
    table.values.row(row).tail(m.disturbances.size()) = m.disturbances.transpose();
    if (row > 0) table.values.row(row - 1).segment(1 + n_y, n_u) = m.input_applied.transpose();
  }
  return table;
}

}  // namespace

CsvTable readBag(const std::string& file) {
  return withBag(file, [&](const rosbag::Bag& bag) { return tableOf(bag, file); });
}

}  // namespace fpc
