// Data and structure in, Takagi-Sugeno model out, with a report of every rule and every choice.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "identification/cluster_validity.hpp"
#include "identification/consequents.hpp"
#include "identification/data_set.hpp"
#include "identification/free_run_fit.hpp"
#include "identification/structure.hpp"

namespace fpc {

/// Where identification is.
struct IdentifyProgress {
  std::string output;  ///< name of the output at work
  std::string stage;   ///< "clusters 4", "consequents"
  int iteration{};     ///< of the clustering, all restarts together
  double objective{};  ///< of the clustering
  double share{};      ///< done so far, 0..1: outputs finished, and a guess within the present one
  Eigen::Index samples{};  ///< regression rows in use
};
/// May be empty; false cancels.
using IdentifyCallback = std::function<bool(const IdentifyProgress&)>;

/// One number of clusters that was tried. Judged on blocks of rows held out in turn.
struct ClusterTrial {
  int clusters{};
  ClusterValidity validity;  ///< on the last block
  double one_step_rmse{};    ///< of the models with these clusters, in the unit of the output
  double free_run_rmse{};    ///< the same in free run; infinite if a run left the data
  double spread{};           ///< std of the blocks' free_run_rmse
  double score{};            ///< free_run_rmse times a factor for the parameters; the lowest wins
};

/// What happened to one output.
struct OutputIdentification {
  std::string output;
  Eigen::Index samples{};            ///< regression rows
  std::vector<ClusterTrial> trials;  ///< empty if the number was given
  std::vector<double> objective;     ///< of the final clustering; empty for grids and one cluster
  bool converged{true};
  FreeRunFit free_run;  ///< if asked for
  RuleFit linear;
  std::vector<RuleFit> rules;  ///< as found; dropped ones are in here but not in the model
};

struct Identification {
  TsModel model;
  TsModel linear;  ///< ARX of the same regressors
  std::vector<OutputIdentification> outputs;
  std::vector<std::string>
      remarks;            ///< repairs of the data, scarce rules, clusters that did not converge
  bool cancelled{false};  ///< model and linear are not to be used then
};

/// Identifies one submodel per output. Same data and structure, same bits. Memory: a few times the
/// data, times one number per cluster. `known`: constraints, one per output or none. @throws
/// InputError naming the structure's key or the data's column.
Identification identify(const DataSet& data, const Structure& structure,
                        const IdentifyCallback& callback = {},
                        const std::vector<PriorKnowledge>& known = {});

}  // namespace fpc
