#pragma once
// Strands of muscles of two published models of OpenSim's, at the models' own size: x ahead, y up, z to the right, m;
// right side.
//
// rajagopal2016: Rajagopal, Dembia, DeMers, Delp, Hicks & Delp, Full-body musculoskeletal model for muscle-driven
// simulation of human gait, IEEE Trans. Biomed. Eng. 63, 2016; as distributed with OpenSim, Apache License 2.0.
// gait2392: Delp, Loan, Hoy, Zajac, Topp & Rosen, An interactive graphics-based model of the lower extremity, IEEE
// Trans. Biomed. Eng. 37, 1990; CC BY 3.0.

#include <optional>
#include <string_view>
#include <vector>

#include "engine/eigen.h"

namespace mobil::test::opensim {

enum class Model { rajagopal2016, gait2392 };
enum Bone { pelvis, femur, tibia, calcaneus, toes };

struct Point {
  Bone bone;
  Eigen::Vector3d at;
};

/// A cylinder about its own z axis that a path must not enter. It is turned from the bone's axes by rotations about its
/// own x, y and z, in this order. `side` is the direction along its x or y in which paths pass, 0 for the shorter way.
struct Cylinder {
  Bone bone;
  Eigen::Vector3d turn_deg, at;
  double radius, length;
  Eigen::Vector2d side = {0, 0};
  bool only_second_segment = false;
};

/// One path of a muscle. `line` is the name in the library's table, `volume_cm3` the weight of a strand.
struct Strand {
  std::string_view line;
  Model model;
  double volume_cm3;
  std::vector<Point> path;
  std::optional<Cylinder> cylinder = {};
};

/// Rajagopal's knee every 10 degrees from 0: origin of the tibia in the femur, m; its flexion, adduction and inward
/// rotation, degrees.
inline constexpr std::size_t knee_rows = 13;
inline constexpr double knee_motion[knee_rows][6] = {{0, -0.40443, -0.00127, 0, 0, 0},
                                                     {0.00148, -0.40534, -0.00168, 10.204, 0.355, 2.761},
                                                     {0.00259, -0.40644, -0.002, 20.344, 0.741, 4.987},
                                                     {0.00335, -0.40767, -0.00226, 30.436, 1.127, 6.741},
                                                     {0.00376, -0.40894, -0.00244, 40.494, 1.489, 8.084},
                                                     {0.00383, -0.41022, -0.00258, 50.53, 1.811, 9.079},
                                                     {0.00359, -0.41142, -0.00267, 60.554, 2.09, 9.788},
                                                     {0.00307, -0.4125, -0.00273, 70.573, 2.332, 10.272},
                                                     {0.00228, -0.4134, -0.00277, 80.59, 2.555, 10.592},
                                                     {0.00126, -0.41408, -0.00279, 90.605, 2.788, 10.807},
                                                     {0.00007, -0.41449, -0.0028, 100.616, 3.076, 10.973},
                                                     {-0.00127, -0.41461, -0.00281, 110.62, 3.473, 11.146},
                                                     {-0.00269, -0.41441, -0.00281, 120.616, 4.052, 11.378}};

inline const std::vector<Strand> strands = {
    {"gluteus_maximus",
     Model::rajagopal2016,
     241.03,
     {{pelvis, {-0.1231, 0.0345, 0.0563}},
      {pelvis, {-0.1257, -0.0242, 0.0779}},
      {femur, {-0.0444, -0.0326, 0.0302}},
      {femur, {-0.0277, -0.0566, 0.047}}},
     Cylinder{pelvis, {-34.3775, 25.7831, 0}, {-0.077, -0.099, 0.061}, 0.04, 0.15, {-1, 0}, false}},
    {"gluteus_maximus",
     Model::rajagopal2016,
     367.92,
     {{pelvis, {-0.1317, 0.0087, 0.0462}},
      {pelvis, {-0.1344, -0.0609, 0.0813}},
      {femur, {-0.045, -0.0584, 0.0252}},
      {femur, {-0.0156, -0.1016, 0.0419}}},
     Cylinder{pelvis, {-42.9718, 22.3454, 0}, {-0.08, -0.083, 0.068}, 0.04, 0.1, {}, false}},
    {"gluteus_maximus",
     Model::rajagopal2016,
     263.79,
     {{pelvis, {-0.13, -0.0525, 0.009}},
      {pelvis, {-0.1273, -0.1263, 0.0435}},
      {femur, {-0.0281, -0.1125, 0.0094}},
      {femur, {-0.006, -0.1419, 0.0411}}},
     Cylinder{pelvis, {-5.7296, 0, 0}, {-0.083, -0.088, 0.068}, 0.04, 0.1, {}, false}},
    {"gluteus_medius_anterior",
     Model::rajagopal2016,
     133.04,
     {{pelvis, {-0.0445, 0.0245, 0.1172}}, {femur, {-0.0218, -0.0117, 0.0555}}}},
    {"gluteus_medius_rear",
     Model::rajagopal2016,
     93.09,
     {{pelvis, {-0.085, 0.0316, 0.0675}}, {femur, {-0.0258, -0.0058, 0.0527}}}},
    {"gluteus_medius_rear",
     Model::rajagopal2016,
     106,
     {{pelvis, {-0.1152, -0.0073, 0.0526}}, {femur, {-0.0309, -0.0047, 0.0518}}}},
    {"gluteus_minimus",
     Model::rajagopal2016,
     42.39,
     {{pelvis, {-0.0464, -0.0149, 0.1042}}, {femur, {-0.0072, -0.0104, 0.056}}}},
    {"gluteus_minimus",
     Model::rajagopal2016,
     36.85,
     {{pelvis, {-0.0616, -0.0142, 0.0971}}, {femur, {-0.0096, -0.0104, 0.056}}}},
    {"gluteus_minimus",
     Model::rajagopal2016,
     28.3,
     {{pelvis, {-0.0789, -0.0155, 0.0798}}, {femur, {-0.0135, -0.0083, 0.055}}}},
    {"tensor_fasciae_latae",
     Model::rajagopal2016,
     65.11,
     {{pelvis, {-0.0311, 0.0214, 0.1241}},
      {femur, {0.0294, -0.0995, 0.0597}},
      {femur, {0.0107, -0.405, 0.0324}},
      {tibia, {0.0108, -0.041, 0.0346}}}},
    {"iliacus",
     Model::rajagopal2016,
     181.42,
     {{pelvis, {-0.0605, 0.0309, 0.0843}},
      {pelvis, {-0.0135, -0.0557, 0.0756}},
      {femur, {-0.0023, -0.0565, 0.0139}},
      {femur, {-0.0122, -0.0637, 0.0196}}},
     Cylinder{pelvis, {-18.3346, -13.751, 51.5662}, {-0.071, -0.065, 0.0756}, 0.0549, 0.1, {0, -1}, true}},
    {"psoas",
     Model::rajagopal2016,
     277.99,
     {{pelvis, {-0.0606, 0.062, 0.039}},
      {pelvis, {-0.0205, -0.0654, 0.0656}},
      {femur, {-0.0132, -0.0467, 0.0046}},
      {femur, {-0.0235, -0.0524, 0.0088}}},
     Cylinder{pelvis, {-14.3239, -15.4699, 5.7296}, {-0.074, -0.06, 0.0656}, 0.05, 0.1, {0, -1}, true}},
    {"sartorius",
     Model::rajagopal2016,
     167.52,
     {{pelvis, {-0.0195, -0.0156, 0.1056}},
      {femur, {-0.003, -0.3568, -0.0421}},
      {tibia, {-0.0251, -0.0401, -0.0365}},
      {tibia, {-0.0159, -0.0599, -0.0264}},
      {tibia, {0.0136, -0.081, -0.0026}}}},
    {"gracilis",
     Model::rajagopal2016,
     106.8,
     {{pelvis, {-0.04736, -0.12932, 0.02456}},
      {tibia, {-0.01842, -0.04755, -0.02961}},
      {tibia, {0.00178, -0.06962, -0.01573}}},
     Cylinder{tibia, {0, -22.9183, 0}, {-0.003, -0.02, 0}, 0.036, 0.1, {}, false}},
    {"adductor_longus",
     Model::rajagopal2016,
     165.33,
     {{pelvis, {-0.00758, -0.0889, 0.01888}}, {femur, {0.01126, -0.23937, 0.01583}}},
     Cylinder{femur, {101.821, 7.8202, 0}, {0.03073, -0.23191, 0.01511}, 0.0201, 0.1, {}, false}},
    {"adductor_brevis",
     Model::rajagopal2016,
     107.54,
     {{pelvis, {-0.0191, -0.094, 0.0154}}, {femur, {-0.002, -0.118, 0.0249}}},
     Cylinder{femur, {95.2009, 10.6939, 0}, {0.01464, -0.1126, 0.02337}, 0.0165, 0.07, {}, false}},
    {"adductor_magnus",
     Model::rajagopal2016,
     105.12,
     {{pelvis, {-0.03098, -0.10755, 0.01365}}, {femur, {-0.01527, -0.07886, 0.03202}}},
     Cylinder{femur, {92.3184, 10.6891, 0}, {0.00518, -0.07289, 0.0254}, 0.0211, 0.07, {}, false}},
    {"adductor_magnus",
     Model::rajagopal2016,
     137.08,
     {{pelvis, {-0.05266, -0.12075, 0.02854}}, {femur, {0.00242, -0.1624, 0.02922}}},
     Cylinder{femur, {92.3258, 7.8243, 0}, {0.02301, -0.16071, 0.02058}, 0.0214, 0.12, {}, false}},
    {"adductor_magnus",
     Model::rajagopal2016,
     176.4,
     {{pelvis, {-0.07404, -0.12767, 0.03982}}, {femur, {0.01125, -0.2625, 0.0193}}},
     Cylinder{femur, {98.0835, 10.6935, 0}, {0.03161, -0.26074, 0.00936}, 0.0218, 0.2, {}, false}},
    {"adductor_magnus",
     Model::rajagopal2016,
     155.5,
     {{pelvis, {-0.08962, -0.12976, 0.04171}}, {femur, {0.00481, -0.38797, -0.03273}}},
     Cylinder{femur, {98.0417, -26.5487, 0}, {-0.02265, -0.37683, -0.00315}, 0.04, 0.24, {}, false}},
    {"piriformis",
     Model::rajagopal2016,
     44.62,
     {{pelvis, {-0.10181, -0.00653, 0.01351}},
      {pelvis, {-0.10202, -0.03066, 0.06092}},
      {femur, {-0.0148, -0.0036, 0.0437}}}},
    {"pectineus", Model::gait2392, 44.33, {{pelvis, {-0.0431, -0.0768, 0.0451}}, {femur, {-0.0122, -0.0822, 0.0253}}}},
    {"quadratus_femoris",
     Model::gait2392,
     34.29,
     {{pelvis, {-0.1143, -0.1151, 0.052}}, {femur, {-0.0381, -0.0359, 0.0366}}}},
    {"tibialis_posterior",
     Model::gait2392,
     82.05,
     {{tibia, {-0.0094, -0.1348, 0.0019}},
      {tibia, {-0.0144, -0.4051, -0.0229}},
      {calcaneus, {0.0417, 0.0334, -0.0286}},
      {calcaneus, {0.0772, 0.0159, -0.0281}}}},
    {"peroneus_longus",
     Model::gait2392,
     77.01,
     {{tibia, {0.0005, -0.1568, 0.0362}},
      {tibia, {-0.0207, -0.4205, 0.0286}},
      {tibia, {-0.0162, -0.4319, 0.0289}},
      {calcaneus, {0.0438, 0.023, 0.0221}},
      {calcaneus, {0.0681, 0.0106, 0.0284}},
      {calcaneus, {0.0852, 0.0069, 0.0118}},
      {calcaneus, {0.1203, 0.0085, -0.0184}}}},
    {"peroneus_brevis",
     Model::gait2392,
     36.25,
     {{tibia, {-0.007, -0.2646, 0.0325}},
      {tibia, {-0.0198, -0.4184, 0.0283}},
      {tibia, {-0.0144, -0.4295, 0.0289}},
      {calcaneus, {0.0471, 0.027, 0.0233}},
      {calcaneus, {0.0677, 0.0219, 0.0343}}}},
    {"peroneus_tertius",
     Model::gait2392,
     23.7,
     {{tibia, {0.001, -0.2804, 0.0231}}, {tibia, {0.0229, -0.4069, 0.0159}}, {calcaneus, {0.0857, 0.0228, 0.0299}}}},
    {"extensor_digitorum_longus",
     Model::gait2392,
     87.04,
     {{tibia, {0.0032, -0.1381, 0.0276}},
      {tibia, {0.0289, -0.4007, 0.0072}},
      {calcaneus, {0.0922, 0.0388, -0.0001}},
      {calcaneus, {0.1616, 0.0055, 0.013}},
      {toes, {0.0003, 0.0047, 0.0153}},
      {toes, {0.0443, -0.0004, 0.025}}}},
    {"extensor_hallucis_longus",
     Model::gait2392,
     29.97,
     {{tibia, {0.0012, -0.1767, 0.0228}},
      {tibia, {0.0326, -0.3985, -0.0085}},
      {calcaneus, {0.097, 0.0389, -0.0211}},
      {calcaneus, {0.1293, 0.0309, -0.0257}},
      {calcaneus, {0.1734, 0.0139, -0.028}},
      {toes, {0.0298, 0.0041, -0.0245}},
      {toes, {0.0563, 0.0034, -0.0186}}}},
    {"flexor_digitorum_longus",
     Model::gait2392,
     17.57,
     {{tibia, {-0.0083, -0.2046, -0.0018}},
      {tibia, {-0.0154, -0.4051, -0.0196}},
      {calcaneus, {0.0436, 0.0315, -0.028}},
      {calcaneus, {0.0708, 0.0176, -0.0263}},
      {calcaneus, {0.1658, -0.0081, 0.0116}},
      {toes, {-0.0019, -0.0078, 0.0147}},
      {toes, {0.0285, -0.0071, 0.0215}},
      {toes, {0.0441, -0.006, 0.0242}}}},
    {"flexor_hallucis_longus",
     Model::gait2392,
     23.08,
     {{tibia, {-0.0079, -0.2334, 0.0244}},
      {tibia, {-0.0186, -0.4079, -0.0174}},
      {calcaneus, {0.0374, 0.0276, -0.0241}},
      {calcaneus, {0.1038, 0.0068, -0.0256}},
      {calcaneus, {0.1726, -0.0053, -0.0269}},
      {toes, {0.0155, -0.0064, -0.0265}},
      {toes, {0.0562, -0.0102, -0.0181}}}},
};

}  // namespace mobil::test::opensim
