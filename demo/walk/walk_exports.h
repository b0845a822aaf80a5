#pragma once
// `mobil walk --export`: the walk in the formats of other programs.

#include <filesystem>
#include <string>
#include <vector>

#include <mobil/assets/export/walk_recording.h>
#include <mobil/engine/error.h>

namespace mobil {

enum class WalkFormat { glb, bvh, mot, sto, usda, wrl, x3d, gl };

struct WalkExport {
  std::string file;  // in the folder of results
  WalkFormat format;
};

/// From names, whose endings say the format. Errors: an ending that is none, a name with a folder, the same name twice.
Result<std::vector<WalkExport>> read_exports(const std::vector<std::string>& names);

/// Whether it tells of every tick, without surfaces; the others are of every picture.
bool of_every_tick(const WalkExport& wanted);

/// Writes one file into `folder`. `ticks`: poses of every tick and forces, where they are; `pictures`: with surfaces.
Result<void> write_export(const WalkExport& wanted, const WalkRecording& pictures, const WalkRecording& ticks,
                          const std::filesystem::path& folder);

/// What --help says of them.
extern const char* const walk_exports_help;

}  // namespace mobil
