#include "demo/bake/baked_file.h"

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <string_view>

#include <mobil/assets/files/output_file.h>
#include "demo/measure/measure.h"

namespace mobil {
namespace {

/// Empty where there is no place for it.
std::filesystem::path kept_file() {
  const char *const cache = std::getenv("XDG_CACHE_HOME"), *const home = std::getenv("HOME");
  const std::filesystem::path folder = cache != nullptr && *cache == '/' ? std::filesystem::path(cache)
                                       : home != nullptr && *home == '/' ? std::filesystem::path(home) / ".cache"
                                                                         : std::filesystem::path();
  return folder.empty() ? folder : folder / "mobil" / "mobil.baked";
}

}  // namespace

Result<void> write_baked(const std::filesystem::path& file, std::span<const std::byte> bytes) {
  return write_file(file, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

Result<void> load_baked(Simulation& simulation, const std::filesystem::path& file) {
  std::error_code error;
  const auto size = std::filesystem::file_size(file, error);
  if (error) return fail(fmt::format("{}: cannot be read ({}); make it by mobil bake", file.string(), error.message()));
  std::vector<std::byte> bytes(size);
  std::ifstream in(file, std::ios::binary);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (!in) return fail(fmt::format("{}: cannot be read; is it being written?", file.string()));
  if (auto done = simulation.load_baked(bytes); !done)
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

Result<void> prepare_and_keep(Relevance& relevance, const Simulation& simulation, std::span<const float> tolerances_m,
                              const std::function<void(std::size_t done, std::size_t of)>& progress) {
  constexpr double worth_s = 0.5;
  const double start_s = wall_now_s();
  if (auto done = relevance.prepare(tolerances_m, progress); !done) return done;
  const auto file = kept_file();
  if (wall_now_s() - start_s < worth_s || file.empty()) return {};
  std::error_code error;
  std::filesystem::create_directories(file.parent_path(), error);
  if (!error) (void)write_baked(file, simulation.bake());
  return {};
}

}  // namespace mobil
