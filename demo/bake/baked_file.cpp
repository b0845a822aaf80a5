#include "demo/bake/baked_file.h"

#include <fmt/format.h>

#include <fstream>
#include <string>
#include <string_view>

#include "assets/files/output_file.h"

namespace mobil {

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
  for (const char* const place : {"mobil.baked", "../mobil.baked", "../share/mobil/mobil.baked"}) {
    if (std::filesystem::is_regular_file(program / place, none) && load_baked(simulation, program / place)) break;
  }
  return {};
}

}  // namespace mobil
