#pragma once
// Meshes on the graphics device: stored ones with a key, which are sent once, and those of this frame in one stream.

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include <mobil/engine/error.h>
#include <mobil/systems/render/matrix.h>
#include <mobil/systems/render/scene.h>

namespace mobil::inline v0_3 {

/// Location of a mesh: byte offsets into its buffers. Wireframes have three vertices per triangle and no indices.
struct StoredMesh {
  unsigned vertex_buffer = 0, index_buffer = 0;
  std::size_t position_at = 0, normal_at = 0, tissue_at = 0, index_at = 0;
  bool has_tissue = false;
  int count = 0;  // indices, or vertices of a wireframe
  capture_math::Box box;
};

/// Store of meshes. All functions need a current context, which owns the buffers.
class MeshStore {
 public:
  void create_buffers();

  /// Begins a frame and clears the stream of the last one.
  void begin_frame();

  /// Adds a mesh to the stream, or returns a stored one. A new mesh with a key is sent at once. Errors: a number of
  /// indices that is not a multiple of three, an index out of range, sizes beyond the range of the device.
  Result<StoredMesh> place(const DrawMesh& mesh);

  /// Sends the frame's stream. It must be called before a mesh without a key is drawn.
  void send_stream();

  void forget(std::uint64_t key);

 private:
  struct Kept {
    std::uint64_t key;
    bool wireframe;
    bool operator==(const Kept&) const = default;
  };
  struct KeptHash {
    std::size_t operator()(const Kept& kept) const { return std::hash<std::uint64_t>{}(2 * kept.key + kept.wireframe); }
  };

  std::unordered_map<Kept, StoredMesh, KeptHash> kept_;
  unsigned stream_vertices_ = 0, stream_indices_ = 0;
  std::vector<Vec3<float>> vertices_, normal_, own_vertices_;
  std::vector<std::uint32_t> indices_;
  StoredMesh last_;  // the last mesh of the stream, and its source
  const Vec3<float>* last_places_ = nullptr;
  const Vec3<float>* last_normals_ = nullptr;
};

}  // namespace mobil::inline v0_3
