#include "cluster/alone.h"
#include "cluster/started.h"

namespace taut {

std::unique_ptr<Cluster> Cluster::Join(Diagnostics& out) {
  if (!cluster::StartedByLauncher()) return cluster::MakeAlone();
  out.Error("cluster.no_mpi", {},
            "started as one of several processes, but this taut was built without MPI",
            "install libopenmpi-dev, configure and build again; or start it alone");
  return nullptr;
}

}  // namespace taut
