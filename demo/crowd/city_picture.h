#pragma once
// Pictures of a crowd on several ranks.

#include <filesystem>
#include <optional>

#include <mobil/systems/capture/camera.h>
#include <mobil/systems/cluster/ranks.h>
#include "demo/crowd/city_shard.h"
#include "demo/crowd/crowd_picture.h"

namespace mobil {

/// Each rank finds who of its own is in the picture, and hands over their poses, bodies and, of the nearest, bones and
/// muscles; the first rank, which alone has `pictures`, draws and writes the file. The picture is the same from any
/// number of ranks. What fails stops all.
void take_picture(Ranks& ranks, Cluster& cluster, const Camera& camera, std::optional<CrowdCamera>& pictures,
                  const std::filesystem::path& file);

}  // namespace mobil
