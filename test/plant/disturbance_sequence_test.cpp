#include <gtest/gtest.h>

#include <fstream>

#include "fmbpc/base/input_error.hpp"
#include "plant/disturbance.hpp"

namespace fpc {
namespace plant_disturbance_sequence_test {

std::string fileWith(const std::string& name, const std::string& text) {
  const std::string file = ::testing::TempDir() + "disturbance_sequence_" + name;
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

/// Two records of two hours after a lead-in of one.
CsvDisturbanceParams sequence() {
  CsvDisturbanceParams params;
  params.file = fileWith("a.csv", "t,q\n0,10\n1,11\n");
  params.next_file = fileWith("b.csv", "t,q\n0,20\n1,21\n");
  params.time_column = "t";
  params.channels = {{"q", "q"}};
  params.lead_in_h = 1.0;
  params.next_after_h = 2.0;
  return params;
}

std::vector<double> flows(const CsvDisturbanceParams& params, std::uint32_t samples) {
  const Matrix values =
      readDisturbanceSequence(params, {"q"}, Vector::Constant(1, 5.0), 3600.0, samples).values;
  EXPECT_EQ(values.cols(), static_cast<Eigen::Index>(samples) + 1);
  const Vector row = values.row(0);
  return {row.data(), row.data() + row.size()};
}

TEST(DisturbanceSequence, NominalThenOneRecordThenTheOther) {
  const std::vector<double> all{5, 10, 11, 20, 21};
  const auto got = flows(sequence(), 5);
  EXPECT_EQ(std::vector<double>(got.begin(), got.begin() + 5), all);
}

TEST(DisturbanceSequence, BadCellsOfBothRecordsAreCounted) {
  CsvDisturbanceParams params = sequence();
  params.file = fileWith("a.csv", "t,q\n0,10\n1,99\n");
  params.next_file = fileWith("b.csv", "t,q\n0,98\n1,7\n2,\n");
  params.missing = MissingCells::kHold;
  params.channels[0].upper = 50.0;
  const DisturbanceRecord record =
      readDisturbanceSequence(params, {"q"}, Vector::Constant(1, 5.0), 3600.0, 6);
  EXPECT_EQ(record.implausible, 2U);
  EXPECT_EQ(record.repaired, 1U);
}

TEST(DisturbanceSequence, AShorterRunEndsBefore) {
  const auto two = flows(sequence(), 2);
  EXPECT_EQ(two[0], 5.0);
  EXPECT_EQ(two[1], 10.0);
  EXPECT_EQ(flows(sequence(), 1)[0], 5.0);
  EXPECT_EQ(flows(sequence(), 3)[2], 11.0);
}

TEST(DisturbanceSequence, WithoutSequenceItIsThePlainRecord) {
  CsvDisturbanceParams plain = sequence();
  plain.lead_in_h = 0.0;
  plain.next_file.clear();
  const Vector nominal = Vector::Constant(1, 5.0);
  EXPECT_EQ(readDisturbanceSequence(plain, {"q"}, nominal, 1800.0, 4).values,
            readDisturbances(plain, {"q"}, nominal, 1800.0, 4).values);
}

TEST(DisturbanceSequence, TimesBetweenSamplesAreErrors) {
  CsvDisturbanceParams params = sequence();
  params.lead_in_h = 0.5;
  EXPECT_THROW(flows(params, 5), InputError);
  params = sequence();
  params.next_after_h = 1.5;
  EXPECT_THROW(flows(params, 5), InputError);
  params.next_after_h = 0.0;
  EXPECT_THROW(flows(params, 5), InputError);
}

}  // namespace plant_disturbance_sequence_test
}  // namespace fpc
