// What the main() of a node calls; compiled with the node's class, so that a main() reads no ROS.
#pragma once

#include <string>

namespace fpc {

class ClpOptimizer;
class ControllerNode;
class FuzzyIdentifier;
class GatewayNode;
class LoopRecorder;
class PlantSimulator;
class TargetOptimizer;

/// Everything a main() does. A node that its loop does not need ends, or with ~stay true (a launch
/// that respawns) waits for the shutdown.
template <typename Class>
int runNode(int argc, char** argv, const std::string& name);

}  // namespace fpc
