#include "fmbpc/ros/controller_node.hpp"

int main(int argc, char** argv) {
  return fpc::runNode<fpc::HybridMpcControllerNode>(argc, argv, "hybrid_mpc_controller");
}
