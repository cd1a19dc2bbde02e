// The floor under the loop over topics: three processes that pass messages of the loop's own types
// and sizes round, with its other publishers, and compute nothing. Roles: plant, controller,
// optimizer, listener; `all` has them as threads of one process that hand shared messages on, as
// nodelets do.
//   bare_ring ROLE SAMPLES
#include <fmbpc/ControlAction.h>
#include <fmbpc/Measurement.h>
#include <fmbpc/PlantState.h>
#include <fmbpc/PredictiveAction.h>
#include <fmbpc/Signal.h>
#include <fmbpc/SolverReport.h>
#include <fmbpc/Tracking.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>
#include <std_msgs/Float64.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "ros/shared.hpp"

namespace {

constexpr unsigned kQueue = 100000;
constexpr int kOutputs = 2, kInputs = 1, kDisturbances = 2, kStates = 6, kModelState = 3,
              kSteps = 42;

template <typename Msg>
ros::Subscriber listen(ros::NodeHandle& node, const char* topic,
                       boost::function<void(const boost::shared_ptr<const Msg>&)> handler) {
  return node.subscribe<Msg>(topic, kQueue, handler, ros::VoidConstPtr(),
                             ros::TransportHints().tcpNoDelay());
}

void spin(const ros::NodeHandle& node) {
  auto& queue = *static_cast<ros::CallbackQueue*>(node.getCallbackQueue());
  while (ros::ok()) queue.callAvailable(ros::WallDuration(0.1));
}

fmbpc::Matrix matrix(int rows, int cols) {
  fmbpc::Matrix m;
  m.rows = static_cast<std::uint32_t>(rows);
  m.cols = static_cast<std::uint32_t>(cols);
  m.data.assign(static_cast<std::size_t>(rows * cols), 1.0);
  return m;
}

class Signals {
 public:
  Signals(ros::NodeHandle& node, const std::string& role, int count) {
    for (int i = 0; i < count; ++i)
      publishers_.push_back(
          node.advertise<fmbpc::Signal>("signal/" + role + std::to_string(i), 1000));
  }
  void publish() {
    for (auto& publisher : publishers_) publisher.publish(fmbpc::Signal());
  }

 private:
  std::vector<ros::Publisher> publishers_;
};

// `listeners`: processes that hear the measurement; those in one process count once.
void runPlant(ros::NodeHandle& node, std::uint32_t samples, std::uint32_t listeners) {
  auto measured = node.advertise<fmbpc::Measurement>("measurement", kQueue);
  auto state = node.advertise<fmbpc::PlantState>("plant_state", kQueue);
  auto clock = node.advertise<rosgraph_msgs::Clock>("/clock", 1000);
  auto seconds = node.advertise<std_msgs::Float64>("bare_seconds", 1, true);
  Signals signals(node, "p", kOutputs + kDisturbances + kInputs);
  fmbpc::Measurement sample;
  sample.header.frame_id = "plant";
  sample.outputs.assign(kOutputs, 1.0);
  sample.disturbances.assign(kDisturbances, 1.0);
  sample.input_applied.assign(kInputs, 1.0);
  fmbpc::PlantState truth;
  truth.state.assign(kStates, 1.0);
  truth.outputs.assign(kOutputs, 1.0);
  truth.disturbances.assign(kDisturbances, 1.0);
  ros::WallTime start;
  const auto send = [&] {
    measured.publish(fpc::shared(sample));
    clock.publish(rosgraph_msgs::Clock());
    state.publish(fpc::shared(truth));
    signals.publish();
  };
  const auto answer = listen<fmbpc::ControlAction>(
      node, "control_action", [&](const fmbpc::ControlAction::ConstPtr& m) {
        if (m->step != sample.step) return;
        if (++sample.step < samples) return send();
        std::printf("%.9f\n", (ros::WallTime::now() - start).toSec());
        std::fflush(stdout);
        ros::shutdown();
      });
  const auto ready = [&] {
    return measured.getNumSubscribers() >= listeners && state.getNumSubscribers() >= 1 &&
           answer.getNumPublishers() >= 1;
  };
  // Sent again until it is answered: the others may not have found one another yet.
  ros::WallTimer begin =
      node.createWallTimer(ros::WallDuration(0.1), [&](const ros::WallTimerEvent&) {
        if (sample.step > 0 || !ready()) return;
        start = ros::WallTime::now();
        send();
      });
  spin(node);
}

void runController(ros::NodeHandle& node) {
  auto base = node.advertise<fmbpc::ControlAction>("base_action", kQueue);
  auto prediction = node.advertise<fmbpc::PredictiveAction>("predictive_action", kQueue);
  auto tracking = node.advertise<fmbpc::Tracking>("tracking", kQueue);
  Signals signals(node, "c", 2 * kOutputs);
  fmbpc::PredictiveAction predicted;
  predicted.state.assign(kModelState, 1.0);
  predicted.A = matrix(kModelState, kModelState);
  predicted.B = matrix(kModelState, kInputs);
  predicted.C = matrix(kOutputs, kModelState);
  predicted.offset_state.assign(kModelState, 1.0);
  predicted.offset_output.assign(kOutputs, 1.0);
  predicted.K = matrix(kInputs, kModelState);
  predicted.feedforward = matrix(kInputs, kSteps);
  predicted.reference = matrix(kOutputs, kSteps);
  predicted.setpoint.assign(kOutputs, 1.0);
  predicted.input_base_unclipped.assign(kInputs, 1.0);
  predicted.input_previous.assign(kInputs, 1.0);
  predicted.input_lower.assign(kInputs, 0.0);
  predicted.input_upper.assign(kInputs, 1600.0);
  const auto heard =
      listen<fmbpc::Measurement>(node, "measurement", [&](const fmbpc::Measurement::ConstPtr& m) {
        fmbpc::ControlAction action;
        action.step = predicted.step = m->step;
        action.input = m->input_applied;
        prediction.publish(fpc::shared(predicted));
        base.publish(fpc::shared(action));
        fmbpc::Tracking followed;
        followed.setpoint = followed.reference = m->outputs;
        tracking.publish(fpc::shared(followed));
        signals.publish();
      });
  spin(node);
}

void runOptimizer(ros::NodeHandle& node) {
  auto action = node.advertise<fmbpc::ControlAction>("control_action", kQueue);
  auto report = node.advertise<fmbpc::SolverReport>("solver_report", kQueue);
  Signals signals(node, "o", 2 * kInputs);
  const auto predicted = listen<fmbpc::PredictiveAction>(
      node, "predictive_action", [](const fmbpc::PredictiveAction::ConstPtr&) {});
  const auto heard = listen<fmbpc::ControlAction>(node, "base_action",
                                                  [&](const fmbpc::ControlAction::ConstPtr& m) {
                                                    action.publish(m);
                                                    fmbpc::SolverReport solved;
                                                    solved.perturbation = m->input;
                                                    report.publish(fpc::shared(solved));
                                                    signals.publish();
                                                  });
  spin(node);
}

void runListener(ros::NodeHandle& node) {
  const auto a =
      listen<fmbpc::Measurement>(node, "measurement", [](const fmbpc::Measurement::ConstPtr&) {});
  const auto b =
      listen<fmbpc::PlantState>(node, "plant_state", [](const fmbpc::PlantState::ConstPtr&) {});
  const auto c = listen<fmbpc::ControlAction>(node, "base_action",
                                              [](const fmbpc::ControlAction::ConstPtr&) {});
  const auto d = listen<fmbpc::ControlAction>(node, "control_action",
                                              [](const fmbpc::ControlAction::ConstPtr&) {});
  const auto e = listen<fmbpc::Tracking>(node, "tracking", [](const fmbpc::Tracking::ConstPtr&) {});
  const auto f = listen<fmbpc::SolverReport>(node, "solver_report",
                                             [](const fmbpc::SolverReport::ConstPtr&) {});
  spin(node);
}

void run(const std::string& role, std::uint32_t samples, std::uint32_t listeners,
         ros::NodeHandle& node) {
  if (role == "plant")
    runPlant(node, samples, listeners);
  else if (role == "controller")
    runController(node);
  else if (role == "optimizer")
    runOptimizer(node);
  else
    runListener(node);
}

void runAll(std::uint32_t samples) {
  std::vector<std::thread> threads;
  for (const char* role : {"listener", "optimizer", "controller", "plant"})
    threads.emplace_back([role, samples] {
      ros::CallbackQueue queue;
      ros::NodeHandle node;
      node.setCallbackQueue(&queue);
      run(role, samples, 1, node);
    });
  for (std::thread& thread : threads) thread.join();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  const std::string role = argv[1];
  ros::init(argc, argv, "bare_" + role);
  ros::NodeHandle node;
  const auto samples = static_cast<std::uint32_t>(std::atoi(argv[2]));
  if (role == "all")
    runAll(samples);
  else
    run(role, samples, 2, node);
  return 0;
}
