#pragma once
// Ranks as mpirun or srun starts them.

#include <memory>

#include <mobil/engine/error.h>
#include <mobil/systems/cluster/transport.h>

namespace mobil::inline v0_3 {

/// Whether this process was started as a rank (by what Open MPI, MPICH and Slurm's PMIx leave in the environment).
bool started_as_rank();
/// Whether it is no rank or the first one: before MPI begins, for what only one is to say.
bool first_by_environment();

/// Begins MPI, and ends it with the transport; once in a process. Errors: this mobil was built without MPI.
Result<std::unique_ptr<Transport>> mpi_transport();

}  // namespace mobil::inline v0_3
