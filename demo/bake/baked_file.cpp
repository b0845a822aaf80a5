#include "demo/bake/baked_file.h"

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <mobil/assets/files/output_file.h>
#include <mobil/lod.h>
#include <mobil/muscle_library.h>
#include <mobil/muscle_table.h>
#include <mobil/skin_writer.h>
#include "demo/measure/measure.h"
#include "demo/program/commands.h"
#include "demo/program/muscle_options.h"
#include "demo/program/progress.h"
#include "demo/program/units.h"

namespace mobil {
namespace {

/// Returns the baked file in the user's cache; empty if neither cache nor home folder is set.
std::filesystem::path kept_file() {
  const char *const cache = std::getenv("XDG_CACHE_HOME"), *const home = std::getenv("HOME");
  const std::filesystem::path folder = cache != nullptr && *cache == '/' ? std::filesystem::path(cache)
                                       : home != nullptr && *home == '/' ? std::filesystem::path(home) / ".cache"
                                                                         : std::filesystem::path();
  return folder.empty() ? folder : folder / "mobil" / "mobil.baked";
}

struct BakeText {
  std::string out, muscles = "usual", threads = "0";
  bool inertia = false, skins = false;
};

/// Writes the skins of usual builds.
Result<void> bake_skins(const std::filesystem::path& file) {
  const double start_s = wall_now_s();
  BodySkins skins;
  skins.prepare([](std::size_t done, std::size_t of) { show_progress("baking skins", done, of); });
  show("");
  const std::vector<std::byte> bytes = skins.bake();
  if (auto written = write_baked(file, bytes); !written) return fail("--out " + written.error().message);
  const double made_s = wall_now_s();
  BodySkins fresh;
  if (auto loaded = fresh.load(bytes); !loaded) return loaded;
  say_where(fmt::format("written {}: {:.1f} MB, made in {:.1f} s, loaded in {:.1f} ms", file.string(),
                        1e-6 * static_cast<double>(bytes.size()), made_s - start_s, 1e3 * (wall_now_s() - made_s)));
  return {};
}

Result<void> bake(const BakeText& text) {
  const auto threads = parse_count(text.threads, 0, 256);
  if (!threads) return fail(fmt::format("--threads {}: give a whole number from 0 to 256", text.threads));
  const auto muscles = read_muscles(text.muscles);
  if (!muscles) return tl::unexpected(muscles.error());
  const std::filesystem::path file = text.out.empty() ? text.skins ? "mobil.skins" : "mobil.baked" : text.out;
  if (auto place = check_result_place("--out", file); !place) return place;
  if (text.skins) return bake_skins(file);
  const double start_s = wall_now_s();
  Simulation simulation({.threads = static_cast<int>(*threads)});
  LodOptions options;
  options.leg_muscles.muscles = *muscles;
  options.leg_muscles.inertia = text.inertia;
  Lod lod = simulation.lod();
  if (auto done = lod.set_options(options); !done) return done;
  LodScene all;
  all.muscles = *muscles;
  all.camera = Viewpoint{};  // a person who approaches it needs every method
  if (auto done = lod.set_scene(all); !done) return done;
  const auto progress = [](std::size_t done, std::size_t of) { show_progress("baking", done, of); };
  auto done = lod.prepare({}, progress);
  show("");
  if (!done) return done;
  const std::vector<std::byte> bytes = simulation.muscle_library().bake();
  if (auto written = write_baked(file, bytes); !written) return fail("--out " + written.error().message);
  const double made_s = wall_now_s() - start_s;
  Simulation fresh;
  const double before_s = wall_now_s();
  if (auto loaded = fresh.muscle_library().load(bytes); !loaded) return loaded;
  const double loaded_s = wall_now_s();
  const auto person = fresh.spawn({});
  if (!person) return tl::unexpected(person.error());
  const double spawned_s = wall_now_s();
  if (auto added = fresh.set_muscles(*person, options.leg_muscles); !added) return added;
  say_where(fmt::format(
      "written {}: {:.1f} MB, made in {:.1f} s, loaded in {:.1f} ms; a person's first muscles then take {:.2f} ms",
      file.string(), 1e-6 * static_cast<double>(bytes.size()), made_s, 1e3 * (loaded_s - before_s),
      1e3 * (wall_now_s() - spawned_s)));
  return {};
}

}  // namespace

Result<void> write_baked(const std::filesystem::path& file, std::span<const std::byte> bytes) {
  return write_file(file, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

Result<void> load_baked(Simulation& simulation, const std::filesystem::path& file) {
  std::error_code error;
  const auto size = std::filesystem::file_size(file, error);
  if (error) return fail(fmt::format("{}: cannot be read ({}); run mobil bake", file.string(), error.message()));
  std::vector<std::byte> bytes(size);
  std::ifstream in(file, std::ios::binary);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (!in) return fail(fmt::format("{}: cannot be read; is it being written?", file.string()));
  if (auto done = simulation.muscle_library().load(bytes); !done)
    return fail(fmt::format("{}: {}", file.string(), done.error().message));
  return {};
}

Result<void> load_baked_option(Simulation& simulation, const std::filesystem::path& named) {
  if (!named.empty()) {
    auto done = load_baked(simulation, named);
    return done ? done : fail("--baked " + done.error().message);
  }
  std::error_code none;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", none).parent_path();
  for (const auto& file :
       {program / "mobil.baked", program / "../mobil.baked", program / "../share/mobil/mobil.baked", kept_file()}) {
    if (std::filesystem::is_regular_file(file, none)) (void)load_baked(simulation, file);
  }
  return {};
}

Result<void> prepare_and_keep(Simulation& simulation, std::span<const float> tolerances_m,
                              const std::function<void(std::size_t done, std::size_t of)>& progress) {
  constexpr double worth_s = 0.5;
  const double start_s = wall_now_s();
  if (auto done = simulation.lod().prepare(tolerances_m, progress); !done) return done;
  const auto file = kept_file();
  if (wall_now_s() - start_s < worth_s || file.empty()) return {};
  std::error_code error;
  std::filesystem::create_directories(file.parent_path(), error);
  if (!error) (void)write_baked(file, simulation.muscle_library().bake());
  return {};
}

Subcommand bake_command() {
  auto text = std::make_shared<BakeText>();
  Subcommand command{.name = "bake"};
  command.footer =
      "Writes meshes, operators and bases of all methods that level of detail can choose, for bodies of\n"
      "usual build. A program loads them with MuscleLibrary::load, which avoids computing them at run\n"
      "time. Other versions, and processors with different arithmetic, reject the file. Missing entries\n"
      "are computed on first use.\n"
      "\n--skins writes skins of usual builds, for BodySkins::load and mobil_load_skins. A program's first\n"
      "skin then takes milliseconds instead of two seconds.\n"
      "\nExamples: mobil bake\n"
      "          mobil bake --muscles groups\n"
      "          mobil bake --inertia --out game/assets/mobil.baked\n"
      "          mobil bake --skins --out game/assets/mobil.skins\n"
      "          mobil crowd --people 5000 --baked mobil.baked";
  add_options(command,
              {{"--out", &text->out, "FILE to write; default mobil.baked, or mobil.skins"},
               {"--skins", &text->skins, "Bake skins instead of muscles, see below"},
               {"--muscles", &text->muscles,
                "Muscles to prepare: usual (four groups), groups (twelve), all, or names like hamstrings,soleus"},
               {"--inertia", &text->inertia, "Prepare for gravity and the acceleration of the muscles' frames"},
               {"--threads", &text->threads, "Number of threads, 1 to 256; 0: one per processor"}});
  command.empty_refused = true;
  command.run = [text] { return exit_status_of("bake", bake(*text)); };
  return command;
}

}  // namespace mobil
