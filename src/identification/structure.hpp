// What a user states before identification: which signals depend on which, and how the rules are to
// be found.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/column_repair.hpp"
#include "base/csv.hpp"
#include "fmbpc/model/ts_model.hpp"

namespace fpc {

/// A signal of the process and where its values are.
struct StructureSignal {
  SignalInfo info;     ///< lower, upper: what is plausible; values outside may mean a wrong unit
  std::string column;  ///< of the data file
  Implausible implausible{Implausible::kError};  ///< what becomes of values outside
};

/// How one output depends on the past. Lags are seen from the prediction of k + 1 (see Regressor).
struct OutputStructure {
  std::vector<Regressor> regressors;
  std::vector<Regressor> antecedents;
  int clusters_min{1};  ///< clusters_min < clusters_max: the number is chosen on held-out data
  int clusters_max{1};
  /// Grid partition only: the sets of each antecedent; every combination becomes a rule.
  std::vector<std::vector<Membership>> sets;
};

enum class PartitionMethod { kGustafsonKessel, kFuzzyCMeans, kGrid };
enum class Scaling { kDeviation, kRange, kNone };

/// Where the rules lie.
struct PartitionParams {
  PartitionMethod method{PartitionMethod::kGustafsonKessel};
  MembershipShape membership{
      MembershipShape::kGaussian};  ///< gaussian or exponential, for clusters
  bool multivariate{false};         ///< the clusters' ellipsoids instead of sets of that shape
  Scaling scaling{Scaling::kDeviation};
  bool with_output{
      true};  ///< cluster in the space of antecedents and predicted output, else antecedents only
  double fuzziness{1.5};  ///< m > 1; near 2, clusters in many dimensions fall together
  double regularisation{
      0.05};          ///< gamma in [0, 1): share of the data's own spread in each covariance
  double width{1.0};  ///< > 0: the sets are made this much wider
  int max_iterations{200};
  double tolerance{1e-4};  ///< stops when no membership moves by more
  int restarts{3};         ///< random starts; the one with the lowest objective is kept
  std::uint64_t seed{1};
  double held_out{0.3};  ///< share of the rows, at the end, that judges the number of clusters
};

enum class ConsequentMethod { kLocal, kGlobal, kRecursive };
enum class ScarceRule { kBorrow, kDrop, kError, kNeighbour };

/// How the consequents are fitted, and what happens to rules without enough data.
struct ConsequentParams {
  ConsequentMethod method{ConsequentMethod::kLocal};
  double ridge{0.1};          ///< >= 0: weight of the linear model in each coefficient, in samples
  double weight_power{1.0};   ///< local: squared errors weigh firing weight ^ power; 2 in karer2007
  double weight_threshold{};  ///< local: samples with a lower firing weight are left out (delta)
  double samples_per_coefficient{3.0};  ///< rules with less (sum of firing weights) are scarce
  double max_condition{1e8};  ///< of scaled columns, without ridge; rules beyond it are scarce too
  ScarceRule scarce{ScarceRule::kBorrow};
  double forgetting{1.0};       ///< recursive only
  int free_run_iterations{0};   ///< > 0: then the coefficients are fitted to free runs as well
  double one_step_weight{1.0};  ///< of one-step errors beside free-run errors in that fit
};

/// What may be done to bad data; everything done is counted and told.
struct RepairParams {
  MissingCells missing{MissingCells::kError};
  bool sort_time{false};      ///< false: unsorted times are an error
  bool drop_constant{false};  ///< false: an input or disturbance that never moves is an error
};

struct ValidationParams {
  int correlation_lags{25};
  double confidence{0.99};  ///< of the bounds on residual correlations
};

/// A structure file.
struct Structure {
  std::string name;
  double sample_time_s{};
  std::string time_column;     ///< empty: rows are taken to be equally spaced
  std::string time_unit{"s"};  ///< s, min, h or d
  CsvFormat csv;               ///< how data files are written
  std::vector<StructureSignal> outputs, inputs, disturbances;
  std::vector<OutputStructure> submodels;  ///< one per output
  PartitionParams partition;
  ConsequentParams consequents;
  RepairParams repair;
  ValidationParams validation;

  /// A model of these names and this sample time without rules.
  TsModel emptyModel() const;
  /// @throws InputError naming the part.
  void validate() const;
};

/// Regressors from orders as the field writes them, for output i: N_y, N_u and N_d hold one number
/// per output, per input and disturbance, per input and disturbance. N_y(j) = n gives
/// y_j(k)..y_j(k-n+1); N_u(j) = n with transport delay N_d(j) = d >= 1 gives
/// u_j(k-d+1)..u_j(k-d-n+2). Source: babuska1998, eq. 3.38; vallejo2021thesis, table 4.
std::vector<Regressor> regressorsOf(const std::vector<int>& N_y, const std::vector<int>& N_u,
                                    const std::vector<int>& N_d, int n_inputs);

}  // namespace fpc
