#include "assets/import/gltf_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include <mobil/mesh_file.h>
#include "assets/import/gltf_buffer.h"
#include "assets/import/mesh_text.h"

namespace mobil::inline v0_3 {
namespace {

using nlohmann::json;

constexpr std::size_t max_json_values = 1'000'000, max_json_depth = 64, glb_head = 12, chunk_head = 8;
constexpr std::size_t max_accessor_values = 200'000'000;

/// Extensions that change no position of a mesh.
bool is_harmless(std::string_view extension) {
  for (const std::string_view family : {"KHR_materials_", "KHR_texture_", "KHR_lights_", "KHR_xmp",
                                        "KHR_animation_pointer", "EXT_texture_", "EXT_lights_", "MSFT_texture_"}) {
    if (extension.starts_with(family)) return true;
  }
  return extension == "KHR_mesh_quantization";
}

std::uint32_t little_endian_word(std::string_view bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    word |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  }
  return word;
}

/// Returns the JSON of a GLB and keeps its binary chunk; other chunks are passed over.
std::string_view json_chunk(std::string_view bytes, GltfFile& file) {
  if (bytes.size() < glb_head + chunk_head) throw GltfFault{"a GLB without chunks; it is cut short: copy it again"};
  const std::size_t version = little_endian_word(bytes, 4), length = little_endian_word(bytes, 8);
  if (version != 2) throw GltfFault{fmt::format("GLB version {}; valid: 2: export it as glTF 2.0", version)};
  if (length > bytes.size()) {
    throw GltfFault{
        fmt::format("{} bytes where its head says {}; the file is cut short: copy it again", bytes.size(), length)};
  }
  if (length < glb_head + chunk_head) {
    throw GltfFault{fmt::format("its head says {} bytes in all; valid: {} to the file's {}: export it again", length,
                                glb_head + chunk_head, bytes.size())};
  }
  bytes = bytes.substr(0, length);
  std::optional<std::string_view> text;
  for (std::size_t at = glb_head; at + chunk_head <= bytes.size();) {
    const std::size_t size = little_endian_word(bytes, at);
    const std::string_view kind = bytes.substr(at + 4, 4);
    at += chunk_head;
    if (size > bytes.size() - at) {
      throw GltfFault{
          fmt::format("a chunk of {} bytes where {} remain; the file is cut short or damaged: copy it again", size,
                      bytes.size() - at)};
    }
    if (!text && kind != "JSON") throw GltfFault{"the first chunk is not JSON; export it again"};
    if (!text) {
      text = bytes.substr(at, size);
    } else if (kind == std::string_view("BIN\0", 4) && !file.binary) {
      file.binary = bytes.substr(at, size);
    }
    at += size;
  }
  if (!text) throw GltfFault{"a GLB without chunks; it is cut short: copy it again"};
  return text->substr(0, text->find_last_not_of('\0') + 1);
}

/// Throws on more values or levels than a mesh needs, before any is made. (The parser's own callback takes the square
/// of their number.)
void check_size(std::string_view text) {
  std::size_t values = 1, depth = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') {
      while (++i < text.size() && text[i] != '"') i += text[i] == '\\' ? 1 : 0;
    }
    values += c == ',' || c == '[' || c == '{' ? 1 : 0;
    depth += c == '[' || c == '{' ? 1 : 0;
    depth -= (c == ']' || c == '}') && depth > 0 ? 1 : 0;
    if (depth > max_json_depth) {
      throw GltfFault{fmt::format("JSON nested more than {} deep; export it again", max_json_depth)};
    }
    if (values > max_json_values) {
      throw GltfFault{fmt::format("more than {} values of JSON; export the mesh alone", max_json_values)};
    }
  }
}

json parsed(std::string_view text) {
  check_size(text);
  try {
    return json::parse(text);
  } catch (const json::parse_error& error) {
    throw GltfFault{
        fmt::format("not JSON at byte {}; the file may be damaged or of another format: copy or export it "
                    "again",
                    error.byte)};
  } catch (const json::exception&) {
    throw GltfFault{"a number in it is too large; export it again"};
  }
}

/// Returns major and minor number of "2.0"; nothing for other words.
std::optional<std::pair<unsigned, unsigned>> version_of(const json* value) {
  if (value == nullptr || !value->is_string()) return std::nullopt;
  const auto& text = value->get_ref<const std::string&>();
  std::pair<unsigned, unsigned> number;
  const char* const end = text.data() + text.size();
  const auto major = std::from_chars(text.data(), end, number.first);
  if (major.ec != std::errc() || major.ptr == end || *major.ptr != '.') return std::nullopt;
  const auto minor = std::from_chars(major.ptr + 1, end, number.second);
  if (minor.ec != std::errc() || minor.ptr != end) return std::nullopt;
  return number;
}

void check_version(const json& root) {
  const json* asset = gltf_member(root, "asset");
  const json* least = asset == nullptr ? nullptr : gltf_member(*asset, "minVersion");
  const auto version = asset == nullptr ? std::nullopt : version_of(gltf_member(*asset, "version"));
  const auto needed = least == nullptr ? version : version_of(least);
  if (!version || !needed) throw GltfFault{"no asset.version in it, as glTF 2.0 has; export it again"};
  if (version->first != 2 || needed->first != 2 || (least != nullptr && needed->second > 0)) {
    const auto& wanted = least == nullptr ? *version : *needed;
    throw GltfFault{fmt::format("it needs glTF {}.{}; valid: 2.0: export it so", wanted.first, wanted.second)};
  }
}

void check_extensions(const json& root) {
  const json* required = gltf_member(root, "extensionsRequired");
  if (required == nullptr) return;
  std::string unknown;
  for (const json& name : *required) {
    if (!name.is_string() || is_harmless(name.get_ref<const std::string&>())) continue;
    unknown += (unknown.empty() ? "" : ", ") + shown(name.get_ref<const std::string&>(), name_length);
  }
  if (unknown.empty()) return;
  throw GltfFault{
      fmt::format("it requires {}, which this reader does not have; export it without (of extensions that "
                  "change meshes, KHR_mesh_quantization alone is read)",
                  unknown.substr(0, 4 * name_length))};
}

std::size_t whole_of(const GltfItem& item, const char* name, const json& value) {
  constexpr double most = 9007199254740992.0;
  const double number = value.is_number() ? value.get<double>() : -1;
  if (!(number >= 0 && number <= most) || number != std::floor(number)) {
    gltf_fault(item, fmt::format("{} is not a whole number; export it again", name));
  }
  return static_cast<std::size_t>(number);
}

// -------------------------------------------------------------------------------------------------------- accessors

enum class Component : std::uint8_t { int8, uint8, int16, uint16, uint32, float32 };
constexpr std::array<std::size_t, 6> component_code = {5120, 5121, 5122, 5123, 5125, 5126};
constexpr std::array<std::size_t, 6> component_size = {1, 1, 2, 2, 4, 4};

Component component_of(const GltfItem& item) {
  const auto code = gltf_whole(item, "componentType", 0);
  const auto* found = std::ranges::find(component_code, *code);
  if (found == component_code.end()) {
    gltf_fault(item, fmt::format("componentType {}; valid: 5120 to 5123, 5125, 5126: export it again", *code));
  }
  return static_cast<Component>(found - component_code.begin());
}

/// Elements in a buffer, `stride` bytes apart; null: zeros.
struct Elements {
  const char* first = nullptr;
  std::size_t stride = 0;
};

/// Returns `count` elements of `size` bytes that a view and an offset describe.
Elements elements_of(GltfFile& file, const GltfItem& item, const json& place, std::size_t count, std::size_t size) {
  const GltfItem at{place, item.list, item.index};
  const auto named = gltf_whole(at, "bufferView");
  if (!named || count == 0) return {};
  const GltfItem view = gltf_item(file, "bufferViews", *named);
  const std::string_view bytes = gltf_view(file, view);
  const std::size_t offset = *gltf_whole(at, "byteOffset", 0), stride = *gltf_whole(view, "byteStride", size);
  if (stride < size || stride > 252) {
    gltf_fault(view, fmt::format("byteStride {}; valid: {} to 252 here: export it again", stride, size));
  }
  // Products stay far below 2^64: counts are limited, and offsets at most 2^53.
  if (offset + (count - 1) * stride + size > bytes.size()) {
    gltf_fault(item,
               fmt::format("{} elements reach beyond the {} bytes of bufferViews[{}]; the file is damaged: export "
                           "it again",
                           count, bytes.size(), *named));
  }
  return {bytes.data() + offset, stride};
}

template <class T>
T component_at(const char* bytes) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), bytes, sizeof(T));
  if constexpr (std::endian::native == std::endian::big) std::ranges::reverse(raw);
  return std::bit_cast<T>(raw);
}

template <class T>
float as_float(const char* bytes, bool normalised) {
  const auto value = static_cast<float>(component_at<T>(bytes));
  if (!normalised) return value;
  return std::max(value / static_cast<float>(std::numeric_limits<T>::max()), -1.0F);
}

float float_at(const char* bytes, Component component, bool normalised) {
  switch (component) {
    case Component::int8:
      return as_float<std::int8_t>(bytes, normalised);
    case Component::uint8:
      return as_float<std::uint8_t>(bytes, normalised);
    case Component::int16:
      return as_float<std::int16_t>(bytes, normalised);
    case Component::uint16:
      return as_float<std::uint16_t>(bytes, normalised);
    default:
      return component_at<float>(bytes);
  }
}

std::uint32_t index_at(const char* bytes, Component component) {
  return component == Component::uint8    ? component_at<std::uint8_t>(bytes)
         : component == Component::uint16 ? component_at<std::uint16_t>(bytes)
                                          : component_at<std::uint32_t>(bytes);
}

bool is_index(Component component) {
  return component == Component::uint8 || component == Component::uint16 || component == Component::uint32;
}

/// Reads an accessor, with `value_at` for each of its components.
template <class T, class ValueAt>
std::vector<T> read_accessor(GltfFile& file, const GltfItem& item, Component component, std::size_t width,
                             const ValueAt& value_at) {
  constexpr std::array<const char*, 5> types = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
  const char* const wanted = width == 16 ? "MAT4" : types[width];
  const json* type = gltf_member(item.value, "type");
  if (type == nullptr || *type != wanted) gltf_fault(item, fmt::format("not of type {} here; export it again", wanted));
  const std::size_t count = gltf_accessor_count(file, item.index),
                    size = component_size[static_cast<std::size_t>(component)];
  gltf_spend(file, item, count * width);
  const Elements from = elements_of(file, item, item.value, count, width * size);
  std::vector<T> values(count * width);
  const auto copy = [&](const char* bytes, T* to) {
    for (std::size_t i = 0; i < width; ++i) to[i] = value_at(bytes + i * size);
  };
  for (std::size_t i = 0; from.first != nullptr && i < count; ++i)
    copy(from.first + i * from.stride, &values[i * width]);
  const json* sparse = gltf_member(item.value, "sparse");
  if (sparse == nullptr) return values;
  const auto changes = gltf_whole({*sparse, item.list, item.index}, "count", 0);
  const json *indices = gltf_member(*sparse, "indices"), *replaced = gltf_member(*sparse, "values");
  if (*changes > count || indices == nullptr || replaced == nullptr) {
    gltf_fault(item, "its sparse part lacks indices or values, or has more than the accessor; export it again");
  }
  const Component kind = component_of({*indices, item.list, item.index});
  if (!is_index(kind)) gltf_fault(item, "its sparse indices are no unsigned integers; export it again");
  const Elements where = elements_of(file, item, *indices, *changes, component_size[static_cast<std::size_t>(kind)]);
  const Elements what = elements_of(file, item, *replaced, *changes, width * size);
  if (*changes > 0 && (where.first == nullptr || what.first == nullptr)) {
    gltf_fault(item, "its sparse part has no bufferView; export it again");
  }
  for (std::size_t i = 0; i < *changes; ++i) {
    const std::size_t at = index_at(where.first + i * where.stride, kind);
    if (at >= count) gltf_fault(item, fmt::format("sparse index {}; valid: below {}: export it again", at, count));
    copy(what.first + i * what.stride, &values[at * width]);
  }
  return values;
}

}  // namespace

GltfFile open_gltf(std::string_view bytes, const std::filesystem::path& folder) {
  GltfFile file;
  file.folder = folder;
  file.bytes_left = max_mesh_bytes;
  file.values_left = max_accessor_values;
  std::string_view text = bytes;
  if (bytes.starts_with("glTF")) {
    text = json_chunk(bytes, file);
  } else {
    text.remove_prefix(mesh_text(bytes).at);
  }
  file.root = parsed(text);
  if (!file.root.is_object()) throw GltfFault{"its JSON is no object; export it again"};
  check_version(file.root);
  check_extensions(file.root);
  file.buffer.resize(gltf_count(file, "buffers"));
  return file;
}

const json* gltf_member(const json& value, const char* name) {
  if (!value.is_object()) return nullptr;
  const auto found = value.find(name);
  return found == value.end() ? nullptr : &*found;
}

std::size_t gltf_count(const GltfFile& file, const char* list) {
  const json* all = gltf_member(file.root, list);
  return all != nullptr && all->is_array() ? all->size() : 0;
}

GltfItem gltf_item(const GltfFile& file, const char* list, std::size_t index) {
  const std::size_t count = gltf_count(file, list);
  if (index >= count) {
    throw GltfFault{fmt::format("{}[{}] is missing, there are {}; export it again", list, index, count)};
  }
  const json& value = file.root[list][index];
  if (!value.is_object()) throw GltfFault{fmt::format("{}[{}] is no object; export it again", list, index)};
  return {value, list, index};
}

void gltf_fault(const GltfItem& item, std::string_view what) {
  throw GltfFault{fmt::format("{}[{}]: {}", item.list, item.index, what)};
}

std::optional<std::size_t> gltf_whole(const GltfItem& item, const char* name, std::optional<std::size_t> usual) {
  const json* value = gltf_member(item.value, name);
  return value == nullptr ? usual : whole_of(item, name, *value);
}

std::vector<std::size_t> gltf_wholes(const GltfItem& item, const char* name) {
  std::vector<std::size_t> numbers;
  const json* list = gltf_member(item.value, name);
  if (list == nullptr) return numbers;
  if (!list->is_array()) gltf_fault(item, fmt::format("{} is no list; export it again", name));
  for (const json& value : *list) numbers.push_back(whole_of(item, name, value));
  return numbers;
}

bool gltf_numbers(const GltfItem& item, const char* name, std::span<double> numbers) {
  const json* list = gltf_member(item.value, name);
  if (list == nullptr) return false;
  const bool good = list->is_array() && list->size() == numbers.size() &&
                    std::ranges::all_of(*list, [](const json& value) { return value.is_number(); });
  if (!good) gltf_fault(item, fmt::format("{} is not {} numbers; export it again", name, numbers.size()));
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = (*list)[i].get<double>();
  return true;
}

std::size_t gltf_accessor_count(const GltfFile& file, std::size_t accessor) {
  const GltfItem item = gltf_item(file, "accessors", accessor);
  const std::size_t count = *gltf_whole(item, "count", 0);
  if (count > 3 * max_mesh_triangles) {
    gltf_fault(item,
               fmt::format("{} elements; valid: at most {}: make the mesh coarser", count, 3 * max_mesh_triangles));
  }
  return count;
}

void gltf_spend(GltfFile& file, const GltfItem& item, std::size_t values) {
  if (values > file.values_left) {
    gltf_fault(item,
               fmt::format("the file's meshes read more than {} numbers; make them coarser", max_accessor_values));
  }
  file.values_left -= values;
}

std::vector<float> gltf_floats(GltfFile& file, std::size_t accessor, std::size_t width) {
  const GltfItem item = gltf_item(file, "accessors", accessor);
  const Component component = component_of(item);
  if (component == Component::uint32) {
    gltf_fault(item, "components of 32-bit integers; valid: floats, or integers of 8 or 16 bits: export it again");
  }
  const json* flag = gltf_member(item.value, "normalized");
  const bool normalised = flag != nullptr && *flag == true;
  return read_accessor<float>(file, item, component, width,
                              [&](const char* bytes) { return float_at(bytes, component, normalised); });
}

std::vector<std::uint32_t> gltf_indices(GltfFile& file, std::size_t accessor, std::size_t width) {
  const GltfItem item = gltf_item(file, "accessors", accessor);
  const Component component = component_of(item);
  if (!is_index(component)) {
    gltf_fault(item, "components that are no unsigned integers; valid: 5121, 5123, 5125: export it again");
  }
  return read_accessor<std::uint32_t>(file, item, component, width,
                                      [&](const char* bytes) { return index_at(bytes, component); });
}

}  // namespace mobil::inline v0_3
