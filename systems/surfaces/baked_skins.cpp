// Shared meshes and skins as baked bytes (systems/bellies/baked_bytes.h): meshes of men and women, fits, skins.
#include <algorithm>
#include <array>
#include <string_view>
#include <type_traits>
#include <utility>

#include <mobil/anthropometry.h>
#include <mobil/assets/surfaces/body_form.h>
#include <mobil/skin_writer.h>
#include <mobil/version.h>
#include "assets/surfaces/form_mesh.h"
#include "engine/row_hash.h"
#include "systems/bellies/baked_bytes.h"

namespace mobil::inline v0_3 {
namespace {

constexpr std::uint64_t magic = 0x33736b6c69626f6d;  // "mobilks3", little-endian
constexpr std::array sexes = {Sex::man, Sex::woman};

/// The finest meshes are most of the bytes and seldom needed.
constexpr std::size_t first_detail(bool any_hero) {
  return any_hero ? 0 : 1;
}

/// Calls put(elements, n, field) for each field, which returns the address of n numbers of an element.
template <class Mesh, class Put>
void each_field(Mesh& mesh, const Put& put) {
  put(mesh.frame, 1, [](auto& f) { return &f.from; });
  put(mesh.frame, 1, [](auto& f) { return &f.to; });
  put(mesh.frame, 1, [](auto& f) { return &f.turn; });
  put(mesh.vertex, SkinVertex::max_frames, [](auto& v) { return v.frame.data(); });
  put(mesh.vertex, SkinVertex::max_frames, [](auto& v) { return v.weight.data(); });
  put(mesh.leg, 3, [](auto& v) { return &v.along; });
  put(mesh.fat, 2, [](auto& v) { return v.region.data(); });
  put(mesh.fat, 2, [](auto& v) { return v.part.data(); });
  put(mesh.place, 3, [](auto& v) { return &v.x; });
}

void write(BakeWriter& out, const SkinMesh& mesh) {
  out.put(static_cast<std::uint32_t>(mesh.vertex.size()));
  out.put(static_cast<std::uint32_t>(mesh.triangle.size()));
  out.put(static_cast<std::uint32_t>(mesh.frame.size()));
  for (const std::uint32_t first : mesh.first_triangle) out.put(first);
  out(mesh.triangle, mesh.triangle.size());
  each_field(mesh, [&](const auto& elements, std::size_t n, const auto& field) {
    std::vector<std::remove_cvref_t<decltype(*field(elements.front()))>> numbers;
    numbers.reserve(n * elements.size());
    for (const auto& element : elements) numbers.insert(numbers.end(), field(element), field(element) + n);
    out(numbers, numbers.size());
  });
}

/// Refuses indices beyond their arrays: corners, parts, frames, segments, regions of fat.
void check(BakeReader& in, const SkinMesh& mesh) {
  const auto below = [&](std::size_t index, std::size_t count) {
    if (index >= count) in.refuse();
  };
  for (const std::uint32_t corner : mesh.triangle) below(corner, mesh.vertex.size());
  if (!std::ranges::is_sorted(mesh.first_triangle) || mesh.first_triangle.front() != 0 ||
      3 * std::size_t{mesh.first_triangle.back()} != mesh.triangle.size())
    in.refuse();
  for (const SkinFrame& frame : mesh.frame) {
    below(frame.from, skin_segments);
    below(frame.to, skin_segments);
  }
  for (const SkinVertex& vertex : mesh.vertex)
    for (const std::uint16_t frame : vertex.frame) below(frame, mesh.frame.size());
  for (const FatPlace& fat : mesh.fat)
    for (const std::uint8_t region : fat.region) below(region, fat_regions);
  for (const LegPlace& leg : mesh.leg) {
    if (!(leg.along >= 0 && leg.along <= leg_stations && leg.round >= 0 && leg.round <= leg_angles)) in.refuse();
  }
}

SkinMesh read_mesh(BakeReader& in) {
  constexpr std::uint32_t most = 1 << 20;
  SkinMesh mesh;
  const std::uint32_t vertices = in.take_up_to(most), corners = in.take_up_to(6 * most),
                      frames = in.take_up_to(1 << 16);
  for (std::uint32_t& first : mesh.first_triangle) first = in.take<std::uint32_t>();
  in(mesh.triangle, corners);
  if (!in.sound()) return mesh;
  mesh.frame.resize(frames);
  mesh.vertex.resize(vertices);
  mesh.leg.resize(vertices);
  mesh.fat.resize(vertices);
  mesh.place.resize(vertices);
  each_field(mesh, [&](auto& elements, std::size_t n, const auto& field) {
    std::vector<std::remove_cvref_t<decltype(*field(elements.front()))>> numbers;
    in(numbers, n * elements.size());
    for (std::size_t i = 0; n * i < numbers.size(); ++i) std::copy_n(&numbers[n * i], n, field(elements[i]));
  });
  check(in, mesh);
  return mesh;
}

std::array<double*, 6> numbers_of(form::TrunkFit& fit) {
  return {&fit.hips, &fit.waist, &fit.chest, &fit.neck, &fit.between, &fit.thighs};
}

std::vector<float> flat(std::span<const Vec3<float>> values) {
  std::vector<float> numbers;
  numbers.reserve(3 * values.size());
  for (const Vec3<float>& v : values) numbers.insert(numbers.end(), {v.x, v.y, v.z});
  return numbers;
}
std::vector<Vec3<float>> read_places(BakeReader& in, std::size_t count) {
  std::vector<float> numbers;
  in(numbers, 3 * count);
  std::vector<Vec3<float>> values;
  values.reserve(count);
  for (std::size_t i = 0; i + 2 < numbers.size(); i += 3)
    values.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
  return values;
}

/// Reads the skin of a build.
BodySkin read_skin(BakeReader& in, Sex sex, SkinDetail detail, const SkinMesh& mesh) {
  BodySkin skin;
  skin.sex = sex;
  skin.detail = detail;
  skin.rest = read_places(in, mesh.vertex.size());
  skin.normal = read_places(in, mesh.vertex.size());
  for (auto* const grid : {&skin.leg.base, &skin.leg.fat})
    for (float& number : *grid) number = in.take<float>();
  for (std::size_t s = 0; s < segment_count; ++s) {
    skin.standing.rotation[s] = {0, 0, 0, 1};
    Vec3<float>& joint = skin.standing.position_m[s];
    for (float* const number : {&joint.x, &joint.y, &joint.z}) *number = in.take<float>();
  }
  return skin;
}

/// Returns a hash of the version and of points of a form, as this machine computes them. Other skins have another
/// value.
std::uint64_t find_maker() {
  BakeWriter out;
  for (const char letter : std::string_view(MOBIL_VERSION)) out.put(static_cast<std::uint8_t>(letter));
  for (const Sex sex : sexes) {
    const Body body = *make_body(skin_body(sex));
    const form::BodyForm form(body);
    for (int i = 0; i < 24; ++i) {
      const Vec3<double> from{0.12 + 0.01 * (i % 5), 0.05 + 0.07 * i, 0.15 - 0.02 * (i % 7)};
      const Vec3<double> at = onto_surface(form, from, 2);
      for (const double number : {at.x, at.y, at.z}) out.put(number);
    }
  }
  return hash_bytes(out.bytes.data(), out.bytes.size());
}

}  // namespace

void BodySkins::prepare(const std::function<void(std::size_t made, std::size_t all)>& progress) {
  constexpr float lowest = 17, highest = 34;
  constexpr std::array details = {SkinDetail::near, SkinDetail::far, SkinDetail::distant};
  std::vector<std::pair<BodyRequest, SkinDetail>> wanted;
  for (const Sex sex : sexes) {
    for (float index = lowest; index <= highest; index += index_step) {
      BodyRequest body = skin_body(sex);
      body.mass_kg = index * body.height_m * body.height_m;
      for (const SkinDetail detail : details) wanted.emplace_back(body, detail);
    }
  }
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (progress) progress(i, wanted.size());
    (void)of(wanted[i].first, wanted[i].second);
  }
}

std::vector<std::byte> BodySkins::bake() const {
  BakeWriter out;
  out.put(static_cast<std::uint32_t>(dress_.dressed ? 1 : 0));
  const bool any_hero =
      std::ranges::any_of(skin_, [](const auto& one) { return std::get<1>(one.first) == SkinDetail::hero; });
  out.put(std::uint32_t{any_hero});
  for (const Sex sex : sexes)
    for (std::size_t d = first_detail(any_hero); d < skin_details; ++d)
      write(out, skin_mesh(sex, static_cast<SkinDetail>(d)));
  out.put(
      static_cast<std::uint32_t>(std::ranges::count_if(fit_, [](const auto& one) { return one.second.has_value(); })));
  for (const auto& [key, fit] : fit_) {
    if (!fit) continue;
    const auto& [sex, age_y, step] = key;
    for (const std::uint32_t number :
         {static_cast<std::uint32_t>(sex), static_cast<std::uint32_t>(age_y), static_cast<std::uint32_t>(step)})
      out.put(number);
    form::TrunkFit copy = *fit;
    for (const double* const number : numbers_of(copy)) out.put(*number);
  }
  out.put(
      static_cast<std::uint32_t>(std::ranges::count_if(skin_, [](const auto& one) { return one.second != nullptr; })));
  for (const auto& [key, skin] : skin_) {
    if (!skin) continue;
    const auto& [sex, detail, age_y, step] = key;
    for (const std::uint32_t number : {static_cast<std::uint32_t>(sex), static_cast<std::uint32_t>(detail),
                                       static_cast<std::uint32_t>(age_y), static_cast<std::uint32_t>(step)})
      out.put(number);
    for (const auto* const values : {&skin->rest, &skin->normal}) out(flat(*values), 3 * values->size());
    for (const auto* const grid : {&skin->leg.base, &skin->leg.fat})
      for (const float number : *grid) out.put(number);
    for (const Vec3<float>& joint : skin->standing.position_m)
      for (const float number : {joint.x, joint.y, joint.z}) out.put(number);
  }
  return sealed(out, magic, find_maker());
}

Result<void> BodySkins::load(std::span<const std::byte> baked) {
  const auto contents = opened(baked, magic, &find_maker, "skins");
  if (!contents) return tl::unexpected(contents.error());
  BakeReader in(*contents);
  if ((in.take_up_to(1) != 0) != dress_.dressed) return fail("these skins have other clothes; bake them again");
  const std::size_t finest = first_detail(in.take_up_to(1) != 0);
  std::array<std::array<SkinMesh, skin_details>, sexes.size()> meshes;
  for (auto& of_sex : meshes)
    for (std::size_t d = finest; d < skin_details && in.sound(); ++d) of_sex[d] = read_mesh(in);
  constexpr std::uint32_t most_steps = 64, ages = 13, oldest_y = 85;
  decltype(fit_) fits;
  const std::uint32_t fit_count = in.take_up_to(2 * ages * most_steps);
  for (std::uint32_t i = 0; i < fit_count && in.sound(); ++i) {
    const auto sex = static_cast<Sex>(in.take_up_to(1));
    const auto age_y = static_cast<int>(in.take_up_to(oldest_y));
    const auto step = static_cast<int>(in.take_up_to(most_steps));
    form::TrunkFit fit;
    for (double* const number : numbers_of(fit)) *number = in.take<double>();
    fits[{sex, age_y, step}] = fit;
  }
  decltype(skin_) skins;
  const std::uint32_t skin_count = in.take_up_to(2 * ages * most_steps * skin_details);
  for (std::uint32_t i = 0; i < skin_count && in.sound(); ++i) {
    const auto sex = static_cast<Sex>(in.take_up_to(1));
    const auto detail = static_cast<SkinDetail>(in.take_up_to(skin_details - 1));
    const auto age_y = static_cast<int>(in.take_up_to(oldest_y));
    const auto step = static_cast<int>(in.take_up_to(most_steps));
    if (static_cast<std::size_t>(detail) < finest) in.refuse();
    const SkinMesh& mesh = meshes[static_cast<std::size_t>(sex)][static_cast<std::size_t>(detail)];
    skins[{sex, detail, age_y, step}] = std::make_unique<BodySkin>(read_skin(in, sex, detail, mesh));
  }
  if (!in.whole()) return fail("the baked skins do not agree with themselves; bake them again");
  for (const Sex sex : sexes) {
    for (std::size_t d = finest; d < skin_details; ++d)
      give_skin_mesh(sex, static_cast<SkinDetail>(d), std::move(meshes[static_cast<std::size_t>(sex)][d]));
  }
  fit_.merge(fits);
  skin_.merge(skins);
  return {};
}

}  // namespace mobil::inline v0_3
