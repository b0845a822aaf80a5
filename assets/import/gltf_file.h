#pragma once
// A glTF or GLB file: its JSON, buffers and accessors. Nothing in it is trusted.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace mobil::inline v0_3 {

/// A fault of the file, thrown within the reader of glTF only; the line lacks the path.
struct GltfFault {
  std::string line;
};

struct GltfFile {  // NOLINT(bugprone-exception-escape): the parser's assertions
  nlohmann::json root;
  std::optional<std::string_view> binary;          // of a GLB
  std::filesystem::path folder;                    // of files that it refers to; empty: none are read
  std::vector<std::optional<std::string>> buffer;  // read when first used
  std::size_t bytes_left = 0, values_left = 0;     // that buffers and accessors can still take
};

/// An element of one of the file's lists, which messages name as "accessors[3]".
struct GltfItem {
  const nlohmann::json& value;
  const char* list;
  std::size_t index;
};

/// Parses JSON and chunks; checks version and required extensions. The bytes must outlive the file.
GltfFile open_gltf(std::string_view bytes, const std::filesystem::path& folder);

/// Returns an element; throws without it.
GltfItem gltf_item(const GltfFile& file, const char* list, std::size_t index);

/// Returns the number of elements of a list of the file.
std::size_t gltf_count(const GltfFile& file, const char* list);

/// Returns a member of an object, or null.
const nlohmann::json* gltf_member(const nlohmann::json& value, const char* name);

/// Returns a member as a whole number of at most 2^53, or `usual` without it.
std::optional<std::size_t> gltf_whole(const GltfItem& item, const char* name, std::optional<std::size_t> usual = {});

/// Returns a member as a list of whole numbers, which can be missing.
std::vector<std::size_t> gltf_wholes(const GltfItem& item, const char* name);

/// Writes a member's numbers, if it is there, and returns whether it is; throws on another count of numbers.
bool gltf_numbers(const GltfItem& item, const char* name, std::span<double> numbers);

/// Throws a fault of the item.
[[noreturn]] void gltf_fault(const GltfItem& item, std::string_view what);

/// Returns the number of elements of an accessor.
std::size_t gltf_accessor_count(const GltfFile& file, std::size_t accessor);

/// Counts values that are read, because few bytes can name the same ones many times; throws beyond a limit.
void gltf_spend(GltfFile& file, const GltfItem& item, std::size_t values);

/// Returns an accessor's numbers, `width` for each element. Components are floats, or integers of 8 or 16 bits, which
/// are fractions if the accessor is normalised.
std::vector<float> gltf_floats(GltfFile& file, std::size_t accessor, std::size_t width);

/// Returns an accessor's unsigned integers, `width` for each element.
std::vector<std::uint32_t> gltf_indices(GltfFile& file, std::size_t accessor, std::size_t width);

}  // namespace mobil::inline v0_3
