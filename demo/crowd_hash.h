#pragma once
// What a crowd's simulation holds, in one number. A stopgap: Simulation::state_hash() takes its place.

#include <cstdint>

#include "demo/crowd_scene.h"

namespace mobil {

/// Of every word of everybody's rows and their muscles', by person; whose muscle it is (a handle) left out.
std::uint64_t crowd_hash(const CrowdScene& scene);

}  // namespace mobil
