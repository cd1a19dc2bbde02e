// `mpirun fmbpc study ...`: the tool itself links no MPI, so that it starts fast; a program beside
// it does.
#pragma once

namespace fpc::tool {

/// If this is one of several ranks of mpirun and the command makes many runs: becomes fmbpc_mpi.
/// False if that is not there; rank 0 says so on standard error.
bool becomeMpi(char** arguments);

}  // namespace fpc::tool
