// A roscpp node that does nothing but say that it is there: what a launch cannot do without.
#include <ros/ros.h>
#include <std_msgs/Empty.h>

int main(int argc, char** argv) {
  ros::init(argc, argv, "empty_node");
  ros::NodeHandle node("~");
  auto up = node.advertise<std_msgs::Empty>("up", 1, true);
  up.publish(std_msgs::Empty());
  ros::spin();
  return 0;
}
