#include "ros/gateway_node.hpp"

#include <utility>

#include "fmbpc/base/signals.hpp"
#include "ros/float64_field.hpp"

namespace fpc {
namespace {

constexpr double kExchange = 0.01;  // [s] between two looks at the field

std::unique_ptr<Field> makeField(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                                 const LoopFile& loop) {
  if (loop.gateway.type == GatewayType::kModbus) return makeModbusField(loop);
  return std::make_unique<Float64Field>(node, loop, private_node.getNamespace());
}

}  // namespace

std::string GatewayNode::idleReason(const LoopFile& loop) {
  return loop.gateway.enabled() ? "" : loop.name + " has no gateway";
}

GatewayNode::GatewayNode(ros::NodeHandle node, ros::NodeHandle private_node, const LoopFile& loop)
    : GatewayNode(node, private_node, loop, makeField(node, private_node, loop)) {}

GatewayNode::GatewayNode(ros::NodeHandle node, ros::NodeHandle private_node, const LoopFile& loop,
                         std::unique_ptr<Field> field)
    : PlantNode(node, std::move(private_node), loop,
                std::make_unique<PlantGateway>(loop, field->rounding()),
                namesOf(loop.plant_info.disturbances)),
      field_(std::move(field)),
      gateway_(static_cast<PlantGateway&>(session().process())),
      field_timer_(guardedTimer(node, kExchange, "field", [this] { exchange(); }).started()) {
  begin();
}

/// Who is missing, and why nothing can come from it.
std::vector<std::string> GatewayNode::plantMissing() {
  std::vector<std::string> missing = gateway_.missing();
  const std::string link = field_->problem();
  if (!missing.empty() && !link.empty())
    missing.insert(missing.begin(), "the plant (" + link + ")");
  return missing;
}

void GatewayNode::exchange() {
  const double now_s = steadyNow();
  gateway_.tick(now_s);
  field_->exchange(gateway_, session().phase() == PlantPhase::kRunning, now_s);
  if (session().phase() == PlantPhase::kWaiting) gateway_.renew();
  const std::string problem = field_->problem();
  if (problem == problem_ || (!problem.empty() && !problem_log_.pass())) return;
  problem_ = problem;
  if (!problem.empty()) ROS_ERROR("%s: %s", name().c_str(), problem.c_str());
}

static_assert(fmbpc::Measurement::STALE == static_cast<std::uint8_t>(Quality::kStale));
static_assert(fmbpc::Measurement::BAD == static_cast<std::uint8_t>(Quality::kBad));
static_assert(fmbpc::Measurement::MISSING == static_cast<std::uint8_t>(Quality::kMissing));

void GatewayNode::mark(fmbpc::Measurement& measurement) const {
  for (const Quality quality : gateway_.quality())
    measurement.quality.push_back(static_cast<std::uint8_t>(quality));
  const Vector& age = gateway_.age();
  measurement.age_s.assign(age.data(), age.data() + age.size());
  measurement.local = !session().takesActions();
}

int GatewayNode::finish() {
  field_->release();
  return Node::finish();
}

Health GatewayNode::plantHealth() const {
  const std::string problem = gateway_.problem(), link = field_->problem();
  if (problem.empty() && link.empty()) return {LoopMode::kAutomatic, EventCode::kNone, "", {}};
  const std::string words = problem.empty() ? link : link.empty() ? problem : problem + ": " + link;
  if (gateway_.field() == FieldState::kLocal)
    return {LoopMode::kManual, EventCode::kPlantLocal, words, {}};
  return {gateway_.field() == FieldState::kRunning ? LoopMode::kDegraded : LoopMode::kHeld,
          EventCode::kLinkLost,
          words,
          {}};
}

void GatewayNode::addValues(Diagnostics::Status& status) const {
  for (const auto& [name, count] : field_->counts()) status.add(name, count);
  status.add("actions that the plant could not take", gateway_.skipped());
}

template int runNode<GatewayNode>(int, char**, const std::string&);

}  // namespace fpc
