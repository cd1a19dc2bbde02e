// Free runs of one output's rules over a record, with the derivatives by their coefficients.
#pragma once

#include "identification/data_set.hpp"
#include "identification/partition.hpp"
#include "optim/least_squares.hpp"

namespace fpc {

/// A model of one output whose coefficients are one vector, in columns scaled to mean 0 and
/// deviation 1.
class FreeRunSimulator {
 public:
  /// `data` and `shape` are kept by address; the coefficients of `shape` do not matter.
  FreeRunSimulator(const DataSet& data, int output, const OutputModel& shape);

  Eigen::Index unknowns() const {
    return static_cast<Eigen::Index>(shape_.rules.size()) * x_.size();
  }
  Eigen::Index rows() const { return rows_; }  ///< of the last run

  /// The coefficients of rules as one vector, and back.
  Vector scaled(const std::vector<Rule>& rules) const;
  void write(const Vector& theta, std::vector<Rule>& rules) const;

  /// Sum of squared errors of a free run, or one step ahead. With `squares`: adds a row per sample,
  /// the sensitivity of the prediction and its error, both over `unit`.
  double run(const Vector& theta, bool free, double unit, double weight, LeastSquares* squares);

 private:
  struct Source {
    Eigen::Index column, lag;
    bool own;
  };
  void addSources(const std::vector<Regressor>& variables, int output,
                  std::vector<Source>& sources);
  double value(const Source& s, Eigen::Index k) const {
    return s.own ? past_[k - s.lag] : data_.values(k - s.lag, s.column);
  }
  double predict(const Vector& theta, Eigen::Index k);
  void differentiatePast(const Vector& theta);
  void differentiate(const Vector& theta, Eigen::Index k, bool free);

  const DataSet& data_;
  const OutputModel& shape_;
  Eigen::Index own_column_, longest_{}, own_lags_{}, rows_{};
  double span_{}, center_{};
  std::vector<Source> z_sources_, x_sources_;
  ColumnScaling scaling_;
  Vector z_, x_, past_, gradient_;
  Matrix sensitivity_;  // of the last own_lags_ predictions, a ring of columns
  Matrix slopes_;       // of the weights: rules x antecedents
  Vector consequents_, past_slope_;
  FiringResult firing_;
};

}  // namespace fpc
