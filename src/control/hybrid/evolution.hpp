// The tree of evolution of a hybrid model: what a block of held inputs costs, and what all that
// follows must cost at least.
#pragma once

#include "control/hybrid/hybrid_mpc.hpp"
#include "model/choice_model.hpp"

namespace fpc {

inline constexpr double kSameInput = 1e-9;  // values of an input that differ by less are the same
/// Is the input one of the pattern's? NaN in a pattern: any value.
bool matches(const Vector& pattern, VectorRef input);

/// A level is a block of Z samples. Costs: karer2007, eqs. 27-29, 44, 45.
class HybridEvolution final : public TreeProblem {
 public:
  HybridEvolution(HybridMpcParams params, InputLimits limits, const TsModel& model);

  /// The next search starts with this input in force. reference: n_y, Z H_Z columns, kept by
  /// address.
  void start(VectorRef input_before, VectorRef disturbances, const Matrix& reference);
  double advance(int level, int before, int choice, Eigen::Ref<Vector> state) override;
  double leastCostToGo(int level, Eigen::Ref<Vector> state, double enough) override;
  const ChoiceModel& model() const { return model_; }
  /// The choices that raise and lower all outputs most, whatever the state; -1 if there is none.
  int highest() const { return highest_; }
  int lowest() const { return lowest_; }

 private:
  double blockCost(VectorRef before, int choice) const;  // infinite if not allowed
  double trackingCost(VectorRef state, Eigen::Index sample) const;
  double bandCost(Eigen::Index sample) const;
  bool insideRanges(VectorRef state) const;
  int extremeChoice(double sign);
  bool isExtreme(int choice, double sign);
  Vector mapped(int choice, const Vector& state);

  HybridMpcParams params_;
  InputLimits limits_;
  ChoiceModel model_;
  Matrix block_cost_;  // n_choices n_choices: before, this
  Vector first_cost_;  // after the input in force
  Vector disturbances_, high_, low_;
  const Matrix* reference_{nullptr};
  int highest_{-1}, lowest_{-1};
};

}  // namespace fpc
