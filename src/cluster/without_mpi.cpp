#include "cluster/single_process.h"
#include "cluster/started.h"

namespace taut {

std::unique_ptr<Cluster> Cluster::Join(Diagnostics& out) {
  if (!cluster::StartedByLauncher()) return cluster::MakeAlone();
  out.Error("cluster.no_mpi", {},
            "taut was started as one of several processes, but built without MPI",
            "install libopenmpi-dev, configure and build again; or start a single process");
  return nullptr;
}

}  // namespace taut
