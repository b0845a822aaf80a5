#include <mobil/assets/surfaces/clothes.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;
using form::BodyForm;

/// A point in the coordinates that clothes use; m of a body of 1.75 m.
struct Where {
  Vec p;            // right-hand side, x ≥ 0 outwards
  double down_arm;  // from the shoulder; −1 off the arm
  double down_leg;  // s of the leg
  Sex sex;
};

Where where(const BodyForm& form, const Vec& p) {
  const double size = form.size();
  const Vec right{-std::abs(p.x), p.y, p.z}, arm = form.in_arm(right);
  Where at{};
  at.p = form.scale().usual({-right.x, p.y, p.z});
  const bool on_arm = right.x < -0.17 * size && std::abs(arm.x - form.arm().shoulder().x) < 0.11 * size;
  at.down_arm = on_arm ? (form.arm().shoulder().y - arm.y) / form.scale().arm : -1;
  at.sex = form.sex();
  at.down_leg = form.leg().s(form.in_leg(right).y);
  return at;
}

constexpr double hem_m = 0.925, sleeve_m = 0.19, shorts_s = 0.80, shoe_m = 0.082;

/// Returns the distance outside a part's border, m; negative within.
double outside(SkinPart part, const Where& at) {
  const Vec& p = at.p;
  switch (part) {
    case SkinPart::shirt: {
      const double neck = 1.478 - 0.42 * p.z - 0.25 * std::max(0.0, 0.06 - p.x);  // lower in front than behind
      return std::max({hem_m - p.y, p.y - neck, at.down_arm - sleeve_m});
    }
    case SkinPart::shorts:
      return std::max({p.y - hem_m, 0.43 * (at.down_leg - shorts_s), p.x - 0.36});
    case SkinPart::shoes:
      return p.y - shoe_m - 0.10 * std::max(0.0, -p.z);
    case SkinPart::hair: {
      // The hairline runs high over the forehead, in front of the ears and behind them down to the nape.
      const bool woman = at.sex == Sex::woman;
      const double front = smoothstep(-0.02, 0.085, p.z),
                   line = (woman ? 1.530 : 1.578) + (woman ? 0.170 : 0.125) * front;
      const double ear = 0.078 * std::exp(-(p.z + 0.010) * (p.z + 0.010) / 0.0009) * smoothstep(0.050, 0.066, p.x);
      return line + (woman ? 0 : ear) - p.y;
    }
    case SkinPart::lips: {
      const double bow = 0.0010 * std::cos(std::min(p.x / 0.006, 3.1));
      const double half = 0.0070 * std::sqrt(std::max(0.0, 1 - p.x * p.x / (0.0245 * 0.0245)));
      return std::max({std::abs(p.y - 1.5663 + 0.8 * bow) - half, p.x - 0.0242, 0.070 - p.z});
    }
    case SkinPart::skin:
    case SkinPart::legs:
      break;
  }
  return 1;
}

constexpr std::array<SkinPart, 5> worn = {SkinPart::lips, SkinPart::hair, SkinPart::shirt, SkinPart::shorts,
                                          SkinPart::shoes};

constexpr double hem_width_m = 0.003;

bool is_cloth(SkinPart part) {
  return part == SkinPart::shirt || part == SkinPart::shorts || part == SkinPart::shoes;
}

/// Divides triangles where a field changes its sign between two corners. Corners nearer to the border than `snap` of an
/// edge are moved onto it.
void cut(std::vector<double>& field, double snap, SurfaceMesh& mesh, std::vector<SkinPart>& part) {
  for (std::size_t t = 0; t < mesh.triangle.size(); t += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangle[t + k], b = mesh.triangle[t + (k + 1) % 3];
      for (const auto& [near, far] : {std::pair{a, b}, std::pair{b, a}}) {
        if (field[near] * field[far] >= 0) continue;
        const double share = field[near] / (field[near] - field[far]);
        if (share >= snap) continue;
        Vec3<float>& p = mesh.position[near];
        p = p + static_cast<float>(share) * (mesh.position[far] - p);
        field[near] = 0;
      }
    }
  }
  std::unordered_map<std::uint64_t, std::uint32_t> middle;
  const auto between = [&](std::uint32_t a, std::uint32_t b) {
    const std::uint64_t key = static_cast<std::uint64_t>(std::min(a, b)) << 32 | std::max(a, b);
    const auto [found, is_new] = middle.try_emplace(key, static_cast<std::uint32_t>(mesh.position.size()));
    if (is_new) {
      const double share = field[a] / (field[a] - field[b]);
      const Vec3<float> from = mesh.position[a], to = mesh.position[b];
      mesh.position.push_back(from + static_cast<float>(share) * (to - from));
      field.push_back(0);
    }
    return found->second;
  };
  const auto split = [&](std::size_t t, std::size_t k) {  // along the edge from corner k to the next
    const std::uint32_t a = mesh.triangle[t + k], b = mesh.triangle[t + (k + 1) % 3],
                        c = mesh.triangle[t + (k + 2) % 3];
    const std::uint32_t m = between(a, b);
    for (const std::uint32_t v : {m, b, c}) mesh.triangle.push_back(v);
    part.push_back(part[t / 3]);
    mesh.triangle[t] = a;
    mesh.triangle[t + 1] = m;
    mesh.triangle[t + 2] = c;
  };
  for (std::size_t t = 0; t < mesh.triangle.size(); t += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangle[t + k], b = mesh.triangle[t + (k + 1) % 3];
      if (field[a] * field[b] >= 0) continue;
      split(t, k);
      k = 2;  // repeats this triangle; its new half follows later
      t -= 3;
    }
  }
}

}  // namespace

std::vector<SkinPart> cut_clothes(const BodyForm& form, SurfaceMesh& mesh, bool hems) {
  std::vector<SkinPart> part(mesh.triangle.size() / 3, SkinPart::skin);
  std::vector<double> field;
  const auto cut_at = [&](SkinPart one, double beyond_m, double snap) {
    field.clear();
    for (const Vec3<float>& p : mesh.position) field.push_back(outside(one, where(form, to_double(p))) - beyond_m);
    cut(field, snap, mesh, part);
  };
  for (const SkinPart one : worn) {
    const bool has_hem = hems && is_cloth(one);
    cut_at(one, 0, 0.25);
    if (has_hem) cut_at(one, hem_width_m, 0.02);
    for (std::size_t t = 0; t < part.size(); ++t) {
      double sum = 0;
      for (std::size_t k = 0; k < 3; ++k) sum += field[mesh.triangle[3 * t + k]];
      if (sum < 0) part[t] = one;
    }
  }
  for (std::size_t t = 0; t < part.size(); ++t) {
    const Where at = where(form, to_double(mesh.position[mesh.triangle[3 * t]]));
    if (part[t] == SkinPart::skin && at.p.y < 0.6 && at.p.x < 0.4) part[t] = SkinPart::legs;
  }
  return part;
}

std::vector<double> cloth_thickness(const BodyForm& form, const std::vector<Vec>& place) {
  std::vector<double> thickness;
  thickness.reserve(place.size());
  for (const Vec& p : place) {
    const Where at = where(form, p);
    const double shirt = -outside(SkinPart::shirt, at), shorts = -outside(SkinPart::shorts, at),
                 shoes = -outside(SkinPart::shoes, at), hair = -outside(SkinPart::hair, at);
    // Cloth reaches its full offset within the hem's width and is farthest from the body there.
    double off = 0;
    off = std::max(off, (0.005 + 0.007 * (1 - smoothstep(0, 0.12, shirt))) * smoothstep(-hem_width_m, 0, shirt));
    const double up_leg = 0.43 * (shorts_s - at.down_leg);  // from the hem
    off = std::max(off, (0.004 + 0.010 * (1 - smoothstep(0, 0.20, up_leg))) * smoothstep(-hem_width_m, 0, shorts));
    off = std::max(off, 0.004 * smoothstep(-hem_width_m, 0, shoes));
    const double full = form.sex() == Sex::woman ? 0.016 : 0.009;
    off = std::max(off, full * smoothstep(-0.002, 0.014, hair));
    thickness.push_back(off * form.size());
  }
  return thickness;
}

}  // namespace mobil::inline v0_3
