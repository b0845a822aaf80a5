#include "demo/walk/walk_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <mobil/engine/geometry.h>
#include <mobil/png.h>
#include <mobil/renderer.h>
#include <mobil/video.h>
#include "demo/walk/drawn_skin.h"

namespace mobil {
namespace {

using namespace geometry;

constexpr int width = 1280, height = 720;
constexpr Colour line_red{0.80F, 0.16F, 0.12F};
constexpr float half_stride_s = 0.55F;

/// Returns the mean place of the pelvis over a stride around each frame, so that the camera does not sway with each
/// step.
std::vector<Vec3<float>> smooth_path(const WalkRecording& recording) {
  const std::size_t count = recording.frames.size();
  const auto reach = static_cast<std::size_t>(half_stride_s / recording.frame_s);
  std::vector<Vec3<float>> path(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t half = std::min({reach, i, count - 1 - i});  // symmetric
    Vec3<float> sum{0, 0, 0};
    for (std::size_t j = i - half; j <= i + half; ++j) {
      sum = sum + recording.frames[j].position_m[index(Segment::pelvis)];
    }
    path[i] = (1.0F / static_cast<float>(2 * half + 1)) * sum;
  }
  return path;
}

/// Returns a camera at the height of the hips that shows the whole body, or its legs. From the front right it is behind
/// if stairs would hide the feet. It moves with the walker but keeps its direction, so that turns are visible.
Camera follow(const Vec3<float>& at, float floor_m, const WalkOptions& options, const Body& body) {
  const float stature = body.request.height_m;
  const bool hidden = options.ground.rise > 0 && options.camera_deg == usual_camera_deg;
  const double angle = (hidden ? -114.0 : options.camera_deg) * std::numbers::pi / 180;
  const float away = stature * (options.camera_on_legs ? 1.3F : 2.28F);
  Camera camera;
  camera.target = {at.x, floor_m + stature * (options.camera_on_legs ? 0.33F : 0.50F), at.z + 0.1F * stature};
  if (options.camera_on_legs) camera.target.z = at.z;
  camera.eye = {camera.target.x + away * static_cast<float>(std::sin(angle)), camera.target.y + 0.1F * stature,
                camera.target.z + away * static_cast<float>(std::cos(angle))};
  camera.vertical_fov_deg = 28;
  return camera;
}

/// Returns the sticks of one frame: every segment from its joint to its parent's, and the ends of the limbs.
std::vector<Vec3<float>> sticks(const Pose<float>& pose, const Body& body) {
  const auto place = [&](Segment s, const Vec3<float>& p) {
    return pose.position_m[index(s)] + rotated(pose.rotation[index(s)], p);
  };
  std::vector<Vec3<float>> ends;
  std::array<bool, segment_count> has_child{};
  for (std::size_t s = 1; s < segment_count; ++s) {
    ends.push_back(pose.position_m[index(segment_parent[s])]);
    ends.push_back(pose.position_m[s]);
    has_child[index(segment_parent[s])] = true;
  }
  for (std::size_t s = 0; s < segment_count; ++s) {
    if (has_child[s]) continue;
    ends.push_back(pose.position_m[s]);
    ends.push_back(place(static_cast<Segment>(s), body.tip_m[s]));
  }
  for (std::size_t side = 0; side < 2; ++side) {
    const Segment foot = on_side(Segment::foot_right, side);
    ends.push_back(pose.position_m[index(foot)]);
    ends.push_back(place(foot, body.heel_m));
  }
  return ends;
}

/// Copies a picture into the left or right half of a wider one.
void set_beside(const Image& half, Image& whole, int column) {
  for (int y = 0; y < half.height; ++y) {
    const auto* from = half.pixel(0, y);
    auto* to = whole.rgba.data() + 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(whole.width) +
                                        static_cast<std::size_t>(column));
    std::copy(from, from + 4 * static_cast<std::size_t>(half.width), to);
  }
}

/// All data that is drawn in one frame; the scene refers to it.
struct FrameScene {
  RecordedScene drawn;
  std::vector<Vec3<float>> stick, joint;
  std::vector<DrawLines> lines;
  std::vector<DrawPoints> points;
  std::optional<BodySkin> own;  // drawn by `skin`
  DrawnSkin skin;
};

/// Creates the skin for the views that show it.
Result<void> begin_skin(const WalkDrawing& drawing, WalkView view, FrameScene& scene) {
  if (view != WalkView::skin && view != WalkView::glass) return {};
  const bool of_their_own = !drawing.figure->skins.empty(), dressed = view == WalkView::skin;
  auto made = make_body_skin(*drawing.body, SkinDetail::hero, {.dressed = dressed});
  if (!made) return tl::unexpected(made.error());
  scene.own = std::move(*made);
  scene.skin = {.skin = &*scene.own,
                .colours = dressed ? skin_colours(0) : bare_colours(),
                .opacity = opacity_of(view == WalkView::skin ? 1 : 0.45F)};
  if (!of_their_own) return {};
  return scene.skin.follow(*drawing.body, drawing.figure->skins, drawing.figure->rest_m, dressed);
}

void fill_scene(const WalkDrawing& drawing, WalkView view, std::size_t frame, FrameScene& scene) {
  const WalkRecording& recording = *drawing.recording;
  const Pose<float>& pose = recording.frames[frame];
  scene.drawn = {};
  scene.lines.clear();
  scene.points.clear();
  if (view == WalkView::stick) {
    scene.stick = sticks(pose, *drawing.body);
    scene.joint.assign(pose.position_m, pose.position_m + segment_count);
    scene.lines.push_back({.position = scene.stick, .colour = bone_ivory, .width = 0.022F, .unit = LineUnit::metre});
    scene.points.push_back({.position = scene.joint, .colour = joint_steel, .radius_m = 0.018F});
    scene.lines.push_back(
        {.position = drawing.action_line[frame], .colour = line_red, .width = 0.016F, .unit = LineUnit::metre});
    return;
  }
  if (scene.own) {
    scene.skin.pose(pose, muscles_of(recording, frame), drawing.fat.empty() ? nullptr : &drawing.fat[frame]);
    scene.skin.draw(scene.drawn.meshes);
    if (view == WalkView::skin) return;
  }
  add_bones(recording, frame, {0, 0, 0}, 1, scene.drawn);
  if (view == WalkView::wireframe) {
    scene.lines.push_back({.position = drawing.mesh_edge[frame], .colour = line_red, .width = 1.6F});
    return;
  }
  add_muscles(recording, frame, {0, 0, 0}, scene.drawn);
}

void add_ground(const GroundPicture& ground, FrameScene& scene) {
  constexpr Colour floor{0.80F, 0.81F, 0.82F}, edge{0.45F, 0.47F, 0.50F};
  scene.drawn.meshes.push_back(
      {.position = ground.position, .triangle = ground.triangle, .normal = ground.normal, .colour = floor});
  scene.lines.push_back({.position = ground.line, .colour = edge, .width = 0.012F, .unit = LineUnit::metre});
}

}  // namespace

Result<void> write_pictures(const WalkDrawing& drawing, const WalkOptions& options, const std::filesystem::path& folder,
                            const std::function<void(std::size_t)>& progress) {
  const int eye_width = options.stereo ? width / 2 : width;
  auto renderer = Renderer::create(eye_width, height);
  if (!renderer) return tl::unexpected(renderer.error());
  std::optional<VideoWriter> video;
  if (options.video) {
    auto opened = VideoWriter::create((folder / "walk.mp4").string(), width, height,
                                      static_cast<int>(std::lround(1 / drawing.recording->frame_s)));
    if (!opened) return tl::unexpected(opened.error());
    video = std::move(*opened);
  }

  const auto path = smooth_path(*drawing.recording);
  FrameScene contents;
  const bool level = options.ground.kind == GroundKind::level;
  const GroundPicture ground = level ? GroundPicture{} : picture_of(options.ground, path.back().z + 6);
  if (auto begun = begin_skin(drawing, options.view, contents); !begun) return begun;
  Image eye;
  Image whole{width, height, std::vector<std::uint8_t>(std::size_t{4} * width * height)};
  for (std::size_t frame = 0; frame < drawing.recording->frames.size(); ++frame) {
    fill_scene(drawing, options.view, frame, contents);
    const float floor_m = level ? 0 : path[frame].y - drawing.body->hip_height_m;
    const Camera camera = follow(path[frame], floor_m, options, *drawing.body);
    const StereoPair pair = stereo_pair(camera, static_cast<float>(options.eye_distance_m));
    Scene scene;
    if (!level) add_ground(ground, contents);
    scene.ground = level;
    scene.meshes = contents.drawn.meshes;
    scene.lines = contents.lines;
    scene.points = contents.points;
    scene.light = {-0.55F, 0.80F, 0.45F};
    const auto render = [&](const Camera& from, Image& image) {
      scene.camera = from;
      return renderer->render(scene, image);
    };
    if (options.stereo) {
      for (const bool left_eye : {true, false}) {
        if (auto done = render(left_eye ? pair.left : pair.right, eye); !done) return done;
        set_beside(eye, whole, left_eye ? 0 : eye_width);
      }
    } else if (auto done = render(camera, whole); !done) {
      return done;
    }
    if (options.frames) {
      const auto file = folder / fmt::format("frame_{:04}.png", frame);
      if (auto done = write_png(file.string(), whole); !done) return done;
    }
    if (video) {
      if (auto done = video->add(whole); !done) return done;
    }
    progress(frame + 1);
  }
  if (video) return video->close();
  return {};
}

}  // namespace mobil
