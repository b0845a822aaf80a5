#pragma once
// What `mobil crowd` or `mobil city` was asked for, checked.

#include <string>

#include <mobil/cluster.h>
#include "demo/crowd/alive_scene.h"
#include "demo/program/options.h"

namespace mobil {

struct CrowdOptions {
  CrowdRequest crowd;
  double seconds = 10;
  std::filesystem::path report, capture;  // empty: none
  std::size_t frames = 0;                 // pictures in a folder; 0: one file
  std::vector<std::filesystem::path> exports;
  double export_s = 2;
  bool raise = false;
  std::optional<AliveRequest> alive{};  // of `mobil city`, instead of the crowd
  /// A city, several shards, several ranks, or a run that is saved: `run_city` instead of one scene.
  bool city = false;
  ClusterOptions cluster{};
  double silence_s = 60;
};

/// The options as text, as the command line hands them over; bound by `crowd_options`.
struct CrowdText {
  std::string command = "crowd";
  std::string people = "1000", seconds = "10", threads = "0", tolerance = "5mm", near = "500", near_tolerance = "1mm";
  std::string budget, effects = "muscles", churn = "0", burst = "0", seed = "1", report, capture, frames = "0", baked;
  std::string alive, in_view = "10000", export_seconds = "2";
  std::string shards, save, save_every = "10", resume, silence = "60", balance_every = "0";
  std::vector<std::string> exports;
  bool all_seen = false, raise = false;
};

inline constexpr std::size_t max_crowd = 200'000, max_alive = 20'000'000;

/// Of `mobil crowd`, and of `mobil city`, which wants `alive` to be set.
std::vector<Option> crowd_options(CrowdText& text);
std::vector<Option> city_options(CrowdText& text);

/// Shards of a crowd on several ranks where nobody says how many.
inline constexpr std::uint32_t usual_shards = 16, max_shards = 4096;

/// Reads and checks every option. Errors name the option, the valid range and the mend.
Result<CrowdOptions> read_crowd_options(const CrowdText& text);

}  // namespace mobil
