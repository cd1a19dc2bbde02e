// In place of bag_run.cpp, bag_table.cpp and operator_line.cpp in a build without ROS.
#include "fmbpc/base/input_error.hpp"
#include "runtime/bag_reader.hpp"
#include "runtime/operator_line.hpp"

namespace fpc {
namespace {

[[noreturn]] void refuse(const std::string& bag, const std::string& expected) {
  throw InputError(bag + ": expected " + expected +
                   "; this program is built without ROS and reads no bags");
}

}  // namespace

std::string loopTextOf(const std::string& bag) { refuse(bag, "a program built with ROS"); }

RecordedRun readBagRun(const std::string& bag, const LoopFile&, int) {
  refuse(bag, "a program built with ROS");
}

CsvTable readBag(const std::string& file) { refuse(file, "a CSV"); }

std::string askLoop(const OperatorCommand&) {
  throw InputError("a loop over topics: expected a program built with ROS");
}

std::string commissionLoop(const CommissionWish&,
                           const std::function<void(const std::string&, const std::string&)>&) {
  return askLoop({});
}

}  // namespace fpc
