#include "control/hybrid/hybrid_mpc.hpp"

#include <cmath>
#include <string>

#include "base/require_numbers.hpp"
#include "control/hybrid/evolution.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kMoved = 1e-6;  // an input is elsewhere than it was sent

void checkChoices(const Matrix& choices, Index n_u) {
  require(choices.rows() == n_u && choices.cols() > 0, "controller.inputs",
          "at least one vector of " + std::to_string(n_u) + " inputs");
  require(choices.allFinite(), "controller.inputs", "finite numbers");
  for (Index i = 0; i < choices.cols(); ++i)
    for (Index j = 0; j < i; ++j)
      require((choices.col(i) - choices.col(j)).cwiseAbs().maxCoeff() > kSameInput,
              "controller.inputs", "every vector only once");
}

void checkTerm(double weight, int input, Index n_u, const std::string& key) {
  require(std::isfinite(weight) && weight >= 0.0, key + ".weight", "a number >= 0");
  require(input >= 0 && input < n_u, key, "inputs of the plant");
}

}  // namespace

void HybridMpcParams::validate(Index n_y, Index n_u) const {
  checkChoices(choices, n_u);
  require(hold_samples >= 1, "controller.hold_samples", "a number >= 1");
  require(horizon_blocks >= 1, "controller.horizon_blocks", "a number >= 1");
  requireNonNegative(weight_tracking, n_y, "controller.cost.tracking");
  bool signs = true;
  for (const SwitchTerm& s : switching) {
    checkTerm(s.weight, s.before, n_u, "controller.cost.switching");
    checkTerm(s.weight, s.after, n_u, "controller.cost.switching");
    signs =
        signs && choices.row(s.before).minCoeff() >= 0.0 && choices.row(s.after).minCoeff() >= 0.0;
  }
  for (const TravelTerm& t : travel) {
    checkTerm(t.weight, t.input, n_u, "controller.cost.travel");
    require(t.gate >= -1 && t.gate < n_u, "controller.cost.travel", "inputs of the plant");
    signs = signs && (t.gate < 0 || choices.row(t.gate).minCoeff() >= 0.0);
  }
  require(signs, "controller.cost", "terms that no input vector makes negative");
  for (const ForbiddenTransition& t : forbidden_transitions)
    require(t.from.size() == n_u && t.to.size() == n_u, "controller.forbidden_transitions",
            "from and to of " + std::to_string(n_u) + " inputs");
  TreeSearchParams{horizon_blocks, false, node_budget}.validate(static_cast<int>(choices.cols()));
}

void HybridMpcParams::validateLimits(const InputLimits& limits) const {
  for (Index i = 0; i < choices.cols(); ++i)
    require((choices.col(i).array() >= limits.lower.array() - kSameInput).all() &&
                (choices.col(i).array() <= limits.upper.array() + kSameInput).all(),
            "controller.inputs", "vectors inside the actuator's bounds");
}

Index HybridMpcParams::nearestChoice(VectorRef input) const {
  Index nearest = 0;
  (choices.colwise() - input).colwise().squaredNorm().minCoeff(&nearest);
  return nearest;
}

bool HybridMpcParams::mayBeSent(VectorRef input) const {
  return (choices.col(nearestChoice(input)) - input).cwiseAbs().maxCoeff() <= kSameInput;
}

HybridMpc::HybridMpc(HybridMpcParams params, InputLimits limits, PlantInfo plant)
    : params_(std::move(params)), limits_(std::move(limits)), plant_(std::move(plant)) {
  const auto n_y = static_cast<Index>(plant_.outputs.size());
  const auto n_u = static_cast<Index>(plant_.inputs.size());
  params_.validate(n_y, n_u);
  limits_.validate(n_u);
  params_.validateLimits(limits_);
  reference_ = Matrix::Zero(n_y, static_cast<Index>(params_.hold_samples) * params_.horizon_blocks);
  past_disturbances_ = Vector::Zero(static_cast<Index>(plant_.disturbances.size()));
  for (const SignalInfo& input : plant_.inputs)
    stuck_.push_back(input.name + " is not where it was sent");
  signals_ = {{"choice", 0.0}, {"search_cost", 0.0}, {"search_nodes", 0.0}};
}

HybridMpc::~HybridMpc() = default;

void HybridMpc::setModel(const TsModel& model) {
  auto evolution = std::make_unique<HybridEvolution>(params_, limits_, model);
  require(model.outputs.size() == plant_.outputs.size() &&
              model.disturbances.size() == plant_.disturbances.size(),
          "model", "a model matched to the plant");
  const TreeSearchParams tree{params_.horizon_blocks,
                              params_.bound == BranchBound::kReach &&
                                  (evolution->highest() >= 0 || evolution->lowest() >= 0),
                              params_.node_budget};
  tree_ = std::make_unique<TreeSearch>(evolution->model().stateSize(),
                                       static_cast<int>(params_.choices.cols()), tree);
  evolution_ = std::move(evolution);
  state_ = Vector::Zero(evolution_->model().stateSize());
  decision_.choices.assign(static_cast<std::size_t>(params_.horizon_blocks), 0);
  fresh_ = true;
}

bool HybridMpc::boundsByReach() const {
  return evolution_ && (evolution_->highest() >= 0 || evolution_->lowest() >= 0);
}

TreeProblem& HybridMpc::problem() { return *evolution_; }

bool HybridMpc::mayBeSent(VectorRef input) const { return params_.mayBeSent(input); }

void HybridMpc::makeSendable(Eigen::Ref<Vector> input) const {
  if (input.allFinite()) input = params_.choices.col(params_.nearestChoice(input));
}

void HybridMpc::reset(const Measurement& /*start*/) {
  fresh_ = true;
  sent_before_ = false;
  samples_left_ = 0;
}

const TreeResult& HybridMpc::search(VectorRef input_before, VectorRef disturbances) {
  evolution_->start(input_before, disturbances, reference_);
  decision_ = tree_->search(*evolution_, state_);
  return decision_;
}

const TreeResult& HybridMpc::decide(VectorRef outputs, VectorRef input_before,
                                    VectorRef disturbances, MatrixRef reference) {
  evolution_->model().restState(outputs, input_before, disturbances, state_);
  reference_ = reference;
  return search(input_before, disturbances);
}

void HybridMpc::startBlock(const Measurement& now, const SetpointSource& setpoint) {
  for (Index i = 0; i < reference_.cols(); ++i) {
    if (params_.preview)
      setpoint.scheduled(now.header.step + 1 + static_cast<std::uint32_t>(i), reference_.col(i));
    else
      reference_.col(i) = setpoint.present();
  }
  search(now.input_applied, now.disturbances);
  choice_ =
      decision_.usable() ? decision_.choices.front() : params_.nearestChoice(now.input_applied);
  samples_left_ = params_.hold_samples;
  signals_[0].second = static_cast<double>(choice_);
  signals_[1].second = decision_.cost;
  signals_[2].second = static_cast<double>(decision_.nodes);
}

const char* HybridMpc::faultOf(const Measurement& now) const {
  for (Index i = 0; sent_before_ && i < now.input_applied.size(); ++i)
    if (std::abs(now.input_applied[i] - params_.choices(i, choice_)) > kMoved)
      return stuck_[static_cast<std::size_t>(i)].c_str();
  return nullptr;
}

void HybridMpc::step(const Measurement& now, const SetpointSource& setpoint,
                     ControllerOutput& output) {
  const ChoiceModel& model = evolution_->model();
  if (fresh_)
    model.restState(now.outputs, now.input_applied, now.disturbances, state_);
  else
    model.shiftState(now.outputs, now.input_applied, past_disturbances_, state_);
  fresh_ = false;
  past_disturbances_ = now.disturbances;
  const char* fault = faultOf(now);
  if (samples_left_ == 0) startBlock(now, setpoint);
  --samples_left_;
  output.begin();
  output.input = params_.choices.col(choice_);
  output.reference = setpoint.present();
  if (fault != nullptr) output.events.add({EventCode::kInputStuck, fault});
  if (decision_.status == TreeStatus::kBudget) output.events.add({EventCode::kSolverLimit});
  if (decision_.status == TreeStatus::kImpossible) output.events.add({EventCode::kNoAllowedInput});
  sent_before_ = true;
}

}  // namespace fpc
