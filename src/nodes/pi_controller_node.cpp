#include "fmbpc/ros/controller_node.hpp"

int main(int argc, char** argv) {
  return fpc::runNode<fpc::PiControllerNode>(argc, argv, "pi_controller");
}
