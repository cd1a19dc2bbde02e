// The rules of one output: clusters or grid, their number, and the consequents.
#pragma once

#include "identification/identify.hpp"
#include "identification/partition.hpp"

namespace fpc {

/// Clusters and the scaling of the space that they were found in.
struct FoundClusters {
  Clusters clusters;
  ColumnScaling scaling;
};
ClusterValidity validityOn(const FoundClusters& found, const Regression& rows,
                           const PartitionParams& params);

/// With structure.clusters_max rules. Fills `model` and what `found` says about its rules. @return
/// false when the callback cancelled.
bool findRules(const Regression& rows, const OutputStructure& structure, const Structure& settings,
               const OutputModel& linear, const IdentifyCallback& report,
               OutputIdentification& found, OutputModel& model,
               FoundClusters* clusters_found = nullptr);

/// The number of clusters, from structure.clusters_min to .clusters_max, whose models run best over
/// blocks of the record held out in turn, with Akaike's factor for their parameters; adds what each
/// did to `trials`. Beyond 8000 rows it looks at windows of the record. @return 0 when cancelled
int chooseClusterNumber(const DataSet& data, int output, const OutputStructure& structure,
                        const Structure& settings, const IdentifyCallback& report,
                        std::vector<ClusterTrial>& trials);

}  // namespace fpc
