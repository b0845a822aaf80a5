#pragma once
// Options of `mobil crowd` and `mobil city`, read and checked.

#include <string>

#include <mobil/cluster.h>
#include "demo/crowd/alive_scene.h"
#include "demo/program/file_axes.h"
#include "demo/program/options.h"

namespace mobil {

struct CrowdOptions {
  CrowdRequest crowd;
  double seconds = 10;
  std::filesystem::path report, capture;  // empty: none
  std::size_t frames = 0;                 // pictures in a folder; 0: one file
  std::vector<std::filesystem::path> exports;
  double export_s = 2;
  bool root_motion = false, in_place = false, z_back = false;  // of exports
  bool raise = false;
  std::optional<AliveRequest> alive{};  // for `mobil city`, instead of `crowd`
  /// True for a city, several shards or ranks, or a saved run, which `run_city` runs instead of one scene.
  bool city = false;
  ClusterOptions cluster{};
  double silence_s = 60;
};

/// Options as text from the command line, bound by `crowd_options` or `city_options`.
struct CrowdText {
  std::string command = "crowd";
  std::string people = "1000", seconds = "10", threads = "0", tolerance = "5mm", near = "500", near_tolerance = "1mm";
  std::string budget, effects = "muscles", muscles = "usual", churn = "0", burst = "0", seed = "1", report, capture,
                      frames = "0", baked;
  std::string alive, in_view = "10000", export_seconds = "2";
  std::string axes = usual_axes;
  std::string shards, save, save_every = "10", resume, silence = "60", balance_every = "0";
  std::vector<std::string> exports;
  bool all_seen = false, raise = false, root_motion = false, in_place = false;
};

inline constexpr std::size_t max_crowd = 200'000, max_alive = 20'000'000;

/// Return the options of `mobil crowd` and `mobil city`. The latter needs `alive` to be set.
std::vector<Option> crowd_options(CrowdText& text);
std::vector<Option> city_options(CrowdText& text);

/// Default and maximum number of shards of a crowd on several ranks.
inline constexpr std::uint32_t usual_shards = 16, max_shards = 4096;

/// Reads and checks every option. Errors name the option, the valid range and the remedy.
Result<CrowdOptions> read_crowd_options(const CrowdText& text);

}  // namespace mobil
