#include "ros/run_node.hpp"

int main(int argc, char** argv) {
  return fpc::runNode<fpc::ControllerNode>(argc, argv, "fmbpc_controller");
}
