#include "ros/commission_server.hpp"

#include <filesystem>
#include <limits>
#include <utility>

#include "config/design_library.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/option.hpp"
#include "ros/topics.hpp"
#include "runtime/commissioning/stages_job.hpp"

namespace fpc {
namespace {

constexpr double kPatienceShare = 0.25;  // of a sample's wall time, which the law waits for stages
constexpr double kPacedPatience = 1.0;   // [s] where the plant waits for the law anyway

/// The status goes out when something changes; actionlib's timer goes by simulated time.
ros::NodeHandle quiet(const ros::NodeHandle& private_node) {
  private_node.setParam(std::string(topics::kCommission) + "/actionlib_status_frequency", 0.0);
  return private_node;
}

}  // namespace

CommissionServer::CommissionServer(const ros::NodeHandle& private_node, const LoopFile& loop,
                                   Loop hooks)
    : loop_(loop),
      hooks_(std::move(hooks)),
      server_(
          quiet(private_node), topics::kCommission,
          [this](Server::GoalHandle goal) { onGoal(std::move(goal)); },
          [this](Server::GoalHandle goal) {
            if (!thread_.joinable() || !(goal == goal_)) return;
            cancelled_ = true;
            tap_->end("cancelled");
          },
          false) {
  server_.start();
}

CommissionServer::~CommissionServer() {
  if (tap_) tap_->end("the node ends");
  if (thread_.joinable()) thread_.join();
}

double CommissionServer::patience() const {
  if (loop_.exchange.pace == Pace::kLockstep) return std::numeric_limits<double>::infinity();
  if (loop_.exchange.pace == Pace::kPaced) return kPacedPatience;
  const double speedup = loop_.external_plant ? loop_.gateway.speedup : loop_.exchange.speedup;
  return kPatienceShare * loop_.plant_info.sample_time_s / speedup;
}

void CommissionServer::onGoal(Server::GoalHandle goal) {
  try {
    require(!thread_.joinable(), topics::kCommission, "no other goal that is at work");
    require(loop_.exchange.publishers.at(topics::kServices).empty(), "loop.publishers.services",
            "nobody named: an action does not say who asks");
    begin(*goal.getGoal());
  } catch (const std::exception& error) {
    fmbpc::CommissionResult result;
    result.message = error.what();
    ROS_WARN("commission: goal rejected: %s", error.what());
    return goal.setRejected(result, error.what());
  }
  goal_ = goal;
  goal_.setAccepted();
}

void CommissionServer::begin(const fmbpc::CommissionGoal& wish) {
  require(std::filesystem::path(wish.folder).is_absolute(), "folder", "an absolute path");
  tap_ = std::make_shared<PlantTap>(patience());
  StagesWish asked;
  asked.brief = wish.brief;
  asked.folder = wish.folder;
  asked.until = wish.until;
  asked.again = wish.again;
  asked.evaluations = static_cast<int>(wish.evaluations);
  asked.members = static_cast<int>(wish.members);
  asked.plant = tap_;
  asked.loop = &loop_;
  asked.show = [this](const std::string& stage, const std::string& text) {
    fmbpc::CommissionFeedback news;
    news.stage = stage;
    news.text = text;
    const std::lock_guard<std::mutex> lock(mutex_);
    news_.push_back(std::move(news));
  };
  const std::shared_ptr<StagesJob> stages = designLibrary("commission").stages(asked);
  if (stages->needsPlant()) {
    hooks_.tap(tap_);
    held_ = stages->held();
    if (!held_.empty()) hooks_.setpoint({0, held_, stages->heldValues(), CommandMode::kOverride});
  }
  cancelled_ = over_ = false;
  result_ = {};
  thread_ = std::thread([this, stages] {
    fmbpc::CommissionResult result;
    try {
      stages->run();
      result.ok = 1;
    } catch (const std::exception& error) {
      result.message = error.what();
    }
    tap_->end(result.ok ? "the stages are done" : result.message);
    result.figures = stages->figures();
    const std::lock_guard<std::mutex> lock(mutex_);
    result_ = std::move(result);
    over_ = true;
  });
}

void CommissionServer::poll() {
  if (!thread_.joinable()) return;
  std::vector<fmbpc::CommissionFeedback> news;
  bool over = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    news.swap(news_);
    over = over_;
  }
  for (const fmbpc::CommissionFeedback& text : news) goal_.publishFeedback(text);
  if (!tap_->open() && !held_.empty())
    hooks_.setpoint({0, std::exchange(held_, {}), {}, CommandMode::kRelease});
  if (!over) return;
  thread_.join();
  if (cancelled_)
    goal_.setCanceled(result_, result_.message);
  else if (result_.ok)
    goal_.setSucceeded(result_, "");
  else
    goal_.setAborted(result_, result_.message);
  goal_ = {};
}

}  // namespace fpc
