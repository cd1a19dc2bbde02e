// Alternatives for every output, and what choices among them do in a joint free run.
#pragma once

#include "identification/auto_choice.hpp"
#include "identification/auto_output.hpp"

namespace fpc {

/// One model of one output, fitted without each block.
struct CoupledOption {
  Candidate candidate;
  std::vector<Fitted> blocks;
  RecurrentData record;
  Vector one_step;
  Eigen::Index parameters{};
};

/// One option per output.
using CoupledChoice = std::vector<std::size_t>;

class CoupledOptions {
 public:
  CoupledOptions(const std::vector<SearchedOutput>& alone, const SearchLimits& limits);

  std::size_t outputs() const { return data_.size(); }
  const AutoData& data(std::size_t output) const { return data_[output]; }
  const CoupledOption& option(std::size_t output, std::size_t o) const {
    return options_[output][o];
  }
  std::size_t count(std::size_t output) const { return options_[output].size(); }

  /// Fits candidates of one output and keeps those with a finite fit for every block. @return
  /// where each stands; kNone: not kept
  std::vector<std::size_t> add(std::size_t output, const std::vector<Candidate>& candidates);
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  /// Held-out figures of all outputs in a joint free run.
  std::vector<AutoFigures> figures(const CoupledChoice& choice) const;
  /// Sum of the logarithms of all scores; infinite where a block could not be judged.
  double objective(const CoupledChoice& choice) const;
  /// Changes one output after the other as long as the objective falls.
  CoupledChoice descend(CoupledChoice choice) const;
  bool isOver() const;

 private:
  std::vector<Vector> freeRuns(const CoupledChoice& choice) const;

  std::vector<AutoData> data_;
  Matrix measured_;  ///< scaled outputs
  const SearchLimits& limits_;
  std::vector<std::vector<CoupledOption>> options_;
};

}  // namespace fpc
