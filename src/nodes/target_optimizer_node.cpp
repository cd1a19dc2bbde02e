#include "ros/run_node.hpp"

int main(int argc, char** argv) {
  return fpc::runNode<fpc::TargetOptimizer>(argc, argv, "target_optimizer");
}
