// One structure of an automatic search, and its fit to stretches of a record.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "identification/auto_data.hpp"

namespace fpc {

enum class AntecedentChoice {
  kOutput,
  kOutputs,
  kInputs,  ///< and disturbances, and the present values of partners
  kOutputAndInputs,
  kState,
  kStateAndInputs,
  kPartners  ///< the present values of other outputs
};

/// Enough to fit it again on other rows.
struct Candidate {
  bool hidden{false};                         ///< own state, or the output's past
  int order{2};                               ///< states
  int input_terms{2};                         ///< past values of each input, not hidden
  std::vector<int> delay;                     ///< of each input and disturbance
  std::vector<std::vector<int>> block_delay;  ///< the same for each held-out block; none: `delay`
  std::vector<int> second;  ///< lags of as many terms more of each, for what comes later; or empty
  std::vector<int> partners;  ///< other outputs, from their present value on; not hidden
  int later{};                ///< added to every delay, but none becomes negative
  int rules{1};
  AntecedentChoice antecedents{AntecedentChoice::kOutput};
  double ridge{10.0};         ///< of the rules towards the linear model
  double linear_ridge{1e-3};  ///< of the linear model towards its one-step fit
  bool free_run{true};        ///< false: one-step least squares only (linear, not hidden)
  bool chain{false};          ///< hidden: starts as a chain of lags, else as the one-step fit
  bool absolute{false};       ///< hidden: the output is the size of the first state
  int iterations{100};
  std::uint64_t seed{1};

  std::string text() const;       ///< "hidden state 2, 3 rules on the state, ridge 10, seed 2"
  std::string structure() const;  ///< the same without the seed
};

struct Fitted {
  RecurrentShape shape;
  std::vector<Regressor> exogenous;
  Vector parameters;
  StartPrior prior;  ///< hidden only
  double work{};     ///< of the fit, see WorkMeter
  bool finite{false};
  bool wild{false};     ///< not finite since it runs away under larger inputs, see endures()
  Eigen::Index rows{};  ///< that it was fitted to; fitWhole()
  double error{};  ///< free-run rmse over the rows it was fitted to, unit of the output; fitWhole()
};

/// `proceed` may be empty; false ends fits early.
Fitted fitCandidate(const AutoData& data, const Candidate& candidate,
                    const std::vector<Stretch>& stretches,
                    const std::function<bool()>& proceed = {});

/// A model of the output's past as a submodel with Gaussian sets, in the signals' own units, its
/// rows counted.
OutputModel toSubmodel(const AutoData& data, const Fitted& fitted);
/// Sets data_count of each rule to the number of complete rows of `data` in which it fires most.
void countRows(const DataSet& data, int output, OutputModel& model);

/// Free run over a stretch in the output's own unit (NaN before its start), from `window` samples.
Vector freeRunOf(const AutoData& data, const Fitted& fitted, Stretch stretch, int window);
/// One step ahead of a model of the output's past, in its own unit; NaN elsewhere.
Vector oneStepOf(const AutoData& data, const Fitted& fitted, Stretch stretch);

}  // namespace fpc
