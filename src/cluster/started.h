/// Detection of MPI launchers.
#pragma once

namespace taut::cluster {

/// Returns whether this process was started by mpirun of Open MPI or MPICH, or by srun with PMIx or
/// PMI-2.
bool StartedByLauncher();

}  // namespace taut::cluster
