#include "ros/run_node.hpp"

int main(int argc, char** argv) {
  return fpc::runNode<fpc::ClpOptimizer>(argc, argv, "clp_optimizer");
}
