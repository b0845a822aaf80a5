// `mobil body`: dimensions that follow from height, mass and build, with their sources, and a picture.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/assets/files/output_file.h>
#include <mobil/assets/muscles/muscle_path.h>
#include <mobil/assets/muscles/muscle_plan.h>
#include <mobil/assets/surfaces/muscle_surfaces.h>
#include <mobil/body_composition.h>
#include <mobil/components/body.h>
#include <mobil/engine/error.h>
#include <mobil/engine/geometry.h>
#include <mobil/muscle_table.h>
#include <mobil/png.h>
#include <mobil/renderer.h>
#include <mobil/systems/render/image.h>
#include "assets/body/joint_limits.h"
#include "assets/body/segment_inertia.h"
#include "assets/muscles/muscle_architecture.h"
#include "assets/surfaces/bone_surfaces.h"
#include "assets/surfaces/surface_mesh.h"
#include "demo/pictures/contact_sheet.h"
#include "demo/program/body_options.h"
#include "demo/program/commands.h"
#include "demo/program/console.h"
#include "demo/program/json.h"
#include "demo/program/must.h"
#include "demo/program/progress.h"

namespace mobil {
namespace {

Json number(double value) {
  return std::stod(fmt::format("{:.6g}", value)) + 0.0;  // no negative zero
}
Json number(float value) {
  return number(static_cast<double>(value));
}
template <class F>
Json point(const Vec3<F>& p) {
  return {number(p.x), number(p.y), number(p.z)};
}
Json biotype(const Biotype& b) {
  return {{"endomorphy", number(b.endo)}, {"mesomorphy", number(b.meso)}, {"ectomorphy", number(b.ecto)}};
}

Json composition(const Body& body) {
  const BodyComposition& c = body.composition;
  const auto [low, high] = living_mass_kg(static_cast<double>(body.request.height_m), body.request.age_y);
  return {
      {"source",
       "ectomorphy and endomorphy: Carter 2002; density of skinfolds: Durnin & Womersley 1974; fat of density: Siri "
       "1961; fat of body mass index, where no biotype was asked for: Gallagher et al. 2000, up to 14 years Deurenberg "
       "et al. 1991; most lean mass: Kondo et al. 1994; least mass: James et al. 1988; muscle in lean mass: Janssen et "
       "al. 2000; leg muscle by sex and age: Maden-Wilkinson et al. 2014; effect of constitution and mesomorphy on "
       "muscle, its maximum in lean mass (65 %), and children's muscle: ours"},
      {"body_mass_index_kg_m2", number(c.body_mass_index)},
      {"height_over_cube_root_mass_cm_kg13", number(c.height_over_cube_root_mass)},
      {"fat_mass_kg", number(c.fat_kg)},
      {"lean_mass_kg", number(c.lean_kg)},
      {"fat_share", number(c.fat_kg / body.request.mass_kg)},
      {"biotype_taken", biotype(c.biotype)},
      {"muscle_factor", number(c.muscle_factor)},
      {"mass_range_at_this_height_kg", {number(low), number(high)}}};
}

Json segments(const Body& body) {
  Json rows = Json::array();
  for (std::size_t i = 0; i < segment_count; ++i) {
    const auto s = static_cast<Segment>(i);
    const Json parent = s == Segment::pelvis ? Json() : Json(segment_name[index(segment_parent[i])]);
    rows.push_back({{"name", segment_name[i]},
                    {"parent", parent},
                    {"joint_offset_m", point(body.joint_offset_m[i])},
                    {"joint_centre_m", point(joint_centre_m(body, s))},
                    {"length_m", number(geometry::length(geometry::to_double(body.tip_m[i])))},
                    {"tip_m", point(body.tip_m[i])},
                    {"mass_kg", number(body.mass_kg[i])},
                    {"centre_of_mass_m", point(body.centre_of_mass_m[i])},
                    {"inertia_kg_m2", point(segment_inertia_kg_m2(body, s))}});
  }
  return {
      {"source",
       {{"lengths",
         "Drillis & Contini 1966 (the figure in Winter); heights of the vertebrae, the collar bone's and "
         "the thumb's place, and how the hand and the foot are divided: ours, within those"},
        {"masses_and_centres",
         "Dempster, tabulated by Winter; division among vertebrae, of the foot and of the hand: "
         "ours"},
        {"inertia",
         "limbs across their length: Dempster, tabulated by Winter; along it, trunk, head and hand: de "
         "Leva 1996; neck, collar bone, kneecap, toes, fingers and thumb: solids of their size"}}},
      {"meaning",
       "joint_offset_m: joint in the parent's frame (pelvis: over the ground). joint_centre_m: in the anatomical "
       "position, standing at x = z = 0. tip_m, centre_of_mass_m: in the segment's frame. inertia_kg_m2: xx, yy, zz "
       "about the centre of mass, principal. x left, y up, z forward; frames are those of poses"},
      {"rows", rows}};
}

Json joint_limits() {
  Json limbs = Json::array(), column = Json::array();
  for (const JointLimit& limit : limb_limits) {
    limbs.push_back({{"joint", limit.joint},
                     {"segment", segment_name[index(limit.segment)]},
                     {"motion", limit.motion},
                     {"low_deg", number(limit.low_deg)},
                     {"high_deg", number(limit.high_deg)},
                     {"source", limit.source}});
  }
  for (std::size_t i = 0; i < vertebra_limits.size(); ++i) {
    const VertebraLimit& v = vertebra_limits[i];
    column.push_back({{"segment", segment_name[index(Segment::L5) + i]},
                      {"flexion_extension_range_deg", v.flexion_extension},
                      {"lateral_bending_to_one_side_deg", v.lateral_bending},
                      {"rotation_to_one_side_deg", v.rotation},
                      {"source", "W"}});
  }
  return {{"source",
           {{"A", "American Academy of Orthopaedic Surgeons: Joint Motion, 1965"},
            {"R", "Roaas & Andersson, Acta Orthop. Scand. 53, 1982"},
            {"B",
             "under the body's weight, knee bent: Baumbach et al., BMC Musculoskelet. Disord. 15, 2014; "
             "plantarflexion: A"},
            {"W", "White & Panjabi: Clinical Biomechanics of the Spine, 1990"},
            {"O", "ours"}}},
          {"meaning",
           "from the anatomical position, right side; the left mirrors it; the first word of a motion is positive"},
          {"limbs", limbs},
          {"column", column}};
}

struct PathBone {
  std::string_view name;
  Segment segment;
};
constexpr PathBone path_bones[] = {{"pelvis", Segment::pelvis},
                                   {"thigh", Segment::thigh_right},
                                   {"shank", Segment::shank_right},
                                   {"foot", Segment::foot_right}};
constexpr PathBone kneecap{"patella", Segment::patella_right};

Json place(const Body& body, const PathPlace& p, const PathBone& bone) {
  using geometry::operator-;
  return {{"bone", bone.name},
          {"in_bone_m", point(p.world_m - joint_centre_m(body, bone.segment))},
          {"world_m", point(p.world_m)}};
}
Json place(const Body& body, const PathPlace& p) {
  return place(body, p, path_bones[static_cast<std::size_t>(p.bone)]);
}

Json attachments(const Body& body, const MemberMuscle& member) {
  const auto places = member_places(body, member);
  Json via = Json::array();
  for (std::size_t i = 1; i + 1 < places.size(); ++i) via.push_back(place(body, places[i]));
  Json insertion = member.kneecap ? place(body, places.back(), kneecap) : place(body, places.back());
  insertion["on_kneecap"] = member.kneecap.has_value();
  return {{"origin", place(body, places.front())}, {"via", via}, {"insertion", insertion}};
}

Json muscle(const Body& body, Muscle which) {
  const MuscleParameters p = muscle_parameters(body, which);
  const auto plan = make_muscle_plan(body, which);
  const bool group = is_muscle_group(which);
  Json row = {{"name", muscle_name(which)}, {"kind", group ? "group" : "member"}};
  if (group) {
    std::vector<std::string_view> members;
    for (const MemberMuscle& line : members_of(which)) {
      const std::string_view name = muscle_name(muscle_of_line(line));
      if (members.empty() || members.back() != name) members.push_back(name);
    }
    row["members"] = members;
  } else {
    row["group"] = muscle_name(members_of(which).front().group);
  }
  row.update({{"volume_m3", number(p.volume_m3)},
              {"mass_kg", number(p.mass_kg)},
              {"muscle_tendon_length_m", number(p.muscle_tendon_m)},
              {"belly_length_m", number(p.belly_m)},
              {"fibre_length_m", number(p.fibre_m)},
              {"pennation_deg", number(p.pennation_deg)},
              {"tendon_length_m", number(p.tendon_m)},
              {"fibre_length_of_that_tendon_m", number(p.model_fibre_m)},
              {"section_m2", number(p.section_m2)},
              {"physiological_section_m2", number(p.physiological_section_m2)}});
  if (plan) {
    row["mesh"] = {{"belly_length_m", number(plan->belly_length_m)},
                   {"tendon_length_m", number(plan->tendon_length_m)},
                   {"section_m2", number(plan->section_m2)},
                   {"start_m", point(plan->start_m)}};
  }
  if (is_single_muscle(which)) row["attachments"] = attachments(body, members_of(which).front());
  return row;
}

Json leg_muscles(const Body& body) {
  Json rows = Json::array();
  for (std::size_t m = 0; m < muscles().size(); ++m) rows.push_back(muscle(body, static_cast<Muscle>(m)));
  return {
      {"source",
       {{"volume_m3", "Handsfield et al. 2014, the limb's volume (height and mass) times composition.muscle_factor"},
        {"mass_kg", "1060 kg/m3, Mendez & Keys 1960"},
        {"belly_length_m, fibre_length_m, pennation_deg",
         "Ward et al. 2009, by stature; plantaris: Wickiewicz et al. 1983"},
        {"tendon_length_m, fibre_length_of_that_tendon_m",
         "gait2392 model of OpenSim (Delp et al. 1990), by the path's length, tendon within the belly included; "
         "plantaris: what the path leaves beside its fibres"},
        {"muscle_tendon_length_m, attachments", "gait2392 model of OpenSim, by segment; plantaris: BodyParts3D"},
        {"section_m2", "volume over belly length"},
        {"physiological_section_m2", "volume times cosine of pennation over fibre length"},
        {"mesh", "the belly that is simulated: its span on the drawn line, that line's tendon, volume over span"}}},
      {"meaning",
       "right leg in the anatomical position, standing at x = z = 0; the left is its mirror image (x to -x). "
       "in_bone_m: "
       "from the segment's joint, in its frame. Of a "
       "group: sums of volume, mass and sections, means of lengths and angles by the members' volumes in the "
       "reference body"},
      {"sides", {"right", "left"}},
      {"rows", rows}};
}

struct NamedRun {
  std::string_view name;
  Segment from, to;
};

/// Returns JSON with SI units and degrees as in the keys; numbers have six digits.
std::string body_json(const Body& body) {
  const BodyRequest& request = body.request;
  Json json;
  json["request"] = {{"height_m", number(request.height_m)},
                     {"mass_kg", number(request.mass_kg)},
                     {"biotype", biotype(request.biotype)},
                     {"constitution", constitution_name[static_cast<std::size_t>(request.constitution)]},
                     {"sex", sex_name[static_cast<std::size_t>(request.sex)]},
                     {"age_y", number(request.age_y)}};
  json["notes"] = body_notes(body);
  json["composition"] = composition(body);
  json["standing"] = {{"source", "Drillis & Contini 1966; heel and ball: ours"},
                      {"hip_height_m", number(body.hip_height_m)},
                      {"thigh_length_m", number(body.thigh_length_m)},
                      {"shank_length_m", number(body.shank_length_m)},
                      {"heel_in_foot_m", point(body.heel_m)},
                      {"ball_in_foot_m", point(body.ball_m)}};
  json["segments"] = segments(body);
  json["joint_limits"] = joint_limits();
  json["muscles"] = leg_muscles(body);
  return json.dump(2) + "\n";
}

/// Returns a summary for people: notes on the request, the segments' lengths and masses, the muscles' sizes.
std::string body_table(const Body& body) {
  using enum Segment;
  const BodyComposition& c = body.composition;
  std::string text;
  for (const std::string& note : body_notes(body)) text += fmt::format("note: {}\n", note);
  text += fmt::format(
      "body mass index {:.1f} kg/m2, fat {:.1f} kg ({:.0f} %), lean {:.1f} kg, biotype {:.1f}-{:.1f}-{:.1f}, muscles "
      "{:.2f} of the average\n\n",
      c.body_mass_index, c.fat_kg, 100 * c.fat_kg / body.request.mass_kg, c.lean_kg, c.biotype.endo, c.biotype.meso,
      c.biotype.ecto, c.muscle_factor);

  constexpr NamedRun runs[] = {{"pelvis", pelvis, pelvis},
                               {"loins (L5-L1)", L5, L1},
                               {"chest (T12-T1)", T12, T1},
                               {"neck (C7-C1)", C7, C1},
                               {"head", head, head},
                               {"thigh", thigh_right, thigh_right},
                               {"kneecap", patella_right, patella_right},
                               {"shank", shank_right, shank_right},
                               {"foot", foot_right, foot_right},
                               {"toes", toes_right, toes_right},
                               {"collar bone", clavicle_right, clavicle_right},
                               {"upper arm", upper_arm_right, upper_arm_right},
                               {"forearm", forearm_right, forearm_right},
                               {"hand", hand_right, hand_right},
                               {"fingers", fingers_right, fingers_right},
                               {"thumb", thumb_right, thumb_right}};
  text += fmt::format("{:<28}{:>10}{:>10}\n", "segment (one side)", "length mm", "mass kg");
  for (const NamedRun& run : runs) {
    double length = 0, mass = 0;
    for (std::size_t s = index(run.from); s <= index(run.to); ++s) {
      length += geometry::length(geometry::to_double(body.tip_m[s]));
      mass += static_cast<double>(body.mass_kg[s]);
    }
    text += fmt::format("{:<28}{:>10.0f}{:>10.3f}\n", run.name, 1e3 * length, mass);
  }

  text += fmt::format("\n{:<28}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}{:>11}\n", "muscle (one leg)", "volume", "length",
                      "belly", "fibre", "tendon", "section", "pennation");
  text += fmt::format("{:<28}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}{:>11}\n", "", "cm3", "mm", "mm", "mm", "mm", "cm2",
                      "deg");
  for (std::size_t m = 0; m < muscles().size(); ++m) {
    const auto which = static_cast<Muscle>(m);
    const MuscleParameters p = muscle_parameters(body, which);
    const bool group = is_muscle_group(which);
    text += fmt::format("{:<28}{:>10.1f}{:>10.0f}{:>10.0f}{:>10.0f}{:>10.0f}{:>10.1f}{:>11.1f}\n",
                        fmt::format("{}{}", group ? "" : "  ", muscle_name(which)), 1e6 * p.volume_m3,
                        1e3 * p.muscle_tendon_m, 1e3 * p.belly_m, 1e3 * p.fibre_m, 1e3 * p.tendon_m, 1e4 * p.section_m2,
                        p.pennation_deg);
  }
  return text;
}

constexpr int view_width = 560, view_height = 1080;
constexpr Colour tendon_cream{0.81F, 0.75F, 0.67F};
constexpr Placement as_it_is{}, mirrored{.scale = {-1, 1, 1}};
constexpr float field_of_view_deg = 12;  // narrow: nearly without perspective, as in an atlas

/// Returns a camera that shows the whole stature with a margin.
Camera looking(const Body& body, Vec3<float> from) {
  const float stature = body.request.height_m, far = 5.35F * stature;
  Camera camera;
  camera.target = {0, 0.5F * stature, 0};
  camera.eye = {far * from.x, camera.target.y + far * from.y, far * from.z};
  camera.vertical_fov_deg = field_of_view_deg;
  return camera;
}

/// Draws the body from the front and from its right, side by side and to the same scale. Error: no graphics driver
/// (with the packages to install), or one that fails.
Image body_picture(const Body& body) {
  auto renderer = must(Renderer::create(view_width, view_height));

  const auto bones = make_bone_surfaces(body);
  const auto muscles = make_muscle_surfaces(body);
  std::vector<Placement> stand(bones.size());
  std::vector<DrawMesh> meshes;
  for (std::size_t i = 0; i < bones.size(); ++i) {
    stand[i].position = geometry::to_float(joint_centre_m(body, bones[i].segment));
    meshes.push_back({.position = bones[i].mesh.position,
                      .triangle = bones[i].mesh.triangle,
                      .colour = bone_ivory,
                      .placement = {&stand[i], 1}});
  }
  for (const GroupSurface& muscle : muscles) {
    const bool tendon = std::ranges::find(muscle.tendon, 0.0F) == muscle.tendon.end();
    for (const Placement* side : {&as_it_is, &mirrored}) {
      meshes.push_back({.position = muscle.surface.mesh.position,
                        .triangle = muscle.surface.mesh.triangle,
                        .colour = tendon ? tendon_cream : muscle_red,
                        .wetness = 0.5F,
                        .placement = {side, 1}});
    }
  }

  std::vector<Image> pair;
  struct View {
    Vec3<float> from, light;  // steep and from the left, so that no shadow reaches into the other view
  };
  constexpr std::array<View, 2> views = {
      {{{0, 0.05F, 1}, {-0.20F, 1.1F, 0.50F}}, {{-1, 0.05F, 0}, {-0.50F, 1.1F, -0.20F}}}};
  for (const View& view : views) {
    Scene scene;
    scene.camera = looking(body, view.from);
    scene.meshes = meshes;
    scene.light = view.light;
    pair.push_back(must(renderer.render(scene)));
  }
  return contact_sheet({&pair, 1}, 0);
}

struct BodyCommand {
  BodyText body;
  std::string out = "out";
  bool json = false;
};

void write_body(const Body& body, const std::filesystem::path& out) {
  auto results = must(OutputFolder::make(out));
  const auto picture = attempt([&] { return body_picture(body); });
  if (picture) must(write_png((results.inside() / "body.png").string(), *picture));
  must(write_file(results.inside() / "body.json", body_json(body)));
  must(results.put());
  std::error_code ignored;
  if (!picture) std::filesystem::remove(out / "body.png", ignored);  // of another body
  if (!quiet) write_note(body_table(body));
  say_where(fmt::format("\nlook at {}: body.json{}", out.string(), picture ? " body.png" : ""));
  if (!picture) print_error("mobil body: no picture: {}", picture.error().message);
}

void run_body(const BodyCommand& text) {
  const auto request = must(read_body_options(text.body));
  const auto body = must(make_body(request));
  if (!text.json) return write_body(body, text.out);
  write_output(body_json(body));
}

}  // namespace

Subcommand body_command() {
  auto text = std::make_shared<BodyCommand>();
  Subcommand command{.name = "body"};
  command.footer =
      "Height gives the lengths, mass the masses; both give the leg's muscles. Sex and age change fat and muscle;\n"
      "--typical sets height and mass from them. Constitution and mesomorphy make muscles larger or smaller,\n"
      "endomorphy is fat, ectomorphy slenderness, which height and mass decide between themselves: where a request\n"
      "contradicts itself, what gave way is said in a note. What no active body weighs at that height and age is\n"
      "refused.\n"
      "body.json holds 48 segments (joint, length, mass, centre, inertia), the joints' limits and the leg's muscles\n"
      "(attachments, belly, fibres, pennation, tendon, section, volume), each with its source; body.png shows the\n"
      "body from the front and from its right in the anatomical position.\n"
      "\n"
      "Examples: mobil body --height 1.80 --mass 80 --out out\n"
      "          mobil body --age 8 --sex woman --typical --json | less\n"
      "          mobil body --height 165cm --mass 58 --biotype 2-3-4 --constitution thin --json | less";
  add_options(command, body_options(text->body));
  add_options(command, {{"--json", &text->json, "Print the JSON, and write and draw nothing"},
                        {"--out", &text->out, "Folder for the results, made if missing"}});
  command.empty_refused = true;
  command.run = [text] { return exit_status_of("body", attempt([&] { run_body(*text); })); };
  return command;
}

}  // namespace mobil
