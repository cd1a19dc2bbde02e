// Identification without a structure file: orders, delays, antecedents, number of rules and
// regularisation are searched by the error of free runs over held-out blocks.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "identification/data_set.hpp"
#include "identification/prior_knowledge.hpp"
#include "identification/row_reading.hpp"
#include "identification/state_model.hpp"

namespace fpc {

/// kRegressors: the outputs' own past, what control laws take. kState: several recursions with a
/// state of their own, for simulation. kBlend: the mean of what the latter two say.
enum class ModelKind { kLinear, kRegressors, kState, kBlend };
const std::string& name(ModelKind kind);

struct AutoParams {
  double work{45.0};             ///< after which no new fit begins, see WorkMeter
  double budget_s{};             ///< wall time after which no new fit begins; 0: none
  int blocks{4};                 ///< of the cross-validation, >= 2
  Eigen::Index most_rows{2000};  ///< that the search uses
  Eigen::Index most_last{8000};  ///< that the last fit uses
  int window{5};                 ///< measured samples that start a free run
  Eigen::Index reach{-1};  ///< samples after which runs start anew; 0: never, -1: by reachOf()
  int longest_delay{0};    ///< [samples]; 0: a tenth of the rows, at most 100
  RowReading rows{RowReading::kFound};  ///< whether inputs act within their sample
  bool keep_still{false};               ///< use inputs that hardly moved as well, see stillCauses()
  bool states{true};                    ///< search models with a state of their own as well
  int threads{0};                       ///< 0: all cores
  std::uint64_t seed{1};
  std::vector<PriorKnowledge> known;  ///< one per output, or none
};

/// What one structure did on the blocks that it was not fitted to.
struct AutoTrial {
  std::string output;
  ModelKind kind{};
  std::string structure;  ///< in words
  Eigen::Index parameters{};
  double free_run{};  ///< mean of the blocks' rmse, by which models are chosen, unit of the output
  double spread{};    ///< std of the blocks' rmse
  bool chosen{false};
};

/// Cross-validated errors of one kind of model.
struct AutoFigures {
  double mean{};                  ///< of the blocks' free-run rmse, by which models are chosen
  double free_run{}, one_step{};  ///< rmse over all held-out rows, unit of the output
  double fit{};                   ///< [%] of the free run
  std::vector<double> blocks;     ///< free-run rmse of each
  double confirmed{};  ///< mean over the blocks, each of a choice that did not look at that block
  std::vector<double> pieces;  ///< of that choice, of shorter parts: models are compared by them
  double width{};              ///< half width of the 95 % interval of the free run
  double one_step_width{};
};

struct AutoOutput {
  std::string output;
  AutoFigures linear, regressors, state;  ///< of the best of each kind; no blocks: not searched
  AutoFigures blend;  ///< of the mean of regressors and state; no blocks: `model` is not fuzzy here
  ModelKind best{ModelKind::kLinear};  ///< lowest mean of those that beat linear, if any
  bool beats_linear{false};  ///< the best fuzzy model is better than linear beyond the spread
  bool fuzzy_model{false};   ///< `model` is fuzzy here, else linear
  std::string verdict;       ///< the same in words
  double hold{};             ///< rmse of the last measured value over runs of `reach`; 0: not asked
  Eigen::Index reach{};      ///< its "free runs" start anew after so many samples; 0: never
  std::vector<int> delay;    ///< of inputs, then disturbances [samples]; 0: acts on the next output
  double sensor_lower{}, sensor_upper{};  ///< limits seen in the data; equal: none
};

struct AutoIdentification {
  TsModel model;   ///< what control laws take: fuzzy where it beats linear, else linear
  TsModel linear;  ///< the best linear model of the search
  StateModel state;
  std::vector<AutoOutput> outputs;
  std::vector<AutoTrial> trials;
  Eigen::Index reach{};                     ///< of all outputs, see AutoOutput
  std::vector<bool> same_row;               ///< of inputs, then disturbances: read by asRead()
  std::vector<std::string> contradictions;  ///< where the record speaks against what is known
  std::vector<std::string> remarks;
  double work{};  ///< that the search did, in the unit of AutoParams::work
  bool cancelled{false};
};

struct AutoProgress {
  std::string stage;
  double share{};
};
using AutoCallback = std::function<bool(const AutoProgress&)>;  ///< false: keep the best so far

/// Searches per output. Same data and parameters, same result, on any machine and number of
/// threads; only a budget of seconds makes it another (a remark says so). @throws InputError naming
/// the data's column or the parameter.
AutoIdentification autoIdentify(const DataSet& data, const AutoParams& params,
                                const AutoCallback& callback = {});

/// A data set of windows of a longer one, equally spaced, with rows of nothing between them.
DataSet subsample(const DataSet& data, Eigen::Index rows, int windows);
/// Records of the same signals behind each other, rows of nothing between them.
/// @throws InputError if their signals differ.
DataSet joinRecords(const std::vector<DataSet>& records);

}  // namespace fpc
