#include "ros/run_node.hpp"

int main(int argc, char** argv) {
  return fpc::runNode<fpc::GatewayNode>(argc, argv, "plant_gateway");
}
