#include "fmbpc/ros/controller_node.hpp"

int main(int argc, char** argv) {
  return fpc::runNode<fpc::SwarmMpcControllerNode>(argc, argv, "swarm_mpc_controller");
}
