/// Whether this process is one of several.
#pragma once

namespace taut::cluster {

/// mpirun of Open MPI or MPICH, or srun with PMIx or PMI-2, started it.
bool StartedByLauncher();

}  // namespace taut::cluster
