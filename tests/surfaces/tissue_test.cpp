// Tendons, aponeuroses and fibres on the surfaces of muscles.
//
// Lengths of paths and bellies: measured for this project on cuts of BodyParts3D 3.0 (© The Database Center for Life
// Science, licensed under CC Attribution-Share Alike 2.1 Japan), scaled to a stature of 1.80 m. A belly is where the
// section across the muscle's line has more than 20 % of its largest area.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/engine/geometry.h>
#include <mobil/surfaces.h>

namespace mobil::tissue_test {
using namespace geometry;

struct Measured {
  std::string_view muscle;
  double path_mm, belly_mm;
};
/// Left out are muscles whose measured length includes tendon: at the foot's edge, the toes and the lesser trochanter,
/// planes across the line cut tendons lengthwise. Gluteus maximus, gluteus minimus and both obturators are drawn by
/// sections across another line.
constexpr Measured measured[] = {
    {"adductor_brevis", 151, 159},
    {"adductor_longus", 250, 219},
    {"adductor_magnus", 358, 251},
    {"peroneus_tertius", 189, 130},
    {"flexor_hallucis_longus", 450, 182},
    {"gluteus_medius", 138, 131},
    {"gracilis", 474, 359},
    {"iliacus", 224, 181},
    {"pectineus", 115, 123},
    {"piriformis", 148, 101},
    {"popliteus", 96, 94},
    {"quadratus_femoris", 76, 61},
    {"sartorius", 630, 575},
    {"tensor_fasciae_latae", 586, 115},
    {"biceps_femoris_long_head", 440, 274},
    {"biceps_femoris_short_head", 263, 234},
    {"gastrocnemius_lateral", 478, 210},
    {"gastrocnemius_medial", 482, 216},
    {"plantaris", 500, 134},
    {"rectus_femoris", 447, 332},
    {"semimembranosus", 435, 308},
    {"semitendinosus", 486, 280},
    {"soleus", 312, 217},
    {"tibialis_anterior", 326, 223},
    {"vastus_intermedius", 196, 281},
    {"vastus_lateralis", 216, 310},
    {"vastus_medialis", 185, 288},
};
/// The measured man's leg is shorter than that of a body in proportion: hip to ankle, at 1.80 m.
constexpr double measured_leg_mm = 761 * 1.80 / 1.69;

/// All muscles of a body's right leg at rest.
struct Leg {
  Body body;
  BodySurfaces surfaces;
  std::vector<Vec3<float>> position, normal;

  explicit Leg(const BodyRequest& request, bool textured = false, double detail = 1) : body(*make_body(request)) {
    const SurfaceChoice choice{
        .bones = false, .sides = {true, false}, .simulated = muscle_members(), .detail = detail, .textured = textured};
    const DrawnSurfaces drawn = *draw_surfaces(body, choice);
    surfaces = *bind_surfaces(body, drawn, choice);
    for (const DrivenSurface& muscle : drawn.muscles) {
      const SurfaceMesh& mesh = muscle.surface.mesh;
      position.insert(position.end(), mesh.position.begin(), mesh.position.end());
    }
    normal.assign(position.size(), {0, 0, 0});
    for (std::size_t t = 0; t < surfaces.index.size(); t += 3) {
      const std::uint32_t* corner = &surfaces.index[t];
      const Vec3<float> out =
          cross(position[corner[1]] - position[corner[0]], position[corner[2]] - position[corner[0]]);
      for (int k = 0; k < 3; ++k) normal[corner[k]] = normal[corner[k]] + out;
    }
    for (Vec3<float>& n : normal) n = (1 / std::max(length(n), 1e-20F)) * n;
  }
  const SurfacePart& part(std::string_view muscle) const {
    return *std::ranges::find(surfaces.part, std::string(muscle) + "_right", &SurfacePart::name);
  }
  /// Returns the mean of `value` of a vertex over the surface of a part.
  template <class Value>
  double mean(const SurfacePart& of, const Value& value) const {
    double sum = 0, whole = 0;
    for (std::uint32_t i = of.first_index; i < of.first_index + of.indices; i += 3) {
      const std::uint32_t* corner = &surfaces.index[i];
      const auto edge = [&](int k) { return to_double(position[corner[k]]) - to_double(position[corner[0]]); };
      const double area = length(cross(edge(1), edge(2)));
      whole += area;
      for (int k = 0; k < 3; ++k) sum += area * value(corner[k]) / 3;
    }
    return sum / whole;
  }
};

const Leg& usual_leg() {
  static const Leg leg({.height_m = 1.80F, .mass_kg = 80});
  return leg;
}

TEST(Tissue, TendonsBeginWhereMeasuredBelliesEnd) {
  const Leg& leg = usual_leg();
  const LimbLengths<float> limbs = limb_lengths(leg.body);
  const double longer = 1000 * static_cast<double>(limbs.thigh_m + limbs.shank_m) / measured_leg_mm;
  for (const Measured& of : measured) {
    const SurfacePart& part = leg.part(of.muscle);
    double low = 1, high = 0;
    for (std::uint32_t v = part.first_vertex; v < part.first_vertex + part.vertices; ++v) {
      if (leg.surfaces.tissue[v].tendon > 127) continue;
      low = std::min(low, leg.surfaces.tissue[v].along / 255.0);
      high = std::max(high, leg.surfaces.tissue[v].along / 255.0);
    }
    const double belly_mm = 1000 * static_cast<double>(part.fibres.length_m) * (high - low);
    EXPECT_NEAR(belly_mm, longer * of.belly_mm, 0.155 * of.path_mm) << of.muscle;
  }
}

TEST(Tissue, AHamstringIsIvoryOverAQuarterOfItsSurface) {
  const Leg& leg = usual_leg();
  for (const Muscle muscle : {Muscle::semimembranosus, Muscle::semitendinosus, Muscle::biceps_femoris_long_head}) {
    const double ivory = leg.mean(leg.part(muscle_name(muscle)), [&](std::uint32_t v) {
      return static_cast<double>(tendon_colour_share(leg.surfaces.tissue[v]));
    });
    EXPECT_GT(ivory, 0.15) << muscle_name(muscle);
    EXPECT_LT(ivory, 0.40) << muscle_name(muscle);
  }
}

/// Returns the mean of the way out of the surface, backward, where one half of a muscle has an aponeurosis.
double sheet_backward(const Leg& leg, Muscle muscle, bool insertion) {
  const SurfacePart& part = leg.part(muscle_name(muscle));
  double sum = 0, whole = 0;
  for (std::uint32_t v = part.first_vertex; v < part.first_vertex + part.vertices; ++v) {
    const Tissue& tissue = leg.surfaces.tissue[v];
    if ((tissue.along > 127) != insertion || tissue.tendon > 127) continue;
    sum -= static_cast<double>(tissue.aponeurosis) * static_cast<double>(leg.normal[v].z);
    whole += tissue.aponeurosis;
  }
  return whole == 0 ? 0 : sum / whole;
}

/// Soleus and tibialis anterior insert by a sheet on their outside. The gastrocnemii, which cover soleus, insert by one
/// that faces it, and rectus femoris by one that faces vastus intermedius. Sheets of origins are on the other side.
TEST(Tissue, AponeurosesAreOnTheSideOfTheBoneOfMusclesThatCoverOthers) {
  const Leg& leg = usual_leg();
  EXPECT_GT(sheet_backward(leg, Muscle::soleus, true), 0.4);
  EXPECT_LT(sheet_backward(leg, Muscle::tibialis_anterior, true), -0.4);
  for (const Muscle muscle : {Muscle::gastrocnemius_medial, Muscle::gastrocnemius_lateral}) {
    EXPECT_LT(sheet_backward(leg, muscle, true), -0.4) << muscle_name(muscle);
    EXPECT_GT(sheet_backward(leg, muscle, false), 0.4) << muscle_name(muscle);
  }
  EXPECT_GT(sheet_backward(leg, Muscle::rectus_femoris, true), 0.4);
  EXPECT_LT(sheet_backward(leg, Muscle::rectus_femoris, false), -0.4);
}

TEST(Tissue, AponeurosesEndInTheBellyAndParallelMusclesHaveNone) {
  const Leg& leg = usual_leg();
  using enum Muscle;
  const std::vector<Muscle> parallel = {
      sartorius, gracilis, tensor_fasciae_latae, adductor_longus, adductor_brevis, adductor_magnus, pectineus};
  for (const SurfacePart& part : leg.surfaces.part) {
    const std::string name = part.name.substr(0, part.name.size() - 6);
    const auto muscle = find_muscle(name);
    if (!muscle) continue;  // tendons and ligaments
    const double sheet = leg.mean(part, [&](std::uint32_t v) { return leg.surfaces.tissue[v].aponeurosis / 255.0; });
    if (std::ranges::find(parallel, *muscle) != parallel.end()) {
      EXPECT_EQ(sheet, 0) << name;
    } else {
      EXPECT_LT(sheet, 0.5) << name;
    }
    EXPECT_GT(part.fibres.length_m, 0.02F) << name;
    EXPECT_GT(part.fibres.girth_m, 0.005F) << name;
    EXPECT_LT(part.fibres.pennation_rad, 0.6F) << name;
  }
  EXPECT_GT(leg.mean(leg.part("semimembranosus"),
                     [&](std::uint32_t v) { return leg.surfaces.tissue[v].aponeurosis / 255.0; }),
            0.03);
}

TEST(Tissue, IsTheSameForBodiesInProportionTexturedSurfacesAndBothSides) {
  const Leg& leg = usual_leg();
  EXPECT_EQ(Leg({.height_m = 1.80F, .mass_kg = 80}, true).surfaces.tissue, leg.surfaces.tissue);
  constexpr float smaller = 0.9F;
  const Leg small({.height_m = smaller * 1.80F, .mass_kg = smaller * smaller * 80});
  ASSERT_EQ(small.surfaces.tissue.size(), leg.surfaces.tissue.size());
  for (const SurfacePart& part : leg.surfaces.part) {
    double apart = 0;
    for (std::uint32_t v = part.first_vertex; v < part.first_vertex + part.vertices; ++v) {
      const Tissue &a = leg.surfaces.tissue[v], &b = small.surfaces.tissue[v];
      apart += std::abs(a.tendon - b.tendon) + std::abs(a.aponeurosis - b.aponeurosis);
    }
    EXPECT_LT(apart / (255.0 * part.vertices), 0.06) << part.name;
  }
  const BodySurfaces both = *bind_surfaces(leg.body, {});
  std::map<std::string, const SurfacePart*> by_name;
  for (const SurfacePart& part : both.part) by_name[part.name] = &part;
  for (const auto& [name, part] : by_name) {
    if (!part->driver || !name.ends_with("_left")) {
      for (std::uint32_t v = 0; !part->driver && v < part->vertices; ++v)
        ASSERT_EQ(both.tissue[part->first_vertex + v], Tissue{}) << name;
      continue;
    }
    const SurfacePart& right = *by_name.at(name.substr(0, name.size() - 4) + "right");
    for (std::uint32_t v = 0; v < part->vertices; ++v)
      ASSERT_EQ(both.tissue[part->first_vertex + v], both.tissue[right.first_vertex + v]) << name;
  }
}

TEST(Tissue, CoarserSurfacesHaveTheSameShareOfTendon) {
  if (!draw_surfaces(usual_leg().body, {.bones = false, .detail = 0.3})) GTEST_SKIP() << "built without meshoptimizer";
  const Leg coarse({.height_m = 1.80F, .mass_kg = 80}, false, 0.3);
  const Leg& fine = usual_leg();
  for (const SurfacePart& part : fine.surfaces.part) {
    const auto ivory = [](const Leg& leg, const SurfacePart& of) {
      return leg.mean(of, [&](std::uint32_t v) { return leg.surfaces.tissue[v].tendon / 255.0; });
    };
    const SurfacePart& same = *std::ranges::find(coarse.surfaces.part, part.name, &SurfacePart::name);
    EXPECT_NEAR(ivory(coarse, same), ivory(fine, part), 0.06) << part.name;
  }
}

/// A surface from a file has no tendon shares: it is tendon where it is thin.
TEST(Tissue, ASurfaceWithoutSharesIsTendonWhereItIsThin) {
  const Leg& leg = usual_leg();
  SurfaceChoice choice{.bones = false, .simulated = muscle_members()};
  DrawnSurfaces drawn = *draw_surfaces(leg.body, choice);
  for (DrivenSurface& muscle : drawn.muscles) muscle.tendon.clear();
  const BodySurfaces unknown =
      *bind_surfaces(leg.body, drawn, {.bones = false, .sides = {true, false}, .simulated = choice.simulated});
  for (const std::string_view name : {"semimembranosus", "tibialis_anterior", "gastrocnemius_medial", "sartorius"}) {
    const SurfacePart& part = leg.part(name);
    const auto share = [&](const BodySurfaces& of) {
      return leg.mean(part, [&](std::uint32_t v) { return of.tissue[v].tendon / 255.0; });
    };
    EXPECT_NEAR(share(unknown), share(leg.surfaces), 0.10) << name;
  }
}

}  // namespace mobil::tissue_test
