// A Takagi-Sugeno model specialised to a finite set of input vectors, for searches that simulate it
// a million times: crisp conditions on u(k) are settled once, before the search.
#pragma once

#include <vector>

#include "fmbpc/model/ts_model.hpp"

namespace fpc {

/// A hybrid model is a Takagi-Sugeno model whose rules also hold crisp sets on inputs or states:
/// the operating modes (karer2007, eqs. 3, 4). Unlike a law, a search knows the u(k) it
/// tries, so that antecedents on u(k) take it as it is. The state stacks, for each output, its lags
/// 0.., then, for each input and disturbance, the past values that the model uses (often none).
class ChoiceModel {
 public:
  /// `model` matched to the plant; choices: n_u n_choices, one input vector per column.
  /// @throws InputError if the model is not valid or the sizes differ.
  ChoiceModel(TsModel model, Matrix choices);

  const TsModel& model() const { return model_; }
  const Matrix& choices() const { return choices_; }
  Eigen::Index stateSize() const { return n_x_; }
  /// Row of y(k) of an output.
  Eigen::Index outputState(Eigen::Index output) const { return output_row_[at(output)]; }
  /// The state holds present outputs only: no lags, no past inputs, no disturbances at all.
  bool isMemoryless() const { return memoryless_; }

  /// State of a process that has rested at these values.
  void restState(VectorRef outputs, VectorRef input, VectorRef disturbances,
                 Eigen::Ref<Vector> state) const;
  /// Moves a state of true values on by one sample: y(k+1) enters, u(k) and d(k) become the newest
  /// past values. In place.
  void shiftState(VectorRef outputs, VectorRef input, VectorRef disturbances,
                  Eigen::Ref<Vector> state) const;
  /// The state one sample later with u(k) = choice. In place, no allocation. Returns false if in
  /// some output no rule fired (the nearest one is used).
  bool step(int choice, VectorRef disturbances, Eigen::Ref<Vector> state);

 private:
  /// A set on one source; triangles and trapezes by their shoulders and slopes.
  struct Set {
    Eigen::Index source;
    Membership membership;
    bool straight;
    double left, right, left_slope, right_slope;
    double degree(double z) const;
  };
  struct CompiledRule {
    double degree;          // of the antecedents that the choice settles
    std::vector<Set> sets;  // on the other antecedents
    Vector coefficients;    // of the output's sources
    double offset;          // with the terms in u(k)
  };
  struct Submodel {
    std::vector<Eigen::Index> sources;             // of the regressors that are not u(k)
    std::vector<std::vector<CompiledRule>> rules;  // per choice
  };

  static std::size_t at(Eigen::Index i) { return static_cast<std::size_t>(i); }
  static Set makeSet(Eigen::Index source, const Membership& membership);
  void layOut();
  void compile(std::size_t output);
  CompiledRule compileRule(const OutputModel& output, const Rule& rule, int choice) const;
  Eigen::Index sourceOf(const Regressor& variable) const;  // -1 for u(k)
  double predict(std::size_t output, int choice, bool& fired);
  double predictFar(std::size_t output, int choice, bool& fired);
  double valueOf(const Regressor& variable, int choice) const;

  TsModel model_;
  Matrix choices_;
  Eigen::Index n_x_{};
  bool memoryless_{false};
  std::vector<Eigen::Index> output_row_, input_row_, disturbance_row_;
  std::vector<int> output_lags_, input_lags_, disturbance_lags_;
  std::vector<Submodel> submodels_;
  Vector source_;  // the state, then d(k)
  Vector next_;
  std::vector<Vector> antecedents_;
  std::vector<FiringResult> firing_;
};

}  // namespace fpc
