#include "ros/plant_host.hpp"

#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "fmbpc/base/text.hpp"
#include "ros/conversions.hpp"
#include "ros/guard.hpp"
#include "ros/node.hpp"
#include "ros/queues.hpp"
#include "ros/topics.hpp"

namespace fpc {
namespace {

constexpr double kLookAtLoops = 0.25;   // [s]
constexpr double kStopPatience = 10.0;  // [s] for a loop's last word and its record
constexpr char kOrder[] = "order";

bool isWell(LoopMode mode) {
  return mode == LoopMode::kAutomatic || mode == LoopMode::kManual || mode == LoopMode::kFinished;
}

std::string wordsOfStatus(int status) {
  if (WIFSIGNALED(status))
    return std::string("its process was ended: ") + strsignal(WTERMSIG(status));
  return "its process ended with exit code " + std::to_string(WEXITSTATUS(status));
}

}  // namespace

PlantHost::PlantHost(ros::NodeHandle node, ros::NodeHandle private_node)
    : node_(std::move(node)),
      private_node_(std::move(private_node)),
      machine_(private_node_.param<std::string>("machine", "")),
      only_(private_node_.param<std::string>("only", "")),
      set_(parseOverrides(private_node_.param<std::string>("set", ""))),
      begun_s_(steadyNow()),
      end_(node_) {
  const std::string plant = private_node_.param<std::string>("plant", "");
  require(!plant.empty(), "parameter ~plant", "a plant file");
  options_.out = private_node_.param<std::string>("out", "");
  options_.keep = private_node_.param("keep", false);
  options_.draw = private_node_.param("draw", false);
  const PlantLoops loops = readPlantLoops(plant, set_);
  file_ = loops.file;
  if (!only_.empty()) loops.of(only_);
  for (const PlantLoop& loop : loops.loops)
    if (only_.empty() || loop.name == only_) add(loop);
  order_ = private_node_.advertiseService(kOrder, &PlantHost::onOrder, this);
  if (only_.empty())
    health_ = std::make_unique<HealthReporter>(
        node_, private_node_, "plant", loops.name, true,
        HealthReporter::Source{[this](double now_s) { return health(now_s); },
                               [] { return StepHeader{}; },
                               [this](Diagnostics::Status& status) {
                                 for (const auto& [name, health] : healths_)
                                   status.add(name, sentence(health));
                               }});
  for (auto& [name, place] : places_)
    if (place.ours) start(place);
  timer_ = SteadyTimer(node_, kLookAtLoops, [this] {
             const auto say = [](const char* what) {
               ROS_ERROR("%s: %s", ros::this_node::getName().c_str(), what);
             };
             callGuarded([this] { look(); }, say, say);
           }).started();
}

PlantHost::~PlantHost() { finish(); }

std::string PlantHost::spaceOf(const PlantLoop& loop) const { return node_.resolveName(loop.name); }

void PlantHost::add(const PlantLoop& loop) {
  Place& place = places_[loop.name];
  place.loop = loop;
  place.ours = loop.machine == machine_ || !only_.empty();
  const std::string space = spaceOf(loop);
  place.state = node_.subscribe<fmbpc::LoopState>(
      space + "/" + topics::kLoopState, queueOf(ListenerKind::kPeer),
      [this, &place](const fmbpc::LoopState::ConstPtr& msg) { onState(place, *msg); });
  place.run_end = node_.subscribe<std_msgs::String>(
      space + "/" + topics::kRunEnd, 1,
      [&place](const std_msgs::String::ConstPtr& msg) { place.end = msg->data; });
}

void PlantHost::onState(Place& place, const fmbpc::LoopState& msg) {
  if (!msg.summary) return;
  healths_[place.loop.name] = {static_cast<LoopMode>(msg.mode),
                               eventCodeOr(msg.code, EventCode::kNone), msg.reason, msg.missing};
  heard_s_[place.loop.name] = steadyNow();
}

void PlantHost::start(Place& place) {
  place.stopped = false;
  place.end.clear();
  place.trouble.clear();
  healths_.erase(place.loop.name);
  heard_s_[place.loop.name] = steadyNow();
  if (place.loop.isolate && only_.empty()) return startProcess(place);
  setLoopParameters(spaceOf(place.loop), place.loop, options_);
  place.here = std::make_unique<HostedLoop>(spaceOf(place.loop));
}

/// This program again, told to have this loop only.
void PlantHost::startProcess(Place& place) {
  const std::string name = ros::this_node::getName();
  std::string text;
  for (const auto& [key, value] : set_) text += (text.empty() ? "" : " ") + key + "=" + value;
  const std::vector<std::string> words{
      "/proc/self/exe",
      "__name:=" + name.substr(name.rfind('/') + 1) + "_" + place.loop.name,
      "_plant:=" + file_,
      "_only:=" + place.loop.name,
      "_out:=" + options_.out,
      std::string("_keep:=") + (options_.keep ? "true" : "false"),
      std::string("_draw:=") + (options_.draw ? "true" : "false")};
  const std::string space = node_.resolveName("plant_host_" + place.loop.name);
  ros::param::set(space + "/set", text);
  std::vector<char*> argv;
  for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child == 0) {  // only what is safe beside other threads
    setpgid(0, 0);   // Ctrl-C is for the parent, which tells it
    prctl(PR_SET_PDEATHSIG, SIGINT);
    if (getppid() != parent) _exit(1);
    execv(argv[0], argv.data());
    _exit(127);
  }
  if (child < 0) throw std::runtime_error("no process for loop " + place.loop.name);
  place.process = child;
}

void PlantHost::stop(Place& place) {
  if (place.process > 0) {
    kill(place.process, SIGINT);
    const double until_s = steadyNow() + kStopPatience;
    int status = 0;
    while (waitpid(place.process, &status, WNOHANG) == 0) {
      if (steadyNow() > until_s) kill(place.process, SIGKILL);  // it may: it is alone there
      ros::WallDuration(0.02).sleep();
    }
    place.process = 0;
  } else if (place.here) {
    place.here->tellToEnd();
    require(place.here->waitForEnd(kStopPatience), "loop " + place.loop.name,
            "code that returns: it hangs and holds its thread; `isolate: true` gives it a process "
            "that can be killed");
    place.here.reset();
  }
  place.stopped = true;
  healths_.erase(place.loop.name);
}

bool PlantHost::onOrder(fmbpc::LoopOrder::Request& request, fmbpc::LoopOrder::Response& response) {
  try {
    order(request.order, request.loop);
    response.success = true;
  } catch (const std::exception& error) {
    response.message = error.what();
    ROS_WARN("%s: order refused: %s", ros::this_node::getName().c_str(), error.what());
  }
  return true;
}

/// A loop that is started is read from the file as it is now; the others stay as they are.
void PlantHost::order(std::uint8_t order, const std::string& loop) {
  using Request = fmbpc::LoopOrder::Request;
  require(order == Request::START || order == Request::STOP || order == Request::REPLACE, "order",
          "1 (start), 2 (stop) or 3 (replace)");
  const bool starts = order != Request::STOP;
  const PlantLoops now = starts ? readPlantLoops(file_, set_) : PlantLoops{};
  auto found = places_.find(loop);
  if (starts && found == places_.end()) {
    add(now.of(loop));
    found = places_.find(loop);
  }
  require(found != places_.end(), "loop '" + loop + "'", "one of the plant's");
  Place& place = found->second;
  require(place.ours, "loop '" + loop + "'",
          "one of this machine; it runs on " + place.loop.machine);
  const bool lives = !place.stopped && place.trouble.empty() && (place.here || place.process > 0);
  require(order != Request::START || !lives, "loop '" + loop + "'", "one that does not run");
  if (starts) now.of(loop);
  stop(place);
  if (!starts) return;
  place.loop = now.of(loop);
  start(place);
}

void PlantHost::lookAt(Place& place) {
  int status = 0;
  if (place.process > 0 && waitpid(place.process, &status, WNOHANG) == place.process) {
    place.process = 0;
    place.trouble = wordsOfStatus(status);
    ROS_ERROR("%s: loop %s: %s", ros::this_node::getName().c_str(), place.loop.name.c_str(),
              place.trouble.c_str());
  }
  if (place.here && place.here->ended() && place.trouble.empty())
    place.trouble = place.here->failure();
  if (!place.trouble.empty())
    healths_[place.loop.name] = {LoopMode::kFailed, EventCode::kNodeSilent, place.trouble, {}};
}

void PlantHost::look() {
  for (auto& [name, place] : places_) lookAt(place);
  sayEndWhenDue();
}

/// With loops that never end, never.
void PlantHost::sayEndWhenDue() {
  if (ended_ || options_.keep || !only_.empty()) return;
  std::string why = "recorded";
  bool any = false;
  for (const auto& [name, place] : places_) {
    if (!place.ours || place.stopped) continue;
    any = true;
    if (place.end.empty() && place.trouble.empty()) return;
    const std::string words = place.trouble.empty() ? place.end : place.trouble;
    if (words != "recorded") why = name + ": " + words;
  }
  if (!any) return;
  ended_ = true;
  failed_ = why != "recorded";
  end_.say(why);
}

/// The worst of the loops', and how many are well.
Health PlantHost::health(double now_s) const {
  Health worst{LoopMode::kFinished, EventCode::kNone, "", {}};
  std::size_t well = 0, living = 0, finished = 0;
  std::vector<std::string> unwell, stopped;
  for (const auto& [name, place] : places_) {
    if (place.stopped) {
      stopped.push_back(name);
      continue;
    }
    ++living;
    Health one{LoopMode::kStarting, EventCode::kWaiting, "starting", {}};
    const auto found = healths_.find(name);
    if (found != healths_.end()) one = found->second;
    const auto heard = heard_s_.find(name);
    const bool silent = heard == heard_s_.end() || now_s - heard->second > RingWatch::kSilence;
    if (found != healths_.end() && place.trouble.empty() && silent)
      one = {LoopMode::kStalled, EventCode::kNodeSilent, "no word from its plant", {}};
    if (one.mode == LoopMode::kFinished) ++finished;
    if (isWell(one.mode)) {
      ++well;
      if (one.mode != LoopMode::kFinished && isWell(worst.mode)) worst.mode = LoopMode::kAutomatic;
      continue;
    }
    unwell.push_back(name + " " + sentence(one));
    if (isWell(worst.mode) || one.mode > worst.mode) worst = {one.mode, one.code, "", {}};
    worst.missing.push_back(spaceOf(place.loop));
  }
  constexpr std::size_t kNamed = 5;
  const std::size_t more = unwell.size() > kNamed ? unwell.size() - kNamed : 0;
  if (more > 0) unwell.resize(kNamed);
  worst.words = finished == living && living > 0
                    ? "finished: " + std::to_string(living) + " loops"
                    : std::to_string(well) + " of " + std::to_string(living) + " loops are well";
  if (!unwell.empty()) worst.words += "; " + join(unwell, "; ");
  if (more > 0) worst.words += "; " + std::to_string(more) + " more";
  if (!stopped.empty()) worst.words += "; stopped: " + join(stopped);
  if (living == 0) worst.mode = LoopMode::kHeld;
  return worst;
}

void PlantHost::sayLast() {
  timer_.stop();
  for (auto& [name, place] : places_) {
    if (place.process > 0) kill(place.process, SIGINT);
    if (place.here) place.here->tellToEnd();
  }
  if (health_) health_->sayLast("the plant's loops are shut down");
}

int PlantHost::finish() {
  for (auto& [name, place] : places_) {
    if (place.here && !place.here->waitForEnd(kStopPatience)) {
      ROS_FATAL("%s: loop %s hangs: it is left behind", ros::this_node::getName().c_str(),
                name.c_str());
      std::_Exit(1);  // its thread cannot be ended in another way
    }
    if (place.here && !place.here->failure().empty()) failed_ = true;
    place.here.reset();
    if (place.process <= 0) continue;
    kill(place.process, SIGINT);
    const double until_s = steadyNow() + kStopPatience;
    while (waitpid(place.process, nullptr, WNOHANG) == 0) {
      if (steadyNow() > until_s) kill(place.process, SIGKILL);
      ::usleep(20000);
    }
    place.process = 0;
  }
  return failed_ ? 1 : 0;
}

int runPlantHost(int argc, char** argv) {
  ros::init(argc, argv, "plant_host", ros::init_options::NoSigintHandler);
  hearShutdown();
  negotiateQuickly();
  const ros::NodeHandle node, private_node("~");
  try {
    PlantHost host(node, private_node);
    spinUntilShutdown([&host] { host.sayLast(); });
    return host.finish();
  } catch (const std::exception& error) {
    ROS_FATAL("%s: %s", ros::this_node::getName().c_str(), error.what());
    return failToStart(node, private_node, error.what());
  }
}

}  // namespace fpc
