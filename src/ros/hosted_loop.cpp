#include "ros/hosted_loop.hpp"

#include <pthread.h>
#include <ros/callback_queue.h>

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "ros/clp_optimizer.hpp"
#include "ros/controller_node.hpp"
#include "ros/fuzzy_identifier.hpp"
#include "ros/gateway_node.hpp"
#include "ros/loop_recorder.hpp"
#include "ros/node_end.hpp"
#include "ros/plant_simulator.hpp"
#include "ros/target_optimizer.hpp"

namespace fpc {
namespace {

constexpr double kLookWhetherTold = 0.1,
                 kLastWordsLeave = 0.05;  // [s] at tellToEnd(); until they have left
constexpr char kSimulator[] = "plant_simulator", kGateway[] = "plant_gateway",
               kLoopRecorder[] = "loop_recorder", kIdentifier[] = "fuzzy_identifier",
               kControllerNode[] = "fmbpc_controller", kTargetOptimizer[] = "target_optimizer",
               kClpOptimizer[] = "clp_optimizer";

/// A node of any class.
struct AnyRunning {
  virtual ~AnyRunning() = default;
  virtual void sayLast() = 0;
  virtual void finish() = 0;
};

template <typename Class>
struct RunningNode final : AnyRunning {
  RunningNode(const ros::NodeHandle& node, const char* name)
      : running(node, ros::NodeHandle(node, name), node.resolveName(name)) {}
  void sayLast() override { running.sayLast(); }
  void finish() override { running.finish(); }
  Running<Class> running;
};

/// The nodes of a loop, made in the order of loop.launch and ended in the opposite one.
class LoopNodes {
 public:
  explicit LoopNodes(const ros::NodeHandle& node) {
    add<PlantSimulator>(node, kSimulator);
    add<LoopRecorder>(node, kLoopRecorder);
    add<FuzzyIdentifier>(node, kIdentifier);
    add<ControllerNode>(node, kControllerNode);
    add<TargetOptimizer>(node, kTargetOptimizer);
    add<ClpOptimizer>(node, kClpOptimizer);
    add<GatewayNode>(node, kGateway);
  }
  ~LoopNodes() {
    while (!nodes_.empty()) nodes_.pop_back();
  }
  LoopNodes(const LoopNodes&) = delete;
  LoopNodes& operator=(const LoopNodes&) = delete;
  void sayLast() {
    for (const auto& node : nodes_) node->sayLast();
  }
  void finish() {
    for (const auto& node : nodes_) node->finish();
  }

 private:
  template <typename Class>
  void add(const ros::NodeHandle& node, const char* name) {
    nodes_.push_back(std::make_unique<RunningNode<Class>>(node, name));
  }
  std::vector<std::unique_ptr<AnyRunning>> nodes_;
};

/// One after another: each asks the master some hundred questions.
std::mutex& makingNodes() {
  static std::mutex mutex;
  return mutex;
}

std::string lastPartOf(const std::string& space) { return space.substr(space.rfind('/') + 1); }

}  // namespace

void setLoopParameters(const std::string& space, const PlantLoop& loop,
                       const HostOptions& options) {
  ros::param::set(space + "/" + topics::kLoopText, loop.loop.resolved);
  ros::param::set(space + "/" + topics::kLoopName, loop.name);
  ros::param::set(space + "/loop_links", loop.links.empty() ? "" : textOf(loop.links));
  XmlRpc::XmlRpcValue recorder;
  recorder["stay"] = true;
  recorder["keep"] = options.keep;
  recorder["plot"] = options.draw;
  recorder["out"] = options.out.empty() ? "" : options.out + "/" + loop.name;
  ros::param::set(space + "/" + kLoopRecorder, recorder);
}

HostedLoop::HostedLoop(std::string space)
    : space_(std::move(space)), ended_(end_.get_future()), thread_([this] { live(); }) {
  pthread_setname_np(thread_.native_handle(), lastPartOf(space_).substr(0, 15).c_str());
}

HostedLoop::~HostedLoop() {
  tellToEnd();
  if (thread_.joinable()) thread_.join();
}

bool HostedLoop::waitForEnd(double seconds) {
  return ended_.wait_for(std::chrono::duration<double>(seconds)) == std::future_status::ready;
}

std::string HostedLoop::failure() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return failure_;
}

void HostedLoop::fail(const std::string& why) {
  ROS_ERROR("%s: the loop ends: %s", space_.c_str(), why.c_str());
  const std::lock_guard<std::mutex> lock(mutex_);
  if (failure_.empty()) failure_ = why;
}

void HostedLoop::live() {
  onNodeEnd([this](const std::string& why) { fail(why); });
  try {
    turnNodes();
  } catch (const std::exception& error) {
    fail(error.what());
  } catch (...) {
    fail("an exception of unknown kind");
  }
  onNodeEnd({});
  end_.set_value();
}

void HostedLoop::turnNodes() {
  ros::CallbackQueue queue;  // lives longer than what puts callbacks into it
  ros::M_string own;         // what is global elsewhere: many loops are in this process
  for (const char* topic : {"/clock", "/tf", "/tf_static"}) own[topic] = space_ + topic;
  ros::NodeHandle node(space_, own);
  node.setCallbackQueue(&queue);
  std::unique_ptr<LoopNodes> nodes;
  {
    const std::lock_guard<std::mutex> lock(makingNodes());
    if (told_ || !ros::ok()) return;
    nodes = std::make_unique<LoopNodes>(node);
  }
  made_ = true;
  while (!told_ && ros::ok() && failure().empty())
    queue.callAvailable(ros::WallDuration(kLookWhetherTold));
  if (ros::ok()) nodes->sayLast();
  ros::WallDuration(kLastWordsLeave).sleep();
  nodes->finish();
}

}  // namespace fpc
