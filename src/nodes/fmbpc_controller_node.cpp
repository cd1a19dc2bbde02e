#include "fmbpc/ros/controller_node.hpp"

int main(int argc, char** argv) {
  return fpc::runNode<fpc::FmbpcControllerNode>(argc, argv, "fmbpc_controller");
}
