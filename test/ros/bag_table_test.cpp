// A bag is the table that the same run writes.
#include "runtime/bag_reader.hpp"

#include <fmbpc/Measurement.h>
#include <fmbpc/PlantInfo.h>
#include <rosbag/bag.h>

#include <algorithm>
#include <cmath>

#include "ros/conversions.hpp"
#include "runtime/loop_fixture.hpp"
#include "runtime/report.hpp"
#include "runtime/run.hpp"

namespace fpc {
namespace ros_bag_table_test {

class BagTable : public LoopFolder {
 protected:
  BagTable() {
    loop_ = readLoop("asp_case1_pi_x", {{"sampling.duration_h", "6"}});
    RunRecord run = runLoop(loop_, {});
    writeRun(loop_, run, summarize(loop_, run, 0.0), folder_.string());
    samples_ = run.samples;
    info_ = run.info;
    info_.header = samples_.front().measurement.header;
  }

  void put(rosbag::Bag& bag, const Measurement& m, const std::string& topic = "/measurement") {
    bag.write(topic, toStamp(m.header.time_ns), toMsg(m));
  }
  /// The bag of the run, with every sample sent twice, but for the steps left out.
  std::string bagWithout(const std::vector<std::size_t>& left_out) {
    rosbag::Bag bag(path("loop.bag"), rosbag::bagmode::Write);
    bag.write("/plant_info", toStamp(info_.header.time_ns), toMsg(info_));
    for (std::size_t k = 0; k < samples_.size(); ++k) {
      if (std::find(left_out.begin(), left_out.end(), k) != left_out.end()) continue;
      put(bag, samples_[k].measurement);
      put(bag, samples_[k].measurement);
    }
    return path("loop.bag");
  }

  LoopFile loop_;
  std::vector<SampleRecord> samples_;
  PlantInfo info_;
};

TEST_F(BagTable, HoldsWhatTheRunWroteToItsTrajectory) {
  const CsvTable bag = readBag(bagWithout({}));
  const CsvTable run = readCsv(path("trajectory.csv"));
  ASSERT_EQ(bag.rows(), run.rows());
  ASSERT_EQ(bag.rows(), 31);
  ASSERT_EQ(bag.names, (std::vector<std::string>{"time", "s", "x", "q_r", "q_i", "s_i"}));
  for (std::size_t c = 0; c < bag.names.size(); ++c) {
    const auto column = run.column(bag.names[c]);
    EXPECT_EQ(bag.units[c], run.units[static_cast<std::size_t>(column)]);
    for (Eigen::Index k = 0; k < run.rows(); ++k) {
      const double here = bag.values(k, static_cast<Eigen::Index>(c));
      const double there = run.values(k, column);
      EXPECT_TRUE(here == there || (std::isnan(here) && std::isnan(there)))
          << bag.names[c] << " row " << k << ": " << here << " instead of " << there;
    }
  }
  EXPECT_TRUE(std::isnan(bag.values(30, bag.column("q_r"))));
}

TEST_F(BagTable, RowsThatWereNotRecordedAreEmptyAndSoIsTheInputBefore) {
  const CsvTable whole = readBag(bagWithout({}));
  const CsvTable bag = readBag(bagWithout({7}));
  ASSERT_EQ(bag.rows(), whole.rows());
  EXPECT_EQ(bag.values.col(0), whole.values.col(0));
  EXPECT_TRUE(bag.values.row(7).head(3).tail(2).array().isNaN().all());
  EXPECT_TRUE(std::isnan(bag.values(6, bag.column("q_r"))));
  EXPECT_EQ(bag.values(7, bag.column("q_r")), whole.values(7, whole.column("q_r")));
  EXPECT_EQ(readBag(bagWithout({0, 1, 2})).values(0, 0), whole.values(3, 0));
}

TEST_F(BagTable, SeveralRunsOrPlantsAreRefused) {
  const std::string file = bagWithout({});
  {
    rosbag::Bag bag(file, rosbag::bagmode::Append);
    Measurement other = samples_[3].measurement;
    other.header.run_id += 1;
    put(bag, other);
  }
  expectWords(errorOf([&] { readBag(file); }), {"loop.bag", "one run, got 2"});
  {
    rosbag::Bag bag(file, rosbag::bagmode::Append);
    put(bag, samples_[3].measurement, "/second/measurement");
  }
  expectWords(errorOf([&] { readBag(file); }),
              {"loop.bag", "one plant", "/measurement, /second/measurement"});
}

TEST_F(BagTable, WhatIsNoRecordedLoopIsRefused) {
  expectWords(errorOf([&] { readBag(write("fake.bag", "time,x\n1,2\n")); }),
              {"fake.bag", "a readable bag"});
  expectWords(errorOf([&] { readBag(path("none.bag")); }), {"none.bag"});
  { rosbag::Bag bag(path("empty.bag"), rosbag::bagmode::Write); }
  expectWords(errorOf([&] { readBag(path("empty.bag")); }), {"empty.bag", "fmbpc/Measurement"});
  {
    rosbag::Bag bag(path("silent.bag"), rosbag::bagmode::Write);
    for (const auto& sample : samples_) put(bag, sample.measurement);
  }
  expectWords(errorOf([&] { readBag(path("silent.bag")); }), {"silent.bag", "fmbpc/PlantInfo"});
  {
    rosbag::Bag bag(path("sizes.bag"), rosbag::bagmode::Write);
    bag.write("/plant_info", toStamp(info_.header.time_ns), toMsg(info_));
    Measurement wrong = samples_[0].measurement;
    wrong.outputs = Vector::Zero(5);
    put(bag, wrong);
  }
  expectWords(errorOf([&] { readBag(path("sizes.bag")); }), {"sizes.bag", "sizes"});
}

TEST_F(BagTable, DamagedBytesOfAMessageAreToldInWords) {
  const std::string file = bagWithout({});
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  std::string content = text.str();
  const Vector& outputs = samples_[3].measurement.outputs;
  const std::string numbers(reinterpret_cast<const char*>(outputs.data()),
                            sizeof(double) * static_cast<std::size_t>(outputs.size()));
  const std::size_t at = content.find(numbers);
  ASSERT_NE(at, std::string::npos);
  content[at - 4] = static_cast<char>(200);  // so many numbers are not in the message
  std::ofstream(path("damaged.bag"), std::ios::binary) << content;
  expectWords(errorOf([&] { readBag(path("damaged.bag")); }), {"damaged.bag", "a readable bag"});
}

}  // namespace ros_bag_table_test
}  // namespace fpc
