#include "assets/import/gltf_buffer.h"

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>

#include <mobil/mesh_file.h>
#include "assets/import/folder_file.h"
#include "assets/import/mesh_text.h"

namespace mobil::inline v0_3 {
namespace {

namespace fs = std::filesystem;

int hex_digit(char c) {
  return c >= '0' && c <= '9'   ? c - '0'
         : c >= 'a' && c <= 'f' ? c - 'a' + 10
         : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                : -1;
}

/// Returns the text with %20 and the like as the bytes that they stand for.
std::string without_percents(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool code =
        text[i] == '%' && i + 2 < text.size() && hex_digit(text[i + 1]) >= 0 && hex_digit(text[i + 2]) >= 0;
    plain += code ? static_cast<char>(16 * hex_digit(text[i + 1]) + hex_digit(text[i + 2])) : text[i];
    i += code ? 2 : 0;
  }
  return plain;
}

/// Returns the bytes of a text in base64; nothing for other texts.
std::optional<std::string> from_base64(std::string_view text) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::array<int, 256> value;
  value.fill(-1);
  for (std::size_t i = 0; i < digits.size(); ++i) value[static_cast<unsigned char>(digits[i])] = static_cast<int>(i);
  text = text.substr(0, text.find_last_not_of('=') + 1);
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t bits = 0;
  int waiting = 0;
  for (const char c : text) {
    const int digit = value[static_cast<unsigned char>(c)];
    if (digit < 0) return std::nullopt;
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    waiting += 6;
    if (waiting < 8) continue;
    waiting -= 8;
    bytes += static_cast<char>(bits >> waiting & 255);
  }
  return bytes;
}

std::string data_of_uri(const GltfItem& item, std::string_view uri) {
  const auto comma = uri.find(',');
  if (comma == std::string_view::npos) gltf_fault(item, "its data uri has no comma; export it again");
  const auto head = uri.substr(0, comma), data = uri.substr(comma + 1);
  constexpr std::string_view mark = ";base64";
  if (head.size() < mark.size() || !same_word(head.substr(head.size() - mark.size()), mark))
    return without_percents(data);
  auto bytes = data.find('%') == std::string_view::npos ? from_base64(data) : from_base64(without_percents(data));
  if (!bytes) gltf_fault(item, "its data uri is not base64; export it again");
  return std::move(*bytes);
}

std::string bytes_of_file(const GltfFile& file, const GltfItem& item, std::string_view uri, std::size_t length) {
  std::string name = without_percents(uri);
  if (file.folder.empty()) {
    gltf_fault(item,
               fmt::format("its data is in {}; read it from a file, or export it as .glb", shown(name, name_length)));
  }
  auto path = file_below(file.folder, name);
  if (!path) gltf_fault(item, path.error().message);
  std::error_code error;
  if (!fs::is_regular_file(*path, error)) {  // some exporters write a name as it is
    if (auto raw = file_below(file.folder, uri); raw && fs::is_regular_file(*raw, error)) {
      path = std::move(raw);
      name = uri;
    }
  }
  if (!fs::is_regular_file(*path, error)) {
    gltf_fault(item, fmt::format("no file {} in the mesh's folder; put it there, or export the mesh as .glb",
                                 shown(name, name_length)));
  }
  const auto size = fs::file_size(*path, error);
  if (error || size < length) {
    gltf_fault(item, fmt::format("{} has {} bytes where {} are promised; it is cut short: copy it again",
                                 shown(name, name_length), error ? 0 : size, length));
  }
  std::string bytes(length, '\0');
  std::ifstream in(*path, std::ios::binary);
  in.read(bytes.data(), static_cast<std::streamsize>(length));
  if (!in) gltf_fault(item, fmt::format("{} cannot be read; make it readable", shown(name, name_length)));
  return bytes;
}

/// Returns a buffer's bytes.
std::string_view buffer_bytes(GltfFile& file, std::size_t index) {
  const GltfItem item = gltf_item(file, "buffers", index);
  const std::size_t length = *gltf_whole(item, "byteLength", 0);
  const nlohmann::json* uri = gltf_member(item.value, "uri");
  std::string_view bytes;
  if (uri == nullptr && index == 0 && file.binary) {
    bytes = *file.binary;
  } else if (file.buffer[index]) {
    bytes = *file.buffer[index];
  } else {
    if (uri == nullptr || !uri->is_string()) {
      gltf_fault(item, gltf_member(item.value, "extensions") == nullptr
                           ? "no data; export it again"
                           : "no data, for its views are compressed by EXT_meshopt_compression; export it without");
    }
    if (length > file.bytes_left) {
      gltf_fault(item, fmt::format("{} bytes; valid: at most {} MB in all: make the mesh coarser", length,
                                   max_mesh_bytes / 1'000'000));
    }
    file.bytes_left -= length;
    const std::string_view text = uri->get_ref<const std::string&>();
    file.buffer[index] = begins_with(text, "data:") ? data_of_uri(item, text) : bytes_of_file(file, item, text, length);
    bytes = *file.buffer[index];
  }
  if (bytes.size() < length) {
    gltf_fault(item, fmt::format("{} bytes where {} are promised; the file is cut short: copy or export it again",
                                 bytes.size(), length));
  }
  return bytes.substr(0, length);
}

}  // namespace

std::string_view gltf_view(GltfFile& file, const GltfItem& view) {
  const auto buffer = gltf_whole(view, "buffer");
  if (!buffer) gltf_fault(view, "no buffer; export it again");
  const std::string_view bytes = buffer_bytes(file, *buffer);
  const std::size_t offset = *gltf_whole(view, "byteOffset", 0), length = *gltf_whole(view, "byteLength", 0);
  if (offset > bytes.size() || length > bytes.size() - offset) {
    gltf_fault(view, fmt::format("bytes {} to {} of a buffer of {}; the file is damaged: export it again", offset,
                                 offset + length, bytes.size()));
  }
  return bytes.substr(offset, length);
}

}  // namespace mobil::inline v0_3
