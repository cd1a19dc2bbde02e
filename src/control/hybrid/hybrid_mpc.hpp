// Predictive control of processes whose inputs are valves that are open or shut, or stand in one of
// a few positions: the best sequence of input vectors, by reachability.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "fmbpc/control/controller.hpp"
#include "optim/tree_search.hpp"

namespace fpc {

class HybridEvolution;

/// weight * u_before(previous block) * u_after(this block), once per block. karer2007, w2 of
/// eq. 45.
struct SwitchTerm {
  int before{}, after{};  ///< inputs
  double weight{};
};
/// weight * |change of u_input| * u_gate(previous block), once per block; gate -1: always. w3 of
/// eq. 45.
struct TravelTerm {
  int input{}, gate{-1};
  double weight{};
};
/// Values that must not follow each other. NaN: any value.
struct ForbiddenTransition {
  Vector from, to;  ///< n_u
};

/// What a node of the tree is judged by: the cost of the way so far, or of what must follow as
/// well.
enum class BranchBound { kCost, kReach };
inline std::vector<std::string> wordsOf(BranchBound) { return {"cost", "reach"}; }

/// Section `controller` of a loop file, type hybrid_mpc.
struct HybridMpcParams {
  Matrix choices;  ///< n_u n_choices, the input vectors that may be sent, one per column
  std::vector<ForbiddenTransition> forbidden_transitions;
  int hold_samples{15};    ///< Z, samples of a block
  int horizon_blocks{4};   ///< H_Z
  bool preview{true};      ///< the recipe ahead is known; otherwise the present setpoint is held
  Vector weight_tracking;  ///< n_y, of (y - setpoint)^2, per sample
  std::vector<SwitchTerm> switching;
  std::vector<TravelTerm> travel;
  BranchBound bound{BranchBound::kReach};
  std::uint64_t node_budget{1000000};  ///< nodes of a search, then the best so far, with an event
  /// @throws InputError naming the field: sizes, repeated choices, negative costs, indices.
  void validate(Eigen::Index n_y, Eigen::Index n_u) const;
  void validateLimits(const InputLimits& limits) const;  ///< @throws InputError: choices inside
  bool mayBeSent(VectorRef input) const;                 ///< it is one of the choices
  Eigen::Index nearestChoice(VectorRef input) const;
};

/// At the first sample of each block of Z the tree of evolution is searched over H_Z blocks, from
/// the measured state; its first input vector is sent for the whole block. The cost is a sum of
/// non-negative terms: the samples' squared errors and consumption, and the blocks' switching and
/// travel against the block before (for the first one: the input in force). Move limits are
/// transitions that are not allowed. A reset starts a new block.
/// If nothing is allowed the allowed vector nearest to the input in force is sent. Only vectors of
/// `choices` are ever sent.
/// bound `reach`: where the model has no memory besides its outputs, and on a grid over its ranges
/// and the corners of its sets one choice raises all outputs most, one lowers them most and both
/// maps grow with the outputs, the least error that any sequence must make is that of the band
/// between these two trajectories. Elsewhere the bound is `cost`. Fewer nodes; the result is the
/// same unless the model does something else between two points of the grid, which `cost` does not
/// depend on. Source: karer2007, section 4, eqs. 21-32, 44, 45. signals(): choice (index),
/// search_cost, search_nodes of the last decision.
class HybridMpc final : public Controller {
 public:
  /// @throws InputError naming the field, also for choices outside the bounds.
  HybridMpc(HybridMpcParams params, InputLimits limits, PlantInfo plant);
  ~HybridMpc() override;

  void reset(const Measurement& start) override;
  void step(const Measurement& now, const SetpointSource& setpoint,
            ControllerOutput& output) override;
  bool needsModel() const override { return true; }
  void setModel(const TsModel& model) override;
  const std::vector<std::pair<std::string, double>>& signals() const override { return signals_; }
  bool mayBeSent(VectorRef input) const override;
  void makeSendable(Eigen::Ref<Vector> input) const override;

  /// Decides at once from these values, whatever the block: for tests and benchmarks. reference:
  /// n_y, Z H_Z columns.
  const TreeResult& decide(VectorRef outputs, VectorRef input_before, VectorRef disturbances,
                           MatrixRef reference);
  /// The problem that the last decision solved, to be solved again in another way.
  TreeProblem& problem();
  bool boundsByReach() const;  ///< bound `reach` holds for the model

 private:
  void startBlock(const Measurement& now, const SetpointSource& setpoint);
  const TreeResult& search(VectorRef input_before, VectorRef disturbances);
  const char* faultOf(const Measurement& now) const;  // null if there is none

  HybridMpcParams params_;
  InputLimits limits_;
  PlantInfo plant_;
  std::unique_ptr<HybridEvolution> evolution_;  // with a model
  std::unique_ptr<TreeSearch> tree_;
  TreeResult decision_;
  Vector state_, past_disturbances_;
  Matrix reference_;         // n_y Z H_Z, from the next sample on
  bool fresh_{true};         // the state is to be made from the next measurement
  bool sent_before_{false};  // choice_ went out one sample ago
  int samples_left_{0};      // of the block
  Eigen::Index choice_{0};
  std::vector<std::string> stuck_;  // what to say of each input that is not where it was sent
  std::vector<std::pair<std::string, double>> signals_;
};

}  // namespace fpc
