#include "fmbpc/ros/controller_node.hpp"

int main(int argc, char** argv) {
  return fpc::runNode<fpc::ExcitationGeneratorNode>(argc, argv, "excitation_generator");
}
