#include <mobil/bvh_writer.h>

#include <fmt/format.h>

#include <array>
#include <numbers>
#include <string>
#include <vector>

#include <mobil/assets/files/output_file.h>
#include "assets/export/figure_pieces.h"
#include "assets/export/joint_angles.h"
#include "assets/export/recording_check.h"
#include "assets/export/skeleton_keys.h"

namespace mobil::inline v0_3 {
namespace {

constexpr double bvh_degrees = 180 / std::numbers::pi;

struct BvhSkeleton {
  std::array<Eigen::Vector3d, segment_count> offset_m;
  std::array<bool, segment_count> slides;
  std::array<std::vector<std::size_t>, segment_count> children;
  std::vector<std::size_t> order;  // in the hierarchy's order
};

BvhSkeleton bvh_skeleton(const SkeletonKeys& keys) {
  BvhSkeleton made;
  for (std::size_t s = 0; s < segment_count; ++s) {
    const std::size_t parent = index(segment_parent[s]);
    made.slides[s] = parent == s || keys.segment[s].translation_m.size() > 1;
    made.offset_m[s] = made.slides[s] ? Eigen::Vector3d::Zero() : widened(keys.segment[s].translation_m.front());
    if (parent != s) made.children[parent].push_back(s);
  }
  return made;
}

void write_joint(std::size_t s, std::size_t depth, const WalkRecording& recording, BvhSkeleton& skeleton,
                 std::string& text) {
  const std::string indent(depth, '\t');
  const Eigen::Vector3d& offset = skeleton.offset_m[s];
  skeleton.order.push_back(s);
  text += fmt::format("{}{} {}\n{}{{\n", indent, depth == 0 ? "ROOT" : "JOINT", segment_name[s], indent);
  text += fmt::format("{}\tOFFSET {:.6f} {:.6f} {:.6f}\n", indent, offset.x(), offset.y(), offset.z());
  text += fmt::format("{}\tCHANNELS {}Xrotation Zrotation Yrotation\n", indent,
                      skeleton.slides[s] ? "6 Xposition Yposition Zposition " : "3 ");
  for (const std::size_t child : skeleton.children[s]) write_joint(child, depth + 1, recording, skeleton, text);
  if (skeleton.children[s].empty()) {
    const Vec3<float> tip = recording.tip_m.size() != segment_count ? Vec3<float>{0, 0, 0} : recording.tip_m[s];
    text += fmt::format("{0}\tEnd Site\n{0}\t{{\n{0}\t\tOFFSET {1:.6f} {2:.6f} {3:.6f}\n{0}\t}}\n", indent, tip.x,
                        tip.y, tip.z);
  }
  text += indent + "}\n";
}

std::string bvh_text(const WalkRecording& recording) {
  const RecordedPeople people = recorded_people(recording);
  const SkeletonKeys keys = skeleton_keys(recording.frames, figure_standing(people.figures[0], people.people[0]));
  BvhSkeleton skeleton = bvh_skeleton(keys);
  std::string text = "HIERARCHY\n";
  write_joint(0, 0, recording, skeleton, text);
  std::vector<std::vector<JointTurn>> turns(segment_count);
  for (std::size_t s = 0; s < segment_count; ++s) {
    std::vector<Eigen::Quaterniond> local;
    const auto& rotation = keys.segment[s].rotation;
    local.reserve(rotation.size());
    for (const auto& q : rotation) {
      local.emplace_back(static_cast<double>(q.w), static_cast<double>(q.x), static_cast<double>(q.y),
                         static_cast<double>(q.z));
    }
    turns[s] = joint_turns(local);
  }
  text += fmt::format("MOTION\nFrames: {}\nFrame Time: {:.9f}\n", recording.frames.size(), recording.frame_s);
  for (std::size_t f = 0; f < recording.frames.size(); ++f) {
    for (const std::size_t s : skeleton.order) {
      if (skeleton.slides[s]) {
        const auto& places = keys.segment[s].translation_m;
        const auto& p = places[std::min(f, places.size() - 1)];
        text += fmt::format("{:.6f} {:.6f} {:.6f} ", p.x, p.y, p.z);
      }
      const JointTurn& turn = turns[s][std::min(f, turns[s].size() - 1)];
      text += fmt::format("{:.5f} {:.5f} {:.5f} ", turn.x * bvh_degrees, turn.z * bvh_degrees, turn.y * bvh_degrees);
    }
    text.back() = '\n';
  }
  return text;
}

}  // namespace

Result<void> write_bvh(const std::filesystem::path& path, const WalkRecording& recording) {
  if (auto ok = check_recording(recorded_people(recording)); !ok) {
    return fail(fmt::format("{}: {}", path.string(), ok.error().message));
  }
  return write_file(path, bvh_text(recording));
}

}  // namespace mobil::inline v0_3
