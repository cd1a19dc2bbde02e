#include "fmbpc/ros/fuzzy_optimal_controller.hpp"

int main(int argc, char** argv) {
  return fpc::runNode<fpc::FuzzyOptimalControllerNode>(argc, argv, "fuzzy_optimal_controller");
}
