#pragma once
// Meshes on the graphics device: those sent once and kept by key, and those of this frame in one stream.

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include <mobil/engine/error.h>
#include <mobil/systems/render/matrix.h>
#include <mobil/systems/render/scene.h>

namespace mobil::inline v0_3 {

/// Where a mesh lies: byte offsets into its buffers. Wireframes are three vertices a triangle, without indices.
struct StoredMesh {
  unsigned vertex_buffer = 0, index_buffer = 0;
  std::size_t position_at = 0, normal_at = 0, index_at = 0;
  int count = 0;  // indices, or vertices of a wireframe
  capture_math::Box box;
};

/// Its functions need the context current. The context takes the buffers with it.
class MeshStore {
 public:
  void create_buffers();

  /// Begins a frame: forgets the stream of the last.
  void begin_frame();

  /// Places a mesh, sending it at once if it is a new keyed one. Error: triangles not in threes, an index out of range,
  /// sizes beyond what the device counts.
  Result<StoredMesh> place(const DrawMesh& mesh);

  /// Sends the frame's stream; before it, no mesh without key may be drawn.
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
  StoredMesh last_;  // of the stream, and what it was made of
  const Vec3<float>* last_places_ = nullptr;
  const Vec3<float>* last_normals_ = nullptr;
};

}  // namespace mobil::inline v0_3
