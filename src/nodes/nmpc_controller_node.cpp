#include "fmbpc/ros/controller_node.hpp"

int main(int argc, char** argv) {
  return fpc::runNode<fpc::NmpcControllerNode>(argc, argv, "nmpc_controller");
}
