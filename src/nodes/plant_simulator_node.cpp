#include "ros/run_node.hpp"

int main(int argc, char** argv) {
  return fpc::runNode<fpc::PlantSimulator>(argc, argv, "plant_simulator");
}
