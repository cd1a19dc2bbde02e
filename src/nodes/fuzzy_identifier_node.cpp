#include "ros/run_node.hpp"

int main(int argc, char** argv) {
  return fpc::runNode<fpc::FuzzyIdentifier>(argc, argv, "fuzzy_identifier");
}
