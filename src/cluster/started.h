/// Detection of processes that MPI launchers started.
#pragma once

namespace taut::cluster {

/// Returns whether mpirun of Open MPI or MPICH, or srun with PMIx or PMI-2, started this process.
bool StartedByLauncher();

}  // namespace taut::cluster
