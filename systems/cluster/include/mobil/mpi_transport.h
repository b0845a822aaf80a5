#pragma once
// Ranks started by mpirun or srun.

#include <memory>

#include <mobil/engine/error.h>
#include <mobil/systems/cluster/transport.h>

namespace mobil::inline v0_3 {

/// Returns true if this process was started as a rank, from environment variables of Open MPI, MPICH and Slurm's PMIx.
bool started_as_rank();
/// Returns true if this process is not a rank, or is rank 0. Usable before MPI_Init, for messages printed only once.
bool first_by_environment();

/// Initializes MPI, once in a process. The transport finalizes it. Errors: this mobil was built without MPI.
Result<std::unique_ptr<Transport>> mpi_transport();

}  // namespace mobil::inline v0_3
