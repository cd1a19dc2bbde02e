#include "fmbpc/ros/controller_node.hpp"

int main(int argc, char** argv) {
  return fpc::runNode<fpc::AdaptivePiControllerNode>(argc, argv, "adaptive_pi_controller");
}
