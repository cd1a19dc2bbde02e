// A bag opened to read, and whatever its library says against it in the words of an input error.
#pragma once

#include <ros/exception.h>
#include <rosbag/bag.h>
#include <rosbag/exceptions.h>

#include <string>

#include "fmbpc/base/input_error.hpp"

namespace fpc {

/// What `function` makes of the open bag. @throws InputError naming the file: unreadable, not
/// closed, or with messages whose bytes are damaged.
template <typename Function>
auto withBag(const std::string& file, Function function) {
  try {
    const rosbag::Bag bag(file, rosbag::bagmode::Read);
    return function(bag);
  } catch (const rosbag::BagUnindexedException&) {
    throw InputError(file + ": expected a bag that was closed (rosbag reindex mends it)");
  } catch (const ros::Exception& e) {
    throw InputError(file + ": expected a readable bag (" + e.what() + ")");
  }
}

}  // namespace fpc
