#pragma once
// The two tables of an anatomy folder, manifest and landmarks, separated by a line `@`; the folder has a few small
// meshes.

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include <mobil/anthropometry.h>
#include <mobil/assets/import/anatomy_folder.h>
#include <mobil/fit_anatomy.h>
#include "tests/fuzz/fuzz_input.h"

namespace mobil::fuzz {

/// A folder with a tetrahedron for each of some bones and for a muscle, in millimetres.
class SmallAnatomy {
 public:
  SmallAnatomy() : folder_(std::filesystem::temp_directory_path() / ("mobil_fuzz_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(folder_);
    write("femur_right.obj", 440, 30);
    write("tibia_right.obj", 70, 30);
    write("calcaneus_right.obj", 0, 40);
    write("hip_bone_right.obj", 800, 40);
    write("soleus_right.obj", 100, 40);
  }
  ~SmallAnatomy() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  SmallAnatomy(const SmallAnatomy&) = delete;
  SmallAnatomy& operator=(const SmallAnatomy&) = delete;

  std::string folder() const { return folder_.string(); }
  void write_tables(std::string_view manifest, std::string_view landmarks) const {
    std::ofstream(folder_ / "manifest.csv", std::ios::binary) << manifest;
    std::ofstream(folder_ / "landmarks.csv", std::ios::binary) << landmarks;
  }

 private:
  void write(const char* name, int z, int size) const {
    std::ofstream out(folder_ / name);
    out << "v -80 -60 " << z << "\nv " << size - 80 << " -60 " << z << "\nv -80 " << size - 60 << " " << z
        << "\nv -80 -60 " << z + 3 * size << "\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
  }
  std::filesystem::path folder_;
};

inline void fuzz_anatomy(Input input) {
  static const SmallAnatomy small;
  static const Body body = *make_body({});
  const std::string_view text = text_of(input);
  const std::size_t between = text.find("\n@\n");
  if (between == std::string_view::npos) return;
  small.write_tables(text.substr(0, between + 1), text.substr(between + 3));
  AnatomyOptions options;
  options.threads = 1;
  options.other_muscles = options.skin = true;
  const auto anatomy = load_anatomy(small.folder(), options);
  if (!held(anatomy)) return;
  auto fitted = fit_anatomy(*anatomy, body);
  if (!held(fitted)) return;
  for (FittedMuscle& muscle : fitted->muscles) (void)cut_at_kneecap(muscle, body);
}

}  // namespace mobil::fuzz
