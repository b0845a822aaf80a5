#include "assets/import/folder_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <system_error>
#include <vector>

#include "assets/import/mesh_text.h"

namespace mobil::inline v0_3 {
namespace {

namespace fs = std::filesystem;

std::string in_small_letters(std::string text) {
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return text;
}

bool is_there(const fs::path& path) {
  std::error_code error;
  return fs::exists(fs::symlink_status(path, error));
}

/// Returns the names in a folder that differ from `name` only in the case of letters.
std::vector<std::string> names_like(const fs::path& folder, const std::string& name) {
  std::vector<std::string> like;
  std::error_code error;
  const std::string wanted = in_small_letters(name);
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    std::string own = entry->path().filename().string();
    if (in_small_letters(own) == wanted) like.push_back(std::move(own));
  }
  std::ranges::sort(like);
  return like;
}

/// Returns the name as the folder spells it.
Result<fs::path> spelt(const fs::path& folder, const fs::path& name) {
  fs::path found;
  for (const fs::path& part : name) {
    if (is_there(folder / found / part)) {
      found /= part;
      continue;
    }
    const auto like = names_like(folder / found, part.string());
    if (like.size() > 1) {
      return fail(fmt::format("file {} fits {} and {}; write it as the file is named",
                              shown(name.string(), name_length), shown(like[0], name_length),
                              shown(like[1], name_length)));
    }
    if (like.empty()) return name;
    found /= like.front();
  }
  return found;
}

}  // namespace

Result<fs::path> file_below(const fs::path& folder, std::string_view name) {
  const bool plain = std::none_of(name.begin(), name.end(), [](unsigned char c) { return c < ' ' || c == 127; });
  std::string slashes(name);
  if (!is_there(folder / name)) std::ranges::replace(slashes, '\\', '/');
  fs::path named(slashes);
  bool inside = plain && named.is_relative() && !named.has_root_name() &&
                std::find(named.begin(), named.end(), "..") == named.end();
  if (inside) {
    auto found = spelt(folder, named);
    if (!found) return found;
    named = std::move(*found);
    std::error_code error;
    if (is_there(folder / named)) {
      const auto home = fs::canonical(folder, error), resolved = fs::canonical(folder / named, error);
      inside = !error && std::mismatch(home.begin(), home.end(), resolved.begin(), resolved.end()).first == home.end();
    }
  }
  if (inside) return folder / named;
  return fail(
      fmt::format("file {} leads out of the folder; valid: a path below it without '..' and links: copy the file into "
                  "the folder",
                  shown(name, name_length)));
}

}  // namespace mobil::inline v0_3
