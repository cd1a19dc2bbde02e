// Bytes as what happened to a recorded bag: messages changed, lost, repeated or on other topics
// (first byte even), or the file itself edited and cut (odd).
#include <fmbpc/Measurement.h>
#include <fmbpc/PlantInfo.h>
#include <rosbag/bag.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "fuzz/message_mutator.hpp"
#include "fuzz/scratch_file.hpp"
#include "fuzz/targets.hpp"
#include "fuzz/tolerant.hpp"
#include "ros/conversions.hpp"
#include "runtime/bag_reader.hpp"
#include "runtime/run.hpp"

namespace fpc::fuzz {
namespace {

const RunRecord& exampleRecord() {
  static const RunRecord record =
      runLoop(readLoop("asp_case1_pi_x", {{"sampling.duration_h", "2"}}), {});
  return record;
}

template <typename Message>
void put(rosbag::Bag& bag, const std::string& topic, const Message& message, Bytes& bytes) {
  const int fate = bytes.below(8);
  const Message written = fate == 2 ? mutated(message, bytes) : message;
  const ros::Time stamp = std::max(written.header.stamp, ros::TIME_MIN);
  if (fate == 3) bag.write(topic + "_2", stamp, written);
  for (int i = 0; i < (fate == 1 ? 0 : fate == 4 ? 2 : 1); ++i) bag.write(topic, stamp, written);
}

void writeBag(const std::string& file, Bytes& bytes) {
  rosbag::Bag bag(file, rosbag::bagmode::Write);
  PlantInfo info = exampleRecord().info;
  info.header = exampleRecord().samples.front().measurement.header;
  put(bag, "/plant_info", toMsg(info), bytes);
  for (const SampleRecord& sample : exampleRecord().samples)
    put(bag, "/measurement", toMsg(sample.measurement), bytes);
}

std::string contentOf(const std::string& file) {
  std::ostringstream content;
  content << std::ifstream(file, std::ios::binary).rdbuf();
  return content.str();
}

/// A bag as it should be, behind the padding of its header; five bytes an edit.
void writeEdited(const std::string& file, Bytes& bytes) {
  static const std::string image = [&] {
    const std::string nothing;
    Bytes none(nothing);
    writeBag(file, none);
    return contentOf(file);
  }();
  std::string content = image;
  while (!bytes.empty()) {
    const auto at = static_cast<std::size_t>(bytes.next() << 8 | bytes.next()) % content.size();
    const int what = bytes.below(4), value = bytes.next();
    if (what == 3) content.resize(at + 1);
    content[at] = static_cast<char>(what == 0 ? value : what == 1 ? 0 : content[at] + value);
  }
  std::ofstream(file, std::ios::binary) << content;
}

void checkTable(const CsvTable& table) {
  const auto columns = static_cast<Eigen::Index>(table.names.size());
  if (table.values.cols() != columns || table.units.size() != table.names.size() ||
      table.values.rows() == 0)
    throw std::logic_error("a table without its columns");
  for (Eigen::Index row = 1; row < table.rows(); ++row)
    if (!(table.values(row, 0) > table.values(row - 1, 0)))
      throw std::logic_error("times that do not increase");
}

}  // namespace

void bag(const std::string& text) {
  Bytes bytes(text);
  const std::string file = scratchFile(".bag");
  if (bytes.below(2) == 0)
    writeBag(file, bytes);
  else
    writeEdited(file, bytes);
  tolerant([&] { checkTable(readBag(file)); });
}

}  // namespace fpc::fuzz
