// In place of bag_run.cpp and bag_table.cpp in a build without ROS.
#include "fmbpc/base/input_error.hpp"
#include "loop/bag_reader.hpp"

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

}  // namespace fpc
