#include "ros/run_node.hpp"

int main(int argc, char** argv) {
  return fpc::runNode<fpc::LoopRecorder>(argc, argv, "loop_recorder");
}
